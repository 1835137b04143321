//! Samples of a run at its output times, which generally lie inside steps, and at the ends of steps. The steps of collocation
//! methods are longer than cubic polynomials between their ends are exact, and have samples at their nodes as well.

use super::step::Step;
use super::stepper::Stepper;
use crate::contact::active::ActiveSet;
use crate::contact::solver::Solver;
use crate::instant::settle::{settle, settle_within};
use crate::mechanics::state::State;
use crate::record::recorder::{Recorder, output_samples};
use crate::{Error, History};

/// Largest number of values of the history with the ends of steps.
const MOST_VALUES: usize = 10_000_000;

/// Fraction of a step behind a break or an event at which a sample shows the forces after it. Wheels roll by more than the
/// slack within which a step ends at the break.
const AFTER: f64 = 1e-3;

/// Samples of a step of collocation. Steps between which memory for all of them need not grow are as long as output intervals.
const SAMPLES_OF_STEP: usize = 3;

/// Times that differ by less, relative to them, are the same: a step ends by rounding before a wheel is at a break of its rail.
const SAME_TIME: f64 = 1e-14;

/// Recorder of the history at the output times, and of that with the ends of steps.
pub(crate) struct Samples {
    recorder: Recorder,
    /// The history with the ends of steps; `None` where it is not wanted.
    steps: Option<History>,
    /// Samples inside the step just taken and at its end that are no output times, by increasing time.
    inside: Vec<f64>,
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
        Acting {
            active: solver.active().clone(),
            pieces: solver.geometry().places().piece.clone(),
        }
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
        let steps = wanted.then(|| {
            let mut steps = recorder.history().clone();
            steps.reserve(output_samples(solver.system().scene).saturating_mul(SAMPLES_OF_STEP));
            steps
        });
        let (begun, inside) = (Acting::of(solver), Vec::new());
        Ok(Samples {
            recorder,
            steps,
            inside,
            next: 1,
            sample: start.clone(),
            after: begun.clone(),
            begun,
        })
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
        self.inside.clear();
        if self.steps.is_some() {
            self.take_inside(step)?;
        }
        let known = self.recorder.history().len();
        while system.scene.output_time(self.next) <= to * (1.0 + SAME_TIME) {
            let t = system.scene.output_time(self.next);
            let is_end = t >= to * (1.0 - SAME_TIME);
            if is_end && (self.begun != self.after || !step.has_damped_rails()) {
                self.sample.copy_from(&step.to);
                settle(step.solver, &mut self.sample)?;
            } else {
                let fraction = if is_end {
                    1.0
                } else {
                    (t - from) / (to - from)
                };
                // a step ends just before a break of the rail, where the rail has the slope of this side
                self.sample_within(step, fraction, t.min(to))?;
                self.sample.t = t;
            }
            self.recorder
                .record(system, step.solver.geometry(), &self.sample)?;
            self.after.restore(step.solver);
            self.next += 1;
        }
        self.add_step(known, system.scene.output_parts.max(1));
        Ok(())
    }

    /// Samples the step just taken: just behind its start, if forces may jump there, at its inner nodes, and at its end before
    /// a break or an event changes the forces.
    fn take_inside(&mut self, step: &mut Step) -> Result<(), Error> {
        let system = step.system();
        // the geometry of the solver is that of the end until another time is sampled
        self.recorder.row(
            system,
            step.solver.geometry(),
            &step.arrived,
            &mut self.inside,
        )?;
        let width = self.inside.len();
        let from = step.from.t;
        if from > 0.0 && !step.begins_smoothly {
            self.sample_within(step, AFTER, from + AFTER * step.length())?;
            self.recorder.row(
                system,
                step.solver.geometry(),
                &self.sample,
                &mut self.inside,
            )?;
            self.after.restore(step.solver);
        }
        for (geometry, node) in step.inner_nodes() {
            self.recorder
                .row(system, geometry, node, &mut self.inside)?;
        }
        self.inside.rotate_left(width);
        Ok(())
    }

    /// Sets `sample` to the state at the time `t`, at a fraction of the step just taken, with the elements that were active in
    /// it. The solver keeps them.
    fn sample_within(&mut self, step: &mut Step, fraction: f64, t: f64) -> Result<(), Error> {
        self.begun.restore(step.solver);
        let is_known = step.sample(fraction, &mut self.sample)?;
        self.sample.t = t;
        if !(is_known && step.apply_laws(&mut self.sample)?) {
            let slack = step.solver.allowed_error();
            settle_within(step.solver, &mut self.sample, slack)?;
        }
        Ok(())
    }

    /// Adds the samples at the ends of output intervals and those inside the step just taken to those of the steps, by
    /// increasing time. Output samples from number `known` on are new; every `parts`-th one ends an interval.
    fn add_step(&mut self, known: usize, parts: usize) {
        let Some(steps) = &mut self.steps else { return };
        let history = self.recorder.history();
        let mut values = steps.take_values();
        let width = history.channels().len();
        let mut inside = self.inside.chunks_exact(width).peekable();
        for k in (known..history.len()).filter(|k| k.is_multiple_of(parts)) {
            let sample = history.sample(k);
            while let Some(before) = inside.next_if(|own| own[0] < sample[0] * (1.0 - SAME_TIME)) {
                values.extend(before);
            }
            let is_same = |own: &&[f64]| own[0] - sample[0] <= SAME_TIME * sample[0];
            if !inside.peek().is_some_and(is_same) {
                values.extend(sample);
            }
        }
        inside.for_each(|own| values.extend(own));
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
            self.recorder
                .record(system, step.solver.geometry(), &step.to)?;
        }
        Ok(())
    }

    /// Returns the samples at the output times, and those with the ends of steps.
    pub fn histories(self) -> [History; 2] {
        [self.recorder.into_history(), self.steps.unwrap_or_default()]
    }
}
