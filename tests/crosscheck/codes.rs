//! Frames in OpenSees and PyNite, solids of gmsh and scikit-fem.

use formats::grid::block::GridBlock;
use girderway::crosscheck::{Peer, PlainGrid, Station, ask};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use super::{EI, PAPER, cache, environment};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn crosscheck(spec: &Path, more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_girderway"));
    command
        .args(["crosscheck", "--json"])
        .arg(spec)
        .args(more)
        .env("XDG_CACHE_HOME", cache());
    command.output().expect("the program starts")
}

fn result(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("{error}: {}", String::from_utf8_lossy(&output.stderr)))
}

/// Largest difference of a grid from a code, by the first word of its name.
fn difference(result: &Value, code: &str, grid: &str) -> f64 {
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let named = |value: &Value, key: &str, name: &str| {
        value[key].as_str().is_some_and(|t| t.starts_with(name))
    };
    let compared = list(&result["compared"]);
    let outcome = compared
        .iter()
        .find(|outcome| named(outcome, "code", code))
        .expect("the code was compared");
    let differences = list(&outcome["differences"]);
    let found = differences
        .iter()
        .find(|d| d["grid"] == grid)
        .expect("the grid was compared");
    found["relative"].as_f64().expect("a number")
}

#[test]
fn mill_girderway_agrees_with_both_frame_codes() {
    environment();
    let spec = root().join("examples/mill_girderway/spec.json");
    for theory in ["euler-bernoulli", "timoshenko"] {
        let output = crosscheck(&spec, &["--theory", theory]);
        let result = result(&output);
        assert!(output.status.success(), "{result:#}");
        for code in ["OpenSees", "PyNite"] {
            for quantity in GridBlock::ALL {
                let relative = difference(&result, code, quantity.name());
                assert!(
                    relative < 1e-8,
                    "{theory}, {code}, {quantity}: {relative:e}"
                );
            }
        }
    }
}

#[test]
fn a_frame_with_everything_agrees_with_both_frame_codes() {
    // Three coupled rails, one backwards, two on one member, over gaps; skew and tapered members with arms; releases
    // of all kinds, at skew ends too; trusses on arms; springs; linked points, both supported.
    environment();
    let spec = root().join("tests/crosscheck/frame.json");
    let output = crosscheck(&spec, &[]);
    let result = result(&output);
    assert!(output.status.success(), "{result:#}");
    for quantity in GridBlock::ALL {
        let relative =
            ["OpenSees", "PyNite"].map(|code| difference(&result, code, quantity.name()));
        assert!(
            relative[0] < 5e-8 && relative[1] < 1e-10,
            "{quantity}: {relative:?}"
        );
    }
}

/// A girder on rods, which resist elongation and twist alone. At two joints nothing but rods resists a rotation, about
/// axes that are not global; one rod is released in torsion.
#[test]
fn a_girder_on_rods_agrees_with_both_frame_codes() {
    environment();
    let output = crosscheck(&root().join("tests/crosscheck/rods.json"), &[]);
    let result = result(&output);
    assert!(output.status.success(), "{result:#}");
    for quantity in GridBlock::ALL {
        for code in ["OpenSees", "PyNite"] {
            let relative = difference(&result, code, quantity.name());
            assert!(relative < 1e-11, "{code}, {quantity}: {relative:e}");
        }
    }
}

/// A girder of two spans that its axial force softens, and the monorail on hangers, which has no lateral stiffness without its
/// weight: PyNite's geometric stiffness of cubic elements errs by their fourth power, OpenSees' PDelta transformation by the
/// square of their length.
#[test]
fn structures_about_their_preload_agree_with_p_delta() {
    environment();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let girder = folder.path().join("girder.json");
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "euler-bernoulli",
        "girder": {"spans": [6, 7.5], "E": 2.1e8, "G": 8.1e7, "A": 0.0198, "I_vertical": 5.768e-4,
                   "I_lateral": 1.08e-4, "J": 3.6e-6},
        "stations": [0, 2, 3, 6, 9, 9.75, 13.5],
        "preload": {"loads": [{"x": 13.5, "force": [-2200, 0, 0]}]},
    });
    std::fs::write(&girder, spec.to_string()).expect("a writable folder");
    let monorail = root().join("examples/monorail/spec.json");
    for (spec, most) in [(&girder, [5e-3, 1e-6]), (&monorail, [1e-3, 1e-8])] {
        let output = crosscheck(spec, &[]);
        let result = result(&output);
        assert!(output.status.success(), "{result:#}");
        for (code, most) in ["OpenSees", "PyNite"].into_iter().zip(most) {
            for grid in ["vertical", "lateral"] {
                let relative = difference(&result, code, grid);
                assert!(
                    relative > 0.0 && relative < most,
                    "{}, {code}, {grid}: {relative:e}",
                    spec.display()
                );
            }
        }
    }
}

#[test]
fn solids_agree_with_timoshenko_beams() {
    // Source: external; 0.002 to 0.004 % at L/h = 20 and 0.07 to 0.15 % at L/h = 5 for the vertical midspan.
    environment();
    for (name, vertical, lateral) in [("rectangle_20", 1e-4, 5e-4), ("rectangle_5", 1.5e-3, 2e-3)] {
        let output = crosscheck(&root().join(format!("fea/{name}.json")), &[]);
        let result = result(&output);
        assert!(output.status.success(), "{result:#}");
        let found = ["vertical", "lateral"].map(|grid| difference(&result, "gmsh", grid));
        assert!(
            found[0] < vertical && found[1] < lateral,
            "{name}: {found:?}"
        );
        assert!(difference(&result, "scikit-fem", "vertical") < 1e-9);
    }
}

#[test]
fn a_flat_section_bends_as_a_plate_and_the_verdict_knows_it() {
    environment();
    let (b, h) = (0.12, 1.0_f64);
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "m", "force": "kN", "time": "s"}, "theory": "timoshenko",
        "girder": {"spans": [8], "E": 2.1e8, "G": 80769230.0, "A": b * h, "I_vertical": b * h.powi(3) / 12.0,
                   "I_lateral": h * b.powi(3) / 12.0, "J": 5.32e-4},
        "stations": [0, 2, 4, 8],
    });
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("spec.json");
    std::fs::write(&path, spec.to_string()).expect("a writable folder");
    let output = crosscheck(&path, &[]);
    let result = result(&output);
    assert!(output.status.success(), "{result:#}");
    // Source: external (gmsh, scikit-fem): 1.1e-3 to 1.7e-3 at this ratio of width and span
    let lateral = difference(&result, "gmsh", "lateral");
    assert!((1e-3..2.3e-3).contains(&lateral), "{lateral:e}");
    assert!(difference(&result, "gmsh", "vertical") < 5e-4);
    assert!(result.to_string().contains("bends as a plate"));
}

#[test]
fn a_wrong_shear_area_is_found_by_the_solid_alone() {
    environment();
    let text =
        std::fs::read_to_string(root().join("fea/rectangle_20.json")).expect("the spec is there");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let spec = folder.path().join("spec.json");
    let wrong = text.replace(
        "\"kA_vertical\": 0.4166666666666667",
        "\"kA_vertical\": 0.2",
    );
    assert_ne!(wrong, text);
    std::fs::write(&spec, wrong).expect("a writable folder");
    let out = folder.path().join("out");
    let output = crosscheck(&spec, &["-o", out.to_str().expect("a plain path")]);
    let result = result(&output);
    assert_eq!(output.status.code(), Some(1), "{result:#}");
    assert!(difference(&result, "gmsh", "vertical") > 5e-3);
    assert!(difference(&result, "gmsh", "lateral") < 5e-4);
    assert!(difference(&result, "OpenSees", "vertical") < 1e-9);
    for name in ["scikit-fem", "OpenSees", "PyNite", "gmsh"] {
        let path = out.join(format!("plots/difference-{name}.svg"));
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        roxmltree::Document::parse(&text).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    assert!(out.join("crosscheck.json").is_file() && out.join("manifest.json").is_file());
}

/// Names of sections and crane rails are numbers for the other codes, in both forms of a spec.
#[test]
fn sections_and_crane_rails_by_name_are_compared() {
    environment();
    let units = json!({"length": "m", "force": "kN", "time": "s"});
    let short = json!({"format": "girderway-beam/1", "units": units,
        "girder": {"spans": [6, 7.5, 6], "section": "HEB 400", "crane_rail": "A65"}});
    let general = json!({"format": "girderway-beam/1", "units": units,
        "points": [[0, 0, 0], [6, 0, 0]], "cells": [{"type": "line", "data": [[0, 1]]}],
        "materials": [{"name": "steel", "E": 2.1e8, "G": 8.1e7}],
        "sections": [{"name": "girder", "material": "steel", "shape": "HEB 400"}],
        "supports": [{"point": 0, "fix": ["ux", "uy", "uz", "rx"]}, {"point": 1, "fix": ["uy", "uz", "rx"]}],
        "rails": {"rail": {"axis": [1, 0, 0], "crane_rail": "A65", "stations": [0, 2, 4, 6],
            "segments": [{"cell": [0, 0], "offset": [0, 0.2, 0]}]}}});
    for value in [short, general] {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let spec = folder.path().join("spec.json");
        std::fs::write(&spec, value.to_string()).expect("a writable folder");
        let output = crosscheck(&spec, &[]);
        let result = result(&output);
        assert_eq!(output.status.code(), Some(0), "{result:#}");
        for code in ["OpenSees", "PyNite"] {
            for quantity in ["vertical", "lateral"] {
                assert!(
                    difference(&result, code, quantity) < 1e-9,
                    "{code} {quantity}: {result:#}"
                );
            }
        }
    }
}

/// The paper's girder as a user writes it.
fn paper() -> (Value, Vec<Station>) {
    let stations = [-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0];
    let spec = json!({
        "format": "girderway-beam/1", "units": {"length": "ft", "force": "lbf", "time": "s"},
        "girder": {"spans": [60], "overhangs": [15, 15], "E": 4.32e9, "I_vertical": EI / 4.32e9},
        "stations": stations,
    });
    (spec, stations.iter().map(|x| (0, *x)).collect())
}

#[test]
fn frame_codes_reproduce_the_closed_forms_of_the_papers_girder() {
    let environment = environment();
    let (spec, stations) = paper();
    let question = json!({ "spec": spec, "theory": "euler-bernoulli" });
    let mut vertical: PlainGrid = PAPER.iter().map(|row| row.to_vec()).collect();
    for peer in [Peer::OpenSees, Peer::PyNite] {
        let ours = [(GridBlock::Vertical, vertical.clone())];
        let outcome = ask(peer, &question, &ours, &stations, environment, &mut |_| {});
        let outcome = outcome.unwrap_or_else(|error| panic!("{error}"));
        assert!(
            outcome.agrees() && outcome.differences[0].relative < 1e-11,
            "{}",
            outcome.table(&[])
        );
    }
    vertical[2][4] *= 1.0 + 1e-6;
    let ours = [(GridBlock::Vertical, vertical)];
    let outcome = ask(
        Peer::PyNite,
        &question,
        &ours,
        &stations,
        environment,
        &mut |_| {},
    );
    let outcome = outcome.unwrap_or_else(|error| panic!("{error}"));
    assert!(!outcome.agrees(), "{}", outcome.table(&[]));
    assert_eq!(outcome.differences[0].at, [15.0, 45.0]);
}

#[test]
fn sections_that_are_no_rectangle_are_refused_by_the_solid() {
    let environment = environment();
    let (mut spec, stations) = paper();
    spec["girder"]["A"] = json!(1.0);
    spec["girder"]["G"] = json!(1.66e9);
    spec["girder"]["I_lateral"] = json!(0.875);
    let question = json!({ "spec": spec, "theory": "euler-bernoulli" });
    let answer = ask(
        Peer::Solid,
        &question,
        &[],
        &stations,
        environment,
        &mut |_| {},
    );
    let why = answer.expect_err("I_lateral is another one").to_string();
    assert!(why.contains("no solid rectangle"), "{why}");
}

#[test]
fn without_python_the_status_is_2_and_the_hint_says_what_is_needed() {
    let empty = tempfile::tempdir().expect("a temporary folder");
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .arg("crosscheck")
        .arg(root().join("examples/bogie/spec.json"))
        .env("PATH", empty.path())
        .env("XDG_CACHE_HOME", empty.path())
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        message.contains("python3") && message.contains("hint"),
        "{message}"
    );
    assert_eq!(
        std::fs::read_dir(empty.path()).expect("the folder").count(),
        0,
        "nothing is left behind"
    );
}

/// With a local address at which nothing listens in place of the index, and no folder of packages.
#[test]
fn without_a_package_index_the_message_comes_without_retries() {
    let empty = tempfile::tempdir().expect("a temporary folder");
    let output = Command::new(env!("CARGO_BIN_EXE_girderway"))
        .arg("crosscheck")
        .arg(root().join("examples/bogie/spec.json"))
        .env("XDG_CACHE_HOME", empty.path())
        .env("PIP_INDEX_URL", "http://127.0.0.1:9/simple")
        .env("PIP_NO_CACHE_DIR", "1")
        .env_remove("PIP_FIND_LINKS")
        .env_remove("PIP_EXTRA_INDEX_URL")
        .output()
        .expect("the program starts");
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    // a machine without Python stops earlier, as above
    assert!(
        message.contains("cannot reach PyPI") || message.contains("python3"),
        "{message}"
    );
    assert!(!message.contains("Retrying"), "{message}");
    let left: Vec<_> = std::fs::read_dir(empty.path().join("girderway"))
        .expect("the cache")
        .collect();
    assert!(left.is_empty(), "{left:?}");
}
