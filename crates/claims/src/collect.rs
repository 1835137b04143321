//! Data of the book from what runs left.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::book::Error;
use crate::record::Record;

/// Tests that hold figures: package and name of the test program.
///
/// # Errors
/// Folders that cannot be read.
pub fn programs(root: &Path) -> Result<BTreeSet<(String, String)>, Error> {
    let mut out = BTreeSet::new();
    let holds = |path: &Path| -> Result<bool, Error> {
        let text = fs::read_to_string(path).map_err(|error| Error::file(path, &error))?;
        Ok(text.contains("claims::figure"))
    };
    for krate in folder(&root.join("crates"))? {
        let tests = krate.join("tests");
        if !tests.is_dir() || krate.ends_with("claims") {
            continue;
        }
        for path in folder(&tests)? {
            if path.extension().is_some_and(|own| own == "rs") && holds(&path)? {
                out.insert((name(&krate), name(&path.with_extension(""))));
            }
        }
    }
    for group in folder(&root.join("tests"))? {
        if !group.join("main.rs").is_file() {
            continue;
        }
        for path in folder(&group)? {
            if path.extension().is_some_and(|own| own == "rs") && holds(&path)? {
                out.insert(("girderway".to_owned(), name(&group)));
            }
        }
    }
    Ok(out)
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// What is in a folder, in order.
fn folder(path: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = fs::read_dir(path).map_err(|error| Error::file(path, &error))?;
    let mut out = Vec::new();
    for entry in entries {
        out.push(entry.map_err(|error| Error::file(path, &error))?.path());
    }
    out.sort();
    Ok(out)
}

/// The lines that tests left in `from`, as text of `docs/claims.json`: a record a line, by section, file and test.
///
/// # Errors
/// Files that cannot be read or hold something else.
pub fn collect(from: &Path) -> Result<String, Error> {
    let mut records: Vec<Record> = Vec::new();
    for path in folder(from)? {
        let text = fs::read_to_string(&path).map_err(|error| Error::file(&path, &error))?;
        for line in text.lines() {
            let mut own: Record = serde_json::from_str(line).map_err(|error| Error::file(&path, &error))?;
            // the last digits are of the machine
            own.ours = format!("{:.7e}", own.ours).parse().unwrap_or(own.ours);
            records.push(own);
        }
    }
    // within a test in the order found
    let key = |own: &Record| (own.section.clone(), own.file.clone(), own.test.clone());
    records.sort_by_key(key);
    let lines = records.iter().map(serde_json::to_string).collect::<Result<Vec<String>, _>>();
    let lines = lines.map_err(|error| Error::file(from, &error))?;
    Ok(list(&lines))
}

/// A JSON list with one entry a line.
fn list(lines: &[String]) -> String {
    format!("[\n{}\n]\n", lines.join(",\n"))
}

/// What the book needs of the folder of `girderway study`: references, settings with errors, work, memory and times.
///
/// # Errors
/// Files that cannot be read or hold something else.
pub fn excerpt(folder: &Path, command: &str) -> Result<String, Error> {
    let read = |name: &str| -> Result<Value, Error> {
        let path = folder.join(name);
        let text = fs::read_to_string(&path).map_err(|error| Error::file(&path, &error))?;
        serde_json::from_str(&text).map_err(|error| Error::file(&path, &error))
    };
    let (study, timing) = (read("study.json")?, read("timing.json")?);
    let entries = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let times = entries(&timing["settings"]);
    let mut done = 0;
    let mut lines = Vec::new();
    for setting in entries(&study["settings"]) {
        // what varies is the member after the family
        let knob = setting.as_object().and_then(|own| own.iter().nth(1));
        let (knob, value) = knob.map_or(("", &Value::Null), |(knob, value)| (knob.as_str(), value));
        let mut line = json!({ "family": setting["family"], "knob": knob, "value": value });
        line["against"] = setting["against"].clone();
        line["status"] = setting["status"].clone();
        if setting["status"] == "done" {
            for key in ["errors", "steps", "stages", "freedoms", "memory"] {
                if !setting[key].is_null() {
                    line[key] = setting[key].clone();
                }
            }
            // timing.json lists the settings that were timed, in the same order
            if let Some(time) = times.get(done) {
                for key in ["median", "least", "most", "repetitions"] {
                    line[key] = rounded(&time[key]);
                }
            }
            done += 1;
        }
        if let Some(errors) = line.get_mut("errors").and_then(Value::as_object_mut) {
            for own in errors.values_mut() {
                *own = rounded(&own["largest"]);
            }
        }
        lines.push(line.to_string());
    }
    let references: Vec<String> = entries(&study["references"])
        .iter()
        .map(|own| {
            json!({ "against": own["against"], "run": own["run"], "tells_from": own["tells_from"] })
                .to_string()
        })
        .collect();
    Ok(format!(
        "{{\n\"command\": {},\n\"name\": {},\n\"auto\": {},\n\"dearer_by_stages\": {},\n\"dearer_by_time\": {},\n\"auto_with_its_trials\": {},\n\"references\": {},\n\"settings\": {}}}\n",
        json!(command),
        study["name"],
        study["auto"],
        study["dearer_by_stages"],
        timing["dearer"],
        timing["auto_with_its_trials"],
        list(&references).trim_end(),
        list(&lines),
    ))
}

/// A number to four digits.
fn rounded(value: &Value) -> Value {
    let text = value.as_f64().map(|own| format!("{own:.3e}"));
    match text.and_then(|text| text.parse::<f64>().ok()) {
        Some(own) if value.is_f64() => json!(own),
        _ => value.clone(),
    }
}
