//! The solution of a run, step by step, as the steppers go on.
//!
//! A step gives the state at any time inside it: the motion by the polynomials of its method, the penetrations of wheels with a
//! damper to their rail along it, and the forces by the laws. At its start forces may be others than at the end of the step
//! before: a wheel is on the next member of its rail, a motion has another speed, an element has become active.

use super::collocation::Collocation;
use super::events::at_break_within;
use super::step::Step;
use super::stepper::Stepper;
use crate::Error;
use crate::contact::active::ActiveSet;
use crate::contact::solver::Solver;
use crate::instant::settle::settle_within;
use crate::mechanics::state::State;
use crate::record::modal_motion::ModalMotion;
use crate::record::recorder::Recorder;
use crate::record::solution::{Solution, SolutionBuilder};

/// Largest fraction of a step within which a wheel that begins the step at a break of its rail has passed the break.
const PASSED: f64 = 1e-2;

/// Distance behind a break of a rail, relative to 1 + |x|, at which a wheel is behind it in spite of rounding.
const BEHIND: f64 = 1e-13;

/// Recorder of the solution.
pub(crate) struct Samples {
    builder: SolutionBuilder,
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
    /// Begins the solution with the state at the start of the run; `method` is that which moves natural modes by their
    /// propagators, if one does, and `accuracy` that with which steps are followed.
    ///
    /// # Errors
    /// Any error from evaluating the rails at the gauges.
    pub fn new(
        solver: &Solver,
        start: &State,
        method: Option<&Collocation>,
        accuracy: f64,
    ) -> Result<Self, Error> {
        let system = solver.system();
        let (mut recorder, mut row) = (Recorder::new(system), Vec::new());
        recorder.row(system, solver.geometry(), start, &mut row)?;
        let begun = Acting::of(solver);
        let modes = method.map(|method| {
            let numbers: Vec<usize> = recorder.modes().collect();
            let (modes, terms) = method.modes(&numbers);
            (numbers, ModalMotion::new(modes, terms))
        });
        Ok(Samples {
            builder: SolutionBuilder::new(recorder, accuracy, &row, modes),
            sample: start.clone(),
            after: begun.clone(),
            begun,
        })
    }

    /// Stores the active elements at the start of the next step; samples inside the step are computed with them.
    pub fn begin(&mut self, stepper: &mut Stepper) {
        self.begun.take(stepper.step().solver);
    }

    /// Adds the step just taken.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn take(&mut self, stepper: &mut Stepper) -> Result<(), Error> {
        let (slack, passed_joint) = (stepper.break_slack(), stepper.passed_joint());
        let step = stepper.step();
        let system = step.system();
        let interval = [step.from.t, step.to.t];
        let Samples {
            builder,
            sample,
            begun,
            after,
        } = self;
        after.take(step.solver);
        // the path of this step ends at the joint
        let exchange = |step: &mut Step| {
            if let Some(structure) = passed_joint {
                step.solver.exchange_paths(structure);
            }
        };
        exchange(step);
        let is_smooth = step.from.t == 0.0 || step.begins_smoothly;
        let start = if is_smooth {
            0.0
        } else {
            passed_share(step, slack)
        };
        if start > 0.0 {
            begun.restore(step.solver);
            sample_within(step, start, sample)?;
            step.begin_behind_break(sample);
            after.restore(step.solver);
        }
        // the geometry of the solver is that of the end until another time is sampled
        let is_state = start == 0.0 && step.ends_smoothly && !step.has_damped_rails();
        let mut evaluate = |share: f64, recorder: &mut Recorder, row: &mut Vec<f64>| {
            if share == 1.0 && is_state {
                recorder.row(system, step.solver.geometry(), &step.arrived, row)?;
                return Ok(true);
            }
            begun.restore(step.solver);
            let is_settled = sample_within(step, share.max(start), sample)?;
            recorder.row(system, step.solver.geometry(), sample, row)?;
            after.restore(step.solver);
            Ok(is_settled)
        };
        let done = builder.follow(interval, is_smooth, &mut evaluate);
        exchange(step);
        done?;
        if let (Some(method), Some((numbers, motion))) = (step.propagated(), builder.modes()) {
            method.modal_motion(&step.from, numbers, motion.begin(interval));
        }
        Ok(())
    }

    /// Number of values stored so far.
    pub fn stored(&self) -> usize {
        self.builder.stored()
    }

    /// The solution.
    pub fn finish(self) -> Solution {
        self.builder.finish()
    }
}

/// Sets `sample` to the state at a fraction of the step just taken, with the elements that were active in it, which the solver
/// has. Returns whether its forces are found: where the force of a damper grows with the penetration, an interpolated rate may
/// belong to no penetration, and they are estimates.
fn sample_within(step: &mut Step, fraction: f64, sample: &mut State) -> Result<bool, Error> {
    let is_known = step.sample(fraction, sample)?;
    let t = step.from.t + fraction * step.length();
    // a step ends just before a break of a motion, where the motion still has the speed of this side
    sample.t = t.min(step.to.t.next_down());
    let mut is_settled = true;
    if !(is_known && step.apply_laws(sample)?) {
        let slack = step.solver.allowed_error();
        // a step ends by rounding behind the event that changes the active elements
        let is_end = fraction == 1.0 && !step.ends_smoothly;
        if !(is_end && step.solver.instant_within(sample, [slack; 2])?) {
            is_settled = settle_within(step.solver, sample, slack)?;
        }
    }
    sample.t = t.min(step.to.t);
    Ok(is_settled)
}

/// Fraction of the step just taken at which no wheel is any longer before the break of its rail at which it begins the step: steps
/// end within the `slack` before a break.
fn passed_share(step: &Step, slack: f64) -> f64 {
    let system = step.system();
    let mechanics = &system.mechanics;
    let mut share = 0.0_f64;
    for (w, wheel) in mechanics.wheels.iter().enumerate() {
        let x = mechanics.rail_coordinate(w, step.from.t, &step.from.q);
        let speed = mechanics.speed_along(w, &step.from);
        let near = at_break_within(slack) * (1.0 + x.abs());
        let contact = &system.scene.contacts[wheel.contact];
        let [back, ahead] = if speed < 0.0 {
            [x, x - near]
        } else {
            [x, x + near]
        };
        let breaks = mechanics
            .breaks
            .between(contact.structure, contact.rail, back, ahead);
        if let (Some(place), true) = (breaks.last(), speed != 0.0) {
            let way = (place - x).abs() + BEHIND * (1.0 + x.abs());
            share = share.max(way / (speed.abs() * step.length()));
        }
    }
    share.min(PASSED)
}
