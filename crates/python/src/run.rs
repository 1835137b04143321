//! A run of a scene: its columns as arrays, its summary and its files.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use foundations::StructureCache;
use numpy::{PyArray1, PyArrayMethods};
use outputs::clock::StageClock;
use outputs::run_files::save_run;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use results::cases::{GirderTime, RunOptions, SimulationProgress};
use results::scene_run::SceneRun;
use results::warning;

use crate::convert::{array, python, table};
use crate::errors::{Refusal, internal, untrusted_error};
use crate::source::{GivenInput, changes};
use crate::watch::without_lock;

/// A run of a scene and of its comparisons.
///
/// The values of its columns are in the arrays alone; they are copied back while the summary is made or files are
/// written. Extremes of girders are computed when the summary, the envelope, messages or files are first asked for.
#[pyclass(frozen, module = "girderway._native")]
pub(crate) struct Run {
    /// The results, with empty columns. Locked only by threads that have released the interpreter.
    run: Mutex<SceneRun>,
    clock: StageClock,
    /// The columns of each case.
    cases: Vec<CaseColumns>,
    why_incomplete: Option<String>,
}

/// The columns of one case.
struct CaseColumns {
    label: String,
    arrays: Vec<Py<PyArray1<f64>>>,
}

impl Run {
    /// Moves the columns of a run into arrays.
    pub(crate) fn new(py: Python<'_>, mut run: SceneRun, clock: StageClock) -> Run {
        let why_incomplete = run.reason_incomplete();
        let cases = run.cases.iter_mut().map(|case| {
            case.drop_history();
            let columns = case.columns.columns.iter_mut();
            let arrays =
                columns.map(|column| array(py, std::mem::take(&mut column.values)).unbind());
            CaseColumns {
                label: case.label.clone(),
                arrays: arrays.collect(),
            }
        });
        let cases = cases.collect();
        Run {
            run: Mutex::new(run),
            clock,
            cases,
            why_incomplete,
        }
    }

    /// Calls `read` with the whole run and the extremes of its girders, without the lock of the interpreter; the clock
    /// counts the time that the extremes take. Ctrl-C stops their computation, and they can be asked for again.
    fn with_girders<R: Send>(
        &self,
        py: Python<'_>,
        read: impl FnOnce(&SceneRun, StageClock) -> R + Send,
    ) -> PyResult<R> {
        let copy = |array: &Py<PyArray1<f64>>| array.bind(py).readonly().as_array().to_vec();
        let copies: Vec<Vec<Vec<f64>>> = self
            .cases
            .iter()
            .map(|case| case.arrays.iter().map(copy).collect())
            .collect();
        let mut clock = self.clock.clone();
        let made = without_lock(py, None, move |state| {
            let mut run = self.run.lock().unwrap_or_else(PoisonError::into_inner);
            for (case, copies) in run.cases.iter_mut().zip(copies) {
                for (column, values) in case.columns.columns.iter_mut().zip(copies) {
                    column.values = values;
                }
            }
            clock.resume();
            let computed = run.compute_girders(None, &|| state.go_on());
            clock.prolong();
            let made = computed.map(|()| read(&run, clock));
            for case in &mut run.cases {
                case.columns
                    .columns
                    .iter_mut()
                    .for_each(|column| column.values = Vec::new());
            }
            made
        })?;
        made.map_err(|error| Refusal::from(error).exception(py))
    }

    /// Calls `read` with the run without the values of its columns.
    fn with_run<R: Send>(&self, py: Python<'_>, read: impl FnOnce(&SceneRun) -> R + Send) -> R {
        py.detach(|| read(&self.run.lock().unwrap_or_else(PoisonError::into_inner)))
    }

    fn case(&self, index: usize) -> PyResult<&CaseColumns> {
        self.cases
            .get(index)
            .ok_or_else(|| internal("no such case"))
    }
}

#[pymethods]
impl Run {
    /// Labels of the cases: of the scene itself, then of its comparisons.
    #[getter]
    fn labels(&self) -> Vec<String> {
        self.cases.iter().map(|case| case.label.clone()).collect()
    }

    /// Why the run of a case did not reach its end.
    #[getter]
    fn why_incomplete(&self) -> Option<&str> {
        self.why_incomplete.as_deref()
    }

    /// The columns of a case by name: views that cannot be written.
    fn columns<'py>(&self, py: Python<'py>, case: usize) -> PyResult<Bound<'py, PyDict>> {
        let arrays = &self.case(case)?.arrays;
        let names: Vec<String> = self.with_run(py, |run| {
            run.cases[case]
                .columns
                .columns
                .iter()
                .map(|column| column.name.clone())
                .collect()
        });
        let dict = PyDict::new(py);
        for (name, array) in names.into_iter().zip(arrays) {
            dict.set_item(name, array.bind(py))?;
        }
        Ok(dict)
    }

    /// Units of the columns of a case by name.
    fn units<'py>(&self, py: Python<'py>, case: usize) -> PyResult<Bound<'py, PyAny>> {
        self.case(case)?;
        let units = self.with_run(py, |run| {
            results::summary::units(&run.document.cases[case].scene, &run.cases[case].columns)
        });
        python(py, &units)
    }

    /// The contents of `summary.json`.
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let summary = self.with_girders(py, |run, _| run.summary(&run.comparison(None)))?;
        python(py, &summary)
    }

    /// The columns of the envelope of the girders of a case; empty without girders.
    fn envelope<'py>(&self, py: Python<'py>, case: usize) -> PyResult<Bound<'py, PyDict>> {
        self.case(case)?;
        let text = self.with_girders(py, |run, _| {
            run.cases[case]
                .girders()
                .csv(&run.document.cases[case].scene, case + 1)
        })?;
        match text.map_err(internal)? {
            Some(text) => table(py, &text),
            None => Ok(PyDict::new(py)),
        }
    }

    /// Warnings and notes, as the command line prints them.
    fn messages<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let messages = self.with_girders(py, |run, _| {
            let all = warning::messages(&run.cases, &run.document);
            all.iter().map(ToString::to_string).collect::<Vec<_>>()
        })?;
        PyList::new(py, messages)
    }

    /// Writes the files of `girderway run` to a folder.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<PathBuf> {
        let saved = self.with_girders(py, |run, clock| save_run(run, &path, force, None, clock))?;
        saved
            .map(|written| written.folder)
            .map_err(|error| Refusal::from(error).exception(py))
    }
}

/// The run as an object of Python, or the exception of its error. An incomplete run is the member `run` of its
/// exception.
pub(crate) fn made(
    py: Python<'_>,
    made: Result<(SceneRun, StageClock), Refusal>,
) -> PyResult<Py<Run>> {
    let (run, clock) = made.map_err(|refusal| refusal.exception(py))?;
    let run = Py::new(py, Run::new(py, run, clock))?;
    let Some(why) = run.get().why_incomplete.clone() else {
        return Ok(run);
    };
    let error = untrusted_error(py, &why)?;
    error.value(py).setattr("run", run)?;
    Err(error)
}

/// Runs a scene with changes and its comparisons.
#[pyfunction]
#[pyo3(signature = (scene, patch, comparisons, threads, progress))]
pub(crate) fn run(
    py: Python<'_>,
    scene: GivenInput,
    patch: Option<String>,
    comparisons: bool,
    threads: Option<u16>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Py<Run>> {
    // most callers ask for columns alone
    let options = RunOptions {
        threads,
        girders: GirderTime::OnDemand,
    };
    let found = without_lock(py, progress, |state| {
        let mut clock = StageClock::new();
        let source = scene.scene()?;
        let patch = patch.map(changes);
        let document = source.document(patch.as_ref(), comparisons)?;
        let document = results::preflight::validate(document)?;
        clock.lap("read");
        let structures = StructureCache::default().solve(&document)?;
        clock.lap("fea");
        let run = SceneRun::on(document, structures, options, &|now| match now {
            SimulationProgress::Fraction(fraction) => state.advance(fraction),
            SimulationProgress::Trial(_) => state.go_on(),
        })?;
        clock.lap("simulation");
        Ok((run, clock))
    })?;
    made(py, found)
}
