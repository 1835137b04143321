//! What runs say of second order. 45 runs stand beside OpenSees in `opensees.py`, nightly.

use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

/// A deck of 80 m in six parts on a pylon of the given height and four stays, with the weight of its steel.
fn deck(height: f64, has_preload: bool) -> Value {
    let plane = ["uz", "rx", "ry"];
    let held = |point: usize, fixed: &[&str]| {
        let fixed: Vec<&str> = fixed.iter().chain(&plane).copied().collect();
        json!({"point": point, "fix": fixed})
    };
    let mut supports = vec![
        held(0, &["ux", "uy"]),
        held(6, &["uy"]),
        held(7, &["ux", "uy", "rz"]),
    ];
    supports.extend([1, 2, 3, 4, 5, 8].map(|point| held(point, &[])));
    let up = [0, 1, 0];
    let mut spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"},
        "points": [[0, 0, 0], [15, 0, 0], [28, 0, 0], [40, 0, 0], [52, 0, 0], [65, 0, 0], [80, 0, 0], [40, -10, 0], [40, height, 0]],
        "cells": [
            {"type": "line", "data": [[0, 1], [1, 2], [2, 3], [3, 4], [4, 5], [5, 6], [7, 8]]},
            {"type": "line", "data": [[1, 8], [2, 8], [4, 8], [5, 8]]}],
        "cell_data": {
            "kind": [["beam", "beam", "beam", "beam", "beam", "beam", "beam"], ["truss", "truss", "truss", "truss"]],
            "section": [["deck", "deck", "deck", "deck", "deck", "deck", "pylon"], ["stay", "stay", "stay", "stay"]],
            "orientation": [[up, up, up, up, up, up, [1, 0, 0]], [up, up, up, up]]},
        "materials": [
            {"name": "steel", "E": 2.1e8, "G": 8.1e7, "density": 7.85}, {"name": "light", "E": 2.1e8, "G": 8.1e7},
            {"name": "strand", "E": 1.65e8, "G": 6e7}],
        "sections": [
            {"name": "deck", "material": "steel", "A": 0.08, "Iz": 8e-4, "Iy": 8e-4, "J": 8e-4},
            {"name": "pylon", "material": "light", "A": 0.2, "Iz": 0.05, "Iy": 0.05, "J": 0.05},
            {"name": "stay", "material": "strand", "A": 0.002}],
        "supports": supports,
        "rails": {"deck": {"axis": [1, 0, 0], "stations": [0, 80], "segments": [
            {"cell": [0, 0]}, {"cell": [0, 1]}, {"cell": [0, 2]}, {"cell": [0, 3]}, {"cell": [0, 4]}, {"cell": [0, 5]}]}}
    });
    if has_preload {
        spec["preload"] = json!({"weight": true, "gravity": 9.81});
    }
    spec
}

/// What a run says while a wheel rolls over a structure, without what it warns of its contact stiffness.
fn said(spec: &Value, length: f64, force: f64) -> String {
    let scene = json!({
        "format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
        "analysis": "quasi-static",
        "structures": {"s": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"b": {"weight": force, "dof": ["y"], "x0": 0}},
        "wheels": {"w": {"radius": 0.5, "vertical": {"k": 1e6}}},
        "trucks": [{"name": "t", "body": "b", "rail": "s.deck", "wheel": "w"}],
        "motions": [{"body": "b", "dof": "x", "kind": "prescribed", "speed": [[0, 1.0]]}],
        "end": {"time": length}, "output": {"dt": 1}
    });
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [("spec.json", spec), ("scene.json", &scene)] {
        std::fs::write(Path::join(folder.path(), name), value.to_string())
            .expect("a writable folder");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["run", "scene.json", "-o", "out"])
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// External: OpenSees with co-rotational `dispBeamColumn` and `corotTruss` (`opensees.py`), largest differences of deflections,
/// forces and moments from its linear answer at 25 places of the wheel.
#[test]
fn a_cable_stayed_deck_is_told_what_finite_displacements_change() {
    for (height, has_preload, force, known) in [
        (8.0, true, 300.0, [9.82e-2, 3.54e-2, 3.63e-2]),
        (25.0, true, 600.0, [5.75e-2, 3.77e-2, 2.94e-2]),
        (25.0, false, 300.0, [3.52e-2, 3.09e-2, 2.06e-2]),
    ] {
        let text = said(&deck(height, has_preload), 80.0, force);
        let after = |words: &str| -> f64 {
            let at = text
                .find(words)
                .unwrap_or_else(|| panic!("{words}: {text}"));
            let rest = &text[at + words.len()..];
            let number: String = rest.chars().take_while(|c| !c.is_whitespace()).collect();
            number.trim_end_matches(',').parse().expect("a number")
        };
        let found = [
            after("deflections by about "),
            after(" forces by "),
            after("and moments by "),
        ];
        for (found, known) in found.into_iter().zip(known) {
            let ratio = found / known;
            assert!(
                (0.7..1.4).contains(&ratio),
                "{height} m, {force} kN: {found}, not {known}"
            );
        }
    }
}

/// A shallow arch snaps through under the wheel: no number is given, but up to where it stands.
#[test]
fn an_arch_that_snaps_through_has_no_second_order() {
    let point = |k: usize| {
        let x = 2.5 * k as f64;
        json!([x, 0.2 * x * (1.0 - x / 30.0), 0])
    };
    let cells: Vec<[usize; 2]> = (0..12).map(|k| [k, k + 1]).collect();
    let mut supports: Vec<Value> = (1..12)
        .map(|k| json!({"point": k, "fix": ["uz", "rx", "ry"]}))
        .collect();
    let all = ["ux", "uy", "uz", "rx", "ry", "rz"];
    supports.extend([0, 12].map(|k| json!({"point": k, "fix": all})));
    let mut spec = deck(8.0, false);
    spec["points"] = (0..13).map(point).collect();
    spec["cells"] = json!([{"type": "line", "data": cells}]);
    let (sections, ups) = (vec!["arch"; 12], vec![[0, 1, 0]; 12]);
    spec["cell_data"] = json!({"section": [sections], "orientation": [ups]});
    spec["sections"] = json!([{"name": "arch", "material": "light", "A": 0.02, "Iz": 2e-4, "Iy": 2e-4, "J": 2e-4}]);
    spec["supports"] = Value::Array(supports);
    let segments: Vec<Value> = (0..12).map(|k| json!({"cell": [0, k]})).collect();
    spec["rails"] = json!({"deck": {"axis": [1, 0, 0], "stations": [0, 30], "segments": segments}});
    let text = said(&spec, 30.0, 600.0);
    assert!(
        text.contains("warning: ") && text.contains("would lose its stability"),
        "{text}"
    );
    assert!(
        text.contains("second-order effects are not known"),
        "{text}"
    );
}
