//! Many runs of one scene, each with changes of its own, on all threads.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use crate::Error;
use crate::cases::{RunOptions, SimulationProgress};
use crate::scene_run::SceneRun;
use crate::threads::parallel_map;
use formats::scene::SceneSource;
use formats::text::source::Source;
use foundations::StructureCache;

/// Runs a scene once for each of `changes`, as many at a time as the options have threads, and returns what `each` makes
/// of the results, in the order of the changes. It does not depend on the number of threads.
///
/// The files of the scene are read once, and equal specs are solved once. Comparisons of the scene are run where
/// `compares`. `progress` is called from any thread with the fraction of the runs that are done, and can break off:
/// the remaining runs then are [`Error::Stopped`].
///
/// ```
/// use std::ops::ControlFlow;
///
/// use formats::scene::SceneSource;
/// use formats::text::source::Source;
/// use results::cases::RunOptions;
/// use results::many::run_many;
///
/// # fn main() -> Result<(), results::Error> {
/// let bogie = SceneSource::open("../../examples/bogie/scene.json".as_ref())?;
/// let changes = [8, 9].map(|end| Source {
///     name: "changes".to_owned(),
///     text: format!(r#"{{"end": {{"time": {end}}}}}"#),
/// });
/// let last = run_many(&bogie, &changes, false, RunOptions::default(), &|_| ControlFlow::Continue(()), &|_, run| {
///     run.map(|run| run.cases[0].columns.values("time").last().copied())
/// });
/// let last = last.into_iter().collect::<Result<Vec<_>, _>>()?;
/// assert_eq!(last, [Some(8.0), Some(9.0)]);
/// # Ok(())
/// # }
/// ```
pub fn run_many<R: Send>(
    source: &SceneSource,
    changes: &[Source],
    compares: bool,
    options: RunOptions,
    progress: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
    each: &(dyn Fn(usize, Result<SceneRun, Error>) -> R + Sync),
) -> Vec<R> {
    let source = match source.document(None, compares) {
        Ok(document) => source.clone().with_files_of(&document),
        // the changes may remove the faults
        Err(_) => source.clone(),
    };
    let cache = StructureCache::default();
    let done = AtomicUsize::new(0);
    let fraction = || done.load(Ordering::Relaxed) as f64 / changes.len() as f64;
    let run = |changes: &Source| {
        if progress(fraction()).is_break() {
            return Err(Error::Stopped);
        }
        let document = source.document(Some(changes), compares)?;
        SceneRun::of(
            document,
            &cache,
            RunOptions {
                threads: Some(1),
                ..options
            },
            &|now| match now {
                SimulationProgress::Fraction(_) => progress(fraction()),
                SimulationProgress::Trial(_) => ControlFlow::Continue(()),
            },
        )
    };
    parallel_map(changes, options.threads, |index, changes| {
        let made = each(index, run(changes));
        done.fetch_add(1, Ordering::Relaxed);
        made
    })
}
