//! What a run says of itself: the codes and limits that its scene names, and spans by plane.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

/// Two girders HEB 400 of 12 m, 12 m apart, that are held laterally at midspan.
fn runway() -> Value {
    let held = |point: usize, fix: Value| json!({"point": point, "fix": fix});
    let mut supports = Vec::new();
    for first in [0, 3] {
        supports.push(held(first, json!(["ux", "uy", "uz", "rx"])));
        supports.push(held(first + 1, json!(["uz"])));
        supports.push(held(first + 2, json!(["uy", "uz", "rx"])));
    }
    let rail = |z: f64, first: usize| {
        json!({"origin": [0, 0, z], "axis": [1, 0, 0], "stations": [0, 6, 12],
            "segments": [{"cell": [0, first]}, {"cell": [0, first + 1]}]})
    };
    json!({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "theory": "euler-bernoulli",
        "points": [[0, 0, 0], [6, 0, 0], [12, 0, 0], [0, 0, 12], [6, 0, 12], [12, 0, 12]],
        "cells": [{"type": "line", "data": [[0, 1], [1, 2], [3, 4], [4, 5]]}],
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}],
        "sections": [{"name": "g", "material": "steel", "shape": "HEB 400"}],
        "supports": supports, "rails": {"north": rail(0.0, 0), "south": rail(12.0, 2)}})
}

/// A bridge of 200 kN on four wheels, 3 m apart along the rails, that travels over the runway.
fn scene(practice: Value) -> Value {
    let truck = |name: &str, z: f64| {
        json!({"name": name, "body": "bridge", "tree": [-1.5, 1.5], "rail": format!("rw.{name}"), "wheel": "w",
            "at": [0, 0, z]})
    };
    json!({"format": "girderway-scene/1", "name": "lim", "units": {"length": "m", "force": "kN", "time": "s"},
        "gravity": 9.81, "analysis": "quasi-static",
        "structures": {"rw": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"bridge": {"weight": 200, "inertia": [500, 500, 100], "dof": ["y", "roll", "pitch"],
            "track": ["rw.north", "rw.south"]}},
        "wheels": {"w": {"radius": 0.2, "vertical": {"k": 5e5}}},
        "trucks": [truck("north", -6.0), truck("south", 6.0)],
        "motions": [{"body": "bridge", "dof": "x", "kind": "prescribed", "position": [[0, 1.5], [10, 10.5]]}],
        "end": {"time": 10}, "practice": practice})
}

fn run(folder: &Path, scene: &Value, flags: &[&str]) -> (Output, Value) {
    std::fs::write(folder.join("spec.json"), runway().to_string()).expect("a writable folder");
    std::fs::write(folder.join("scene.json"), scene.to_string()).expect("a writable folder");
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["run", "scene.json", "-o", "out"])
        .args(flags)
        .current_dir(folder)
        .output()
        .expect("the program starts");
    let text = std::fs::read_to_string(folder.join("out/summary.json")).unwrap_or_else(|error| {
        panic!("{error}: {}", String::from_utf8_lossy(&output.stderr));
    });
    (output, serde_json::from_str(&text).expect("JSON"))
}

/// Analytic: two wheels of 50 kN, 3 m apart in the middle of a simple beam of 12 m, P a (3 L^2 - 4 a^2)/(24 E I) with
/// a = 4.5 m: L/442, although a lateral support stands at midspan. It exceeds the limits of all codes.
#[test]
fn a_lateral_support_halves_no_vertical_span_of_a_run() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let practice =
        json!({"class": "D", "code": ["EN 1993-6", "CMAA 70", "IS 800", "AISC Design Guide 7"]});
    let (output, summary) = run(folder.path(), &scene(practice), &["--fail-on-limit"]);
    assert_eq!(output.status.code(), Some(1));
    let verdict = &summary["verdict"];
    assert_eq!(verdict["result"], "not ok");
    let known = 50.0 * 4.5 * (3.0 * 144.0 - 4.0 * 4.5 * 4.5) / (24.0 * 2.1e8 * 5.7681e-4);
    for code in ["EN 1993-6:2007", "CMAA 70", "IS 800", "AISC Design Guide 7"] {
        let checks = verdict["checks"].as_array().expect("checks");
        let own = checks
            .iter()
            .find(|check| check["code"] == code && check["check"] == "vertical deflection")
            .unwrap_or_else(|| panic!("no check of {code}: {verdict}"));
        let applied = own["applied"].as_f64().expect("a number");
        assert!(
            (applied / known - 1.0).abs() < 1e-3,
            "{code}: {applied}, {known}"
        );
        assert_eq!(own["result"], "fail", "{own}");
        assert!(own["sampled"].is_null(), "{own}");
    }
    let ratios = summary["deflection_ratios"].as_array().expect("ratios");
    assert!(
        ratios.iter().all(|one| one["to"].as_f64() == Some(12.0)),
        "{ratios:?}"
    );
}

/// A run is judged by the codes and limits that its scene names; comparison rows alone are no verdict.
#[test]
fn a_run_is_judged_by_what_its_scene_names() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (output, summary) = run(
        folder.path(),
        &scene(json!({"class": "D"})),
        &["--fail-on-limit"],
    );
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(summary["verdict"]["result"], "not checked");
    let practice = json!({"limits": {"vertical": "L/400"}});
    let (output, summary) = run(folder.path(), &scene(practice), &["--fail-on-limit"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert_eq!(summary["verdict"]["result"], "ok");
    assert!(said.contains("verdict: OK for"), "{said}");
    let practice = json!({"limits": {"vertical": ["L/400", 0.02]}});
    let (output, summary) = run(folder.path(), &scene(practice), &["--fail-on-limit"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(
        summary["verdict"]["checks"][0]["source"],
        "given in the input"
    );
}

/// A scene names the codes that a design may name; a limit of one's own that bears on nothing is listed.
#[test]
fn what_a_run_cannot_judge_is_listed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let practice = json!({"code": "ASCE 7", "limits": {"overhang": "L/250"}});
    let (output, summary) = run(folder.path(), &scene(practice), &[]);
    assert_eq!(output.status.code(), Some(0));
    let listed = summary["verdict"]["not_checked"].to_string();
    for words in [
        "own limit of the deflection of the overhang",
        "the code has no limits",
        "a run does not judge overhangs",
    ] {
        assert!(listed.contains(words), "{listed}");
    }
}

/// A stiffness a thousand times too large and a hoisting speed of 8 m/s are warned of.
#[test]
fn slips_of_units_in_a_scene_are_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut stiff = scene(json!({}));
    stiff["wheels"]["w"]["vertical"]["k"] = json!(5e8);
    let fast = scene(json!({"hoisting": "HC2", "hoist_speed": 8}));
    for (scene, words) in [
        (stiff, "`vertical.k` of wheel \"w\""),
        (fast, "`hoist_speed` is 8 m/s"),
    ] {
        let (output, summary) = run(folder.path(), &scene, &[]);
        assert_eq!(output.status.code(), Some(0));
        for place in [&summary["warnings"], &summary["verdict"]["not_checked"]] {
            let told = place.to_string().replace("\\\"", "\"");
            assert!(told.contains(words), "{told}");
        }
    }
    let (_, sound) = run(folder.path(), &scene(json!({})), &[]);
    let told = sound["warnings"].to_string();
    assert!(!told.contains("check its unit"), "{told}");
}

/// A bridge on four rigid wheels over a dip of the rail: page one names the first uplift in time, says which values are
/// sampled, and speaks of influence functions only where they are used.
#[test]
fn the_first_page_of_a_run_says_what_the_run_had() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut dipped = scene(json!({}));
    dipped["analysis"] = json!("dynamic");
    dipped["structures"]["rw"]["foundation"] = json!("modal");
    dipped["structures"]["rw"]["modes"] = json!(6);
    dipped["structures"]["rw"]["damping"] = json!(0.02);
    dipped["structures"]["rw"]["irregularities"] = json!([
        {"kind": "joint", "rail": "north", "x": 5.2, "depth": 0.02, "length": 0.2},
        {"kind": "joint", "rail": "south", "x": 4.7, "depth": 0.02, "length": 0.2}]);
    dipped["wheels"]["w"]["vertical"]["c"] = json!(500);
    dipped["motions"][0]["position"] = json!([[0, 3], [1, 5]]);
    dipped["end"]["time"] = json!(0.5);
    let (_, summary) = run(folder.path(), &dipped, &[]);
    let uplifts = summary["uplift"].as_array().expect("uplifts");
    let time = |one: &Value| one["time"].as_f64().expect("a time");
    let first = uplifts
        .iter()
        .min_by(|a, b| time(a).total_cmp(&time(b)))
        .expect("an uplift");
    assert_ne!(time(first), time(&uplifts[0]), "{uplifts:?}");
    let wheel = first["wheel"].as_str().expect("a name");
    let page = std::fs::read_to_string(folder.path().join("out/report.html")).expect("a report");
    let listed = summary["verdict"]["not_checked"].to_string();
    assert!(listed.contains(&format!("first {wheel} at")), "{listed}");
    assert!(page.contains(&format!("first {wheel} at")));
    assert!(page.contains("largest vertical wheel force"));
    assert!(page.contains("rails on natural modes") && !page.contains("influence functions"));
}

/// Sections are swept: the columns of both runs have the same names, so that their utilisations can be compared.
#[test]
fn results_of_a_sweep_do_not_name_what_is_swept() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let files = [
        (
            "spec.json",
            json!({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
                "girder": {"spans": [6, 6], "section": "HEB 300", "fy": 235000, "rail_height": 0.15}}),
        ),
        (
            "design.json",
            json!({"format": "girderway-design/1", "units": {"length": "m", "force": "kN", "time": "s"},
                "spec": "spec.json", "practice": {"code": "EN 1993-6"},
                "trains": [{"name": "c", "lateral": 5,
                    "wheels": [{"x": 0, "vertical": 60, "skewing": 8}, {"x": 2.5, "vertical": 60}]}]}),
        ),
        (
            "sweep.json",
            json!({"format": "girderway-sweep/1", "name": "sizes", "design": "design.json", "sampling": "grid",
                "axes": {"spec.json#/girder/section": ["HEB 200", "HEB 300", "HEB 400"]}, "results": ["ratios"]}),
        ),
    ];
    for (name, value) in files {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a writable folder");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["sweep", "sweep.json", "-o", "out"])
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = std::fs::read_to_string(folder.path().join("out/results.csv")).expect("results");
    let header = text.lines().next().expect("a header");
    assert!(!header.contains("HEB"), "{header}");
    let names: Vec<&str> = header.split(',').collect();
    let column = names
        .iter()
        .position(|name| *name == "rail.direct stress")
        .expect("a utilisation");
    let used: Vec<f64> = text
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .nth(column)
                .and_then(|cell| cell.parse().ok())
                .expect("a number")
        })
        .collect();
    assert!(
        used.len() == 3 && used[0] > used[1] && used[1] > used[2],
        "{used:?}"
    );
    assert_eq!(
        names.len(),
        names
            .iter()
            .collect::<std::collections::BTreeSet<_>>()
            .len(),
        "{header}"
    );
}
