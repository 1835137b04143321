//! Deflections under static wheel loads beside the limits of codes.

use serde_json::{Value, json};

use super::{read, run_in};

/// A crane of 120 000 lb with two wheels on each of two simply supported girders of 60 ft; E = 4.2e9 lb/ft2, Iz = 3 and
/// Iy = 1 ft4.
fn scene() -> [(&'static str, Value); 2] {
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "ft", "force": "lbf", "time": "s"},
        "points": [[0, 0, 0], [60, 0, 0], [0, 0, 30], [60, 0, 30]],
        "cells": [{"type": "line", "data": [[0, 1], [2, 3]]}],
        "materials": [{"name": "steel", "E": 4.2e9, "G": 1.6e9}],
        "sections": [{"name": "girder", "material": "steel", "A": 1, "Iy": 1, "Iz": 3, "J": 1}],
        "supports": [
            {"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 1, "fix": ["uy", "uz", "rx"]},
            {"point": 2, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 3, "fix": ["uy", "uz", "rx"]}],
        "rails": {
            "north": {"axis": [1, 0, 0], "segments": [{"cell": [0, 0]}], "stations": [0, 20, 40, 60]},
            "south": {"axis": [1, 0, 0], "segments": [{"cell": [0, 1]}], "stations": [0, 20, 40, 60]}}});
    let scene = json!({
        "format": "girderway-scene/1", "units": {"length": "ft", "force": "lbf", "time": "s"}, "gravity": 32.174,
        "structures": {"aisle": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"bridge": {"weight": 120_000, "inertia": [1e5, 1e5, 1e5], "dof": ["y", "roll", "pitch"], "x0": 30}},
        "wheels": {"crane": {"radius": 1, "vertical": {"k": 1e8, "c": 1e5}}},
        "trucks": [
            {"name": "north", "rail": "aisle.north", "at": [0, 0, -15], "tree": [-5, 5]},
            {"name": "south", "rail": "aisle.south", "at": [0, 0, 15], "tree": [-5, 5]}],
        "motions": [{"body": "bridge", "dof": "x", "kind": "prescribed", "speed": [[0, 0]]}],
        "practice": {"class": "E"}, "end": {"time": 0.2}, "output": {"dt": 0.1}});
    [("spec.json", spec), ("scene.json", scene)]
}

/// Analytic: two loads P at the distance a from either support of a span L deflect its middle by P a (3 L^2 - 4
/// a^2)/(24 E I). Here P = 120000/4 = 30000 lb, a = 25 ft, L = 60 ft: 0.0205853 ft vertically, of which 60 ft are 2915;
/// laterally a tenth of the loads and a third of the stiffness: 0.3 of it.
#[test]
fn deflections_under_static_loads_are_those_of_the_closed_form() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in scene() {
        std::fs::write(folder.path().join(name), value.to_string()).expect("written");
    }
    let summary = read(&run_in(folder.path()).join("summary.json"));
    let limits = summary["practice"]["limits"].as_array().expect("limits");
    assert_eq!(limits.len(), 4, "two directions on two rails");
    let (load, a, span) = (30_000.0_f64, 25.0_f64, 60.0_f64);
    let vertical = load * a * (3.0 * span * span - 4.0 * a * a) / (24.0 * 4.2e9 * 3.0);
    assert!((vertical - 0.020_585_3).abs() < 1e-7, "{vertical}");
    for limit in limits {
        let wanted = match limit["name"].as_str().expect("a name") {
            "runway_vertical" => vertical,
            _ => 0.3 * vertical,
        };
        let found = limit["static_deflection"].as_f64().expect("a number");
        assert!((found / wanted - 1.0).abs() < 1e-9, "{limit}");
        assert!(
            (limit["x"].as_f64().expect("a place") - 30.0).abs() < 1e-9,
            "{limit}"
        );
        for code in limit["codes"].as_array().expect("codes") {
            let allowable = code["value"].as_f64().expect("a number");
            assert_eq!(code["within"], json!(found <= allowable), "{code}");
        }
    }
    // 60 ft/1000 = 0.06 ft by Design Guide 7 for class E, 25 mm = 0.0820 ft by EN 1993-6, below 60 ft/600
    let of = |code: &str| {
        let codes = limits[0]["codes"].as_array().expect("codes");
        let own = codes
            .iter()
            .find(|limit| limit["code"] == code)
            .expect(code);
        own["value"].as_f64().expect("a number")
    };
    assert!((of("AISC Design Guide 7") - 0.06).abs() < 1e-12);
    assert!((of("EN 1993-6:2007") - 0.025 / 0.3048).abs() < 1e-12);
}
