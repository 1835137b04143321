//! A solved design: extremes, envelope, summary and files.

use std::path::PathBuf;

use formats::design::Design as DesignInput;
use outputs::design_files::{SolvedDesign, open_design_folder};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{python, table};
use crate::errors::{Refusal, internal};
use crate::source::GivenInput;
use crate::watch::without_lock;

/// A design and its results.
#[pyclass(frozen, module = "girderway._native")]
pub(crate) struct Design {
    solved: SolvedDesign,
}

impl Design {
    /// The results of a design.
    pub(crate) fn new(solved: SolvedDesign) -> Design {
        Design { solved }
    }
}

#[pymethods]
impl Design {
    /// The contents of `summary.json`.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &self.solved.summary())
    }

    /// The columns of `envelope.csv`, `reactions.csv` or `influence.csv`.
    fn table<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let SolvedDesign {
            design,
            result,
            lines,
            ..
        } = &self.solved;
        let text = match name {
            "envelope" => ::design::envelope_csv(design, result),
            "reactions" => ::design::reactions_csv(result),
            _ => ::design::influence_csv(design, lines),
        };
        table(py, text.map_err(internal)?.as_bytes())
    }

    /// Writes the files of `girderway design` to a folder.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<PathBuf> {
        let saved = py.detach(|| {
            let folder = open_design_folder(&path, force)?;
            self.solved.write(folder, None)
        });
        saved.map_err(|error| Refusal::from(error).exception(py))
    }
}

/// Reads and solves a design.
#[pyfunction]
pub(crate) fn design(py: Python<'_>, design: GivenInput) -> PyResult<Design> {
    let made = without_lock(py, None, |_| -> Result<SolvedDesign, Refusal> {
        let (inputs, source) = design.open("design")?;
        let (design, inputs) = DesignInput::read(inputs, &source)?;
        Ok(SolvedDesign::of(&design, inputs)?)
    })?;
    made.map(Design::new)
        .map_err(|refusal| refusal.exception(py))
}
