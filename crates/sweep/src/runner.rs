//! One run of a sweep.

use std::ops::ControlFlow;

use ::design::DesignStructures;
use formats::design::Design;
use formats::scene::{Document, SceneSource};
use formats::spec::SolveError;
use formats::sweep::{AxisValue, ResultKind, Sweep, SweepInput};
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::Inputs;
use formats::units::Units;
use foundations::StructureCache;
use results::cases::{GirderTime, RunOptions};
use results::scene_run::SceneRun;

use crate::outcome::{RunFailure, RunOutcome, RunRow};
use crate::values;

/// Says whether to go on with a run; called from any thread.
pub type GoOn<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

/// Runs the scene or design of a sweep. Solved structures are kept, so that each is solved once where the axes do not
/// change it.
pub struct Runner<'s> {
    sweep: &'s Sweep,
    solved: StructureCache,
    designed: DesignStructures,
}

impl<'s> Runner<'s> {
    /// A runner without solved structures.
    #[must_use]
    pub fn new(sweep: &'s Sweep) -> Runner<'s> {
        Runner {
            sweep,
            solved: StructureCache::default(),
            designed: DesignStructures::default(),
        }
    }

    /// The files of a run: those of the scene or design with the values of the axes in them.
    #[must_use]
    pub fn inputs(&self, values: &[AxisValue]) -> Inputs {
        let changes: Vec<_> = self
            .sweep
            .axes
            .iter()
            .map(|axis| &axis.place)
            .zip(values)
            .collect();
        self.sweep.target.with(&changes)
    }

    /// The scene of a run, without comparisons.
    ///
    /// # Errors
    /// All faults of the files with these values.
    pub fn scene(&self, values: &[AxisValue]) -> Result<Document, Vec<Diagnostic>> {
        scene(self.inputs(values))
    }

    /// The design of a run, and its files.
    ///
    /// # Errors
    /// All faults of the files with these values.
    pub fn design(&self, values: &[AxisValue]) -> Result<(Design, Inputs), Vec<Diagnostic>> {
        design(self.inputs(values))
    }

    /// Runs the scene or design as its files are, without values of axes; returns its units and results. Between two
    /// steps of a scene `go_on` can break off.
    ///
    /// # Errors
    /// As [`Runner::run`]; [`RunFailure::Stopped`] where `go_on` has broken off.
    pub fn run_as_written(&self, go_on: GoOn<'_>) -> Result<(Units, RunRow), RunFailure> {
        self.run_files(self.sweep.target.inputs().clone(), go_on)
    }

    /// Runs the scene or design with values of the axes, in their order; `None` where `go_on` has broken off between two
    /// steps of a scene.
    ///
    /// # Errors
    /// Why the run has no results: faults of the files with these values, a structure that does not stand, a scene that
    /// cannot start, a run that is incomplete, results that it does not have. The text has one line.
    pub fn run(&self, values: &[AxisValue], go_on: GoOn<'_>) -> Option<RunOutcome> {
        match self.run_files(self.inputs(values), go_on) {
            Ok((_, row)) => Some(Ok(row)),
            Err(failure) => failure.why().map(|why| Err(self.with_own_names(why))),
        }
    }

    /// A reason in which files are called as their inputs are, wherever the sweep was started, so that it is the same on
    /// every machine.
    fn with_own_names(&self, why: String) -> String {
        let files = self.sweep.target.inputs().all().iter();
        files.fold(why, |text, file| {
            text.replace(&file.display_name, &file.name)
        })
    }

    fn run_files(&self, inputs: Inputs, go_on: GoOn<'_>) -> Result<(Units, RunRow), RunFailure> {
        match &self.sweep.input {
            SweepInput::Scene(_) => self.run_scene(inputs, go_on),
            SweepInput::Design(_) => self.run_design(inputs),
        }
    }

    fn run_scene(&self, inputs: Inputs, go_on: GoOn<'_>) -> Result<(Units, RunRow), RunFailure> {
        let document = scene(inputs).map_err(|wrong| first(&wrong))?;
        // runs are on threads of their own, and few sweeps ask for extremes of girders
        let options = RunOptions {
            threads: Some(1),
            girders: GirderTime::OnDemand,
        };
        let run = SceneRun::of(document, &self.solved, options, &|_| go_on());
        let run = run.map_err(|error| match error {
            results::Error::Stopped => RunFailure::Stopped,
            results::Error::Input(wrong) => first(&wrong).into(),
            other => line(&other.to_string()).into(),
        })?;
        if let Some(why) = run.reason_incomplete() {
            return Err(line(&why).into());
        }
        if self.sweep.results.contains(&ResultKind::Extremes) {
            run.compute_girders(Some(1), go_on)
                .map_err(|_| RunFailure::Stopped)?;
        }
        let scene = run.document.scene();
        Ok((
            scene.units,
            values::of_scene(&self.sweep.results, scene, &run.cases[0])?,
        ))
    }

    fn run_design(&self, inputs: Inputs) -> Result<(Units, RunRow), RunFailure> {
        let (read, inputs) = design(inputs).map_err(|wrong| first(&wrong))?;
        let read = ::design::with_combinations(&read);
        let result =
            ::design::solve_on(&self.designed, &read, &inputs).map_err(|error| match error {
                SolveError::Input(wrong) => first(&wrong),
                SolveError::NoSolution(why) => line(&why),
            })?;
        Ok((
            read.units,
            values::of_design(&self.sweep.results, &::design::summary(&read, &result))?,
        ))
    }
}

/// The scene of files, without its comparisons.
fn scene(inputs: Inputs) -> Result<Document, Vec<Diagnostic>> {
    SceneSource::of(inputs)?.document(None, false)
}

/// The design of files.
fn design(inputs: Inputs) -> Result<(Design, Inputs), Vec<Diagnostic>> {
    let source = inputs.all()[0].source().map_err(|error| vec![*error])?;
    Design::read(inputs, &source)
}

/// The first of several faults, and how many more there are.
fn first(wrong: &[Diagnostic]) -> String {
    let text = wrong
        .first()
        .map(|one| line(&one.to_string()))
        .unwrap_or_default();
    match wrong.len() {
        0 | 1 => text,
        count => format!("{text} (and {} more)", count - 1),
    }
}

/// A text in one line.
fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
