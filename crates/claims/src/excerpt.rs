//! What the book keeps of the folder of `girderway study`.

use std::path::Path;

use serde_json::{Value, json};

use crate::error::Error;
use crate::file;

/// Charts that the book shows of a study: name in the folder's `plots`, and ending of the name in `docs/studies`.
pub const CHARTS: [(&str, &str); 2] = [("foundations-time", "foundations"), ("methods-time", "methods")];
/// Bytes that a chart of the book may have.
pub const LARGEST: usize = 150_000;

/// References, settings with errors, work, memory and times.
///
/// # Errors
/// Files that cannot be read or hold something else.
pub fn excerpt(folder: &Path, command: &str) -> Result<String, Error> {
    let read = |name: &str| file::json::<Value>(&folder.join(name));
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
        "{{\n\"command\": {},\n\"name\": {},\n\"until\": {},\n\"auto\": {},\n\"dearer_by_stages\": {},\n\"dearer_by_time\": {},\n\"auto_with_its_trials\": {},\n\"references\": {},\n\"settings\": {}}}\n",
        json!(command),
        study["name"],
        study["until"],
        study["auto"],
        study["dearer_by_stages"],
        timing["dearer"],
        timing["auto_with_its_trials"],
        file::list(&references).trim_end(),
        file::list(&lines),
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

/// Charts of a folder that the book shows: name in `docs/studies` and text; those that the study does not have are left out.
///
/// # Errors
/// Charts that cannot be read, or are too large for a book.
pub fn charts(folder: &Path, name: &str) -> Result<Vec<(String, Option<String>)>, Error> {
    let mut out = Vec::new();
    for (chart, ending) in CHARTS {
        let path = folder.join("plots").join(chart).with_extension("svg");
        let text = if path.is_file() { Some(file::text(&path)?) } else { None };
        if let Some(bytes) = text.as_ref().map(String::len).filter(|bytes| *bytes > LARGEST) {
            return Err(Error::File(path, format!("{bytes} bytes, the book takes {LARGEST}")));
        }
        out.push((format!("{name}-{ending}.svg"), text));
    }
    Ok(out)
}
