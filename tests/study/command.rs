//! The command: what it writes, and what it refuses.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn bogie() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/bogie/scene.json")
}

fn girderway(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_girderway"))
        .args(["study", "--quiet"])
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn read(path: &Path) -> Value {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_slice(&bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn equal_studies_differ_in_their_times_alone() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = bogie();
    let scene = scene.to_str().expect("a path in UTF-8");
    for name in ["a", "b"] {
        let run = girderway(folder.path(), &["--quick", scene, "-o", name]);
        assert_eq!(run.status.code(), Some(0), "{}", errors(&run));
    }
    let manifest = read(&folder.path().join("a/manifest.json"));
    let outputs = manifest["outputs"].as_array().expect("a list");
    let (mut same, mut varying) = (0, Vec::new());
    for output in outputs {
        let name = output["name"].as_str().expect("a name");
        let [a, b] = ["a", "b"]
            .map(|own| std::fs::read(folder.path().join(own).join(name)).expect("listed"));
        if output["sha256"].is_string() {
            assert_eq!(a, b, "{name}");
            same += 1;
        } else {
            varying.push(name);
        }
    }
    assert!(same >= 5, "{outputs:?}");
    let times = [
        "plots/foundations-time.svg",
        "plots/methods-time.svg",
        "plots/tables-time.svg",
    ];
    assert_eq!(
        varying,
        [&times[..], &["timing.csv", "timing.json"]].concat()
    );
    for word in ["median", "seconds", "\"time\""] {
        let text = std::fs::read_to_string(folder.path().join("a/study.json")).expect("text");
        assert!(!text.contains(word), "{word}");
    }
}

#[test]
fn a_study_tells_references_errors_and_the_choice() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = bogie();
    let arguments = [
        "--quick",
        scene.to_str().expect("a path in UTF-8"),
        "--case",
        "quasi-static",
        "-o",
        "out",
    ];
    let run = girderway(folder.path(), &arguments);
    assert_eq!(run.status.code(), Some(0), "{}", errors(&run));
    let study = read(&folder.path().join("out/study.json"));
    assert_eq!(study["format"], "girderway-study/1");
    assert_eq!(study["references"].as_array().map(Vec::len), Some(3));
    assert!(
        study["auto"]["girder"]
            .as_str()
            .is_some_and(|why| why.contains("auto: influence")),
        "{}",
        study["auto"]
    );
    let settings = study["settings"].as_array().expect("a list");
    assert!(
        settings.iter().all(|own| own["status"] == "done"),
        "{settings:#?}"
    );
    // baselines: two rigid parts sink by 1.198 ft where the girder sinks by 0.54575 ft
    let two = settings
        .iter()
        .find(|own| own["family"] == "parts" && own["parts"] == 2.0)
        .expect("two parts");
    let error = two["errors"]["deflection"]["peak"]
        .as_f64()
        .expect("a number");
    assert!((error - (1.198 / 0.54575 - 1.0)).abs() < 5e-3, "{error}");
}

#[test]
fn a_reference_that_is_not_converged_is_told_and_fails() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = bogie();
    let scene = scene.to_str().expect("a path in UTF-8");
    let run = girderway(
        folder.path(),
        &["--quick", "--resolution", "1e-12", scene, "-o", "out"],
    );
    assert_eq!(run.status.code(), Some(3));
    assert!(
        errors(&run).contains("not converged: its two finest runs differ by"),
        "{}",
        errors(&run)
    );
    assert!(
        folder.path().join("out/study.json").is_file(),
        "what was found is written"
    );
    let run = girderway(
        folder.path(),
        &["--quick", "--limit", "1e-9", scene, "-o", "none"],
    );
    assert_eq!(run.status.code(), Some(3));
    assert!(
        errors(&run).contains("no reference could be run"),
        "{}",
        errors(&run)
    );
    assert!(!folder.path().join("none").exists());
}

#[test]
fn maps_need_a_straight_girder() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = bogie().with_file_name("../mill_girderway/scene.json");
    let scene = scene.to_str().expect("a path in UTF-8");
    let run = girderway(folder.path(), &["--stability", scene, "-o", "out"]);
    assert_eq!(run.status.code(), Some(1));
    assert!(
        errors(&run).contains("need a truck on a straight girder"),
        "{}",
        errors(&run)
    );
    assert!(!folder.path().join("out").exists());
}

#[test]
fn garbage_is_refused_before_anything_is_run() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = bogie();
    let scene = scene.to_str().expect("a path in UTF-8");
    std::fs::write(
        folder.path().join("bad.json"),
        "{\"format\": \"girderway-scene/1\", \"study\": 1}",
    )
    .expect("writable");
    for (arguments, wanted) in [
        (
            vec!["--case", "rigit", scene],
            "known: quasi-static, printed-akispl",
        ),
        (vec!["bad.json"], "bad.json:1:"),
        (vec!["missing.json"], "no such file"),
        (vec!["--limit", "0", scene], "must be positive"),
        (
            vec!["--resolution", "2", scene],
            "must be greater than 0 and less than 1",
        ),
    ] {
        let run = girderway(folder.path(), &arguments);
        assert_eq!(run.status.code(), Some(2), "{arguments:?}");
        assert!(
            errors(&run).contains(wanted),
            "{arguments:?}: {}",
            errors(&run)
        );
        assert!(run.stdout.is_empty());
    }
}
