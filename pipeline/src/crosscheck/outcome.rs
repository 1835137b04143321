//! Differences between two codes.

use super::girder::Quantity;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The largest difference between two grids of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Which grid.
    pub quantity: Quantity,
    /// Number of entries compared.
    pub entries: usize,
    /// What the difference is measured by: the largest entry of the grid; for a coupling the geometric mean
    /// of those of its two direct grids.
    pub scale: f64,
    /// Stations of the entry that differs most: deflection, load.
    pub at: [f64; 2],
    /// That entry here.
    pub ours: f64,
    /// That entry in the other code.
    pub theirs: f64,
    /// Difference by scale.
    pub relative: f64,
}

/// Result of a cross-check.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The other code with its version.
    pub code: String,
    /// Its finite elements.
    pub elements: String,
    /// Largest relative difference that counts as agreement.
    pub tolerance: f64,
    /// One line a compared grid.
    pub differences: Vec<Difference>,
    /// Grids that only one side has.
    pub skipped: Vec<Quantity>,
}

impl Outcome {
    /// Something was compared, and all of it agrees.
    pub fn agrees(&self) -> bool {
        !self.differences.is_empty() && self.differences.iter().all(|d| d.relative <= self.tolerance)
    }

    /// The result as lines of text.
    pub fn table(&self) -> String {
        let mut text = format!("compared with {} ({})\n", self.code, self.elements);
        let head =
            ["grid", "entries", "largest", "deflection at", "load at", "girderway", "other", "difference"];
        let mut rows = vec![head.map(str::to_owned)];
        for d in &self.differences {
            rows.push([
                d.quantity.to_string(),
                d.entries.to_string(),
                format!("{:.6e}", d.scale),
                format!("{}", d.at[0]),
                format!("{}", d.at[1]),
                format!("{:.12e}", d.ours),
                format!("{:.12e}", d.theirs),
                format!("{:.1e}", d.relative),
            ]);
        }
        let widths: Vec<usize> =
            (0..head.len()).map(|i| rows.iter().map(|r| r[i].len()).max().unwrap_or(0)).collect();
        for row in &rows {
            let cells = row.iter().zip(&widths).enumerate();
            let line: Vec<String> = cells
                .map(|(i, (c, &w))| if i == 0 { format!("{c:<w$}") } else { format!("{c:>w$}") })
                .collect();
            text.push_str(line.join("  ").trim_end());
            text.push('\n');
        }
        for quantity in &self.skipped {
            let _ = writeln!(text, "{quantity}: not compared, only one side has it");
        }
        let verdict = match (self.differences.is_empty(), self.agrees()) {
            (true, _) => "nothing compared",
            (false, true) => "agree",
            (false, false) => "DISAGREE",
        };
        let _ = writeln!(text, "{verdict} (tolerance {:.0e} of the largest entry)", self.tolerance);
        text
    }

    /// The result for machines.
    pub fn json(&self) -> Value {
        let differences: Vec<Value> = self
            .differences
            .iter()
            .map(|d| {
                json!({
                    "grid": d.quantity.name(), "entries": d.entries, "scale": d.scale, "at": d.at,
                    "ours": d.ours, "theirs": d.theirs, "relative": d.relative,
                })
            })
            .collect();
        let skipped: Vec<&str> = self.skipped.iter().map(|q| q.name()).collect();
        json!({
            "code": self.code, "elements": self.elements, "tolerance": self.tolerance,
            "agrees": self.agrees(), "differences": differences, "skipped": skipped,
        })
    }
}
