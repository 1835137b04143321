//! The bridge crane and its parts against closed forms: pendulum, sudden stop, hoisting, buffers, equilibrium.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};

mod codes;
mod couplings;
mod cranes;
mod damping;
mod drift;
mod drop;
mod emergency;
mod event;
mod extremes;
mod film;
use crate::history;
mod inertia;
mod limits;
mod parts;
mod skew;

use history::History;

const GRAVITY: f64 = 32.174;

fn example() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bridge_crane")
}

fn read(path: &Path) -> Value {
    let text =
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// One of the example's scenes, on its own: without comparisons.
fn scene(name: &str) -> Value {
    let mut scene = read(&example().join(format!("{name}.json")));
    scene["compare"] = json!([]);
    scene
}

impl History {
    /// Columns whose names begin and end so.
    fn all(&self, begin: &str, end: &str) -> Vec<&[f64]> {
        let fits = |name: &str| name.starts_with(begin) && name.ends_with(end);
        self.0
            .iter()
            .filter(|(name, _)| fits(name))
            .map(|(_, values)| values.as_slice())
            .collect()
    }

    fn most(&self, name: &str) -> f64 {
        self.column(name)
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Runs `scene` beside the example's specs: histories, the scene's own first, and the summary.
fn run(scene: &Value) -> (Vec<History>, Value) {
    let (histories, summary, _) = run_whole(scene);
    (histories, summary)
}

/// Runs the scene of a folder; returns the folder of its results.
fn run_in(folder: &Path) -> PathBuf {
    let out = folder.join("out");
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .arg("run")
        .arg(folder.join("scene.json"))
        .arg("-o")
        .arg(&out)
        .output()
        .expect("the program starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    out
}

/// The same with the report.
fn run_whole(scene: &Value) -> (Vec<History>, Value, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for spec in ["aisle.json", "girders.json"] {
        std::fs::copy(example().join(spec), folder.path().join(spec)).expect("a copy");
    }
    std::fs::write(folder.path().join("scene.json"), scene.to_string()).expect("written");
    let out = run_in(folder.path());
    let mut files = vec![out.join("history.csv")];
    let labels = scene["compare"].as_array().into_iter().flatten();
    files.extend(labels.map(|case| {
        out.join(format!(
            "history-{}.csv",
            case["label"].as_str().unwrap_or_default()
        ))
    }));
    let report = std::fs::read_to_string(out.join("report.html")).expect("a report");
    (
        files.iter().map(|file| History::read(file)).collect(),
        read(&out.join("summary.json")),
        report,
    )
}

/// Times at which a history passes zero upwards, by lines between rows.
fn upwards(times: &[f64], values: &[f64]) -> Vec<f64> {
    (1..values.len())
        .filter(|&k| values[k - 1] < 0.0 && values[k] >= 0.0)
        .map(|k| {
            times[k - 1] + (times[k] - times[k - 1]) * values[k - 1] / (values[k - 1] - values[k])
        })
        .collect()
}
