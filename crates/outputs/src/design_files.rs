//! The files of a design: tables, summary and the page.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::Error;
use crate::files::json as json_text;
use crate::folder::{OutputFolder, PlannedFiles};
use crate::manifest::Manifest;
use design::{DesignResult, GoverningLine};
use formats::design::Design;
use formats::spec::SolveError;
use formats::text::inputs::Inputs;
use formats::verdict::Verdict;
use report::text::design_report::design_report;

/// Files of a design.
const FILES: [&str; 5] = [
    "envelope.csv",
    "reactions.csv",
    "influence.csv",
    "summary.json",
    "report.html",
];

/// A design with its results.
pub struct SolvedDesign {
    /// The design, with the combinations of its codes.
    pub design: Design,
    /// The files from which it was read.
    pub inputs: Inputs,
    /// Its results.
    pub result: DesignResult,
    /// Influence lines of the values that govern.
    pub lines: Vec<GoverningLine>,
}

impl SolvedDesign {
    /// Solves a design that was read from `inputs`.
    ///
    /// # Errors
    /// Those of [`design::solve`] and [`design::governing_lines`].
    pub fn of(design: &Design, inputs: Inputs) -> Result<SolvedDesign, SolveError> {
        let design = design::with_combinations(design);
        let result = design::solve(&design, &inputs)?;
        let lines = design::governing_lines(&design, &inputs, &result)?;
        Ok(SolvedDesign {
            design,
            inputs,
            result,
            lines,
        })
    }

    /// The verdict.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        design::verdict(&self.design, &self.result)
    }

    /// The contents of `summary.json`.
    #[must_use]
    pub fn summary(&self) -> Value {
        design::summary(&self.design, &self.result)
    }

    /// Writes the files into an open folder and returns its path.
    ///
    /// # Errors
    /// A file that would be replaced belongs to somebody else, or the folder cannot be written.
    pub fn write(&self, mut folder: OutputFolder, threads: Option<u16>) -> Result<PathBuf, Error> {
        let SolvedDesign {
            design,
            inputs,
            result,
            lines,
        } = self;
        folder.add(
            "envelope.csv",
            design::envelope_csv(design, result).map_err(Error::not_shown)?,
        );
        folder.add(
            "reactions.csv",
            design::reactions_csv(result).map_err(Error::not_shown)?,
        );
        folder.add(
            "influence.csv",
            design::influence_csv(design, lines).map_err(Error::not_shown)?,
        );
        folder.add("summary.json", json_text(&self.summary()));
        let page = design_report(design, result, lines);
        folder.add("report.html", page.html(threads).map_err(Error::not_shown)?);
        folder.commit(Manifest::new("design", inputs, json!({})))
    }
}

/// Opens the output folder of a design. Files of others are replaced only where `force`.
///
/// # Errors
/// A file that would be replaced belongs to somebody else, or the folder cannot be written.
pub fn open_design_folder(path: &Path, force: bool) -> Result<OutputFolder, Error> {
    let planned = PlannedFiles {
        names: FILES.iter().map(|name| (*name).to_owned()).collect(),
        plots: Vec::new(),
    };
    OutputFolder::open(path, "design", force, &planned)
}
