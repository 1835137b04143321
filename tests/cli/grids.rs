//! `girderway fea`: units, effects, tapers and the coupling, as a user meets them.

use std::fs;

use serde_json::{Value, json};
use tempfile::TempDir;

use super::{base, folder, girderway, json as parsed, path, text};

const MILL: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../crates/fea/tests/it/data/mill_girderway.json"
);

/// Length in metres and force in newtons of a unit word.
fn unit(word: &str) -> f64 {
    match word {
        "ft" => 0.3048,
        "in" => 0.0254,
        "m" => 1.0,
        "mm" => 1e-3,
        "lbf" => 4.448_221_615_260_5,
        "kip" => 4_448.221_615_260_5,
        "N" => 1.0,
        "kN" => 1e3,
        _ => panic!("{word} is no unit"),
    }
}

/// A girder of 20 m and 12 m, 250 kN/m2-like steel, in the units named: numbers by their definitions.
fn girder([length, force]: [&str; 2]) -> Value {
    let (l, f) = (unit(length), unit(force));
    let stress = |value: f64| value * l * l / f;
    json!({
        "format": "girderway-beam/1", "name": "girder", "theory": "timoshenko",
        "units": {"length": length, "force": force, "time": "s"},
        "girder": {
            "spans": [20.0 / l, 12.0 / l], "overhangs": [0.0, 3.0 / l], "E": stress(2.1e11), "G": stress(8.1e10),
            "A": 0.03 / (l * l), "I_vertical": 2.5e-3 / l.powi(4), "I_lateral": 3e-4 / l.powi(4), "J": 5e-5 / l.powi(4),
            "kA_vertical": 0.012 / (l * l), "kA_lateral": 0.01 / (l * l), "rail_height": 0.7 / l,
        },
        "effects": [{"name": "mid", "x": 10.0 / l}],
        "stations": [2.0 / l, 10.0 / l, 17.0 / l, 26.0 / l, 35.0 / l],
    })
}

fn solve(folder: &TempDir, spec: &Value) -> Value {
    fs::write(folder.path().join("given.json"), spec.to_string()).expect("writable");
    let run = girderway(folder, &["fea", "given.json", "--quiet"]);
    assert_eq!((run.status.code(), text(&run.stderr)), (Some(0), ""));
    parsed(&run.stdout)
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        other => vec![other.as_f64().expect("a number")],
    }
}

fn close(found: &[f64], exact: &[f64], factor: f64, tolerance: f64, what: &str) {
    assert_eq!(found.len(), exact.len());
    let largest = exact.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    for (found, exact) in found.iter().zip(exact) {
        let error = (found * factor - exact).abs();
        assert!(
            error <= tolerance * largest.max(1e-30),
            "{what}: {} {exact}",
            found * factor
        );
    }
}

/// Source: a structure does not know its units; coefficients convert by length/force, moments by length.
#[test]
fn one_girder_in_six_systems_of_units_has_one_grid() {
    let folder = folder();
    let own = solve(&folder, &girder(["m", "N"]));
    for units in [
        ["ft", "lbf"],
        ["in", "lbf"],
        ["mm", "N"],
        ["ft", "kip"],
        ["in", "kip"],
        ["m", "kN"],
        ["mm", "kN"],
    ] {
        let other = solve(&folder, &girder(units));
        assert_eq!(other["units"]["length"], units[0]);
        let (l, f) = (unit(units[0]), unit(units[1]));
        for (name, block) in own["influence"].as_object().expect("blocks") {
            let found = numbers(&other["influence"][name]);
            // A coupling that is not there is rounding, on the scale of the direct grids.
            if numbers(block).iter().any(|x| x.abs() > 1e-15) {
                close(
                    &found,
                    &numbers(block),
                    l / f,
                    1e-11,
                    &format!("{units:?} {name}"),
                );
            }
        }
        let line = |grid: &Value, component: &str| {
            numbers(&grid["effects"]["sections"][0][component]["vertical"])
        };
        close(&line(&other, "Mz"), &line(&own, "Mz"), l, 1e-10, "Mz");
        close(&line(&other, "Vy"), &line(&own, "Vy"), 1.0, 1e-10, "Vy");
        assert_eq!(
            other["effects"]["units"]["moment"],
            format!("{f} {l}/{f}", l = units[0], f = units[1])
        );
    }
}

/// Source: statics of the simply supported span of 60 ft with overhangs.
#[test]
fn fea_reports_reactions_and_forces_per_unit_load() {
    let folder = folder();
    let mut spec = parsed(&fs::read(base("spec.json")).expect("the base spec"));
    spec["effects"] = json!([{"name": "mid", "x": 30}, {"name": "first support", "x": 0}, {"name": "end", "x": 75}]);
    let grid = solve(&folder, &spec);
    let sections = &grid["effects"]["sections"];
    let x = [-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0];
    let check = |value: &Value, exact: &dyn Fn(f64) -> f64, what: &str| {
        let exact: Vec<f64> = x.iter().map(|x| exact(*x)).collect();
        close(&numbers(value), &exact, 1.0, 1e-12, what);
    };
    check(
        &sections[0]["Mz"]["vertical"],
        &|z| -f64::min(z, 60.0 - z) / 2.0,
        "Mz at midspan",
    );
    check(
        &sections[1]["Mz"]["vertical"],
        &|z| f64::max(-z, 0.0),
        "Mz over the support",
    );
    let holds = grid["effects"]["reactions"].as_array().expect("a list");
    let hold = |x: f64, dof: &str| {
        holds
            .iter()
            .find(|hold| hold["x"] == x && hold["dof"] == dof)
            .expect("a reaction there")
    };
    check(
        &hold(0.0, "uy")["vertical"],
        &|z| z / 60.0 - 1.0,
        "first support",
    );
    check(
        &hold(60.0, "uy")["vertical"],
        &|z| -z / 60.0,
        "second support",
    );
    check(
        &hold(0.0, "ux")["longitudinal"],
        &|_| -1.0,
        "the held length",
    );
    check(
        &hold(0.0, "rx")["lateral"],
        &|z| -3.6615 * (1.0 - z.clamp(0.0, 60.0) / 60.0),
        "twist",
    );

    fs::write(folder.path().join("grid.json"), grid.to_string()).expect("writable");
    let run = girderway(&folder, &["splines", "grid.json", "-o", "tables.adm"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
}

/// Source: baselines of the mill girderway: 0.57 of sqrt(Gvv Gll), 40 % at the median.
#[test]
fn coupling_of_the_mill_girderway_is_told() {
    let folder = folder();
    for (theory, share, median, percent) in [
        ("timoshenko", 0.5684, 0.3955, "39.5 %"),
        ("euler-bernoulli", 0.6032, 0.3998, "40.0 %"),
    ] {
        let run = girderway(
            &folder,
            &["fea", MILL, "--theory", theory, "-o", "grid.json"],
        );
        let told = text(&run.stderr);
        assert!(
            told.contains(&format!(
                "the vertical-lateral coefficients are up to {share:.3} of sqrt(Gvv Gll)"
            )),
            "{told}"
        );
        assert!(
            told.contains(&format!("lateral deflection by {percent} (median")),
            "{told}"
        );
        let grid = parsed(&fs::read(folder.path().join("grid.json")).expect("written"));
        let number = |value: &Value| value.as_f64().expect("a number");
        let coupling = &grid["coupling"];
        assert!((number(&coupling["vertical_lateral"]) - share).abs() < 1e-4);
        assert!((number(&coupling["dropped"]["lateral"]["median"]) - median).abs() < 1e-4);
        assert_eq!(number(&coupling["dropped"]["side_load"]), 0.1);
        let lateral = &coupling["dropped"]["lateral"];
        assert!(number(&lateral["largest"]) > number(&lateral["median"]));
    }
    // Without an offset to speak of there is nothing to tell.
    let run = girderway(
        &folder,
        &["fea", path(&base("spec.json")), "-o", "grid.json"],
    );
    assert_eq!(text(&run.stderr), "wrote grid.json\n");
}

/// Effects of the mill girderway: what its holds give balances every unit load.
#[test]
fn reactions_of_the_mill_girderway_balance_every_load() {
    let folder = folder();
    let run = girderway(&folder, &["fea", MILL, "--quiet"]);
    let grid = parsed(&run.stdout);
    let holds = grid["effects"]["reactions"].as_array().expect("a list");
    for (axis, dof) in [
        ("longitudinal", "ux"),
        ("vertical", "uy"),
        ("lateral", "uz"),
    ] {
        let mut sum = vec![0.0; numbers(&grid["rails"][0]["stations"]).len()];
        for hold in holds.iter().filter(|hold| hold["dof"] == dof) {
            sum.iter_mut()
                .zip(numbers(&hold[axis]))
                .for_each(|(sum, value)| *sum += value);
        }
        assert!(
            sum.iter().all(|sum| (sum + 1.0).abs() < 1e-9),
            "{axis}: {sum:?}"
        );
    }
}

/// A cantilever whose stiffness falls linearly to 0.4 of that at its root.
fn tapered(parts: Value) -> Value {
    let section = |name: &str, k: f64| json!({"name": name, "material": "steel", "A": 0.02 * k, "Iy": 2e-5 * k, "Iz": 4e-4 * k, "J": 2e-6 * k});
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "points": [[0, 0, 0], [6, 0, 0]], "cells": [{"type": "line", "data": [[0, 1]]}],
        "cell_data": {"section": [[0]], "section_b": [[1]], "parts": [[parts]]}, "parts": 64,
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7}],
        "sections": [section("root", 1.0), section("tip", 0.4)],
        "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]}],
        "effects": [{"name": "third", "cell": [0, 0], "at": 1.0 / 3.0}, {"name": "root", "cell": [0, 0], "at": 0}],
        "rails": {"top": {"axis": [1, 0, 0], "segments": [{"cell": [0, 0]}], "stations": [0, 2.5, 6]}},
    })
}

/// Source: deflection by the integral of (L - x)^2/EI(x); moments by statics.
#[test]
fn tapered_cells_are_solved_in_the_parts_that_are_stated() {
    let folder = folder();
    let r: f64 = 0.4;
    let integral = (0.5 * (1.0 - r * r) - 2.0 * r * (1.0 - r) - r * r * r.ln()) / (1.0 - r).powi(3);
    let exact = 216.0 / (2.1e8 * 4e-4) * integral;
    let error = |parts: Value| {
        let grid = solve(&folder, &tapered(parts));
        let sections = &grid["effects"]["sections"];
        close(
            &numbers(&sections[0]["Mz"]["vertical"]),
            &[0.0, 0.5, 4.0],
            1.0,
            1e-9,
            "a third along",
        );
        close(
            &numbers(&sections[1]["Mz"]["vertical"]),
            &[0.0, 2.5, 6.0],
            1.0,
            1e-9,
            "at the root",
        );
        (numbers(&grid["influence"]["vertical"])[8] / exact - 1.0).abs()
    };
    let errors = [8, 16, 32].map(|parts| error(json!(parts)));
    assert!(
        (errors[1] / errors[2]).log2() > 1.95 && errors[2] < 3e-4,
        "{errors:?}"
    );
    // The count for all cells where a cell has none of its own.
    assert!((error(Value::Null) / errors[2] - 0.25).abs() < 0.01);
}

#[test]
fn specs_without_units_are_refused_with_a_hint() {
    let folder = folder();
    let mut spec = girder(["m", "N"]);
    spec.as_object_mut().expect("an object").remove("units");
    fs::write(folder.path().join("given.json"), spec.to_string()).expect("writable");
    let run = girderway(&folder, &["fea", "given.json"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(
        text(&run.stderr).contains("missing key `units`  hint: units have no default"),
        "{}",
        text(&run.stderr)
    );
}

/// Two rails on one girder: the grid of both and its surface are read again.
#[test]
fn paired_rails_on_one_girder_are_solved_and_read_back() {
    let folder = folder();
    let mut spec = parsed(&fs::read(base("frame.json")).expect("the base frame"));
    let top = spec["rails"]["top"].clone();
    let mut under = top.clone();
    under["origin"] = json!([6, 0, 0]);
    under["axis"] = json!([-1, 0, 0]);
    under["segments"][0]["offset"] = json!([0, -0.3, 0]);
    spec["rails"] = json!({"top": top, "under": under});
    let grid = solve(&folder, &spec);
    // Station 1.5 of the one is over station 4.5 of the other: they sink alike under a load at midspan.
    let vertical = &grid["influence"]["vertical"];
    let at = |i: usize, j: usize| vertical[i][j].as_f64().expect("a number");
    for (i, j) in [(1, 8), (2, 7), (3, 6)] {
        assert!((at(i, 2) - at(j, 2)).abs() < 1e-12 * at(2, 2), "{i} {j}");
        assert!((at(i, 2) - at(i, 7)).abs() < 1e-12 * at(2, 2), "{i} {j}");
    }
    fs::write(folder.path().join("grid.json"), grid.to_string()).expect("writable");
    let run = girderway(&folder, &["splines", "grid.json", "-o", "tables.json"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
}

/// Source: files of different units are converted: the same girder in metres gives the same motion in feet.
#[test]
fn a_scene_in_feet_takes_a_spec_in_metres() {
    let folder = folder();
    for name in ["scene.json", "spec.json"] {
        fs::copy(base(name), folder.path().join(name)).expect("writable");
    }
    let mut scene = parsed(&fs::read(base("scene.json")).expect("the base scene"));
    scene["analysis"] = json!("quasi-static");
    scene["structures"]["bridge"]["spec"] = json!("metres.json");
    let (l, f) = (unit("ft"), unit("lbf"));
    let mut spec = parsed(&fs::read(base("spec.json")).expect("the base spec"));
    spec["units"] = json!({"length": "m", "force": "N", "time": "s"});
    let girder = spec["girder"].as_object_mut().expect("an object");
    for (key, value) in girder.iter_mut() {
        let factor = match key.as_str() {
            "spans" | "overhangs" | "rail_height" => l,
            "E" | "G" => f / (l * l),
            "A" => l * l,
            _ => l.powi(4),
        };
        *value = match &*value {
            Value::Array(items) => items
                .iter()
                .map(|x| json!(x.as_f64().expect("a number") * factor))
                .collect(),
            one => json!(one.as_f64().expect("a number") * factor),
        };
    }
    let stations: Vec<f64> = numbers(&spec["stations"]).iter().map(|x| x * l).collect();
    spec["stations"] = json!(stations);
    let peaks = |scene: &Value| {
        fs::write(folder.path().join("own.json"), scene.to_string()).expect("writable");
        let run = girderway(&folder, &["run", "own.json", "-o", "out", "--quiet"]);
        assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
        let summary = parsed(&fs::read(folder.path().join("out/summary.json")).expect("written"));
        summary["peaks"].clone()
    };
    fs::write(folder.path().join("metres.json"), spec.to_string()).expect("writable");
    let mixed = peaks(&scene);
    scene["structures"]["bridge"]["spec"] = json!("spec.json");
    let own = peaks(&scene);
    assert!(
        own.as_object()
            .is_some_and(|peaks| peaks.contains_key("bogie.deflection")),
        "{own}"
    );
    near(&mixed, &own);
}

/// The same numbers at the same keys, to rounding.
fn near(a: &Value, b: &Value) {
    match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            assert!(a.keys().eq(b.keys()));
            // When a peak comes says nothing where a column is level.
            let pairs = a
                .iter()
                .zip(b.values())
                .filter(|((key, _), _)| !key.ends_with("time"));
            pairs.for_each(|((_, a), b)| near(a, b));
        }
        (Value::Number(a), Value::Number(b)) => {
            let (a, b) = (a.as_f64().expect("finite"), b.as_f64().expect("finite"));
            // forces of 1e6 round to 1e-10 where they vanish
            assert!((a - b).abs() <= 1e-8 * b.abs().max(1e-2), "{a} {b}");
        }
        (a, b) => assert_eq!(a, b),
    }
}

/// A girder of 500 spans: 501 end states of rail elements with 6 degrees of freedom each.
#[test]
fn a_surface_too_large_for_a_file_is_left_out_by_every_command_and_solved_again_for_sim() {
    let folder = folder();
    let spec = json!({
        "format": "girderway-beam/1", "name": "girder", "theory": "timoshenko",
        "units": {"length": "m", "force": "kN", "time": "s"},
        "girder": {
            "spans": vec![6; 500], "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": 5.8e-4, "I_lateral": 1.1e-4,
            "J": 3.6e-6, "kA_vertical": 0.005, "kA_lateral": 0.012, "rail_height": 0.2,
        },
        "stations": [0, 3, 6, 9, 12],
    });
    let scene = json!({
        "format": "girderway-scene/1", "name": "long", "units": {"length": "m", "force": "kN", "time": "s"},
        "structures": {"girder": {"spec": "given.json", "foundation": "influence"}}, "gravity": 9.81,
        "bodies": {"crane": {"weight": 360, "dof": ["x", "y"], "track": ["girder.rail"], "x0": 1.8}},
        "wheels": {"crane": {"radius": 0.2, "vertical": {"k": 4e5, "c": 400}}},
        "trucks": [{"name": "wheel", "body": "crane", "rail": "girder.rail", "tree": [0], "wheel": "crane"}],
        "motions": [{"body": "crane", "dof": "x", "kind": "prescribed", "speed": [[0, 1.5]]}],
        "end": {"time": 0.02}, "output": {"dt": 0.01},
    });
    fs::write(folder.path().join("scene.json"), scene.to_string()).expect("writable");
    let grid = solve(&folder, &spec);
    assert!(grid.get("surface").is_none());
    assert!(
        grid["notes"][0]
            .as_str()
            .is_some_and(|note| note.contains("3006 degrees of freedom")),
        "{grid}"
    );

    let read = |name: &str| fs::read(folder.path().join("out").join(name)).expect("written");
    let run = |command: &str| {
        let run = girderway(&folder, &[command, "scene.json", "-o", "out", "--quiet"]);
        assert_eq!(
            (run.status.code(), text(&run.stderr)),
            (Some(0), ""),
            "{command}"
        );
        [read("grid-girder.json"), read("history.csv")]
    };
    let first = run("run");
    assert_eq!(parsed(&first[0]), grid);
    assert!(first == run("sim"));
}
