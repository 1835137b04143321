//! One scene with its comparisons, from checked files to its results: all that `girderway run` computes, in memory.

use std::ops::ControlFlow;

use serde_json::Value;

use crate::Error;
use crate::case_result::CaseResult;
use crate::cases::{RunOptions, SimulationProgress, simulate_while};
use crate::preflight;
use crate::response::{ComparedRun, RunComparison};
use crate::run_error::reason_incomplete;
use crate::summary;
use crate::threads::parallel_map;
use formats::scene::Document;
use foundations::{SolvedModel, SolvedStructure, StructureCache, solution_of};

/// A scene with its comparisons, and the results of all of them.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use formats::scene::SceneSource;
/// use formats::text::source::Source;
/// use foundations::StructureCache;
/// use results::cases::RunOptions;
/// use results::scene_run::SceneRun;
///
/// # fn main() -> Result<(), results::Error> {
/// let bogie = SceneSource::open("../../examples/bogie/scene.json".as_ref())?;
/// let changes = Source { name: "changes".to_owned(), text: r#"{"end": {"time": 8}}"#.to_owned() };
/// let cache = StructureCache::default();
/// let run = |changes: Option<&Source>| {
///     let document = bogie.document(changes, false)?;
///     // the girder is solved by the first run and known to the second
///     SceneRun::of(document, &cache, RunOptions::default(), &|_| ControlFlow::Continue(()))
/// };
///
/// let [whole, shorter] = [run(None)?, run(Some(&changes))?];
/// assert_eq!((whole.reason_incomplete(), shorter.reason_incomplete()), (None, None));
/// assert_eq!(shorter.cases[0].columns.values("time").last(), Some(&8.0));
/// assert_eq!(whole.summary(&whole.comparison(None))["name"], "bogie");
/// # Ok(())
/// # }
/// ```
pub struct SceneRun {
    /// The scene and its comparisons, with the files read.
    pub document: Document,
    /// The solved structures of all of them.
    pub structures: Vec<SolvedStructure>,
    /// The results: of the scene itself, then of each comparison.
    pub cases: Vec<CaseResult>,
}

impl SceneRun {
    /// Checks a document, solves those of its structures that `cache` does not know, and runs its cases. `progress` is
    /// called from any thread, and can break off.
    ///
    /// # Errors
    /// [`Error::Input`] for faults with a place in a file, [`Error::Stopped`] where `progress` breaks off, and those
    /// of [`simulate`](crate::cases::simulate).
    pub fn of(
        document: Document,
        cache: &StructureCache,
        options: RunOptions,
        progress: &(dyn Fn(SimulationProgress<'_>) -> ControlFlow<()> + Sync),
    ) -> Result<SceneRun, Error> {
        let document = preflight::validate(document)?;
        let structures = cache.solve(&document)?;
        SceneRun::on(document, structures, options, progress)
    }

    /// Runs the cases of a document that has been prepared ([`preflight::validate`]) on its solved structures.
    ///
    /// # Errors
    /// As [`SceneRun::of`].
    pub fn on(
        document: Document,
        structures: Vec<SolvedStructure>,
        options: RunOptions,
        progress: &(dyn Fn(SimulationProgress<'_>) -> ControlFlow<()> + Sync),
    ) -> Result<SceneRun, Error> {
        let cases = simulate_while(&document, &structures, options, progress)
            .map_err(|error| preflight::located(&document, error))?;
        Ok(SceneRun {
            document,
            structures,
            cases,
        })
    }

    /// Computes the extremes of girders that the runs have left ([`GirderTime::OnDemand`](crate::cases::GirderTime::OnDemand)),
    /// on at most `threads` threads. `go_on`, which is called from any thread, can break off.
    ///
    /// # Errors
    /// [`Error::Stopped`] where `go_on` has broken off; the extremes can be asked for again.
    pub fn compute_girders(
        &self,
        threads: Option<u16>,
        go_on: &(dyn Fn() -> ControlFlow<()> + Sync),
    ) -> Result<(), Error> {
        let found = parallel_map(&self.cases, threads, |_, case| {
            case.girders_while(&|| go_on()).is_some()
        });
        if found.into_iter().all(|found| found) {
            Ok(())
        } else {
            Err(Error::Stopped)
        }
    }

    /// The reason why the run of a case did not reach its end, with the label of the first such case; `None` where all
    /// did.
    #[must_use]
    pub fn reason_incomplete(&self) -> Option<String> {
        self.cases
            .iter()
            .zip(&self.document.cases)
            .find_map(|(result, case)| {
                reason_incomplete(&result.run.status, &case.scene)
                    .map(|why| format!("{}: {why}", result.label))
            })
    }

    /// The solution of each structure of the scene; `None` for structures that are defined by tables.
    #[must_use]
    pub fn solutions(&self) -> Vec<Option<&SolvedModel>> {
        let structures = &self.document.scene().structures;
        structures
            .iter()
            .map(|structure| solution_of(&self.structures, &structure.origin))
            .collect()
    }

    /// Statistics of the runs beside each other, computed on at most `threads` threads.
    #[must_use]
    pub fn comparison(&self, threads: Option<u16>) -> RunComparison {
        RunComparison::new(&self.compared(), threads)
    }

    /// The contents of `summary.json`.
    #[must_use]
    pub fn summary(&self, comparison: &RunComparison) -> Value {
        summary::of_document(
            &self.document,
            &self.cases,
            comparison.json(&self.compared()),
        )
    }

    /// The cases as [`RunComparison`] takes them.
    fn compared(&self) -> Vec<ComparedRun<'_>> {
        let cases = self.cases.iter().map(|case| ComparedRun {
            label: &case.label,
            record: &case.columns,
            response: &case.response,
            peaks: &case.peaks,
        });
        cases.collect()
    }
}
