//! Steps of runs follow the motion, and not the rounding of forces that are nothing.

use std::fs;

use serde_json::{Value, json};

use super::{folder, girderway, json as parse, text};
use crate::history::History;

/// A girder of five bays on columns.
fn on_columns() -> Value {
    let at = [0.0, 5.14, 10.3, 15.4, 20.6, 25.7];
    let points = [6, 0]
        .map(|height| at.map(|x| json!([x, height, 0])))
        .concat();
    let bays = (0..5).map(|k| json!([k, k + 1]));
    let cells: Vec<Value> = bays.chain((0..6).map(|k| json!([k + 6, k]))).collect();
    let kinds = [vec!["girder"; 5], vec!["column"; 6]].concat();
    let up = [vec![[0, 1, 0]; 5], vec![[0, 0, 1]; 6]].concat();
    let feet = (6..12).map(|k| json!({"point": k, "fix": ["ux", "uy", "uz", "rx", "ry", "rz"]}));
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "points": points, "cells": [{"type": "line", "data": cells}],
        "cell_data": {"section": [kinds], "orientation": [up]},
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}],
        "sections": [
            {"name": "girder", "material": "steel", "A": 0.00482, "Iy": 0.00576, "Iz": 0.00094, "J": 3.42e-5},
            {"name": "column", "material": "steel", "A": 0.0149, "Iy": 0.000123, "Iz": 0.000875, "J": 1.25e-5}],
        "supports": feet.collect::<Vec<Value>>(),
        "rails": {"rail": {"origin": [0, 6, 0], "axis": [1, 0, 0], "stations": [0, 5.14, 10.3, 18, 25.7],
            "segments": (0..5).map(|k| json!({"cell": [0, k]})).collect::<Vec<Value>>()}}
    })
}

/// Two girders of three spans side by side.
fn side_by_side() -> Value {
    let points = [-3, 3]
        .map(|z| [0, 4, 8, 12].map(|x| json!([x, 6, z])))
        .concat();
    let starts: [usize; 6] = [0, 1, 2, 4, 5, 6];
    let support = |k: usize| match k % 4 {
        0 => json!({"point": k, "fix": ["ux", "uy", "uz", "rx"]}),
        _ => json!({"point": k, "fix": ["uy", "uz", "rx"]}),
    };
    let rail = |first: usize, z: i32| {
        let segments: Vec<Value> = (first..first + 3)
            .map(|k| json!({"cell": [0, k]}))
            .collect();
        json!({"origin": [0, 6, z], "axis": [1, 0, 0], "segments": segments, "stations": [0, 2.4, 4.8, 8.4, 12]})
    };
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "points": points, "cells": [{"type": "line", "data": starts.map(|k| [k, k + 1])}],
        "cell_data": {"section": [vec!["girder"; 6]], "orientation": [vec![[0, 1, 0]; 6]]},
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.8}],
        "sections": [{"name": "girder", "material": "steel", "A": 0.0032, "Iy": 0.0002, "Iz": 2.4e-5, "J": 1.3e-7}],
        "supports": (0..8).map(support).collect::<Vec<Value>>(),
        "rails": {"north": rail(0, -3), "south": rail(3, 3)}
    })
}

/// Runs a scene: its steps and history.
fn run(spec: &Value, scene: &Value) -> (u64, History) {
    let folder = folder();
    for (name, file) in [("spec.json", spec), ("scene.json", scene)] {
        fs::write(folder.path().join(name), file.to_string()).expect("written");
    }
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let summary = parse(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    let steps = summary["steps"]["accepted"].as_u64();
    let history = History::read(&folder.path().join("out/history.csv"));
    (steps.expect("a number of steps"), history)
}

/// Analytic: wheels that slide at 170 times the speed at which their brake grips have the friction mu N. Steps alternated between
/// its two signs, with a displacement of the rail, which has no mass, to either side.
#[test]
fn the_friction_of_a_sliding_wheel_is_steady_on_a_rail_that_gives() {
    let scene = json!({
        "format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
        "structures": {"s": {"spec": "spec.json", "foundation": "influence", "longitudinal": true}},
        "bodies": {"a": {"x0": 13.5, "weight": 256, "dof": ["y"]}, "b": {"x0": 17.7, "weight": 236, "v0": -1.71, "dof": ["x"]}},
        "wheels": {"w": {"radius": 0.496, "vertical": {"k": 8890, "c": 0.36, "damper": "rail"},
            "friction": {"mu": 0.3, "slip": 0.01, "law": "coulomb"}, "braked": true}},
        "trucks": [
            {"name": "a", "body": "a", "wheel": "w", "tree": [-1, 1]},
            {"name": "b", "body": "b", "wheel": "w", "tree": [[[-2, -1], [1, 2]]]}],
        "motions": [
            {"kind": "prescribed", "speed": [[0, 0], [0.00184, -2.18]], "body": "a", "dof": "x"},
            {"kind": "free", "brake": 0.001, "body": "b", "dof": "x"}],
        "loads": [{"body": "b", "dof": "x", "value": [[0, 0.52], [0.00147, -36.4]]}],
        "end": {"time": 0.00369}, "output": {"dt": 0.000_184_5}
    });
    let (steps, history) = run(&on_columns(), &scene);
    assert!(steps < 100, "{steps} steps");
    for (row, time) in history.column("time").iter().enumerate() {
        let of = |what: &str| history.column(&format!("b.wheel1.{what}"))[row];
        let (found, limit) = (of("traction"), -0.3 * of("vertical"));
        let slides = *time > 0.0022;
        assert!(
            !slides || (found / limit - 1.0).abs() < 1e-4,
            "{found} of {limit} at {time}"
        );
    }
}

/// Of two bodies one is held in its height, so that its wheels touch their rail with forces of 1e-15.
#[test]
fn wheels_without_force_shorten_no_step() {
    let scene = json!({
        "format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.8,
        "structures": {"s": {"spec": "spec.json", "foundation": "modal", "damping": 0.077, "modes": 11}},
        "bodies": {
            "a": {"inertia": [220, 15, 15], "x0": 4, "mass": 23, "dof": ["pitch"]},
            "b": {"inertia": [9.9, 9.3, 7.8], "x0": 7.9, "mass": 28, "dof": ["y", "x"]}},
        "wheels": {"v": {"radius": 0.59,
            "vertical": {"k": 1100, "law": "impact", "exponent": 1.1, "depth": 0.00096, "c": 6.5, "damper": "rail"}}},
        "trucks": [
            {"name": "a", "body": "a", "rail": "s.north", "wheel": "v", "tree": [-1, 1]},
            {"name": "b", "body": "b", "rail": "s.south", "wheel": "v", "tree": [-1, 1]}],
        "motions": [{"kind": "drive", "speed": [[0, 0], [0.00081, -3.8]], "gain": 0.25, "max_force": 230, "body": "b", "dof": "x"}],
        "end": {"time": 0.0027}, "output": {"dt": 0.000_135}
    });
    let (steps, _) = run(&side_by_side(), &scene);
    assert!(steps < 100, "{steps} steps");
}
