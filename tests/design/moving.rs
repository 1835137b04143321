//! Extremes of girders in a run against the static design of the same loads, and against rows of other lengths.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use serde_json::{Value, json};

use super::{number, table};

/// Three spans of a runway girder with mass.
fn runway() -> Value {
    json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "timoshenko",
        "girder": {"spans": [6, 7.5, 6], "E": 2.1e8, "G": 8.1e7, "A": 0.01978, "I_vertical": 5.768e-4,
                   "I_lateral": 1.082e-4, "J": 3.557e-6, "kA_vertical": 0.00508, "kA_lateral": 0.012,
                   "rail_height": 0.275, "mass_per_length": 0.1986},
        "stations": [0, 1.5, 3, 4.5, 6, 7.5, 9, 9.75, 10.5, 12, 13.5, 15, 16.5, 18, 19.5],
        "effects": [{"name": "mid", "x": 9.75}]
    })
}

/// A crane of two wheels of 180 kN that rolls over it from end to end; with no modes on a girder without mass.
fn crossing(modes: usize, dt: f64, accuracy: f64, dead: bool) -> Value {
    let mut girder = json!({"spec": "spec.json", "foundation": "influence"});
    if modes > 0 {
        girder =
            json!({"spec": "spec.json", "foundation": "modal", "modes": modes, "damping": 0.01});
    }
    json!({
        "format": "girderway-scene/1", "name": "crossing", "units": {"length": "m", "force": "kN", "time": "s"},
        "gravity": 9.81,
        "structures": {"girder": girder},
        "bodies": {"crane": {"weight": 360, "inertia": [0, 0, 120], "dof": ["x", "y", "pitch"], "x0": 1.8}},
        "wheels": {"crane": {"radius": 0.2, "vertical": {"law": "linear", "k": 4e5, "c": 400}}},
        "trucks": [{"body": "crane", "rail": "girder.rail", "tree": [-1.8, 1.8], "wheel": "crane"}],
        "motions": [{"body": "crane", "dof": "x", "kind": "prescribed", "speed": [[0, 6]]}],
        "end": {"time": 2.65}, "output": {"dt": dt, "dead_load": dead, "sections": true}, "accuracy": accuracy
    })
}

/// Writes the files and runs a command of the program; returns the folder with the results in `out`.
fn run(command: &str, job: &Value) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, value) in [("spec.json", &runway()), ("job.json", job)] {
        std::fs::write(folder.path().join(name), value.to_string()).expect("a writable folder");
    }
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args([command, "job.json", "-o", "out"])
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    folder
}

fn summary(folder: &Path) -> Value {
    let text = std::fs::read_to_string(folder.join("out/summary.json")).expect("a summary");
    serde_json::from_str(&text).expect("the summary is JSON")
}

/// Extremes of spans by span, quantity, plane and kind.
fn extremes(folder: &Path) -> BTreeMap<String, f64> {
    let summary = summary(folder);
    let all = summary["extremes"]
        .as_array()
        .expect("a list of extremes")
        .iter();
    let spans = all.filter(|entry| entry.get("span").is_some());
    let key = |entry: &Value| {
        ["span", "quantity", "plane", "kind"]
            .map(|k| entry[k].to_string())
            .join(" ")
    };
    spans
        .map(|entry| (key(entry), entry["value"].as_f64().expect("a number")))
        .collect()
}

/// Asserts that extremes agree to a fraction of the largest value of their quantity.
fn assert_alike(
    found: &BTreeMap<String, f64>,
    known: &BTreeMap<String, f64>,
    tolerance: f64,
    quantities: &[&str],
) {
    for quantity in quantities {
        let of = |key: &&String| key.split(' ').nth(1) == Some(&format!("\"{quantity}\""));
        let largest = known
            .iter()
            .filter(|(key, _)| of(key))
            .fold(0.0_f64, |most, (_, v)| most.max(v.abs()));
        let mut count = 0;
        for (key, value) in found.iter().filter(|(key, _)| of(key)) {
            let error = (value - known[key]).abs() / largest;
            assert!(
                error <= tolerance,
                "{key}: {value} instead of {}, {error:e}",
                known[key]
            );
            count += 1;
        }
        assert!(count >= 6, "{count} extremes of {quantity}");
    }
}

/// External to the run: exact roots of the static design. The wheel forces of a resting crane do not depend on the
/// girder, so that any output interval gives the same extremes.
#[test]
fn a_quasi_static_run_has_the_extremes_of_the_design() {
    let design = json!({
        "format": "girderway-design/1", "name": "worked", "units": {"length": "m", "force": "kN", "time": "s"},
        "spec": "spec.json",
        "trains": [{"name": "crane", "wheels": [{"x": 0, "vertical": 180}, {"x": 3.6, "vertical": 180}]}]
    });
    let known = extremes(run("design", &design).path());
    for dt in [0.05, 0.0123] {
        let mut scene = crossing(0, dt, 1e-4, false);
        scene["analysis"] = json!("quasi-static");
        let found = extremes(run("run", &scene).path());
        assert_alike(&found, &known, 1e-6, &["moment", "shear", "deflection"]);
    }
}

/// External to the run: the static design with the weight of the girder.
#[test]
fn dead_load_counts_as_in_the_design() {
    let design = json!({
        "format": "girderway-design/1", "name": "worked", "units": {"length": "m", "force": "kN", "time": "s"},
        "spec": "spec.json", "dead_load": true, "gravity": 9.81,
        "trains": [{"name": "crane", "wheels": [{"x": 0, "vertical": 180}, {"x": 3.6, "vertical": 180}]}]
    });
    let mut scene = crossing(0, 0.02, 1e-4, true);
    scene["analysis"] = json!("quasi-static");
    let found = extremes(run("run", &scene).path());
    assert_alike(
        &found,
        &extremes(run("design", &design).path()),
        1e-6,
        &["moment", "shear"],
    );
}

/// Identity: rows of the history and the method are choices of the user, the extremes are not. As the second wheel passes a
/// support the force of its damper jumps by 1.5 %, and the shear force beside the support is largest just behind it. With an
/// output time at this passage the force of one side was taken on the other, and it was 1 % too large.
#[test]
fn extremes_do_not_depend_on_the_output_interval() {
    for modes in [0, 8] {
        let of = |dt: f64, stepper: &str| {
            let mut scene = crossing(modes, dt, 1e-4, false);
            scene["stepper"] = json!(stepper);
            extremes(run("run", &scene).path())
        };
        let known = of(0.01, "radau");
        for (dt, stepper) in [
            (0.01 / 7.0, "radau"),
            (0.00143, "radau"),
            (0.01, "sdirk4"),
            (0.0017, "sdirk4"),
        ] {
            // each run has an error of its own
            let tolerance = if stepper == "radau" { 1e-4 } else { 2e-4 };
            assert_alike(
                &of(dt, stepper),
                &known,
                tolerance,
                &["moment", "shear", "deflection"],
            );
        }
    }
}

/// Identity: an output at the very passage of a support has the forces of the rows before it, by a cubic through four of
/// them; the force of the wheel that passes jumps behind it. It was 1e-4 off, with slopes of the rail of both sides.
#[test]
fn a_row_at_the_passage_of_a_support_has_the_forces_before_it() {
    for modes in [0, 8] {
        let mut scene = crossing(modes, 1e-4, 1e-6, false);
        scene["end"] = json!({"time": 1.0005});
        let rows = table(&run("run", &scene).path().join("out"), "history.csv");
        let at = rows
            .iter()
            .position(|row| number(&row["time"]) == 1.0)
            .expect("a row at the passage");
        for wheel in [1, 2] {
            let force =
                |row: usize| number(&rows[row][&format!("crane.truck1.wheel{wheel}.vertical")]);
            let cubic = 4.0 * (force(at - 1) + force(at - 3)) - 6.0 * force(at - 2) - force(at - 4);
            assert!(
                (force(at) / cubic - 1.0).abs() < 1e-7,
                "{} instead of {cubic}",
                force(at)
            );
            let jump = (force(at + 1) / force(at) - 1.0).abs();
            assert_eq!(jump > 0.01, wheel == 1, "wheel {wheel}: {jump}");
        }
    }
}

/// Identity, in a run whose wheels are undamped: the largest shear force of span 2 occurs in a vibration of a wheel just before
/// it passes a support, where the forces of sections jump. When the jump hid it, the value depended on the rows and on the
/// method, by 2.6e-2 of the largest.
#[test]
fn extremes_beside_a_jump_depend_neither_on_the_output_interval_nor_on_the_method() {
    let of = |dt: f64, stepper: &str| {
        let mut scene = crossing(0, dt, 1e-4, false);
        scene["wheels"]["crane"]["vertical"] = json!({"k": 1e6});
        scene["motions"][0]["speed"] = json!([[0, 0], [3, 1.5], [10, 1.5]]);
        (scene["end"], scene["stepper"]) = (json!({"time": 9}), json!(stepper));
        extremes(run("run", &scene).path())
    };
    let known = of(0.0007, "radau");
    for (dt, stepper) in [(0.014, "radau"), (0.0031, "radau"), (0.014, "sdirk4")] {
        assert_alike(
            &of(dt, stepper),
            &known,
            1e-3,
            &["moment", "shear", "deflection"],
        );
    }
}

/// Independent in the program: the column of a named section is the product of its own influence line with forces and
/// inertia. The envelope at the same section is the same, of 237.65.
#[test]
fn envelopes_contain_the_columns_of_sections() {
    let scene = crossing(8, 0.001, 1e-4, true);
    let folder = run("run", &scene);
    let column = &summary(folder.path())["envelopes"]["girder.mid.Mz"];
    for kind in ["max", "min"] {
        let known = column[kind]["value"].as_f64().expect("a number");
        let rows = table(&folder.path().join("out"), "envelope.csv");
        let is_it = |row: &&BTreeMap<String, String>| {
            number(&row["x"]) == 9.75
                && row["quantity"] == "moment"
                && row["plane"] == "vertical"
                && row["kind"] == kind
        };
        let found = number(&rows.iter().find(is_it).expect("a row of the section")["value"]);
        let sign = if kind == "max" { 1.0 } else { -1.0 };
        let more = sign * (found - known);
        assert!(
            (-1e-5..=1e-4).contains(&more),
            "{kind}: {found} beside {known}"
        );
    }
}
