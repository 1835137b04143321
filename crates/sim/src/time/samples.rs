//! Samples of a run at its output times, which generally lie inside steps.

use super::stepper::Stepper;
use crate::contact::active::ActiveSet;
use crate::contact::solver::Solver;
use crate::instant::settle::settle;
use crate::mechanics::state::State;
use crate::record::recorder::Recorder;
use crate::{Error, History};

/// Recorder of the history at the output times.
pub(crate) struct Samples {
    recorder: Recorder,
    /// Index of the next output time.
    next: u64,
    sample: State,
    /// Active elements and rail pieces during the step, and those after it.
    begun: Acting,
    after: Acting,
}

/// Quantities that are constant in a step and may change at its end: the active elements, and the pieces of uneven
/// rails below the wheels.
#[derive(Clone, PartialEq)]
struct Acting {
    active: ActiveSet,
    pieces: Vec<usize>,
}

impl Acting {
    fn of(solver: &Solver) -> Self {
        Acting { active: solver.active().clone(), pieces: solver.geometry().places().piece.clone() }
    }

    fn take(&mut self, solver: &Solver) {
        self.active.copy_from(solver.active());
        self.pieces.clone_from(&solver.geometry().places().piece);
    }

    fn restore(&self, solver: &mut Solver) {
        solver.restore(&self.active, &self.pieces);
    }
}

impl Samples {
    /// Creates the recorder and records the start of the run.
    ///
    /// # Errors
    /// Any error from evaluating the rails at the gauges.
    pub fn new(solver: &Solver, start: &State) -> Result<Self, Error> {
        let mut recorder = Recorder::new(solver.system());
        recorder.record(solver.system(), solver.geometry(), start)?;
        let begun = Acting::of(solver);
        Ok(Samples { recorder, next: 1, sample: start.clone(), after: begun.clone(), begun })
    }

    /// Stores the active elements at the start of the next step; samples inside the step are computed with them.
    pub fn begin(&mut self, stepper: &mut Stepper) {
        self.begun.take(stepper.step().solver);
    }

    /// Records the output times of the step just taken.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn take(&mut self, stepper: &mut Stepper) -> Result<(), Error> {
        let step = stepper.step();
        let system = step.system();
        let (from, to) = (step.from.t, step.to.t);
        self.after.take(step.solver);
        while system.scene.output_time(self.next) <= to {
            let t = system.scene.output_time(self.next);
            let is_end = t >= to * (1.0 - 1e-14);
            if is_end && (self.begun != self.after || !step.has_damped_rails()) {
                self.sample.copy_from(&step.to);
            } else {
                self.begun.restore(step.solver);
                let fraction = if is_end { 1.0 } else { (t - from) / (to - from) };
                step.sample(fraction, &mut self.sample)?;
                self.sample.t = t;
            }
            settle(step.solver, &mut self.sample)?;
            self.recorder.record(system, step.solver.geometry(), &self.sample)?;
            self.after.restore(step.solver);
            self.next += 1;
        }
        Ok(())
    }

    /// Records the end of the step just taken if it is not an output time.
    ///
    /// # Errors
    /// Any error from evaluating the rails at the gauges.
    pub fn close(&mut self, stepper: &mut Stepper) -> Result<(), Error> {
        let step = stepper.step();
        let system = step.system();
        if system.scene.output_time(self.next - 1) < step.to.t {
            self.recorder.record(system, step.solver.geometry(), &step.to)?;
        }
        Ok(())
    }

    /// Returns the recorded samples.
    pub fn history(self) -> History {
        self.recorder.into_history()
    }
}
