//! Samples of a run at its output times, which fall within steps.

use crate::Error;
use crate::contact::solver::Solver;
use crate::mechanics::state::State;
use crate::record::history::History;
use crate::record::recorder::Recorder;
use crate::time::acting::Acting;
use crate::time::stepper::Stepper;

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

impl Samples {
    /// With the sample of the start.
    pub fn new(solver: &Solver, start: &State) -> Result<Self, Error> {
        let mut recorder = Recorder::new(solver.system);
        recorder.record(solver.system, &solver.geometry, start)?;
        let begun = Acting::of(solver);
        Ok(Samples { recorder, next: 1, sample: start.clone(), after: begun.clone(), begun })
    }

    /// Notes what acts in the step that is to come: a sample within it belongs to where it began.
    pub fn begin(&mut self, stepper: &Stepper) {
        self.begun.take(stepper.solver);
    }

    /// Adds the samples of the step just taken.
    pub fn take(&mut self, stepper: &mut Stepper) -> Result<(), Error> {
        let system = stepper.solver.system;
        let (from, to) = (stepper.from.t, stepper.to.t);
        self.after.take(stepper.solver);
        while system.scene.output_time(self.next) <= to {
            let t = system.scene.output_time(self.next);
            let is_end = t >= to * (1.0 - 1e-14);
            if is_end {
                self.sample.copy_from(&stepper.to);
            } else {
                self.begun.give(stepper.solver);
                let share = (t - from) / (to - from);
                stepper.sample(share, &mut self.sample)?;
            }
            stepper.solver.settle(&mut self.sample)?;
            self.recorder.record(system, &stepper.solver.geometry, &self.sample)?;
            self.after.give(stepper.solver);
            self.next += 1;
        }
        Ok(())
    }

    /// Adds the end of the step just taken where it is no output time.
    pub fn close(&mut self, stepper: &Stepper) -> Result<(), Error> {
        let system = stepper.solver.system;
        if system.scene.output_time(self.next - 1) < stepper.to.t {
            self.recorder.record(system, &stepper.solver.geometry, &stepper.to)?;
        }
        Ok(())
    }

    /// All samples.
    pub fn history(self) -> History {
        self.recorder.history
    }
}
