//! Benchmarks: what they print, and what is kept of it.

use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::file::list;

/// All benchmarks of a sitting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sitting {
    /// Day, in UTC.
    pub date: String,
    /// The machine in plain words.
    pub machine: String,
    /// How long all of them took, without their build, s.
    pub seconds: f64,
    /// Each benchmark.
    pub benches: Vec<Bench>,
}

impl Sitting {
    /// As it is kept: a benchmark a line.
    #[must_use]
    pub fn text(&self) -> String {
        let head = json!({ "date": self.date, "machine": self.machine, "seconds": self.seconds });
        let rounded = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
        let lines = self.benches.iter().map(|own| {
            let (fastest, median) = (rounded(own.fastest), rounded(own.median));
            json!(Bench { fastest, median, ..own.clone() }).to_string()
        });
        let lines: Vec<String> = lines.collect();
        format!("{},\n\"benches\": {}}}\n", head.to_string().trim_end_matches('}'), list(&lines))
    }
}

/// A benchmark.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bench {
    /// Package, program and the path within it, with slashes.
    pub name: String,
    /// Shortest sample, s.
    pub fastest: f64,
    /// Median of the samples, s.
    pub median: f64,
    /// How many.
    pub samples: u64,
    /// The same elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub known: Option<Known>,
}

/// A time known from elsewhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Known {
    /// The time, s.
    pub value: f64,
    /// Where from.
    pub source: String,
}

/// Seconds of a number with its unit, such as `1.25 us`.
fn seconds(text: &str) -> Option<f64> {
    let (value, unit) = text.trim().rsplit_once(' ')?;
    let unit = match unit {
        "ps" => 1e-12,
        "ns" => 1e-9,
        "us" | "\u{b5}s" | "\u{3bc}s" => 1e-6,
        "ms" => 1e-3,
        "s" => 1.0,
        "m" => 60.0,
        _ => return None,
    };
    Some(value.trim().parse::<f64>().ok()? * unit)
}

/// The first cell of a row: its name, and a time where it has one.
fn split(cell: &str) -> (&str, Option<f64>) {
    let mut spaces = cell.trim_end().rmatch_indices(' ').map(|(at, _)| at);
    let (_, value) = (spaces.next(), spaces.next());
    let time = value.and_then(|at| Some((at, seconds(cell[at..].trim())?)));
    time.map_or((cell.trim(), None), |(at, time)| (cell[..at].trim(), Some(time)))
}

/// Benchmarks that divan printed: trees of boxes, each under a line of headings.
///
/// Columns are known by their headings, depths by where names begin; what is no row is passed over.
#[must_use]
pub fn divan(text: &str, program: &str) -> Vec<Bench> {
    const BAR: char = '\u{2502}';
    let mut out = Vec::new();
    let mut headings: Vec<&str> = Vec::new();
    // beginnings and names of what a row is in
    let mut path: Vec<(usize, &str)> = Vec::new();
    for line in text.lines() {
        if line.contains("fastest") && line.contains("median") {
            headings = line.split(BAR).map(str::trim).collect();
            headings[0] = "fastest";
            path.clear();
            continue;
        }
        let is_row = line.starts_with(['\u{251c}', '\u{2570}', BAR, ' ']);
        let Some(start) = line.find('\u{2500}').filter(|_| is_row) else { continue };
        let rest = line[start..].trim_start_matches('\u{2500}').trim_start();
        let depth = line[..start].chars().count();
        let cells: Vec<&str> = rest.split(BAR).collect();
        let (name, fastest) = split(cells[0]);
        path.retain(|(own, _)| *own < depth);
        path.push((depth, name));
        let column = |heading: &str| cells.get(headings.iter().position(|own| *own == heading)?).copied();
        let median = column("median").and_then(seconds);
        let samples = column("samples").and_then(|own| own.trim().parse().ok());
        if let (Some(fastest), Some(median), Some(samples)) = (fastest, median, samples) {
            let parts: Vec<&str> = path.iter().map(|(_, name)| *name).collect();
            let name = format!("{program}/{}", parts.join("/"));
            out.push(Bench { name, fastest, median, samples, known: None });
        }
    }
    out
}

/// Benchmarks of a table whose headings have `fastest_ms`, `median_ms` and `samples`; the first column is the name.
#[must_use]
pub fn table(text: &str, program: &str) -> Vec<Bench> {
    let mut out = Vec::new();
    let mut headings: Vec<&str> = Vec::new();
    for line in text.lines() {
        let cells: Vec<&str> = line.split_whitespace().collect();
        if cells.contains(&"fastest_ms") {
            headings = cells;
        } else if cells.len() >= headings.len() && !headings.is_empty() {
            // names may have spaces, numbers have none
            let extra = cells.len() - headings.len();
            let column = |heading: &str| -> Option<f64> {
                cells[extra + headings.iter().position(|own| *own == heading)?].parse().ok()
            };
            if let (Some(fastest), Some(median), Some(samples)) =
                (column("fastest_ms"), column("median_ms"), column("samples"))
            {
                let name = format!("{program}/{}", cells[..=extra].join(" "));
                let [fastest, median] = [fastest, median].map(|own| 1e-3 * own);
                out.push(Bench { name, fastest, median, samples: samples as u64, known: None });
            }
        }
    }
    out
}

/// Day of the Gregorian calendar, `days` after 1 January 1970.
///
/// # Source
/// H. Hinnant, chrono-compatible low-level date algorithms: eras of 400 years that begin in March.
#[must_use]
pub fn date(days: u64) -> String {
    let shifted = days + 719_468;
    let (era, of_era) = (shifted / 146_097, shifted % 146_097);
    let year = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year + year / 4 - year / 100);
    let march = (5 * of_year + 2) / 153;
    let day = of_year - (153 * march + 2) / 5 + 1;
    let month = if march < 10 { march + 3 } else { march - 9 };
    let year = 400 * era + year + u64::from(month <= 2);
    format!("{year}-{month:02}-{day:02}")
}

/// The machine in plain words, of what Linux says of its processors.
#[must_use]
pub fn machine(processors: &str, load: &str, cores: usize) -> String {
    let model = processors.lines().find(|line| line.starts_with("model name"));
    let model = model.and_then(|line| line.split_once(':')).map_or("a processor", |(_, own)| own.trim());
    let load =
        load.split_whitespace().next().map_or_else(String::new, |own| format!(", load {own} at the start"));
    let plural = if cores == 1 { "" } else { "s" };
    format!("{model}, {cores} core{plural}{load}")
}

#[cfg(test)]
mod tests;
