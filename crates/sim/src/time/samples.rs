//! Samples of a run at its output times, which fall within steps.

use super::stepper::Stepper;
use crate::contact::active::ActiveSet;
use crate::contact::solver::Solver;
use crate::instant::settle::settle;
use crate::mechanics::state::State;
use crate::record::recorder::Recorder;
use crate::{Error, History};

/// The history at the output times, from inside the steps.
pub(crate) struct Samples {
    recorder: Recorder,
    /// Number of the output time that is next.
    next: u64,
    sample: State,
    /// What acts in the step; what acts after it.
    begun: Acting,
    after: Acting,
}

/// What acts in a step and may change in the next: active elements, and the pieces of uneven rails below the wheels.
#[derive(Clone)]
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
    /// With the sample of the start.
    ///
    /// # Errors
    /// What the rails refuse at the gauges.
    pub fn new(solver: &Solver, start: &State) -> Result<Self, Error> {
        let mut recorder = Recorder::new(solver.system());
        recorder.record(solver.system(), solver.geometry(), start)?;
        let begun = Acting::of(solver);
        Ok(Samples { recorder, next: 1, sample: start.clone(), after: begun.clone(), begun })
    }

    /// Notes what acts in the step that is to come: a sample within it belongs to where it began.
    pub fn begin(&mut self, stepper: &mut Stepper) {
        self.begun.take(stepper.step().solver);
    }

    /// Adds the samples of the step just taken.
    ///
    /// # Errors
    /// What the rails refuse.
    pub fn take(&mut self, stepper: &mut Stepper) -> Result<(), Error> {
        let step = stepper.step();
        let system = step.system();
        let (from, to) = (step.from.t, step.to.t);
        self.after.take(step.solver);
        while system.scene.output_time(self.next) <= to {
            let t = system.scene.output_time(self.next);
            let is_end = t >= to * (1.0 - 1e-14);
            if is_end {
                self.sample.copy_from(&step.to);
            } else {
                self.begun.restore(step.solver);
                let fraction = (t - from) / (to - from);
                step.sample(fraction, &mut self.sample)?;
            }
            settle(step.solver, &mut self.sample)?;
            self.recorder.record(system, step.solver.geometry(), &self.sample)?;
            self.after.restore(step.solver);
            self.next += 1;
        }
        Ok(())
    }

    /// Adds the end of the step just taken where it is no output time.
    ///
    /// # Errors
    /// What the rails refuse at the gauges.
    pub fn close(&mut self, stepper: &mut Stepper) -> Result<(), Error> {
        let step = stepper.step();
        let system = step.system();
        if system.scene.output_time(self.next - 1) < step.to.t {
            self.recorder.record(system, step.solver.geometry(), &step.to)?;
        }
        Ok(())
    }

    /// All samples.
    pub fn history(self) -> History {
        self.recorder.into_history()
    }
}
