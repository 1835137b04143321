//! Sweeps: many runs of a scene or design, whole, in shards, and joined.

use std::path::PathBuf;

use formats::sweep::Sweep;
use outputs::sweep_files::{SweepProgress, WrittenSweep, make_sweep};
use pyo3::prelude::*;

use crate::convert::python;
use crate::errors::Refusal;
use crate::watch::without_lock;

/// Folder, contents of `summary.json`, and number and reason of each run without results.
type Written<'py> = (PathBuf, Bound<'py, PyAny>, Vec<(usize, String)>);

/// Makes the runs of a sweep, or of shard K of N, and writes the files of `girderway sweep`.
#[pyfunction]
#[pyo3(signature = (sweep, output, shard, threads, force, progress))]
pub(crate) fn sweep<'py>(
    py: Python<'py>,
    sweep: PathBuf,
    output: PathBuf,
    shard: Option<(usize, usize)>,
    threads: Option<u16>,
    force: bool,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Written<'py>> {
    let is_shard = |(k, n): &(usize, usize)| (1..=*n).contains(k);
    if shard.as_ref().is_some_and(|shard| !is_shard(shard)) {
        let found = shard.map(|(k, n)| format!("({k}, {n})"));
        let expected = "must be (K, N) with K from 1 to N";
        return Err(Refusal::argument("shard", expected, found).exception(py));
    }
    let made = without_lock(py, progress, |state| -> Result<WrittenSweep, Refusal> {
        let (read, own) = Sweep::open(&sweep)?;
        let mut observe = |now: SweepProgress| match now {
            SweepProgress::Resumed(..) => state.go_on(),
            SweepProgress::Made(made, all) => state.advance(made as f64 / all as f64),
        };
        let go_on = || state.go_on();
        Ok(make_sweep(
            (&read, &own),
            shard,
            (&output, force),
            threads,
            &mut observe,
            &go_on,
        )?)
    })?;
    written(py, made)
}

/// Joins the folders of all shards of a sweep.
#[pyfunction]
pub(crate) fn join_shards<'py>(
    py: Python<'py>,
    shards: Vec<PathBuf>,
    output: PathBuf,
    force: bool,
) -> PyResult<Written<'py>> {
    let joined = py.detach(|| outputs::sweep_files::join_shards(&shards, &output, force, None));
    written(py, joined.map_err(Refusal::from))
}

fn written<'py>(py: Python<'py>, made: Result<WrittenSweep, Refusal>) -> PyResult<Written<'py>> {
    let made = made.map_err(|refusal| refusal.exception(py))?;
    Ok((made.folder, python(py, &made.summary)?, made.failures))
}
