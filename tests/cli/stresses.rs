//! Direct stresses of girders in a run, against hand calculations.

use serde_json::json;

use super::*;

/// A simple beam of 8 m of HEB 400 whose numbers are given, with the rail on its axis.
fn beam() -> Value {
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [8], "section": "HEB 400", "fy": 2.35e5, "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": 5.8e-4,
                   "I_lateral": 1.1e-4, "J": 3.6e-6, "mass_per_length": 0},
        "stations": [0, 4, 8]
    })
}

/// A wheel of 100 kN that is held 0.5 mm to the side, so that its flange of 20 kN/mm presses with 10 kN, from x = 1 at 1 m/s.
fn scene(practice: &Value) -> Value {
    json!({
        "format": "girderway-scene/1", "name": "wheel", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
        "analysis": "quasi-static",
        "structures": {"girder": {"spec": "spec.json", "foundation": "rigid"}},
        "bodies": {"car": {"weight": 100, "dof": ["y", "z"], "x0": 1, "start": {"z": 5e-4}}},
        "wheels": {"steel": {"radius": 0.4, "vertical": {"k": 2e4}, "lateral": {"k": 2e4}}},
        "trucks": [{"name": "truck", "body": "car", "rail": "girder.rail", "tree": [0], "wheel": "steel"}],
        "motions": [{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, 1]]}],
        "end": {"time": 6}, "output": {"dt": 0.07}, "accuracy": 1e-6, "practice": practice
    })
}

/// Runs a scene; the folder with its output.
fn ran(spec: &Value, scene: &Value) -> TempDir {
    let folder = folder();
    fs::write(folder.path().join("spec.json"), spec.to_string()).expect("a spec");
    fs::write(folder.path().join("scene.json"), scene.to_string()).expect("a scene");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    folder
}

fn summary(folder: &TempDir) -> Value {
    json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"))
}

fn page(folder: &TempDir) -> String {
    fs::read_to_string(folder.path().join("out/report.html")).expect("a report")
}

/// The only stress of a run.
fn only(summary: &Value) -> &Value {
    let all = summary["stresses"]
        .as_array()
        .unwrap_or_else(|| panic!("no stresses in {summary}"));
    assert_eq!(all.len(), 1, "{all:?}");
    &all[0]
}

fn value(row: &Value, key: &str) -> f64 {
    row[key]
        .as_f64()
        .unwrap_or_else(|| panic!("no number {key} in {row}"))
}

fn close(found: f64, known: f64, tolerance: f64, what: &str) {
    assert!(
        (found / known - 1.0).abs() < tolerance,
        "{what}: {found}, not {known}"
    );
}

/// Hand calculation: under the wheel at midspan M_v = 100 * 8/4 = 200 kN m and M_l = 10 * 8/4 = 20 kN m, so that at the top edge
/// sigma = -200 * 0.2/5.8e-4 - 20 * 0.15/1.1e-4 kN/m2 with the whole section, and with the top flange of 24 mm by 300 mm alone
/// -200 * 0.2/5.8e-4 - 20/(0.024 * 0.3^2/6). The wheel is there 3 s after the start.
#[test]
fn stresses_of_a_run_are_those_of_simultaneous_moments_with_either_model() {
    let mut given = scene(&json!({"lateral_section": "top flange"}));
    given["compare"] =
        json!([{"label": "whole", "practice": {"lateral_section": "whole section"}}]);
    let folder = ran(&beam(), &given);
    let summary = summary(&folder);
    let vertical = -200.0 * 0.2 / 5.8e-4;
    let models = [
        (&summary, "top flange", -20.0 / (0.024 * 0.09 / 6.0)),
        (
            &summary["compare"]["whole"],
            "whole section",
            -20.0 * 0.15 / 1.1e-4,
        ),
    ];
    for (summary, word, lateral) in models {
        let row = only(summary);
        close(value(row, "value"), vertical + lateral, 1e-9, word);
        close(
            value(row, "utilisation"),
            -(vertical + lateral) / 2.35e5,
            1e-9,
            word,
        );
        close(value(&row["parts"], "vertical"), vertical, 1e-9, word);
        close(value(&row["parts"], "lateral"), lateral, 1e-9, word);
        close(value(&row["forces"], "moment"), 200.0, 1e-9, word);
        close(value(&row["forces"], "lateral moment"), 20.0, 1e-9, word);
        assert_eq!(value(&row["parts"], "normal"), 0.0, "{row}");
        assert!(
            (value(row, "x") - 4.0).abs() < 1e-6 && (value(row, "time") - 3.0).abs() < 1e-6,
            "{row}"
        );
        assert_eq!(
            [
                &row["lateral_section"],
                &row["fibre"],
                &row["section"],
                &row["within"]
            ],
            [
                &json!(word),
                &json!("top, -z"),
                &json!("HEB 400"),
                &json!(true)
            ]
        );
    }
    let page = page(&folder);
    for part in [
        "lateral moments on the top flange alone: 53 % of the yield strength",
        "in the run \"whole\"",
        "lateral moments on the whole section",
        "Largest direct stress of each section under a rail",
    ] {
        let escaped = part.replace('"', "&quot;");
        assert!(
            page.contains(part) || page.contains(&escaped),
            "the page does not say: {part}"
        );
    }
}

/// Analytic: a wheel of 100 kN without side force runs 3 m before a wheel of 20 kN with 10 kN to the side. Between the wheels
/// moments are linear, so that the largest stress of both moments together is under a wheel. There it is a polynomial of the
/// second degree in the position, whose largest value is evaluated on a grid of 1e-5 m; it is neither where the vertical nor
/// where the lateral moment is largest.
#[test]
fn the_largest_stress_need_not_be_where_a_moment_is_largest() {
    let mut given = scene(&json!({"lateral_section": "whole section"}));
    given["bodies"] = json!({
        "light": {"weight": 20, "dof": ["y", "z"], "x0": 0.5, "start": {"z": 5e-4}},
        "heavy": {"weight": 100, "dof": ["y"], "x0": 3.5},
    });
    given["trucks"] = json!([
        {"body": "light", "rail": "girder.rail", "tree": [0], "wheel": "steel"},
        {"body": "heavy", "rail": "girder.rail", "tree": [0], "wheel": "steel"},
    ]);
    let motion =
        |body: &str| json!({"body": body, "dof": "x", "kind": "prescribed", "speed": [[0, 1]]});
    given["motions"] = json!([motion("light"), motion("heavy")]);
    given["end"] = json!({"time": 4.4});
    let summary = summary(&ran(&beam(), &given));
    let row = only(&summary);
    let line = |place: f64, load: f64| place.min(load) * (8.0 - place.max(load)) / 8.0;
    let stress = |place: f64, light: f64| {
        let vertical = 20.0 * line(place, light) + 100.0 * line(place, light + 3.0);
        vertical * 0.2 / 5.8e-4 + 10.0 * line(place, light) * 0.15 / 1.1e-4
    };
    let steps = (0..=440_000).map(|k| 0.5 + 1e-5 * f64::from(k));
    let all =
        steps.flat_map(|light| [light, light + 3.0].map(|place| (stress(place, light), place)));
    let (known, place) = all.fold(
        (0.0, 0.0),
        |best, next| if next.0 > best.0 { next } else { best },
    );
    close(value(row, "value").abs(), known, 1e-6, "stress");
    assert!((value(row, "x") - place).abs() < 2e-3, "{row} and {place}");
    let extremes = summary["extremes"].as_array().expect("extremes");
    for plane in ["vertical", "lateral"] {
        let largest = extremes
            .iter()
            .find(|e| e["quantity"] == "moment" && e["plane"] == plane && e["kind"] == "max")
            .expect("a moment");
        let (x, time) = (value(largest, "x"), value(largest, "time"));
        let there = stress(x, 0.5 + time);
        assert!(
            there < known * (1.0 - 1e-3),
            "{plane}: {there} at {x} is not below {known}"
        );
    }
}

/// Analytic: dead load w and a wheel with P down and H to the side that stands at a = 0.5 m give M_v = w x (L - x)/2 +
/// P a (L - x)/L and M_l = H a (L - x)/L behind the wheel. With the section moduli W_v and W_l the stress M_v/W_v + M_l/W_l is
/// largest at x = L/2 - (P + H W_v/W_l) a/(w L), between two sections of the run and 63 mm from the largest M_v.
#[test]
fn stresses_of_dead_load_are_found_between_sections() {
    let mut spec = beam();
    spec["girder"]["mass_per_length"] = json!(4.0);
    let mut given = scene(&json!({"lateral_section": "whole section"}));
    given["output"]["dead_load"] = json!(true);
    given["bodies"]["car"]["x0"] = json!(0.5);
    given["motions"][0]["speed"] = json!([[0, 0]]);
    let summary = summary(&ran(&spec, &given));
    let row = only(&summary);
    let (w, vertical, lateral) = (4.0 * 9.81, 5.8e-4 / 0.2, 1.1e-4 / 0.15);
    let x = 4.0 - (100.0 + 10.0 * vertical / lateral) * 0.5 / (w * 8.0);
    let moments = [
        0.5 * w * x * (8.0 - x) + 50.0 * (8.0 - x) / 8.0,
        5.0 * (8.0 - x) / 8.0,
    ];
    close(
        value(row, "value").abs(),
        moments[0] / vertical + moments[1] / lateral,
        1e-9,
        "stress",
    );
    assert!((value(row, "x") - x).abs() < 2e-3, "{row} and {x}");
}

/// Analytic: a stress of 96.24 N/mm2 is 120.3 % of a strength of 80 N/mm2; that is a result, not an error.
#[test]
fn a_stress_of_a_run_above_its_strength_is_told() {
    let mut spec = beam();
    spec["girder"]["fy"] = json!(8e4);
    let folder = ran(&spec, &scene(&json!({"lateral_section": "whole section"})));
    assert_eq!(only(&summary(&folder))["within"], json!(false));
    assert!(
        page(&folder).contains("120 % of the yield strength of"),
        "no utilisation on the page"
    );
    assert!(page(&folder).contains("which is exceeded"));
}

/// Analytic: without the member there are no stresses, without `fy` no utilisation, and a section without plates is named.
#[test]
fn what_stresses_of_a_run_lack_is_named() {
    let mut given = scene(&json!(null));
    given.as_object_mut().expect("an object").remove("practice");
    let folder = ran(&beam(), &given);
    assert!(summary(&folder).get("stresses").is_none() && !page(&folder).contains("direct stress"));

    let mut spec = beam();
    spec["girder"]
        .as_object_mut()
        .expect("an object")
        .remove("fy");
    let folder = ran(&spec, &scene(&json!({"lateral_section": "top flange"})));
    let row = only(&summary(&folder)).clone();
    assert!(
        row.get("utilisation").is_none() && row.get("within").is_none(),
        "{row}"
    );
    assert!(page(&folder).contains("the spec gives no yield strength <code>fy</code>"));

    let mut spec = beam();
    let girder = spec["girder"].as_object_mut().expect("an object");
    girder.remove("section");
    girder.remove("fy");
    let folder = ran(&spec, &scene(&json!({"lateral_section": "top flange"})));
    let summary = summary(&folder);
    assert!(summary.get("stresses").is_none());
    let notes = summary["notes"].to_string();
    assert!(
        notes.contains("no direct stress on rail girder.rail: section"),
        "{notes}"
    );
    assert!(page(&folder).contains("Direct stresses of girders are not available"));
}

/// Hand calculation: A65 (5490 mm2, 319e4 mm4, centroid 30.84 mm above its base) on HEB 400, 0.2 m above the axis, moves the centroid
/// up by e = h A_r/A, h = 0.23084 m. At the top edge sigma = -200 (0.2 - e)/I - 20/(0.024 * 0.3^2/6) with the top flange alone
/// sideways, I = I_g + I_r + A_g h e.
#[test]
fn stresses_of_a_run_know_the_rail_in_the_section() {
    let mut spec = beam();
    for (key, value) in [
        ("crane_rail", json!("A65")),
        ("composite", json!(true)),
        ("rail_height", json!(0.2)),
    ] {
        spec["girder"][key] = value;
    }
    let folder = ran(&spec, &scene(&json!({"lateral_section": "top flange"})));
    let summary = summary(&folder);
    let (rail, h) = (5490e-6, 0.23084);
    let e = h * rail / (0.02 + rail);
    let second = 5.8e-4 + 319e-8 + 0.02 * h * e;
    let known = -200.0 * (0.2 - e) / second - 20.0 / (0.024 * 0.09 / 6.0);
    close(value(only(&summary), "value"), known, 1e-6, "top edge");
}

/// Hand calculation: a beam that tapers from 400 to 800 mm in four parts. The stress of a part is the larger one of those at both of
/// its ends, here at the lower one, with the moments where it occurs: sigma = -M (h/2)/I(h) - M_l/(0.02 * 0.2^2/6).
#[test]
fn stresses_of_a_run_know_the_dimensions_of_a_tapered_member() {
    let section = |name: &str, height: f64| {
        json!({"name": name, "material": "S235",
               "shape": {"kind": "I", "length": "mm", "height": height, "width": 200, "flange": 20, "web": 10}})
    };
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "points": [[0, 0, 0], [8, 0, 0]], "cells": [{"type": "line", "data": [[0, 1]]}],
        "cell_data": {"section": [[0]], "section_b": [[1]], "orientation": [[[0, 1, 0]]]}, "parts": 4,
        "materials": [{"name": "S235", "E": 2.1e8, "G": 8.1e7, "fy": 2.35e5}],
        "sections": [section("low", 400.0), section("high", 800.0)],
        "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 1, "fix": ["uy", "uz", "rx"]}],
        "rails": {"rail": {"axis": [1, 0, 0], "segments": [{"cell": [0, 0]}], "stations": [0, 4, 8]}}
    });
    let folder = ran(&spec, &scene(&json!({"lateral_section": "top flange"})));
    let summary = summary(&folder);
    let rows = summary["stresses"].as_array().expect("stresses");
    assert_eq!(rows.len(), 4, "{rows:?}");
    for (part, row) in rows.iter().enumerate() {
        let x = value(row, "x");
        assert!(
            (2.0 * part as f64 - 1e-9..=2.0 * part as f64 + 2.0 + 1e-9).contains(&x),
            "{row}"
        );
        let h: f64 = 0.4 + 0.1 * part as f64;
        let second = (0.2 * h.powi(3) - 0.19 * (h - 0.04).powi(3)) / 12.0;
        let shape = x * (8.0 - x) / 8.0;
        let known = -100.0 * shape * 0.5 * h / second - 10.0 * shape / (0.02 * 0.04 / 6.0);
        close(value(row, "value"), known, 1e-6, "a part");
        assert_eq!(row["section"], json!("low to high"));
    }
}
