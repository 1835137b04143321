//! `girderway fea --modes`: what the member `modes` says.

use std::f64::consts::PI;
use std::fs;

use serde_json::Value;

use super::{folder, girderway, json, text};

const SPEC: &str = r#"{"format": "girderway-beam/1", "name": "one", "theory": "euler-bernoulli",
 "units": {"length": "ft", "force": "lbf", "time": "s"},
 "girder": {"spans": [60], "E": 4.32e9, "I_vertical": 9.528, "mass_per_length": 26.4},
 "stations": [0, 15, 30, 60]}"#;

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().map(Vec::as_slice).unwrap_or_default();
    list.iter()
        .map(|number| number.as_f64().expect("a number"))
        .collect()
}

#[test]
fn modes_of_a_span_are_those_of_the_textbook() {
    let folder = folder();
    fs::write(folder.path().join("one.json"), SPEC).expect("written");
    let run = girderway(
        &folder,
        &["fea", "one.json", "--modes", "4", "-o", "grid.json"],
    );
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    assert!(
        text(&run.stderr).contains("4 modes are below 362.")
            && text(&run.stderr).contains(" Hz, and all of them are listed"),
        "{}",
        text(&run.stderr)
    );
    let grid = json(&fs::read(folder.path().join("grid.json")).expect("written"));
    let modes = &grid["modes"];
    assert_eq!(modes["complete_below"]["count"], 4);
    let mass = 26.4 * 60.0_f64;
    for (k, mode) in modes["modes"]
        .as_array()
        .expect("a list")
        .iter()
        .enumerate()
    {
        let n = (k + 1) as f64;
        // omega = (n pi / L)^2 sqrt(EI / m), phi = sqrt(2 / mL) sin(n pi x / L).
        let omega = (n * PI / 60.0).powi(2) * (4.32e9 * 9.528_f64 / 26.4).sqrt();
        let hz = mode["hz"].as_f64().expect("a number");
        assert!(
            hz > omega / (2.0 * PI) && hz < 1.001 * omega / (2.0 * PI),
            "mode {n}: {hz}"
        );
        let value = numbers(&mode["vertical"]["value"]);
        let slope = numbers(&mode["vertical"]["slope"]);
        let sign = slope[0].signum();
        for (x, (value, slope)) in [0.0, 15.0, 30.0, 60.0]
            .into_iter()
            .zip(value.iter().zip(&slope))
        {
            let (size, wave) = (sign * (2.0_f64 / mass).sqrt(), n * PI / 60.0);
            assert!(
                (value - size * (wave * x).sin()).abs() < 2e-3 * size.abs(),
                "mode {n} at {x}"
            );
            assert!((slope - size * wave * (wave * x).cos()).abs() < 5e-3 * wave * size.abs());
        }
        assert!(mode["lateral"].is_null());
        assert!(
            mode["residual"]
                .as_f64()
                .is_some_and(|residual| residual < 1e-14)
        );
    }
    assert!((modes["mass"][1][1].as_f64().expect("a number") / mass - 1.0).abs() < 1e-12);
    // Whoever reads the grid reads it with its modes.
    let tables = girderway(&folder, &["splines", "grid.json", "-o", "tables.csv"]);
    assert_eq!(tables.status.code(), Some(0), "{}", text(&tables.stderr));
    let spoiled = fs::read_to_string(folder.path().join("grid.json")).expect("text");
    let spoiled = spoiled.replace("\"hz\":", "\"herz\":");
    fs::write(folder.path().join("spoiled.json"), spoiled).expect("written");
    assert_eq!(
        girderway(&folder, &["splines", "spoiled.json"])
            .status
            .code(),
        Some(2)
    );
}

#[test]
fn modes_without_mass_are_refused_at_the_place_that_lacks_it() {
    let folder = folder();
    let spec = SPEC.replace(", \"mass_per_length\": 26.4", "");
    fs::write(folder.path().join("one.json"), spec).expect("written");
    let run = girderway(&folder, &["fea", "one.json", "--modes", "2"]);
    assert_eq!(run.status.code(), Some(2));
    let said = text(&run.stderr);
    assert!(
        said.contains("mass_per_length") && said.contains("one.json:3"),
        "{said}"
    );
    assert_eq!(
        girderway(&folder, &["fea", "one.json", "--modes", "0"])
            .status
            .code(),
        Some(2)
    );
}

/// The ramp of the damper makes the force of a rising wheel fall with its penetration: a negative stiffness, which must
/// not enter the frequency of a mode on its wheels. Regression: 56 steps.
#[test]
fn a_ramped_damper_of_a_rising_wheel_does_not_shorten_the_steps() {
    let folder = folder();
    let spec = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
      "girder": {"spans": [11.6553], "E": 2.1e8, "G": 8.1e7, "A": 0.02, "I_vertical": 3.278e-5, "I_lateral": 3.312e-3,
      "J": 1e-4, "mass_per_length": 0.5301, "rail_height": 0.5}, "stations": [0, 2.9, 5.8, 8.7, 11.6553]}"#;
    let scene = r#"{"format": "girderway-scene/1", "units": {"length": "m", "force": "kN", "time": "s"}, "gravity": 9.81,
      "structures": {"girder": {"spec": "spec.json", "foundation": "modal"}},
      "bodies": {"car": {"mass": 16.11, "inertia": [16.11, 16.11, 11.807], "dof": ["x", "y", "pitch"], "x0": 3.4732}},
      "wheels": {"wheel": {"radius": 0.2463,
      "vertical": {"k": 5414000, "c": 40453.4, "law": "impact", "exponent": 1.1, "depth": 0.0002704}}},
      "trucks": [{"body": "car", "rail": "girder.rail", "tree": [-1.2926, 1.2926], "wheel": "wheel"}],
      "motions": [{"body": "car", "dof": "x", "kind": "prescribed", "speed": [[0, 0.3671]]}],
      "end": {"time": 0.01784}, "output": {"dt": 0.00223}, "accuracy": 1e-4}"#;
    fs::write(folder.path().join("spec.json"), spec).expect("written");
    fs::write(folder.path().join("scene.json"), scene).expect("written");
    let run = girderway(&folder, &["run", "scene.json", "-o", "out"]);
    assert_eq!(run.status.code(), Some(0), "{}", text(&run.stderr));
    let summary = json(&fs::read(folder.path().join("out/summary.json")).expect("a summary"));
    let steps = summary["steps"]["accepted"]
        .as_u64()
        .expect("a number of steps");
    assert!(steps < 1000, "{steps} steps");
}
