//! Values of codes beside runs of the crane.

use serde_json::{Value, json};

use super::{GRAVITY, run, scene};

/// Weights of trolley, ladle, and of the bridge with two boxes of 75 ft, A = 2.0312 ft2, 19.7986 slug/ft3.
const TROLLEY: f64 = 450_000.0;
const LADLE: f64 = 1_020_000.0;
const BRIDGE: f64 = 556_000.0 + 2.0 * 75.0 * 2.0312 * 19.7986 * GRAVITY;

/// The value of a code whose formula begins so.
fn value(summary: &Value, row: &str, code: &str, formula: &str) -> f64 {
    let all = summary["practice"]["values"][row]["codes"].as_array().expect("codes");
    let of = |entry: &&Value| {
        entry["code"] == code && entry["formula"].as_str().is_some_and(|text| text.starts_with(formula))
    };
    all.iter()
        .find(of)
        .and_then(|entry| entry["value"].as_f64())
        .unwrap_or_else(|| panic!("{row} {code} {formula}"))
}

/// Analytic: a crane at rest has its static wheel loads, and codes multiply weights by their factors: with the trolley in the middle
/// (1.1 (B + T) + phi2 Q)/(B + T + Q), phi2 = 1.1 + 0.34 x 0.1524 m/s.
#[test]
fn factors_of_codes_stand_beside_a_crane_at_rest() {
    let mut scene = scene("drop");
    scene["bodies"]["ladle"]["weight"] = json!(LADLE);
    scene["practice"] = json!({"kind": "ladle", "hoisting": "HC2", "hoist_speed": 0.5, "bridge_speed": 5});
    scene["events"] = json!([]);
    scene["end"]["time"] = json!(0.1);
    let (_, summary) = run(&scene);
    let crane = &summary["practice"]["crane"];
    let near = |found: f64, wanted: f64, share: f64| {
        assert!((found / wanted - 1.0).abs() < share, "{found} {wanted}");
    };
    let of = |name: &str| crane[name].as_f64().expect("a number");
    near(of("bridge"), BRIDGE, 1e-9);
    near(of("span"), 75.0, 1e-12);
    near(of("approach"), 37.5, 1e-12);
    near(of("wheels"), 8.0, 1e-12);
    let found = summary["practice"]["values"]["rail_factor"]["measured"]["value"].as_f64().expect("found");
    near(found, 1.0, 1e-3);
    let phi2 = 1.1 + 0.34 * 0.5 * 0.3048;
    near(value(&summary, "load_factor", "EN 1991-3:2006", "phi2"), phi2, 1e-12);
    let factor = |name: &str| summary["practice"]["factors"][name]["value"].as_f64().expect(name);
    near(factor("phi6"), 0.5 + 0.5 * phi2, 1e-12);
    near(factor("wheel_near"), (BRIDGE + TROLLEY + LADLE) / 16.0, 1e-9);
    near(factor("wheel_impact"), 1.25 * (BRIDGE + TROLLEY + LADLE) / 16.0, 1e-9);
    let all = BRIDGE + TROLLEY + LADLE;
    let wanted = (1.1 * (BRIDGE + TROLLEY) + phi2 * LADLE) / all;
    near(value(&summary, "rail_factor", "EN 1991-3:2006", "phi1"), wanted, 1e-9);
    // CMAA 70: 300 ft/min gives 1.05 + 0.15 = 1.2, 30 ft/min of hoisting 15 %
    let wanted = (1.2 * (BRIDGE + TROLLEY) + 1.15 * LADLE) / all;
    near(value(&summary, "rail_factor", "CMAA 70", "DLF"), wanted, 1e-9);
    near(value(&summary, "rail_factor", "AIST TR-13", "impact"), 1.25, 1e-12);
}

/// Analytic: the stops take v sqrt(m S) of bridge and trolley as one mass, less what the bridge's parts move against each other; the
/// code takes 1.25 x 0.7 of the rated speed in place of v.
#[test]
fn a_buffer_stands_beside_its_code_value() {
    let mut scene = scene("buffer");
    for name in ["aisle", "girders"] {
        scene["structures"][name]["foundation"] = json!("rigid");
    }
    scene["structures"]["aisle"]["longitudinal"] = json!(false);
    scene["bodies"]["bridge"]["x0"] = json!(202.0);
    scene["bodies"]["ladle"]["x0"] = json!(202.0);
    scene["end"]["time"] = json!(1.2);
    let (_, summary) = run(&scene);
    let wanted = 2.5 * ((BRIDGE + TROLLEY) / GRAVITY * 4e5).sqrt();
    let found = summary["practice"]["values"]["buffer"]["measured"]["value"].as_f64().expect("found");
    println!("{found} found, {wanted} of the closed form");
    assert!((found / wanted - 1.0).abs() < 2e-2, "{found} {wanted}");
    let code = value(&summary, "buffer", "EN 1991-3:2006", "phi7");
    assert!((code / (1.25 * 0.7 * 5.0 / 2.5 * wanted) - 1.0).abs() < 1e-9, "{code}");
}
