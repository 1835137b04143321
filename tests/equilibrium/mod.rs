//! Static equilibrium under one-sided wheels: found wherever it exists, and otherwise refused with the motion of the fall. Random
//! scenes stand beside Lemke's method in `random_scenes.py`, nightly.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use crate::history::History;

/// Two rails 12 m apart: a continuous one of two spans of 6 m and, of a stiffer section, a single span of 12 m.
fn rails() -> Value {
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "points": [[0, 6, 0], [6, 6, 0], [12, 6, 0], [0, 6, 12], [12, 6, 12]],
        "cells": [{"type": "line", "data": [[0, 1], [1, 2], [3, 4]]}], "cell_data": {"section": [["g", "g", "s"]]},
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}],
        "sections": [{"name": "g", "material": "steel", "shape": "HEB 400"}, {"name": "s", "material": "steel", "shape": "HEB 800"}],
        "supports": [
            {"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 1, "fix": ["uy", "uz", "rx"]},
            {"point": 2, "fix": ["uy", "uz", "rx"]}, {"point": 3, "fix": ["ux", "uy", "uz", "rx"]},
            {"point": 4, "fix": ["uy", "uz", "rx"]}],
        "rails": {
            "north": {"origin": [0, 6, 0], "axis": [1, 0, 0], "segments": [{"cell": [0, 0]}, {"cell": [0, 1]}], "stations": [0, 6, 12]},
            "south": {"origin": [0, 6, 12], "axis": [1, 0, 0], "segments": [{"cell": [0, 2]}], "stations": [0, 6, 12]}}
    })
}

/// A bridge of 200 kN on two wheels on each rail, with its centre of mass at `cg`.
fn bridge(cg: [f64; 3]) -> Value {
    json!({
        "format": "girderway-scene/1", "name": "bridge", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
        "structures": {"rw": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"bridge": {"weight": 200, "inertia": [500, 500, 100], "dof": ["y", "roll", "pitch"],
            "track": ["rw.north", "rw.south"], "x0": 3, "cg": cg}},
        "wheels": {"w": {"radius": 0.2, "vertical": {"k": 1e6, "c": 500}}},
        "trucks": [
            {"name": "n", "body": "bridge", "tree": [-1.5, 1.5], "rail": "rw.north", "wheel": "w", "at": [0, 0, -6]},
            {"name": "s", "body": "bridge", "tree": [-1.5, 1.5], "rail": "rw.south", "wheel": "w", "at": [0, 0, 6]}],
        "motions": [{"body": "bridge", "dof": "x", "kind": "prescribed", "speed": [[0, 0.5]]}],
        "end": {"time": 0.2}
    })
}

/// Runs a scene; returns what it says, and its history where it has one.
fn run(scene: &Value) -> (String, Option<History>) {
    run_on(&rails(), scene)
}

/// Runs a scene on a structure.
fn run_on(spec: &Value, scene: &Value) -> (String, Option<History>) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, value: &Value| {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a writable folder");
    };
    write("spec.json", spec);
    write("scene.json", scene);
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["run", "scene.json", "-o", "out"])
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let path = folder.path().join("out/history.csv");
    let history = Path::exists(&path).then(|| History::read(&path));
    (said, history)
}

/// The first values of columns of the four wheels.
fn of_wheels(scene: &Value, part: &str) -> [f64; 4] {
    let (said, history) = run(scene);
    let history = history.unwrap_or_else(|| panic!("{said}"));
    ["n.wheel1", "n.wheel2", "s.wheel1", "s.wheel2"]
        .map(|wheel| history.column(&format!("{wheel}.{part}"))[0])
}

fn assert_near(found: [f64; 4], wanted: [f64; 4], tolerance: f64) {
    for (found, wanted) in found.iter().zip(wanted) {
        assert!((found - wanted).abs() <= tolerance, "{found} for {wanted}");
    }
}

/// The centre of mass is at half the gauge towards the stiffer rail, which has 150 kN; on the softer one of two wheels that differ in
/// support, the one over the soft middle of the span stands open, and by moments the wheels have 0, 50, 100 and 50 kN. The opening
/// was computed from the beams by scipy.
#[test]
fn a_bridge_on_four_wheels_stands_on_three() {
    let forces = [0.0, 50.0, 100.0, 50.0];
    let mut scene = bridge([0.0, 0.0, 3.0]);
    assert_near(of_wheels(&scene, "vertical"), forces, 1e-9);
    let [open, ..] = of_wheels(&scene, "penetration");
    assert!((open + 1.81e-3).abs() < 5e-6, "{open}");
    scene["analysis"] = json!("quasi-static");
    assert_near(of_wheels(&scene, "vertical"), forces, 1e-9);
    scene = bridge([0.0, 0.0, 3.0]);
    scene["structures"]["rw"]["foundation"] = json!("modal");
    scene["structures"]["rw"]["modes"] = json!(6);
    assert_near(of_wheels(&scene, "vertical"), forces, 0.2);
    scene = bridge([0.0, 0.0, 3.0]);
    scene["wheels"]["w"]["vertical"] = json!({"law": "impact", "k": 1e7, "exponent": 1.5});
    assert_near(of_wheels(&scene, "vertical"), forces, 1e-9);
}

/// On rigid rails with a step of 1 mm under one wheel the bridge rocks over two wheels until a third one stands. By moments about
/// both axes, with stiffnesses k on three wheels: N2 from the moments about the line of S1 and S2, and so on; the opening follows from
/// the plane of the other three.
#[test]
fn a_bridge_on_an_uneven_rail_stands_on_three_wheels() {
    let mut scene = bridge([0.1, 0.0, 0.39]);
    scene["structures"]["rw"] = json!({"spec": "spec.json", "foundation": "rigid",
        "irregularities": [{"kind": "step", "rail": "north", "x": 4.0, "height": 0.001}]});
    let south = 200.0 * (6.0 + 0.39) / 12.0;
    let north = 200.0 - south;
    // the north wheel on the step carries all of its rail: moments about z leave for the south wheels
    let second = 0.5 * south + 200.0 * 0.1 / 3.0 - 0.5 * north;
    let forces = [0.0, north, south - second, second];
    assert_near(of_wheels(&scene, "vertical"), forces, 1e-9);
    let depth = forces.map(|force| force / 1e6);
    // heights of the hubs of three wheels give the fourth: n1 = n2 + s1 - s2
    let open = depth[1] - 0.001 + depth[2] - depth[3];
    assert_near(
        of_wheels(&scene, "penetration"),
        [open, depth[1], depth[2], depth[3]],
        1e-15,
    );
}

/// A refusal names the body, how it falls, and where in the file it stands.
#[test]
fn a_fall_is_named() {
    for (cg, fall) in [
        ([0.0, 0.0, 7.0], "tips to its right (z > 0)"),
        ([0.0, 0.0, -7.0], "tips to its left (z < 0)"),
        ([2.0, 0.0, 0.0], "tips forwards (x > 0)"),
        ([-2.0, 0.0, 0.0], "tips backwards (x < 0)"),
    ] {
        let (said, _) = run(&bridge(cg));
        assert!(said.contains("scene.json:1:"), "{said}");
        assert!(
            said.contains("bodies.bridge: has no static equilibrium"),
            "{said}"
        );
        assert!(said.contains(fall), "{cg:?}: {said}");
    }
    // a centre of mass over one wheel is carried by that wheel
    let forces = of_wheels(&bridge([1.5, 0.0, 6.0]), "vertical");
    assert_near(forces, [0.0, 0.0, 0.0, 200.0], 1e-6);
}

/// A body without a degree of freedom of its own, or with x alone, is held by its track: wheels at the height of the rail carry
/// nothing, on any foundation.
#[test]
fn bodies_that_the_track_holds_run() {
    for foundation in ["rigid", "influence", "modal", "auto"] {
        for dof in [json!([]), json!(["x"])] {
            let mut scene = bridge([0.0; 3]);
            scene["structures"]["rw"]["foundation"] = json!(foundation);
            scene["bodies"]["bridge"]["dof"] = dof.clone();
            let (said, history) = run(&scene);
            assert!(
                history.is_some() && said.contains("wrote out"),
                "{foundation}, {dof}: {said}"
            );
        }
    }
}

/// Analytic: a girder of 10 m under 40 kN at 2 m and at 5 m sinks there by P b x (L^2 - b^2 - x^2)/(6 E I L) each. The wheels share
/// one force through an equaliser; the rail sinks under each by its own amount.
#[test]
fn the_rail_sinks_under_each_wheel_of_an_equaliser() {
    let spec = json!({"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [10], "E": 2.1e8, "I_vertical": 4e-4}, "stations": [0, 10]});
    let scene = json!({"format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 10,
        "analysis": "quasi-static", "structures": {"b": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"t": {"mass": 8, "dof": ["y"], "x0": 3.5}}, "wheels": {"w": {"radius": 0.3, "vertical": {"k": 5e4}}},
        "trucks": [{"name": "w", "body": "t", "tree": [[-1.5, 1.5]], "wheel": "w"}], "end": {"time": 1}, "output": {"dt": 1}});
    let (said, history) = run_on(&spec, &scene);
    let history = history.unwrap_or_else(|| panic!("{said}"));
    let (length, ei) = (10.0_f64, 2.1e8 * 4e-4);
    let unit = |x: f64, at: f64| {
        let (x, b) = if x <= at {
            (x, length - at)
        } else {
            (length - x, at)
        };
        b * x * (length * length - b * b - x * x) / (6.0 * ei * length)
    };
    for (wheel, x) in [("w.wheel1", 2.0), ("w.wheel2", 5.0)] {
        let known = 40.0 * (unit(x, 2.0) + unit(x, 5.0));
        let found = history.column(&format!("{wheel}.rail_deflection"))[0];
        assert!(
            (found / known - 1.0).abs() < 1e-9,
            "{wheel}: {found}, not {known}"
        );
    }
}
