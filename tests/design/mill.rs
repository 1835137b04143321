//! A building with eccentric girders, releases, gaps and springs: the mill girderway.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use super::root;

fn run(command: &str, job: &Path, out: &Path) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args([command, "--quiet"])
        .arg(job)
        .arg("-o")
        .arg(out)
        .output()
        .expect("the program starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("the summary is JSON")
}

/// External: OpenSees, its influence lines at positions every 0.05 ft (`tests/design/mill.py`). Samples fall short of the
/// extremes by less than 3e-7 of the largest reaction and exceed none.
#[test]
fn reactions_of_the_example_are_those_of_another_code() {
    let out = tempfile::tempdir().expect("a temporary folder");
    let found = run(
        "design",
        &root().join("examples/mill_girderway/design.json"),
        out.path(),
    );
    let extremes = found["extremes"].as_array().expect("a list of extremes");
    let sampled = [
        (
            1,
            [
                344802.6, 447510.5, 461579.2, 432424.0, 459391.0, 452125.8, 372823.6,
            ],
            "max",
        ),
        (
            1,
            [
                -33723.0, -48472.5, -41272.7, -30575.7, -49420.4, -54789.8, -28294.3,
            ],
            "min",
        ),
        (
            2,
            [
                396133.2, 788917.8, 865958.3, 761119.2, 839061.0, 803116.7, 490048.9,
            ],
            "max",
        ),
        (
            2,
            [
                -49580.9, -83975.3, -43026.8, -56707.7, -69544.4, -86800.8, -36293.8,
            ],
            "min",
        ),
    ];
    for (case, columns, kind) in sampled {
        for (k, known) in columns.into_iter().enumerate() {
            let name = format!("column{}", k + 1);
            let wanted = extremes.iter().find(|entry| {
                entry["case"] == json!(case)
                    && entry["support"] == json!(name)
                    && entry["direction"] == json!("uy")
                    && entry["kind"] == json!(kind)
            });
            let value = wanted.expect("the reaction is listed")["value"]
                .as_f64()
                .expect("a number");
            // A digit of the samples, and what they fall short by.
            let beyond = if kind == "max" {
                value - known
            } else {
                known - value
            };
            assert!(
                (-0.06..0.3).contains(&beyond),
                "{name} {kind}: {value}, sampled {known}"
            );
        }
    }
}

/// External to the design: a crane whose four wheels carry equal forces at every place, run from end to end. A row of
/// the run has a wheel on the end of the first girder, and other wheels pass ends of members within four rows of it. Its
/// lateral deflections have corners under the wheels, and are largest there, between listed places of the rail; beside
/// gaps between members, which belong to no span, they are smallest.
#[test]
fn a_quasi_static_run_over_the_mill_has_the_extremes_of_the_design() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name);
    std::fs::copy(
        root().join("examples/mill_girderway/spec.json"),
        path("spec.json"),
    )
    .expect("a copy");
    let units = json!({"length": "ft", "force": "lbf", "time": "s"});
    let wheels: Vec<Value> = [0, 5, 13, 18]
        .iter()
        .map(|x| json!({"x": x, "vertical": 120_000}))
        .collect();
    let design = json!({
        "format": "girderway-design/1", "name": "mill", "units": units, "spec": "spec.json",
        "trains": [{"name": "crane", "wheels": wheels}],
        "spans": {"north": [0.75, 40, 95, 170, 230, 275, 324.25]}
    });
    let scene = json!({
        "format": "girderway-scene/1", "name": "mill", "units": units, "gravity": 32.174, "analysis": "quasi-static",
        "structures": {"aisle": {"spec": "spec.json", "foundation": "influence"}},
        "bodies": {"truck": {"weight": 480_000, "inertia": [0, 0, 600_000], "dof": ["x", "y", "pitch"], "x0": 9.75}},
        "wheels": {"runway": {"radius": 1.25, "vertical": {"law": "linear", "k": 1e8, "c": 1e5}}},
        "trucks": [{"body": "truck", "rail": "aisle.north", "tree": [[-9, -4], [4, 9]], "wheel": "runway"}],
        "motions": [{"body": "truck", "dof": "x", "kind": "prescribed", "speed": [[0, 10]]}],
        "end": {"time": 30.55}, "output": {"dt": 0.05, "sections": true}, "accuracy": 1e-6
    });
    for (name, value) in [("design.json", &design), ("scene.json", &scene)] {
        std::fs::write(path(name), value.to_string()).expect("a writable folder");
    }
    let extremes = |summary: &Value| -> BTreeMap<String, f64> {
        let all = summary["extremes"]
            .as_array()
            .expect("a list of extremes")
            .iter();
        let key = |entry: &Value| {
            ["quantity", "plane", "span", "kind"]
                .map(|k| entry[k].to_string())
                .join(" ")
        };
        all.filter(|entry| entry.get("span").is_some())
            .map(|entry| (key(entry), entry["value"].as_f64().expect("a number")))
            .collect()
    };
    let known = extremes(&run("design", &path("design.json"), &path("designed")));
    let found = extremes(&run("run", &path("scene.json"), &path("moved")));
    for quantity in ["moment", "shear", "normal", "torsion", "deflection"] {
        let of = |key: &str| key.starts_with(&format!("\"{quantity}\""));
        let largest = known
            .iter()
            .filter(|(key, _)| of(key))
            .fold(0.0_f64, |most, (_, v)| most.max(v.abs()));
        let mut count = 0;
        for (key, value) in known.iter().filter(|(key, _)| of(key)) {
            let error = (found[key] - value).abs() / largest;
            // a design seeks deflections near to the largest ones of places, a run at that place at all times again
            let is_larger = quantity == "deflection" && found[key].abs() > value.abs();
            assert!(
                error < if is_larger { 3e-5 } else { 1e-8 },
                "{key}: {value} in the design, {} in the run, {error:e}",
                found[key]
            );
            count += 1;
        }
        assert!(count >= 12, "{count} extremes of {quantity}");
    }
}
