//! A scene file with its comparisons: the scene, and the scene again with changes.

use std::path::Path;

use serde_json::Value;

use super::files::Files;
use super::raw::RawScene;
use super::{FORMAT, Scene, read};
use crate::diagnostic::Diagnostic;
use crate::fault::{Fault, Faults};
use crate::inputs::Inputs;
use crate::place::Place;
use crate::source::{Source, path_of, type_fault};

/// A scene file, read in full.
#[derive(Clone, Debug)]
pub struct Document {
    /// The scene itself, then one case for each entry of `compare`.
    pub cases: Vec<Case>,
    /// All files read.
    pub inputs: Inputs,
}

/// One run of a scene.
#[derive(Clone, Debug)]
pub struct Case {
    /// The label of its comparison; none for the scene itself.
    pub label: Option<String>,
    /// The scene with that comparison's changes.
    pub scene: Scene,
}

impl Document {
    /// Reads a scene, the files it names, and its comparisons.
    ///
    /// # Errors
    /// The first syntax or type error, or everything else that is wrong, in all files.
    pub fn open(path: &Path) -> Result<Document, Vec<Diagnostic>> {
        let (mut inputs, source) = Inputs::open(path).map_err(|error| vec![*error])?;
        let raw: RawScene = source.parse(FORMAT).map_err(|error| vec![*error])?;
        let mut faults = source.duplicates_below("compare");
        let mut files = Files::of(&mut inputs);
        let scene = read::scene(&raw, &source.name, &mut files, &mut faults);
        labels(&raw.compare, &mut faults);
        let mut wrong = source.diagnose(&faults);
        wrong.append(&mut files.wrong);
        let base_is_right = wrong.is_empty();
        let mut cases: Vec<Case> = scene.map(|scene| Case { label: None, scene }).into_iter().collect();
        if !raw.compare.is_empty() && base_is_right {
            let document: Value = source.parse(FORMAT).map_err(|error| vec![*error])?;
            for (index, entry) in raw.compare.iter().enumerate() {
                match case(&source, &document, index, entry, &mut inputs) {
                    Ok(case) => cases.push(case),
                    Err(diagnostics) => wrong.extend(
                        diagnostics.into_iter().filter(|new| !wrong.contains(new)).collect::<Vec<_>>(),
                    ),
                }
            }
        }
        if wrong.is_empty() { Ok(Document { cases, inputs }) } else { Err(wrong) }
    }

    /// The scene itself.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.cases[0].scene
    }
}

/// Labels are there, fit file names, and are given once; changes leave format, units and comparisons alone.
fn labels(entries: &[Value], faults: &mut Faults) {
    let root = Place::root();
    let list = root.key("compare");
    let mut seen: Vec<&str> = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let at = list.index(index);
        let Some(object) = entry.as_object() else {
            faults.add(Fault::new(&at, "must be an object with a `label` and changes"));
            continue;
        };
        match object.get("label") {
            Some(Value::String(label)) => {
                super::name(label, &at.key("label"), faults);
                if seen.contains(&label.as_str()) {
                    faults.add(
                        Fault::new(&at.key("label"), "must differ from the other labels")
                            .got(format!("{label:?} again")),
                    );
                }
                seen.push(label);
            }
            Some(_) => faults.add(Fault::new(&at.key("label"), "must be a string")),
            None => faults.add(Fault::new(&at, "missing key `label`").hint("it names history-<label>.csv")),
        }
        for key in ["format", "units", "name", "compare"] {
            if object.contains_key(key) {
                let expected = format!("a comparison cannot change `{key}`");
                faults.add(Fault::new(&at.key(key), expected).at_key());
            }
        }
    }
}

fn case(
    source: &Source,
    document: &Value,
    index: usize,
    entry: &Value,
    inputs: &mut Inputs,
) -> Result<Case, Vec<Diagnostic>> {
    let mut changes = entry.clone();
    let label = changes.as_object_mut().and_then(|object| object.shift_remove("label"));
    let label = label.as_ref().and_then(Value::as_str).unwrap_or_default().to_owned();
    let mut merged = document.clone();
    if let Some(object) = merged.as_object_mut() {
        object.shift_remove("compare");
    }
    merge(&mut merged, changes);
    let mut faults = Faults::default();
    let mut files = Files::of(inputs);
    let scene = match serde_path_to_error::deserialize::<_, RawScene>(merged) {
        Ok(raw) => read::scene(&raw, &source.name, &mut files, &mut faults),
        Err(error) => {
            faults.add(type_fault(path_of(error.path()), &error.inner().to_string()));
            None
        }
    };
    match scene {
        Some(scene) if faults.0.is_empty() && files.wrong.is_empty() => {
            Ok(Case { label: Some(label), scene })
        }
        _ => {
            let mut wrong = source.diagnose_merged(index, &faults);
            for diagnostic in wrong.iter_mut().filter(|found| !found.path.starts_with("compare")) {
                diagnostic.expected = format!("in comparison \"{label}\": {}", diagnostic.expected);
            }
            wrong.append(&mut files.wrong);
            Err(wrong)
        }
    }
}

/// Merges changes into a document: objects member by member, `null` removes, everything else replaces (RFC 7386).
fn merge(target: &mut Value, changes: Value) {
    match (target, changes) {
        (Value::Object(target), Value::Object(changes)) => {
            for (key, change) in changes {
                if change.is_null() {
                    target.shift_remove(&key);
                } else {
                    merge(target.entry(key).or_insert(Value::Null), change);
                }
            }
        }
        (target, Value::Object(changes)) => {
            *target = Value::Object(serde_json::Map::new());
            merge(target, Value::Object(changes));
        }
        (target, changes) => *target = changes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn merge_follows_the_examples_of_rfc_7386() {
        // appendix A of the RFC: original, patch, result
        let cases = [
            (json!({"a": "b"}), json!({"a": "c"}), json!({"a": "c"})),
            (json!({"a": "b"}), json!({"b": "c"}), json!({"a": "b", "b": "c"})),
            (json!({"a": "b"}), json!({"a": null}), json!({})),
            (json!({"a": ["b"]}), json!({"a": "c"}), json!({"a": "c"})),
            (json!({"a": {"b": "c"}}), json!({"a": {"b": "d", "c": null}}), json!({"a": {"b": "d"}})),
            (json!({"a": [{"b": "c"}]}), json!({"a": [1]}), json!({"a": [1]})),
            (json!({}), json!({"a": {"bb": {"ccc": null}}}), json!({"a": {"bb": {}}})),
            (json!([1, 2]), json!({"a": "b", "c": null}), json!({"a": "b"})),
        ];
        for (mut original, patch, result) in cases {
            merge(&mut original, patch.clone());
            assert_eq!(original, result, "{patch}");
        }
    }
}
