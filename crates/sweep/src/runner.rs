//! One run of a sweep.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

use design::DesignError;
use formats::design::Design;
use formats::scene::{Document, Origin};
use formats::spec::{SolveError, Spec};
use formats::sweep::{Scalar, Sweep, SweepInput};
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::Inputs;
use formats::units::Units;
use foundations::{SolvedStructure, distinct_specs, solve_specs};
use results::{before, cases, run_error};

use crate::outcome::{RunFailure, RunOutcome, RunRow};
use crate::values;

/// Number of solved structures that are kept, the ones used last.
const KEPT: usize = 16;

/// Runs the scene or design of a sweep. Solved structures are kept, so that each is solved once where the axes do not
/// change it.
pub struct Runner<'s> {
    sweep: &'s Sweep,
    solved: Mutex<VecDeque<SolvedStructure>>,
}

impl<'s> Runner<'s> {
    /// A runner without solved structures.
    #[must_use]
    pub const fn new(sweep: &'s Sweep) -> Runner<'s> {
        Runner { sweep, solved: Mutex::new(VecDeque::new()) }
    }

    /// The files of a run: those of the scene or design with the values of the axes in them.
    #[must_use]
    pub fn inputs(&self, values: &[Scalar]) -> Inputs {
        let changes: Vec<_> = self.sweep.axes.iter().map(|axis| &axis.place).zip(values).collect();
        self.sweep.target.with(&changes)
    }

    /// Runs the scene or design as its files are, without values of axes; returns its units and results.
    ///
    /// # Errors
    /// As [`Runner::run`].
    pub fn run_as_written(&self) -> Result<(Units, RunRow), RunFailure> {
        let inputs = self.sweep.target.inputs().clone();
        let units = match &self.sweep.input {
            SweepInput::Scene(_) => {
                Document::read_scene(inputs.clone()).map(|document| document.scene().units)
            }
            SweepInput::Design(_) => Design::read(inputs.clone()).map(|(design, _)| design.units),
        };
        Ok((units.map_err(|wrong| first(&wrong))?, self.run_files(inputs)?))
    }

    /// Runs the scene or design with values of the axes, in their order.
    ///
    /// # Errors
    /// Why the run has no results: faults of the files with these values, a structure that does not stand, a scene that
    /// cannot start, a run that is incomplete, results that it does not have. The text has one line.
    pub fn run(&self, values: &[Scalar]) -> RunOutcome {
        self.run_files(self.inputs(values)).map_err(RunFailure::why)
    }

    fn run_files(&self, inputs: Inputs) -> Result<RunRow, RunFailure> {
        match &self.sweep.input {
            SweepInput::Scene(_) => self.run_scene(inputs),
            SweepInput::Design(_) => self.run_design(inputs),
        }
    }

    fn run_scene(&self, inputs: Inputs) -> Result<RunRow, RunFailure> {
        let document = Document::read_scene(inputs).map_err(|wrong| first(&wrong))?;
        before::check(&document).map_err(|wrong| first(&wrong))?;
        let known = self.solved(&document)?;
        let mut outcomes =
            cases::simulate(&document, &known, Some(1), &|_| ()).map_err(|error| line(&error.to_string()))?;
        let outcome = outcomes.pop().ok_or_else(|| "the scene has no case".to_owned())?;
        match run_error::reason_incomplete(&outcome.run.status, document.scene()) {
            Some(why) => Err(line(&why).into()),
            None => values::of_scene(&self.sweep.results, document.scene(), &outcome),
        }
    }

    fn run_design(&self, inputs: Inputs) -> Result<RunRow, RunFailure> {
        let (read, inputs) = Design::read(inputs).map_err(|wrong| first(&wrong))?;
        let read = design::with_combinations(&read);
        let result = design::solve(&read, &inputs).map_err(|error| match error {
            DesignError::Input(wrong) => first(&wrong),
            DesignError::NoSolution(why) => line(&why),
        })?;
        values::of_design(&self.sweep.results, &design::summary(&read, &result))
    }

    /// The solved structures of a document: those kept, and the others solved and kept.
    fn solved(&self, document: &Document) -> Result<Vec<SolvedStructure>, String> {
        let specs = distinct_specs(document);
        let kept = |spec: &Arc<Spec>| self.kept(spec);
        let mut known: Vec<SolvedStructure> = specs.iter().filter_map(|(.., spec)| kept(spec)).collect();
        let new: Vec<_> =
            specs.into_iter().filter(|(.., spec)| known.iter().all(|entry| entry.spec != **spec)).collect();
        let solved = solve_specs(document, &new).map_err(|error| match error {
            SolveError::Input(wrong) => first(&wrong),
            SolveError::NoSolution(why) => line(&why),
        })?;
        self.keep(&solved);
        known.extend(solved);
        // the foundations find a solution by the spec that the scene has
        let origins = document.scene().structures.iter().map(|structure| &structure.origin);
        debug_assert!(origins.into_iter().all(|origin| match origin {
            Origin::Spec { spec, .. } => known.iter().any(|entry| entry.spec == *spec),
            Origin::Tables { .. } => true,
        }));
        Ok(known)
    }

    fn kept(&self, spec: &Arc<Spec>) -> Option<SolvedStructure> {
        let all = self.solved.lock().unwrap_or_else(PoisonError::into_inner);
        all.iter().find(|entry| entry.spec == *spec).cloned()
    }

    fn keep(&self, solved: &[SolvedStructure]) {
        let mut all = self.solved.lock().unwrap_or_else(PoisonError::into_inner);
        for entry in solved {
            if all.iter().all(|known| known.spec != entry.spec) {
                all.push_back(entry.clone());
            }
        }
        while all.len() > KEPT {
            all.pop_front();
        }
    }
}

/// The first of several faults, and how many more there are.
fn first(wrong: &[Diagnostic]) -> String {
    let text = wrong.first().map(|one| line(&one.to_string())).unwrap_or_default();
    match wrong.len() {
        0 | 1 => text,
        count => format!("{text} (and {} more)", count - 1),
    }
}

/// A text in one line.
fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
