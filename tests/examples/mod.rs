//! Every example runs as it stands and gives the numbers beside it.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::history;

use history::History;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn json(path: &Path) -> Value {
    let text =
        std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Runs a scene into a folder of its own.
fn run(scene: &Path) -> tempfile::TempDir {
    let out = tempfile::tempdir().expect("a temporary folder");
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .arg("run")
        .arg(scene)
        .arg("-o")
        .arg(out.path())
        .output()
        .expect("the program starts");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(
        output.stdout.is_empty(),
        "standard output is for --json alone"
    );
    for file in [
        "history.csv",
        "summary.json",
        "report.html",
        "manifest.json",
        "timing.json",
    ] {
        assert!(out.path().join(file).is_file(), "{file} is missing");
    }
    out
}

/// No value of an example is doubted ([`formats::plausible`]).
fn raises_no_doubt(name: &str, summary: &Value) {
    let listed = &summary["verdict"]["not_checked"];
    for one in listed.as_array().expect("a list") {
        let check = one["check"].as_str().expect("a text");
        assert!(
            ![
                "plausibility",
                "agreement of",
                "self-weight",
                "tapered members"
            ]
            .iter()
            .any(|words| check.contains(words)),
            "{name}: {one}"
        );
    }
}

/// Runs an example and checks its `expected.json`.
fn check(name: &str) {
    let example = root().join("examples").join(name);
    let out = run(&example.join("scene.json"));
    let expected = json(&example.join("expected.json"));
    let summary = json(&out.path().join("summary.json"));
    raises_no_doubt(name, &summary);
    if let Some(most) = expected["energy_residual"].as_f64() {
        let residual = number(&summary["energy"]["residual"]);
        assert!(
            residual < most,
            "{name}: the energy audit leaves {residual:e}"
        );
    }
    let checks = expected["checks"].as_array().expect("a list of checks");
    assert!(!checks.is_empty());
    for check in checks {
        let file = match check["run"].as_str() {
            Some(label) => format!("history-{label}.csv"),
            None => "history.csv".to_owned(),
        };
        let history = History::read(&out.path().join(file));
        let column = history.column(check["column"].as_str().expect("a column"));
        let found = match check["where"].as_object() {
            Some(place) => {
                let (key, at) = place.iter().next().expect("one place");
                let along = history.column(key);
                let nearest = (0..along.len())
                    .min_by(|&a, &b| {
                        (along[a] - number(at))
                            .abs()
                            .total_cmp(&(along[b] - number(at)).abs())
                    })
                    .expect("rows");
                assert!(
                    (along[nearest] - number(at)).abs() < 1e-9,
                    "no row where {key} = {at}"
                );
                column[nearest]
            }
            None => column.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        };
        let (value, tolerance) = (number(&check["value"]), number(&check["tolerance"]));
        assert!(
            check["source"]
                .as_str()
                .is_some_and(|source| !source.is_empty()),
            "every number has a source"
        );
        assert!(
            (found - value).abs() <= tolerance,
            "{name}: {check}: found {found}"
        );
    }
}

#[test]
fn bogie_gives_its_expected_numbers() {
    check("bogie");
}

/// External: 0.90868 ft, converged by other codes with the exact influence function.
#[test]
fn a_bogie_at_100_ft_a_second_sinks_as_deep_as_in_other_codes() {
    let out = run(&root().join("examples/bogie/fast.json"));
    let history = History::read(&out.path().join("history.csv"));
    let peak = history
        .column("bogie.deflection")
        .iter()
        .copied()
        .fold(0.0, f64::max);
    assert!((peak - 0.908_68).abs() < 1e-5, "{peak}");
}

#[test]
fn wheel_gives_its_expected_numbers() {
    check("wheel");
}

#[test]
fn mill_girderway_gives_its_expected_numbers() {
    check("mill_girderway");
}

#[test]
fn yang_yau_gives_its_expected_numbers() {
    check("yang_yau");
}

#[test]
fn runway_gives_its_expected_numbers() {
    check("runway");
}

#[test]
fn ties_gives_its_expected_numbers() {
    check("ties");
}

#[test]
fn monorail_gives_its_expected_numbers() {
    check("monorail");
}

#[test]
fn grids_of_the_mill_girderway_are_those_of_other_codes() {
    let example = root().join("examples/mill_girderway");
    let expected = json(&example.join("expected.json"));
    let grids = &expected["grids"];
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let mut checked = 0;
    for theory in ["euler-bernoulli", "timoshenko"] {
        let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
            .args(["fea", "--quiet", "--theory", theory])
            .arg(example.join("spec.json"))
            .output()
            .expect("the program starts");
        let grid: Value = serde_json::from_slice(&output.stdout).expect("a grid");
        let stations = list(&grid["rails"][0]["stations"]);
        let index = |x: &Value| {
            stations
                .iter()
                .position(|known| known == x)
                .expect("a station")
        };
        let at: Vec<usize> = list(&grids["at"]).iter().map(index).collect();
        for entry in list(&grids["entries"])
            .iter()
            .filter(|entry| entry["theory"] == theory)
        {
            let block = entry["block"].as_str().expect("a name");
            let (row, column) = block.split_once('_').unwrap_or((block, block));
            for (i, a) in at.iter().enumerate() {
                for (j, b) in at.iter().enumerate() {
                    let of =
                        |block: &str, i: usize, j: usize| number(&grid["influence"][block][i][j]);
                    let scale = (of(row, *a, *a) * of(column, *b, *b)).sqrt();
                    let apart = (of(block, *a, *b) - number(&entry["value"][i][j])).abs();
                    assert!(
                        apart <= number(&grids["tolerance"]) * scale,
                        "{theory} {block} {i} {j}: {apart:e}"
                    );
                    checked += 1;
                }
            }
        }
    }
    assert_eq!(checked, 2 * 4 * 16);
}

#[test]
fn every_example_is_checked() {
    for entry in std::fs::read_dir(root().join("examples")).expect("the examples") {
        let name = entry
            .expect("an entry")
            .file_name()
            .into_string()
            .expect("a plain name");
        assert!(
            [
                "bogie",
                "bridge_crane",
                "mill_girderway",
                "monorail",
                "runway",
                "ties",
                "wheel",
                "yang_yau"
            ]
            .contains(&name.as_str()),
            "examples/{name} has no test"
        );
        for file in ["scene.json", "README.md", "expected.json"] {
            assert!(
                root().join("examples").join(&name).join(file).is_file(),
                "examples/{name}/{file} is missing"
            );
        }
    }
}

#[test]
fn equal_runs_give_equal_bytes() {
    let folders = [tempfile::tempdir(), tempfile::tempdir()]
        .map(|folder| folder.expect("a temporary folder"));
    for (folder, threads) in folders.iter().zip(["1", "2"]) {
        let status = Command::new(env!("CARGO_BIN_EXE_girderway"))
            .args(["run", "--quiet", "--threads", threads])
            .arg(root().join("examples/bogie/scene.json"))
            .arg("-o")
            .arg(folder.path())
            .status()
            .expect("the program starts");
        assert!(status.success());
    }
    let manifests = folders
        .each_ref()
        .map(|folder| std::fs::read(folder.path().join("manifest.json")).expect("a manifest"));
    assert!(!manifests[0].is_empty());
    assert_eq!(manifests[0], manifests[1]);
}

#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: 45 s of a crane with sixteen wheels, twice"
)]
fn bridge_crane_gives_its_expected_numbers() {
    check("bridge_crane");
}
