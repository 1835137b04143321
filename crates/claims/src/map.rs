//! Maps of where methods fail: what is kept of `girderway study --stability`.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map as Object, Value};

use crate::error::Error;
use crate::file;

/// Where it is kept, from the root of the repository.
pub const FILE: &str = "docs/studies/stability.json";

/// Verdicts, as `stability.json` calls them.
const RIGHT: &str = "right";
const SILENT: &str = "silently wrong";
const DIVERGES: &str = "diverges";
const WARNED: &str = "wrong, with a warning";
const REFUSED: &str = "refused";
pub const VERDICTS: [&str; 5] = [RIGHT, SILENT, DIVERGES, WARNED, REFUSED];

/// What is kept of all maps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Maps {
    /// How they were made.
    pub command: String,
    /// Each map.
    pub maps: Vec<Map>,
}

/// What is kept of a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Map {
    /// Its name in files.
    pub name: String,
    /// Numbers found on the way.
    pub found: Vec<Finding>,
    /// Methods on it.
    pub methods: Vec<Method>,
}

/// A number found on a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What it is.
    pub what: String,
    /// The number.
    pub value: f64,
}

/// A method on a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Method {
    /// Its name.
    pub method: String,
    /// Whether it is what the program does.
    pub is_girderway: bool,
    /// Points by verdict.
    pub counts: Object<String, Value>,
    /// Messages of points refused.
    pub messages: Vec<Message>,
}

/// A message of points refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Message {
    /// Its text.
    pub message: String,
    /// How many points have it.
    pub points: usize,
}

impl Method {
    /// Points with a verdict.
    #[must_use]
    pub fn points(&self, verdict: &str) -> usize {
        self.counts.get(verdict).and_then(Value::as_u64).unwrap_or(0) as usize
    }

    /// All its points.
    #[must_use]
    pub fn all(&self) -> usize {
        VERDICTS.iter().map(|verdict| self.points(verdict)).sum()
    }
}

/// Sums over the methods of the program, or of the others: all points, then by verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sums {
    /// All points.
    pub points: usize,
    /// Solved.
    pub right: usize,
    /// Wrong, and nobody is told.
    pub silent: usize,
    /// Without bound.
    pub diverging: usize,
    /// Wrong, with a warning.
    pub warned: usize,
    /// Refused.
    pub refused: usize,
}

impl Sums {
    /// Of girderway's methods, or of the others.
    #[must_use]
    pub fn of<'a>(maps: impl IntoIterator<Item = &'a Map>, ours: bool) -> Sums {
        let mut out = Sums::default();
        for own in maps.into_iter().flat_map(|map| &map.methods).filter(|own| own.is_girderway == ours) {
            out.points += own.all();
            out.right += own.points(RIGHT);
            out.silent += own.points(SILENT);
            out.diverging += own.points(DIVERGES);
            out.warned += own.points(WARNED);
            out.refused += own.points(REFUSED);
        }
        out
    }
}

/// What is kept of the folder that `girderway study --stability` wrote: a map a line.
///
/// # Errors
/// Files that cannot be read or hold something else.
pub fn excerpt(folder: &Path, command: &str) -> Result<String, Error> {
    let path = folder.join("stability.json");
    let whole: Value = file::json(&path)?;
    let mut maps: Vec<Map> =
        serde_json::from_value(whole["maps"].clone()).map_err(|error| Error::file(&path, &error))?;
    for finding in maps.iter_mut().flat_map(|map| &mut map.found) {
        // the last digits are of the machine
        finding.value = format!("{:.5e}", finding.value).parse().unwrap_or(finding.value);
    }
    let lines = maps.iter().map(serde_json::to_string).collect::<Result<Vec<String>, _>>();
    let lines = lines.map_err(|error| Error::file(&path, &error))?;
    Ok(format!("{{\n\"command\": {},\n\"maps\": {}}}\n", Value::from(command), file::list(&lines)))
}
