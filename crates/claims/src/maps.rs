//! Maps of where methods fail: what is kept of `girderway study --stability`, and tables of it.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map as Object, Value};

use crate::error::Error;
use crate::file;
use crate::number::{number, whole};

/// Where it is kept, from the root of the repository.
pub const FILE: &str = "docs/studies/stability.json";

/// Verdicts, as `stability.json` calls them.
const RIGHT: &str = "right";
const SILENT: &str = "silently wrong";
const DIVERGES: &str = "diverges";
const WARNED: &str = "wrong, with a warning";
const REFUSED: &str = "refused";
const VERDICTS: [&str; 5] = [RIGHT, SILENT, DIVERGES, WARNED, REFUSED];

/// Why girderway refuses points of a map.
const REASONS: [(&str, &str); 1] = [(
    "short-element",
    "elements shorter than 4e-8 of the span: even double-doubles cannot certify 1e-6, and doubles are wrong from 3e-4 on",
)];
/// Why it is wrong with a warning.
const WARNINGS: [(&str, &str); 2] = [
    ("excitation", "told to read by AKISPL, whose forces do work in a closed loop: the energy audit tells"),
    ("steps", "told to take equal steps, far too long ones: the energy audit tells"),
];

/// Numbers known from elsewhere: what, as it is known, digits of ours, map, and its findings.
const KNOWN: [(&str, &str, usize, &str, &[&str]); 9] = [
    (
        "k G at midspan, one wheel and two 32 in apart",
        "10.93, 21.74",
        5,
        "contact",
        &[
            "one wheel: k times the largest eigenvalue of G at midspan",
            "truck: k times the largest eigenvalue of G at midspan",
        ],
    ),
    (
        "k G = 1: one wheel; the middle of two, ft from the support",
        "4.94, 3.18",
        4,
        "contact",
        &[
            "one wheel: distance from the support where it is 1",
            "truck: distance from the support where it is 1",
        ],
    ),
    (
        "AKISPL: largest growth of a bogie, 1/s",
        "0.325 (random search)",
        3,
        "excitation",
        &["akispl: largest growth without dampers, 1/s"],
    ),
    ("where, ft, or as far from the other support", "43.5 or 16.5", 4, "excitation", &["akispl: where"]),
    (
        "damper of each wheel to the ground that stops it, lbf s/ft",
        "1.8e5",
        3,
        "excitation",
        &["akispl: damper of each wheel to the ground that stops it"],
    ),
    (
        "work of a closed loop of 2.4e6 lbf on two wheels, ft lbf",
        "30,789 (printed table)",
        5,
        "excitation",
        &["akispl: work of a closed loop of two wheels' forces"],
    ),
    (
        "Willis and Stokes, beta 100, 25, 10, 5, 2: factor",
        "1.0103, 1.0454, 1.1416, 1.3227, 1.7799",
        5,
        "lift-off",
        &[
            "girderway: factor at beta 100",
            "girderway: factor at beta 25",
            "girderway: factor at beta 10",
            "girderway: factor at beta 5",
            "girderway: factor at beta 2",
        ],
    ),
    (
        "lift-off, beta 10, 5, 2: x/L",
        "0.967, 0.869, 0.919",
        3,
        "lift-off",
        &[
            "girderway: x/L of lift-off at beta 10",
            "girderway: x/L of lift-off at beta 5",
            "girderway: x/L of lift-off at beta 2",
        ],
    ),
    (
        "growth a span at 300 ft/s, damper to the ground",
        "2.24",
        4,
        "steps",
        &["growth a span at the highest speed, the damper's force past the rail"],
    ),
];

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

    fn all(&self) -> usize {
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

fn cell(points: usize) -> String {
    if points == 0 { String::new() } else { whole(points) }
}

/// Maps by methods: points by verdict.
pub fn table(own: &Maps) -> String {
    let mut out =
        "| map | method | points | right | silently wrong | diverges | warned | refused |\n|---|---|---|---|---|---|---|---|\n"
            .to_owned();
    for map in &own.maps {
        for method in &map.methods {
            let [right, silent, diverges, warned, refused] =
                VERDICTS.map(|verdict| cell(method.points(verdict)));
            let bold = if method.is_girderway { "**" } else { "" };
            out += &format!(
                "| `{}` | {bold}{}{bold} | {} | {right} | {silent} | {diverges} | {warned} | {refused} |\n",
                map.name,
                method.method,
                cell(method.all()),
            );
        }
    }
    out
}

/// A map a row: girderway beside the others.
pub fn short(own: &Maps) -> String {
    let mut out = "| map | girderway: points | right | warned | refused | silently wrong | others: points | silently wrong | diverge |\n|---|---|---|---|---|---|---|---|---|\n".to_owned();
    let row = |name: &str, maps: &[Map]| {
        let (ours, others) = (Sums::of(maps, true), Sums::of(maps, false));
        format!(
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
            cell(ours.points),
            cell(ours.right),
            cell(ours.warned),
            cell(ours.refused),
            ours.silent + ours.diverging,
            cell(others.points),
            cell(others.silent),
            cell(others.diverging),
        )
    };
    for map in &own.maps {
        out += &row(&format!("`{}`", map.name), std::slice::from_ref(map));
    }
    out + &row("all", &own.maps)
}

/// All points in one paragraph.
pub fn total(own: &Maps) -> String {
    let (ours, others) = (Sums::of(&own.maps, true), Sums::of(&own.maps, false));
    let silent = ours.silent + ours.diverging;
    format!(
        "In all, {} points of girderway: {} right, {} wrong with a warning, {} refused, {} silently wrong. Of {} points of other methods {} are silently wrong and {} diverge.",
        whole(ours.points),
        whole(ours.right),
        whole(ours.warned),
        whole(ours.refused),
        if silent == 0 { "none".to_owned() } else { whole(silent) },
        whole(others.points),
        whole(others.silent),
        whole(others.diverging),
    )
}

fn told<'a>(of: &[(&str, &'a str)], map: &str) -> Option<&'a str> {
    of.iter().find(|(name, _)| *name == map).map(|(_, why)| *why)
}

/// Where girderway refuses or warns, and why that is right.
///
/// # Errors
/// Points refused or warned of for a reason that nobody wrote down.
pub fn refusals(own: &Maps) -> Result<String, Error> {
    let mut out =
        "| map | points | message of the first, of the last | why |\n|---|---|---|---|\n".to_owned();
    for map in &own.maps {
        let ours = Sums::of([map], true);
        let reason = |known: &[(&str, &'static str)]| {
            told(known, &map.name).ok_or_else(|| Error::Reason(map.name.clone()))
        };
        if ours.warned > 0 {
            out += &format!("| `{}` | {} warned | | {} |\n", map.name, ours.warned, reason(&WARNINGS)?);
        }
        if ours.refused > 0 {
            let messages = map.methods.iter().filter(|own| own.is_girderway).flat_map(|own| &own.messages);
            let all: Vec<&str> = messages.map(|own| own.message.as_str()).collect();
            let ends = match all.as_slice() {
                [] => String::new(),
                [only] => (*only).to_owned(),
                [first, .., last] => format!("{first}; {last}"),
            };
            out +=
                &format!("| `{}` | {} refused | {ends} | {} |\n", map.name, ours.refused, reason(&REASONS)?);
        }
    }
    Ok(out)
}

/// Numbers known from elsewhere beside those found.
///
/// # Errors
/// A number that the maps do not have.
pub fn numbers(own: &Maps) -> Result<String, Error> {
    let mut out = "| number | published or found elsewhere | here |\n|---|---|---|\n".to_owned();
    for (what, known, digits, map, findings) in KNOWN {
        let found = own.maps.iter().find(|own| own.name == map);
        let mut cells = Vec::new();
        for finding in findings {
            let value = found.and_then(|map| map.found.iter().find(|own| own.what == *finding));
            let value = value.ok_or_else(|| Error::Reason(format!("{map}: {finding}")))?.value;
            cells.push(number(value, digits));
        }
        out += &format!("| {what} | {known} | {} |\n", cells.join(", "));
    }
    Ok(out)
}
