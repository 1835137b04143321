//! Results of comparisons with other codes.

use super::peer::{Peer, PeerMeasure, PlainGrid, Station};
use formats::grid::block::GridBlock;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The largest difference between two grids of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockDifference {
    /// Which grid.
    pub quantity: GridBlock,
    /// Number of entries compared.
    pub entries: usize,
    /// Scale of the relative difference, see [`PeerMeasure`].
    pub scale: f64,
    /// Rails of the entry that differs most: deflection, load.
    pub rails: [usize; 2],
    /// Stations of the entry that differs most: deflection, load.
    pub at: [f64; 2],
    /// Value of that entry in this program.
    pub ours: f64,
    /// Value of that entry in the other code.
    pub theirs: f64,
    /// Difference divided by the scale.
    pub relative: f64,
    /// Largest relative difference in each row, which is the station of a deflection.
    pub profile: Vec<f64>,
}

impl BlockDifference {
    /// A difference of which no entry has been compared.
    pub(super) fn none(quantity: GridBlock) -> BlockDifference {
        BlockDifference {
            quantity,
            entries: 0,
            scale: 0.0,
            rails: [0; 2],
            at: [0.0; 2],
            ours: 0.0,
            theirs: 0.0,
            relative: 0.0,
            profile: Vec::new(),
        }
    }
}

/// Result of a cross-check with one code.
#[derive(Clone, Debug, PartialEq)]
pub struct PeerOutcome {
    /// Which code.
    pub peer: Peer,
    /// Its name with its version.
    pub code: String,
    /// Its finite elements.
    pub elements: String,
    /// Beam theory of both codes, if it must be stated.
    pub theory: Option<&'static str>,
    /// Largest relative difference that counts as agreement.
    pub tolerance: f64,
    /// Grids with another tolerance.
    pub own_tolerances: Vec<(GridBlock, f64)>,
    /// Differences, one for each compared grid.
    pub differences: Vec<BlockDifference>,
    /// Grids that only one of the codes has.
    pub skipped: Vec<GridBlock>,
    /// Stations compared.
    pub stations: Vec<Station>,
    /// Notes on the comparison.
    pub notes: Vec<String>,
    /// Grids of the other code.
    pub theirs: Vec<(GridBlock, PlainGrid)>,
    /// Indices of the compared stations among all stations.
    pub chosen: Vec<usize>,
}

impl PeerOutcome {
    /// Whether at least one grid was compared and all of them agree.
    pub fn agrees(&self) -> bool {
        !self.differences.is_empty()
            && self
                .differences
                .iter()
                .all(|d| d.relative <= self.tolerance_of(d.quantity))
    }

    /// Largest relative difference of a grid that counts as agreement.
    pub fn tolerance_of(&self, quantity: GridBlock) -> f64 {
        let own = self
            .own_tolerances
            .iter()
            .find(|(other, _)| *other == quantity);
        own.map_or(self.tolerance, |(_, tolerance)| *tolerance)
    }

    /// The result as lines of text; `rails` are the names of the rails.
    pub fn table(&self, rails: &[String]) -> String {
        let theory = self
            .theory
            .map(|word| format!(", {word}"))
            .unwrap_or_default();
        let mut text = format!("compared with {} ({}){theory}\n", self.code, self.elements);
        let head = [
            "grid",
            "entries",
            "measured by",
            "deflection at",
            "load at",
            "girderway",
            "other",
            "difference",
        ];
        let place = |d: &BlockDifference, k: usize| match rails {
            [_, _, ..] => {
                format!(
                    "{} {}",
                    rails.get(d.rails[k]).map_or("", String::as_str),
                    d.at[k]
                )
            }
            _ => d.at[k].to_string(),
        };
        let mut rows = vec![head.map(str::to_owned)];
        for d in &self.differences {
            rows.push([
                d.quantity.to_string(),
                d.entries.to_string(),
                format!("{:.6e}", d.scale),
                place(d, 0),
                place(d, 1),
                format!("{:.12e}", d.ours),
                format!("{:.12e}", d.theirs),
                format!("{:.1e}", d.relative),
            ]);
        }
        let widths: Vec<usize> = (0..head.len())
            .map(|i| rows.iter().map(|r| r[i].len()).max().unwrap_or(0))
            .collect();
        for row in &rows {
            let cells = row.iter().zip(&widths).enumerate();
            let line: Vec<String> = cells
                .map(|(i, (c, &w))| {
                    if i == 0 {
                        format!("{c:<w$}")
                    } else {
                        format!("{c:>w$}")
                    }
                })
                .collect();
            text.push_str(line.join("  ").trim_end());
            text.push('\n');
        }
        for quantity in &self.skipped {
            let _ = writeln!(
                text,
                "{quantity}: not compared; available from one code only"
            );
        }
        for note in &self.notes {
            let _ = writeln!(text, "note: {note}");
        }
        let verdict = match (self.differences.is_empty(), self.agrees()) {
            (true, _) => "nothing compared",
            (false, true) => "agree",
            (false, false) => "DISAGREE",
        };
        let measure = match self.peer.measure() {
            PeerMeasure::Largest => "of the largest entry",
            PeerMeasure::Diagonal => "of sqrt(Gii Gjj)",
        };
        let others = self.own_tolerances.iter();
        let others: String = others
            .map(|(quantity, tolerance)| format!(", {quantity} {tolerance:.1e}"))
            .collect();
        let _ = writeln!(
            text,
            "{verdict} (tolerance {:.0e} {measure}{others})",
            self.tolerance
        );
        text
    }

    /// The result as JSON.
    pub fn json(&self, rails: &[String]) -> Value {
        let name = |rail: usize| rails.get(rail).map_or("", String::as_str);
        let differences: Vec<Value> = self
            .differences
            .iter()
            .map(|d| {
                json!({
                    "grid": d.quantity.name(), "entries": d.entries, "scale": d.scale,
                    "rails": d.rails.map(name), "at": d.at,
                    "ours": d.ours, "theirs": d.theirs, "relative": d.relative, "by_station": d.profile,
                    "tolerance": self.tolerance_of(d.quantity),
                })
            })
            .collect();
        let skipped: Vec<&str> = self.skipped.iter().map(|q| q.name()).collect();
        let stations: Vec<Value> = self
            .stations
            .iter()
            .map(|(rail, x)| json!({ "rail": name(*rail), "x": x }))
            .collect();
        let measure = match self.peer.measure() {
            PeerMeasure::Largest => "largest entry",
            PeerMeasure::Diagonal => "sqrt(Gii Gjj)",
        };
        json!({
            "code": self.code, "elements": self.elements, "theory": self.theory, "measure": measure,
            "tolerance": self.tolerance, "agrees": self.agrees(), "differences": differences,
            "skipped": skipped, "stations": stations, "notes": self.notes,
        })
    }
}

/// Result of a cross-check with all codes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PeerComparison {
    /// Names of the rails.
    pub rails: Vec<String>,
    /// Codes that were compared.
    pub outcomes: Vec<PeerOutcome>,
    /// Codes that were not compared, with the reasons.
    pub absent: Vec<(Peer, String)>,
}

impl PeerComparison {
    /// Whether at least one code was compared and all compared codes agree.
    pub fn agrees(&self) -> bool {
        let mut compared = self
            .outcomes
            .iter()
            .filter(|o| !o.differences.is_empty())
            .peekable();
        compared.peek().is_some() && compared.all(PeerOutcome::agrees)
    }

    /// The result as text, with a table for each code.
    pub fn table(&self) -> String {
        let mut parts: Vec<String> = self
            .outcomes
            .iter()
            .map(|outcome| outcome.table(&self.rails))
            .collect();
        let absent =
            |(peer, why): &(Peer, String)| format!("not compared with {}: {why}\n", peer.name());
        parts.push(self.absent.iter().map(absent).collect());
        if self
            .outcomes
            .iter()
            .all(|outcome| outcome.differences.is_empty())
        {
            parts.push("nothing compared\n".to_owned());
        }
        parts.retain(|part| !part.is_empty());
        parts.join("\n")
    }

    /// The result as JSON.
    pub fn json(&self) -> Value {
        let outcomes: Vec<Value> = self
            .outcomes
            .iter()
            .map(|outcome| outcome.json(&self.rails))
            .collect();
        let absent: Vec<Value> = self
            .absent
            .iter()
            .map(|(peer, why)| json!({ "code": peer.name(), "why": why }))
            .collect();
        json!({ "agrees": self.agrees(), "compared": outcomes, "not_compared": absent })
    }
}
