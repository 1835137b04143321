//! Many runs of one scene.

use outputs::clock::StageClock;
use pyo3::prelude::*;
use pyo3::types::PyList;
use results::cases::{GirderTime, RunOptions};

use crate::errors::Refusal;
use crate::run::made;
use crate::source::{GivenInput, changes};
use crate::watch::without_lock;

/// Runs a scene once for each patch. What `each` returns for a run, or the run itself, is at its place in the list;
/// an exception is there in the place of a run that has none.
#[pyfunction]
#[pyo3(signature = (scene, patches, comparisons, threads, progress, each))]
pub(crate) fn run_many<'py>(
    py: Python<'py>,
    scene: GivenInput,
    patches: Vec<String>,
    comparisons: bool,
    threads: Option<u16>,
    progress: Option<&Bound<'_, PyAny>>,
    each: Option<&Bound<'_, PyAny>>,
) -> PyResult<Bound<'py, PyList>> {
    let patches: Vec<_> = patches.into_iter().map(changes).collect();
    let each = each.map(|each| each.clone().unbind());
    let options = RunOptions {
        threads,
        girders: GirderTime::OnDemand,
    };
    let all = without_lock(py, progress, |state| -> Result<Vec<Py<PyAny>>, Refusal> {
        let source = scene.scene()?;
        let observe = |fraction: f64| state.advance(fraction);
        let each = |_: usize, run: Result<_, results::Error>| {
            let found = run
                .map(|run| (run, StageClock::new()))
                .map_err(Refusal::from);
            Python::attach(|py| {
                let value = made(py, found).and_then(|run| match &each {
                    Some(each) => each.call1(py, (run,)),
                    None => Ok(run.into_any()),
                });
                value.unwrap_or_else(|error| error.into_value(py).into_any())
            })
        };
        Ok(results::many::run_many(
            &source,
            &patches,
            comparisons,
            options,
            &observe,
            &each,
        ))
    })?;
    PyList::new(py, all.map_err(|refusal| refusal.exception(py))?)
}
