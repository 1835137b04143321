//! A structure: its influence coefficients, modes, tables and designs.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use fea::RefinedModes;
use formats::design::Design as DesignInput;
use formats::grid::file as grid_file;
use formats::grid::modes_file::MESH_TOLERANCE;
use formats::grid::{GridBlock, GridCritical};
use formats::spec::{Spec, theory_word};
use formats::tables::{self, TableFormat, TableSet};
use formats::text::inputs::Inputs;
use formats::text::source::Source;
use foundations::SolvedModel;
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use outputs::design_files::SolvedDesign;
use outputs::files;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use splines::{Axis, Probe};

use crate::convert::{array, matrix, python};
use crate::errors::{Refusal, internal};
use crate::solved_design::Design;
use crate::source::GivenInput;
use crate::watch::without_lock;

/// A checked beam spec, which is solved at the first question.
#[pyclass(frozen, module = "girderway._native")]
pub(crate) struct Structure {
    spec: Spec,
    source: Source,
    inputs: Inputs,
    solved: OnceLock<Result<SolvedModel, Arc<Refused>>>,
}

/// A solution that there is not; the same for all who ask.
type Refused = formats::spec::SolveError;

impl Structure {
    fn solved(&self, py: Python<'_>) -> PyResult<&SolvedModel> {
        if self.solved.get().is_none() {
            py.detach(|| {
                self.solved.get_or_init(|| {
                    let found = foundations::solve(&self.spec);
                    found.map_err(|error| Arc::new(self.spec.locate_error(&self.source, &error)))
                });
            });
        }
        match self.solved.get() {
            Some(Ok(solved)) => Ok(solved),
            Some(Err(error)) => Err(Refusal::from((**error).clone()).exception(py)),
            None => Err(internal("a structure without a solution")),
        }
    }

    /// Index of a rail by its name, which may be left out where there is one.
    fn rail(&self, name: Option<&str>, argument: &str) -> Result<usize, Refusal> {
        let rails = self.spec.rails();
        let words = || {
            rails
                .iter()
                .map(|rail| rail.name.as_str())
                .collect::<Vec<_>>()
                .join(", ")
        };
        match name {
            None if rails.len() == 1 => Ok(0),
            None => Err(Refusal::argument(
                argument,
                format!("must be one of {}", words()),
                None,
            )),
            Some(name) => rails
                .iter()
                .position(|rail| rail.name == name)
                .ok_or_else(|| {
                    Refusal::argument(
                        argument,
                        format!("must be one of {}", words()),
                        Some(format!("{name:?}")),
                    )
                }),
        }
    }
}

/// The refusal of places that have no influence coefficients.
fn off_rail(error: &splines::Error) -> Refusal {
    Refusal::argument("x", error.to_string(), None)
}

#[pymethods]
impl Structure {
    /// Reads and checks a spec: a path, or a text and the folder of its files.
    #[new]
    fn new(py: Python<'_>, spec: GivenInput) -> PyResult<Structure> {
        let made = py.detach(|| {
            let (inputs, source) = spec.open("spec")?;
            let spec = Spec::read(&source, None)?;
            Ok(Structure {
                spec,
                source,
                inputs,
                solved: OnceLock::new(),
            })
        });
        made.map_err(|refusal: Refusal| refusal.exception(py))
    }

    /// Name of the structure.
    #[getter]
    fn name(&self) -> &str {
        &self.spec.name
    }

    /// Units of length, force and time.
    #[getter]
    fn units<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        python(py, &self.spec.units.json())
    }

    /// Keyword of the beam theory.
    #[getter]
    fn theory(&self) -> &str {
        theory_word(self.spec.theory)
    }

    /// Text of the spec.
    #[getter]
    fn text(&self) -> &str {
        &self.source.text
    }

    /// Rails by name: first and last coordinate, and the stations.
    #[getter]
    fn rails<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        for rail in self.spec.rails() {
            let entry = PyDict::new(py);
            entry.set_item("range", (rail.range[0], rail.range[1]))?;
            entry.set_item("stations", array(py, rail.stations))?;
            dict.set_item(rail.name, entry)?;
        }
        Ok(dict)
    }

    /// Values that are probably wrong.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.spec.warnings()
    }

    /// Notes on the spec and its solution.
    fn notes(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let solved = self.solved(py)?;
        Ok(self
            .spec
            .notes
            .iter()
            .chain(&solved.grid.notes)
            .cloned()
            .collect())
    }

    /// Guaranteed bound of the relative error of the influence coefficients by rounding.
    #[getter]
    fn error_bound(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        Ok(self
            .solved(py)?
            .grid
            .certificate
            .map(|certificate| certificate.error_bound))
    }

    /// Critical factor on the preload, of axial forces alone; infinite where there is none up to 1e6, `None` without preload.
    #[getter]
    fn critical_factor(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        Ok(self
            .solved(py)?
            .grid
            .critical
            .map(|critical| match critical {
                GridCritical::At(factor) => factor,
                GridCritical::Above(_) => f64::INFINITY,
            }))
    }

    /// Influence coefficients between places of two rails.
    fn influence<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        z: PyReadonlyArray1<'py, f64>,
        axis: &str,
        rail: Option<&str>,
        load_rail: Option<&str>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let refuse = |refusal: Refusal| refusal.exception(py);
        let known = GridBlock::ALL
            .into_iter()
            .find(|block| block.name() == axis);
        let Some(block) = known else {
            let words: Vec<&str> = GridBlock::ALL.iter().map(|block| block.name()).collect();
            let expected = format!("must be one of {}", words.join(", "));
            return Err(refuse(Refusal::argument(
                "axis",
                expected,
                Some(format!("{axis:?}")),
            )));
        };
        let own = self.rail(rail, "rail").map_err(refuse)?;
        let other = match load_rail {
            None => own,
            name => self.rail(name, "load_rail").map_err(refuse)?,
        };
        let solved = self.solved(py)?;
        let (x, z) = (x.as_slice()?, z.as_slice()?);
        let found = solved
            .influence(block, [own, other], x, z)
            .map_err(|error| refuse(off_rail(&error)))?;
        // numpy stores rows one after the other, the matrix its columns
        matrix(py, x.len(), z.len(), found.transpose().as_slice().to_vec())
    }

    /// The grids at the stations by block.
    fn grid<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let solved = self.solved(py)?;
        let dict = PyDict::new(py);
        for (block, values) in &solved.grid.blocks {
            let rows = values.transpose().as_slice().to_vec();
            dict.set_item(
                block.name(),
                matrix(py, values.nrows(), values.ncols(), rows)?,
            )?;
        }
        Ok(dict)
    }

    /// The natural modes with the lowest frequencies.
    fn modes(&self, py: Python<'_>, count: usize) -> PyResult<Modes> {
        let refuse = |refusal: Refusal| refusal.exception(py);
        if count == 0 {
            return Err(refuse(Refusal::argument(
                "count",
                "must be positive",
                Some("0".to_owned()),
            )));
        }
        let solved = self.solved(py)?;
        let found =
            py.detach(|| fea::refined_modes(&solved.model, &solved.rails, count, MESH_TOLERANCE));
        let refined = found
            .map_err(|error| refuse(Refusal::from(self.spec.locate_error(&self.source, &error))))?;
        let rails = self
            .spec
            .rails()
            .into_iter()
            .map(|rail| rail.name)
            .collect();
        Ok(Modes { refined, rails })
    }

    /// Writes the tables, in the format of the ending.
    fn write_tables(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let solved = self.solved(py)?;
        let write = || -> Result<(), Refusal> {
            let format = TableFormat::of(&path.display().to_string())?;
            let set = TableSet::of_grid(&solved.grid);
            if set.tables.is_empty() {
                let expected = "must have a rail of at least four stations: a SPLINE needs at least four x values";
                return Err(Refusal::argument("stations", expected, None));
            }
            let bytes = tables::write(&set, format)
                .map_err(|error| Refusal::Untrusted(error.to_string()))?;
            Ok(files::write(&path, &bytes)?)
        };
        py.detach(write).map_err(|refusal| refusal.exception(py))
    }

    /// Writes the grid file, as `girderway fea` does.
    fn write_grid(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let solved = self.solved(py)?;
        let write = || {
            files::write(
                &path,
                grid_file::write(&solved.grid, solved.surface.as_ref()).as_bytes(),
            )
        };
        py.detach(write)
            .map_err(|error| Refusal::from(error).exception(py))
    }

    /// Solves a design, given as a text that names the spec as `spec`.
    fn design(&self, py: Python<'_>, text: String) -> PyResult<Design> {
        let made = without_lock(py, None, |_| -> Result<SolvedDesign, Refusal> {
            let (mut inputs, source) = Inputs::of_text("design", text, Path::new(""));
            inputs.add("spec", self.inputs.all()[0].bytes.clone());
            let (design, inputs) = DesignInput::read(inputs, &source)?;
            Ok(SolvedDesign::of(&design, inputs)?)
        })?;
        made.map(Design::new)
            .map_err(|refusal| refusal.exception(py))
    }
}

/// Natural modes of a structure.
#[pyclass(frozen, module = "girderway._native")]
pub(crate) struct Modes {
    refined: RefinedModes,
    rails: Vec<String>,
}

#[pymethods]
impl Modes {
    /// Frequencies in Hz, lowest first.
    #[getter]
    fn frequency<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        array(
            py,
            self.refined
                .modes
                .modes
                .iter()
                .map(|mode| mode.omega / TAU)
                .collect(),
        )
    }

    /// Estimated relative error of the frequencies due to the mesh.
    #[getter]
    fn mesh_error(&self) -> Option<f64> {
        self.refined.error
    }

    /// Displacements of every mode at places of a rail: one row a mode.
    fn shape<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        axis: &str,
        rail: Option<&str>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let refuse = |refusal: Refusal| refusal.exception(py);
        let axes = [
            ("vertical", Axis::Vertical),
            ("lateral", Axis::Lateral),
            ("longitudinal", Axis::Longitudinal),
        ];
        let Some((_, axis)) = axes.into_iter().find(|(word, _)| *word == axis) else {
            let expected = "must be one of vertical, lateral, longitudinal";
            return Err(refuse(Refusal::argument(
                "axis",
                expected,
                Some(format!("{axis:?}")),
            )));
        };
        let index = match rail {
            None if self.rails.len() == 1 => Some(0),
            None => None,
            Some(name) => self.rails.iter().position(|known| known == name),
        };
        let Some(rail) = index else {
            let expected = format!("must be one of {}", self.rails.join(", "));
            return Err(refuse(Refusal::argument(
                "rail",
                expected,
                rail.map(|name| format!("{name:?}")),
            )));
        };
        let count = self.refined.modes.modes.len();
        let x = x.as_slice()?;
        let mut rows = vec![0.0; count * x.len()];
        for (i, &x_i) in x.iter().enumerate() {
            let found = self.refined.modes.at(Probe { rail, x: x_i, axis });
            let found =
                found.map_err(|error| refuse(Refusal::argument("x", error.to_string(), None)))?;
            for (k, [value, _]) in found.into_iter().enumerate() {
                rows[k * x.len() + i] = value;
            }
        }
        matrix(py, count, x.len(), rows)
    }

    /// Number of modes.
    fn __len__(&self) -> usize {
        self.refined.modes.modes.len()
    }

    /// Residuals and effective masses of the modes, as in the grid file.
    #[getter]
    fn rails<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        PyList::new(py, &self.rails)
    }
}
