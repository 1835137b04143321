//! Samples of a run at its output times, which generally lie inside steps, and at the ends of steps.

use super::stepper::Stepper;
use crate::contact::active::ActiveSet;
use crate::contact::solver::Solver;
use crate::instant::settle::settle;
use crate::mechanics::state::State;
use crate::record::recorder::Recorder;
use crate::{Error, History};

/// Largest number of values of the history with the ends of steps.
const MOST_VALUES: usize = 10_000_000;

/// Recorder of the history at the output times, and of that with the ends of steps.
pub(crate) struct Samples {
    recorder: Recorder,
    /// The history with the ends of steps, and the sample at the end of the last one; `None` where it is not wanted.
    steps: Option<(History, Vec<f64>)>,
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
    /// Creates the recorder and records the start of the run; the ends of steps are recorded as well if they are `wanted`.
    ///
    /// # Errors
    /// Any error from evaluating the rails at the gauges.
    pub fn new(solver: &Solver, start: &State, wanted: bool) -> Result<Self, Error> {
        let mut recorder = Recorder::new(solver.system());
        recorder.reserve_for(solver.system().scene);
        recorder.record(solver.system(), solver.geometry(), start)?;
        let steps = wanted.then(|| (recorder.history().clone(), Vec::new()));
        let begun = Acting::of(solver);
        Ok(Samples { recorder, steps, next: 1, sample: start.clone(), after: begun.clone(), begun })
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
        if let Some((_, end)) = &mut self.steps {
            end.clear();
            self.recorder.row(system, step.solver.geometry(), &step.to, end)?;
        }
        let known = self.recorder.history().len();
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
        self.add_step(known, system.scene.output_parts.max(1));
        Ok(())
    }

    /// Adds the samples at the ends of output intervals to those of the steps, and the one at the end of the step just taken,
    /// unless it is among them. Samples from number `known` on are new; every `parts`-th one ends an interval.
    fn add_step(&mut self, known: usize, parts: usize) {
        let Some((steps, end)) = &mut self.steps else { return };
        let mut values = steps.take_values();
        let history = self.recorder.history();
        let ends = (known..history.len()).filter(|k| k.is_multiple_of(parts));
        ends.for_each(|k| values.extend(history.sample(k)));
        if values[values.len() - end.len()] < end[0] {
            values.append(end);
        }
        let is_too_long = values.len() > MOST_VALUES;
        steps.put_values(values);
        if is_too_long {
            self.steps = None;
        }
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

    /// Returns the samples at the output times, and those with the ends of steps.
    pub fn histories(self) -> [History; 2] {
        [self.recorder.into_history(), self.steps.map_or_else(History::default, |(steps, _)| steps)]
    }
}
