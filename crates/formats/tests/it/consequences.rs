//! A value of the wrong type is one fault, and what follows from its loss is none. Other faults are told with it.

use std::fs;
use std::path::{Path, PathBuf};

use formats::scene::Document;
use formats::spec::Spec;
use formats::text::diagnostic::Diagnostic;
use formats::text::source::Source;
use serde_json::{Value, json};

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(path)
}

fn parsed(path: &str) -> Value {
    let text = fs::read_to_string(repository(path)).expect("a file of the repository");
    serde_json::from_str(&text).expect("a file of the repository is JSON")
}

/// JSON pointers of all values below a value, and their paths as messages write them.
fn places(value: &Value, pointer: &str, path: &str, found: &mut Vec<(String, String)>) {
    match value {
        Value::Object(members) => {
            for (key, value) in members {
                let pointer = format!("{pointer}/{}", key.replace('~', "~0").replace('/', "~1"));
                let path = if path.is_empty() {
                    key.clone()
                } else {
                    format!("{path}.{key}")
                };
                found.push((pointer.clone(), path.clone()));
                places(value, &pointer, &path, found);
            }
        }
        Value::Array(items) => {
            for (index, value) in items.iter().enumerate() {
                let (pointer, path) = (format!("{pointer}/{index}"), format!("{path}[{index}]"));
                found.push((pointer.clone(), path.clone()));
                places(value, &pointer, &path, found);
            }
        }
        _ => {}
    }
}

/// The diagnostics of a file in which every value, or one of `stride` values, has a wrong type in turn, where that is
/// refused: exactly one. Returns the number of values that are refused.
fn one_fault_each(file: &str, stride: usize, read: impl Fn(String) -> Vec<Diagnostic>) -> usize {
    let right = parsed(file);
    assert_eq!(read(right.to_string()), [], "{file}");
    let mut all = Vec::new();
    places(&right, "", "", &mut all);
    let (mut refused, mut failures) = (0, Vec::new());
    for (pointer, path) in all.into_iter().step_by(stride) {
        let mut wrong = right.clone();
        let value = wrong.pointer_mut(&pointer).expect("the pointer of a value");
        *value = if value.is_string() || value.is_array() || value.is_object() {
            json!(7)
        } else {
            json!("x")
        };
        let told = read(wrong.to_string());
        let is_type = |one: &Diagnostic| {
            one.path.replace("[\"", ".").replace("\"]", "") == path
                && matches!(
                    one.found.as_deref(),
                    Some("the number 7" | "the text \"x\"")
                )
        };
        if told.iter().any(is_type) {
            refused += 1;
            if told.len() > 1 {
                let lines: Vec<String> = told.iter().map(|one| format!("  {one}\n")).collect();
                failures.push(format!("{path}\n{}", lines.concat()));
            }
        }
    }
    assert!(
        failures.is_empty(),
        "{file}: {} of {refused}\n{}",
        failures.len(),
        failures.concat()
    );
    refused
}

fn faults(result: Result<impl Sized, Vec<Diagnostic>>) -> Vec<Diagnostic> {
    result.err().unwrap_or_default()
}

fn spec(name: &str, text: String) -> Vec<Diagnostic> {
    faults(Spec::read(
        &Source {
            name: name.to_owned(),
            text,
        },
        None,
    ))
}

#[test]
fn a_wrong_type_in_a_spec_is_one_fault() {
    let mut refused = 0;
    for file in [
        "examples/bogie/spec.json",
        "examples/mill_girderway/spec.json",
        "tests/malformed/base/frame.json",
    ] {
        refused += one_fault_each(file, 1, |text| spec(file, text));
    }
    assert!(refused > 150, "only {refused} values have a type");
}

#[test]
fn a_wrong_type_in_a_scene_is_one_fault() {
    let mut refused = 0;
    for (folder, name, stride) in [
        ("examples/wheel", "scene.json", 1),
        ("examples/bogie", "scene.json", 1),
        ("examples/ties", "scene.json", 1),
        ("examples/bridge_crane", "scene.json", 7),
    ] {
        let copy = tempfile::tempdir().expect("a temporary folder");
        for entry in fs::read_dir(repository(folder)).expect("a folder of the repository") {
            let entry = entry.expect("a readable folder");
            fs::copy(entry.path(), copy.path().join(entry.file_name())).expect("a writable folder");
        }
        let path = copy.path().join(name);
        refused += one_fault_each(&format!("{folder}/{name}"), stride, |text| {
            fs::write(&path, text).expect("a writable folder");
            faults(Document::open(&path))
        });
    }
    assert!(refused > 150, "only {refused} values have a type");
}

#[test]
fn a_wrong_type_does_not_hide_the_other_faults() {
    let mut text = parsed("examples/bogie/spec.json");
    text["girder"]["E"] = json!("4e9");
    text["girder"]["J"] = json!(-1);
    text["girder"]["colour"] = json!("blue");
    text["stations"][2] = json!(null);
    text["units"]["force"] = json!("lb");
    text["theory"] = json!("timoshenk");
    let told: Vec<(String, String)> = spec("spec.json", text.to_string())
        .into_iter()
        .map(|one| (one.path, one.expected))
        .collect();
    let has = |path: &str, expected: &str| {
        assert!(
            told.iter()
                .any(|one| one.0 == path && one.1.starts_with(expected)),
            "{path}: {told:?}"
        );
    };
    has("girder.E", "must be a number");
    has("girder.J", "must be positive");
    has("girder.colour", "unknown key");
    has("stations[2]", "must be a number");
    has("units.force", "must be \"");
    has("theory", "must be \"euler-bernoulli\"");
    assert_eq!(told.len(), 6, "{told:?}");
}
