//! The adaptive stepper, which ends steps at events.
//!
//! Within a step the set of active elements is fixed, so that the solution is smooth and the method keeps its order.
//! A step is first tried at the length that the errors of the previous steps allow. Then the reasons to shorten it
//! are checked in their order ([`Reason`]). The first reason that applies gives a shorter length, at which the step
//! is tried again. If no reason applies, the step is accepted and the active elements at its end are determined.

use std::f64::consts::TAU;

use super::books::Books;
use super::events::{
    OVERSHOOT, at_break, break_slack, can_predict, first_corner, first_switch, first_touch, guards,
    prescribed_break, rolling_break, rounding_among,
};
use super::modal_loads::ModalLoads;
use super::outcome::{Counts, FirstImpact, StruckBy};
use super::step::{PathStart, Step};
use super::step_size::StepSize;
use super::transients::Transients;
use super::triggers::Triggers;
use super::wheel_forces::WheelForces;
use crate::contact::element::{Guard, GuardKind};
use crate::contact::solver::Solver;
use crate::instant::settle::{settle, settle_jump};
use crate::instant::uneven::pass_corners;
use crate::mechanics::state::State;
use crate::record::energy::stored;
use crate::{Audit, Error, Fired, GapCause, Stepping, Stored};

/// Largest number of times a step is shortened to end at a break or at a switch of elements.
const REFINEMENTS: usize = 40;

/// Number of these trials that use the estimated position of the switch; the later trials halve the step.
const GUESSES: usize = 20;

/// Largest number of times a step is shortened to end at a touch or at a corner of a law.
const CORNERS: usize = 12;

/// Largest number of times a step is shortened to end where a rule acts.
const TRIALS: usize = 20;

/// Multiple of its planned length that a step may have where it then ends at the break of a rail. What would be left needs
/// another step, and the error of a step is usually a sixth of what is allowed.
const LONGER: f64 = 1.25;

/// Fraction of the planned step below which an event is regarded as occurring at the start of the step. In shorter
/// steps the rates are dominated by rounding.
const NOW: f64 = 1e-6;

/// Largest number of consecutive steps that may end at events. Beyond it the contacts chatter, and the run fails.
const CHATTER: usize = 1000;

/// Length of a step, relative to the shortest period of a wheel at the start, below which it resolves nothing that a scene
/// has, and the largest number of such steps one after the other, without an event. Beyond it the run fails, since it would
/// not come to its end.
const CRAWL: f64 = 1e-7;
const CRAWLING: usize = 5000;

/// Number of consecutive steps that end at events after which the next step is limited to [`WIDER`] times the last.
/// If a trial ends far beyond an event, the secant always underestimates the time of the event.
const SHORT: usize = 2;
const WIDER: f64 = 16.0;

/// Number of consecutive steps that end at events from which on these lie within [`INSTANT`] of the window of an event.
const RATTLE: usize = 8;

/// Part of the time around an event in which forces need not keep the accuracy in which they are not judged. Wheels near to each
/// other that a step of the rail throws off and back again settle in a time that no other quantity resolves.
const INSTANT: f64 = 1e-3;

/// Accuracy of the run, per unit of the tolerance of its steps.
const ASKED: f64 = 1.0 / 3.0;

/// Error of a wheel force, relative to its size, per unit of the error of a displacement, relative to its scale. It is
/// fitted to the crossings S1 to S4 of `tests/it/accuracy.rs`, and judged there by scenes at random.
const FORCE_SHARE: f64 = 0.6;

/// Energy that a step in which a flange touches or separates may leave unaccounted for, relative to the peak energy, per
/// unit of the tolerance.
const ENERGY: f64 = 3e-4;

/// Reason for which a step could not be taken.
pub(crate) enum Failure {
    TooSmall,
    Refused(Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Refused(error)
    }
}

/// Reasons to shorten a step.
#[derive(Clone, Copy)]
enum Reason {
    /// A wheel with prescribed motion would pass a break of its rail. This is known before the step is tried.
    PrescribedBreak,
    /// A freely rolling wheel passes a break. This is checked before the error, because the error of a step across a
    /// break is not representative of the step that ends before it.
    RollingBreak,
    /// A flange touches or separates. This matters only if the error of the step exceeds the tolerance, the step is fixed,
    /// or its energy does not balance.
    Touch,
    /// The error of the step exceeds the tolerance.
    Error,
    /// An element becomes active or inactive.
    Switch,
    /// A rule acts.
    Trigger,
    /// A contact law reaches or leaves a corner.
    Corner,
}

/// Reasons that are checked before a step is tried, and those checked after it, in their order.
const BEFORE: [Reason; 1] = [Reason::PrescribedBreak];
const AFTER: [Reason; 6] = [
    Reason::RollingBreak,
    Reason::Touch,
    Reason::Error,
    Reason::Switch,
    Reason::Trigger,
    Reason::Corner,
];

/// A step that is tried with decreasing lengths.
struct Trial {
    h: f64,
    /// Length below which the step fails, and length below which an event is regarded as being at the start.
    smallest: f64,
    shortest: f64,
    /// Error divided by the tolerance; infinite if the step did not converge.
    error: f64,
    ends_at_event: bool,
    /// Number of times the step was shortened for each kind of reason.
    breaks: usize,
    corners: usize,
    switches: usize,
    triggers: usize,
}

/// A run in progress.
pub(crate) struct Stepper<'a, 'b> {
    step: Step<'a, 'b>,
    size: StepSize,
    transients: Transients,
    /// Whether an element has become active or inactive at the end of the last step.
    has_switched: bool,
    triggers: Triggers,
    books: Books,
    counts: Counts,
    limit: f64,
    /// Largest contact force so far, and at least the total weight.
    force_scale: f64,
    /// Number of consecutive steps near the smallest length, and of consecutive steps that ended at an event.
    stalled: usize,
    chatter: usize,
    /// Number of consecutive steps without an event that are shorter than [`CRAWL`] of the period.
    crawling: usize,
    /// Shortest period 2 pi sqrt(m/k) of a wheel at the start, with its load m g; zero if none presses.
    period: f64,
    /// Number of bounces so far over which errors add up.
    bounces: f64,
    /// The first strike of a flange or a stop.
    strike: Option<FirstImpact>,
    /// Sizes of the wheel forces, to which their errors are relative.
    wheel_forces: WheelForces,
    /// Loads of the natural modes, to which the errors of their accelerations are relative, where these have propagators.
    modal_loads: Option<ModalLoads>,
    /// Touch guards at the start of the next step.
    touches: Vec<Guard>,
    /// Those at the end of the step just tried, once they are known.
    ending: Option<Vec<Guard>>,
    /// The wheel that is at a break of its rail at the end of the step.
    meets: Option<usize>,
    /// The structure with the joint that a wheel has passed at the end of the step.
    passed_joint: Option<usize>,
}

impl<'a, 'b> Stepper<'a, 'b> {
    /// Creates a run from `start`, in which the active elements of the solver are consistent, with steps of the
    /// relative error `tolerance` or of the length fixed by `stepping`. The first step has the length `first`.
    ///
    /// # Errors
    /// A rule refers to a quantity that is not recorded.
    pub fn new(
        solver: &'b mut Solver<'a>,
        start: State,
        stepping: Stepping,
        tolerance: f64,
        first: f64,
    ) -> Result<Self, Error> {
        let scene = solver.system().scene;
        solver.store_open(&start);
        let period = period(solver, &start);
        let system = solver.system();
        let wheel_forces = WheelForces::new(system, &start.force);
        let touches = guards(solver, GuardKind::Touch, &start);
        let (triggers, books) = (Triggers::new(system)?, Books::new(solver, &start));
        let size = StepSize::new(solver, &start, tolerance, stepping.step, first);
        let mut step = Step::new(solver, start, stepping.method);
        step.note_start();
        Ok(Stepper {
            period: if period.is_finite() { period } else { 0.0 },
            triggers,
            books,
            touches,
            ending: None,
            wheel_forces,
            modal_loads: step.propagates_modes().then(|| ModalLoads::new(system)),
            size,
            transients: Transients::none(),
            has_switched: false,
            step,
            counts: Counts::default(),
            limit: f64::INFINITY,
            force_scale: scene
                .bodies
                .iter()
                .map(|body| body.mass * scene.gravity)
                .sum(),
            bounces: 0.0,
            strike: None,
            stalled: 0,
            chatter: 0,
            crawling: 0,
            meets: None,
            passed_joint: None,
        })
    }

    /// The last step.
    pub fn step(&mut self) -> &mut Step<'a, 'b> {
        &mut self.step
    }

    /// The structure with a joint that a wheel has passed at the end of the last step.
    pub fn passed_joint(&self) -> Option<usize> {
        self.passed_joint
    }

    /// Times at the start and at the end of the last step.
    pub fn times(&self) -> [f64; 2] {
        [self.step.from.t, self.step.to.t]
    }

    /// The audit so far.
    pub fn audit(&self) -> Audit {
        self.books.audit()
    }

    /// Counts of the work done so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Number of bounces so far over which errors add up.
    pub fn bounces(&self) -> f64 {
        self.bounces
    }

    /// The first strike of a flange or a stop so far.
    pub fn strike(&self) -> Option<FirstImpact> {
        self.strike
    }

    /// Tries steps until one is accepted; the step ends at `limit` at the latest.
    ///
    /// # Errors
    /// The step would become too small, or evaluating the rails failed.
    pub fn advance(&mut self, limit: f64) -> Result<(), Failure> {
        let mut trial = self.begin(limit);
        let mut ends_at_break;
        loop {
            ends_at_break = false;
            if trial.h < trial.smallest {
                return Err(Failure::TooSmall);
            }
            for reason in BEFORE {
                if let Some(shorter) = self.cut(reason, &mut trial)? {
                    trial.h = shorter;
                    ends_at_break = true;
                }
            }
            trial.error = self.attempt(trial.h)?;
            let mut shorter = None;
            for reason in AFTER {
                shorter = self.cut(reason, &mut trial)?;
                if shorter.is_some() {
                    break;
                }
            }
            match shorter {
                Some(h) => trial.h = h,
                None => break,
            }
        }
        // A step that was shortened gives no information about the error of longer steps.
        if !trial.ends_at_event {
            let step = &self.step;
            self.size
                .plan(trial.h, trial.error, step.lengths(), |h| step.rounded(h));
        }
        self.stalled = if trial.h <= 4.0 * trial.smallest {
            self.stalled + 1
        } else {
            0
        };
        self.chatter = if trial.ends_at_event && trial.breaks == 0 {
            self.chatter + 1
        } else {
            0
        };
        let crawls =
            self.size.fixed.is_none() && !trial.ends_at_event && trial.h < CRAWL * self.period;
        self.crawling = if crawls { self.crawling + 1 } else { 0 };
        if self.stalled > REFINEMENTS || self.chatter > CHATTER || self.crawling > CRAWLING {
            return Err(Failure::TooSmall);
        }
        self.accept(trial.h)?;
        self.step.ends_smoothly =
            !(trial.ends_at_event || ends_at_break || self.step.to.t >= self.limit);
        Ok(())
    }

    /// Plans a step from the end of the last one.
    fn begin(&mut self, limit: f64) -> Trial {
        self.limit = limit;
        if !self.step.is_collocation() {
            self.size.set_accuracy(self.step.solver);
        }
        let mut widest = if self.chatter > SHORT {
            WIDER * self.step.length()
        } else {
            f64::INFINITY
        };
        self.step.begin();
        self.step.begins_smoothly = self.step.ends_smoothly;
        if !self.step.begins_smoothly {
            self.step.last_jump = self.step.from.t;
            // A transient has decayed to the accuracy at the end of the window.
            let decay = (1.0 / self.size.tolerance).ln().max(1.0);
            let window = self.window();
            self.step.shortest_delay = window / decay;
            let Step {
                solver,
                from,
                arrived,
                shortest_delay,
                ..
            } = &self.step;
            let (forces, accuracy) = (&self.wheel_forces, ASKED * self.size.tolerance);
            let allowed = |i: usize| accuracy * forces.size(i);
            let times = [window, *shortest_delay];
            let ends = [arrived, from];
            self.transients
                .add(solver, ends, &allowed, times, self.has_switched);
        }
        widest = widest.min(self.transients.longest(self.step.from.t));
        self.meets = None;
        self.passed_joint = None;
        let smallest = 1e-13 * limit.abs().max(1e-3);
        let instant = if self.chatter >= RATTLE {
            self.instant()
        } else {
            0.0
        };
        let planned = self
            .size
            .planned(self.step.lengths()[0], widest.max(instant));
        let mut trial = Trial {
            h: self.size.within(planned, limit - self.step.from.t),
            smallest,
            shortest: (NOW * planned).max(2.0 * smallest).max(instant),
            error: f64::INFINITY,
            ends_at_event: false,
            breaks: 0,
            corners: 0,
            switches: 0,
            triggers: 0,
        };
        // The extrapolated position of a break is used only if the tolerance lets steps end within a slack larger
        // than rounding.
        let slack = self.break_slack();
        if self.step.system().mechanics.moves_freely && can_predict(slack) {
            let longest = (LONGER * trial.h).min(limit - self.step.from.t);
            self.step.guess_end(longest);
            let to_break = self.rolling_break(slack).map(|fraction| fraction * longest);
            if let Some(h) = to_break.filter(|h| *h > 2.0 * smallest) {
                trial.breaks += 1;
                trial.ends_at_event = true;
                trial.h = h;
            }
        }
        self.step.set_paths(
            PathStart::StepStart,
            [trial.h, self.size.planned(1.0, widest)],
        );
        trial
    }

    /// Tries a step of length `h`; returns its error divided by the tolerance.
    fn attempt(&mut self, h: f64) -> Result<f64, Error> {
        self.ending = None;
        if !self.step.attempt(h, self.limit, &mut self.counts.stages)? {
            return Ok(f64::INFINITY);
        }
        if self.size.fixed.is_some() {
            return Ok(0.0);
        }
        let (step, length, largest) = (&self.step, self.step.length(), self.force_scale);
        if let Some(loads) = &mut self.modal_loads {
            loads.grow(step.solver);
        }
        let loads = self.modal_loads.as_ref();
        let error = step.error(|k, errors| {
            let of_mode = loads.map_or(0.0, |own| {
                own.relative(step.system(), k, length * errors[0], largest)
            });
            self.size.weigh(&step.to, length, k, errors).max(of_mode)
        });
        if length <= self.instant()
            && self.step.to.t - self.step.last_jump <= INSTANT.recip() * self.instant()
        {
            return Ok(error / self.size.tolerance);
        }
        let forces = self.wheel_forces.relative(self.step.force_errors());
        let allowed = self.size.tolerance.min(self.step.loosest());
        let forces = FORCE_SHARE * forces * self.size.tolerance / allowed;
        Ok(error.max(forces) / self.size.tolerance)
    }

    /// Checks whether `reason` shortens the step of the trial; returns the shorter length if it does.
    fn cut(&mut self, reason: Reason, trial: &mut Trial) -> Result<Option<f64>, Error> {
        let has_converged = trial.error.is_finite();
        let is_long = trial.h > trial.shortest;
        let cut = match reason {
            Reason::PrescribedBreak => {
                return Ok(prescribed_break(
                    self.step.system(),
                    self.step.from.t,
                    trial.h,
                ));
            }
            Reason::RollingBreak => {
                if !(has_converged && trial.breaks < REFINEMENTS) {
                    return Ok(None);
                }
                let fraction = self.rolling_break(self.break_slack());
                trial.breaks += usize::from(fraction.is_some());
                fraction.map(|fraction| (trial.h * fraction).max(2.0 * trial.smallest))
            }
            Reason::Touch => {
                if !(has_converged && trial.corners < CORNERS && is_long) {
                    return Ok(None);
                }
                if !(trial.error > 1.0 || self.size.fixed.is_some() || self.loses_energy(trial.h)) {
                    return Ok(None);
                }
                let largest = self.largest_force();
                let fraction = first_touch(&mut self.step, &self.touches, largest)?;
                trial.corners += usize::from(fraction.is_some());
                fraction.map(|fraction| (trial.h * fraction).max(trial.shortest))
            }
            Reason::Error => {
                if trial.error <= 1.0 {
                    return Ok(None);
                }
                self.counts.rejected += 1;
                trial.ends_at_event = false;
                return Ok(Some(self.step.rounded(StepSize::shorter(
                    trial.h,
                    trial.error,
                    self.step.lengths()[1],
                ))));
            }
            Reason::Switch => {
                let largest = self.largest_force();
                let Some((fraction, excess)) = first_switch(&mut self.step, largest)? else {
                    return Ok(None);
                };
                // A step that ends close enough to the switch also counts as ending at it.
                trial.ends_at_event = true;
                let is_beyond = excess > OVERSHOOT * largest;
                if !(is_beyond && is_long && trial.switches < REFINEMENTS) {
                    return Ok(None);
                }
                trial.switches += 1;
                // If the estimates do not converge, the step is halved.
                let fraction = if trial.switches < GUESSES {
                    fraction
                } else {
                    0.5
                };
                Some((trial.h * fraction).max(trial.shortest))
            }
            Reason::Trigger => {
                if trial.triggers >= TRIALS {
                    return Ok(None);
                }
                let shorter = self.triggers.first(&mut self.step, trial.h)?;
                trial.triggers += usize::from(shorter.is_some());
                shorter.map(|shorter| shorter.max(2.0 * trial.smallest))
            }
            Reason::Corner => {
                let fraction = first_corner(&self.step, self.largest_force());
                let fraction = fraction.filter(|_| trial.corners < CORNERS && is_long);
                trial.corners += usize::from(fraction.is_some());
                fraction.map(|fraction| (trial.h * fraction).max(trial.shortest))
            }
        };
        trial.ends_at_event |= cut.is_some();
        Ok(cut)
    }

    /// Whether a flange touches or separates in the step just tried and more energy than allowed is missing or gained. On
    /// rails that move along x, steps end at joints, and touches are left to the audit.
    fn loses_energy(&mut self, h: f64) -> bool {
        if self.step.system().mechanics.has_sliding_rails() || self.touched().is_none() {
            return false;
        }
        let exchanged = self.step.exchanged(h);
        let gap = self
            .books
            .gap(self.step.solver, &exchanged, &self.step.to, self.stored());
        gap.abs() > ENERGY * self.size.tolerance * self.books.audit().peak_stored
    }

    /// The wheel of the first flange that is on another side of its clearance at the end of the step than at its start, and
    /// whether it touches there.
    fn touched(&mut self) -> Option<(usize, bool)> {
        let Step { solver, to, .. } = &self.step;
        let now = self
            .ending
            .get_or_insert_with(|| guards(solver, GuardKind::Touch, to));
        let index = self
            .touches
            .iter()
            .zip(&*now)
            .position(|(old, new)| old.value * new.value < 0.0)?;
        let system = self.step.system();
        let element = system.guarded(GuardKind::Touch)[index];
        Some((system.first_wheel[element]?, now[index].value > 0.0))
    }

    /// Notes a strike at the end of the step if it is the first.
    fn note_strike(&mut self, by: StruckBy) {
        self.strike.get_or_insert(FirstImpact {
            time: self.step.to.t,
            by,
        });
    }

    /// Fraction of the step at which a freely rolling wheel meets a break; stores the wheel in `meets`.
    fn rolling_break(&mut self, slack: f64) -> Option<f64> {
        let (fraction, wheel) = rolling_break(&mut self.step, slack)?;
        self.meets = Some(wheel);
        Some(fraction)
    }

    /// Distance before a break of a rail, relative to 1 + |x|, within which a step that ends there may end.
    pub fn break_slack(&self) -> f64 {
        break_slack(self.size.tolerance, self.size.fixed.is_some())
    }

    /// Accepts the step of length `h`, in this order. First the energy exchanged is added to the audit at the state
    /// that the step reached. Then this state is changed to the start of the next step: prescribed motions pass their
    /// break, wheels pass joints and corners of their rails, and the active elements are determined again if one must
    /// switch. Finally the audit of the step is completed.
    fn accept(&mut self, h: f64) -> Result<(), Error> {
        self.counts.steps += 1;
        self.has_switched = false;
        self.bounces += self.step.bounces * h / self.step.system().scene.end;
        self.step.arrived.copy_from(&self.step.to);
        self.force_scale = self.largest_force();
        self.wheel_forces.grow(&self.step.to.force);
        let touched = self.touched();
        let mut cause = touched.map_or(GapCause::Step, |(wheel, _)| GapCause::Flange(wheel));
        if let Some((wheel, true)) = touched {
            self.note_strike(StruckBy::Flange(wheel));
        }
        let exchanged = self.step.exchanged(h);
        self.books
            .book_step(self.step.solver, &exchanged, &self.step.to);
        self.step.reach_end()?;
        self.size.grow(&self.step.to);
        if self.step.to.t >= self.limit {
            cause = GapCause::Break;
            self.ending = None;
            self.pass_break()?;
        }
        let by_joint = self.pass_joint()?;
        self.books.book_rail(by_joint);
        let before = self.stored();
        let system = self.step.system();
        let has_crossed =
            system.traits.is_uneven && pass_corners(self.step.solver, &mut self.step.to)?;
        let mut after = before;
        if has_crossed || self.is_switch_due() {
            self.ending = None;
            let active = self.step.solver.active().flags().to_vec();
            let Step { solver, to, .. } = &mut self.step;
            if !has_crossed {
                solver.take_rates_from_forces(to);
            }
            let is_settled = has_crossed && settle_jump(solver, to)? || settle(solver, to)?;
            if is_settled {
                let now = self.step.solver.active().flags();
                self.has_switched = active != now;
                self.counts.events += usize::from(self.has_switched);
                let switched = (0..now.len()).find(|&i| active[i] != now[i]);
                let met = (0..now.len())
                    .filter(|&i| now[i] && !active[i])
                    .find_map(|i| system.stop(i));
                if let Some(stop) = met {
                    self.note_strike(StruckBy::Stop(stop));
                }
                cause = switched
                    .and_then(|i| system.first_wheel[i])
                    .map_or(cause, GapCause::Contact);
                after = self.stored();
                let gained = after.total() - before.total();
                if has_crossed {
                    self.books.book_rail(gained)
                } else {
                    self.books.book_switch(-gained)
                }
            }
        }
        self.books
            .close_step(self.step.solver, &self.step.to, after, cause);
        let Step { solver, to, .. } = &self.step;
        self.touches = self
            .ending
            .take()
            .unwrap_or_else(|| guards(solver, GuardKind::Touch, to));
        self.step.note_start();
        Ok(())
    }

    /// Whether an element must become active or inactive at the end of the step.
    fn is_switch_due(&self) -> bool {
        let (solver, to) = (&*self.step.solver, &self.step.to);
        let system = solver.system();
        let has_let_go =
            (0..system.verticals()).any(|i| solver.active().has(i) && solver.opens(i, to));
        has_let_go || solver.next_switch(0, to).is_some()
    }

    /// Energy stored at the end of the step.
    fn stored(&self) -> Stored {
        stored(
            self.step.system(),
            self.step.solver.geometry(),
            &self.step.to,
        )
    }

    /// Time around an event in which forces need not keep the accuracy, accuracy x 2 pi sqrt(m/k), for the contact for
    /// which it is shortest.
    fn window(&self) -> f64 {
        ASKED * self.size.tolerance * period(self.step.solver, &self.step.to)
    }

    /// Time after an event in which the errors of forces are not judged.
    fn instant(&self) -> f64 {
        INSTANT * ASKED * self.size.tolerance * self.period
    }

    /// Passes a break of the prescribed motions. The change of kinetic energy by a jump of speed is the work of these
    /// motions; the accelerations are recomputed for the time after the break.
    fn pass_break(&mut self) -> Result<(), Error> {
        let after = self.stored().kinetic;
        let t = self.step.to.t;
        self.step.to.t = t.next_down();
        let before = self.stored().kinetic;
        self.step.to.t = t;
        self.books.book_jump(after - before);
        self.step.solver.instant(&mut self.step.to)?;
        Ok(())
    }

    /// Moves a wheel that has reached a joint of a rail with compliance along x to the next part of the rail. The
    /// same forces have displaced that part along x by a different amount, so the longitudinal displacement jumps,
    /// without any sliding. The longitudinal force then acts on the new part, so the deflection of the rail below all
    /// wheels jumps as well, by Maxwell's theorem with the same work, and the penetrations are changed by the jump.
    /// Returns the energy supplied.
    fn pass_joint(&mut self) -> Result<f64, Error> {
        let slack = self.break_slack();
        let Step { solver, to, .. } = &mut self.step;
        let system = solver.system();
        let Some(w) = self
            .meets
            .take()
            .filter(|_| system.mechanics.has_sliding_rails())
        else {
            return Ok(0.0);
        };
        let speed = system.mechanics.speed_along(w, to);
        let Some(near) = at_break(solver, w, to, slack).filter(|_| speed != 0.0) else {
            return Ok(0.0);
        };
        let before = stored(system, solver.geometry(), to);
        let felt: Vec<usize> = (0..system.verticals())
            .filter(|&i| solver.remembers(i))
            .collect();
        for &i in &felt {
            to.p[i] += solver.geometry().deflection(i, &to.force);
        }
        // The path of the next step serves for the place beyond the joint. Other structures keep theirs.
        let contact = system.mechanics.wheels[w].contact;
        let structure = system.scene.contacts[contact].structure;
        solver.begin_path(structure);
        self.passed_joint = Some(structure);
        let usual = self.size.planned(1.0, f64::INFINITY);
        self.step.set_paths(
            PathStart::StepEnd,
            [usual * self.step.lengths_of(false)[0], usual],
        );
        let Step {
            solver, to, probe, ..
        } = &mut self.step;
        probe.q.copy_from(&to.q);
        probe.q.axpy(near / speed.abs(), &to.v, 1.0);
        solver.update_to(to, &probe.q)?;
        for i in felt {
            to.p[i] -= solver.geometry().deflection(i, &to.force);
        }
        solver.move_rails(to);
        Ok(stored(system, solver.geometry(), to).total() - before.total())
    }

    /// Largest contact force so far, including the end of the current step.
    fn largest_force(&self) -> f64 {
        self.step
            .to
            .force
            .iter()
            .fold(self.force_scale, |max, force| max.max(force.abs()))
    }

    /// Rules whose conditions are met at the end of the last step.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn due(&mut self) -> Result<Vec<usize>, Error> {
        self.triggers.due(&self.step)
    }

    /// Executes the rules that are `due`, and then those whose conditions are met as a result; adds the energy change
    /// by switching to the audit. Returns the rules, and whether the run ends.
    ///
    /// # Errors
    /// Any error from evaluating the rails, and [`Error::NoEquilibrium`] if no consistent contact forces are found.
    pub fn act(&mut self, mut due: Vec<usize>) -> Result<(Vec<Fired>, bool), Error> {
        let scene = self.step.system().scene;
        let (mut fired, mut ends) = (Vec::new(), false);
        while !due.is_empty() {
            self.step.solver.instant(&mut self.step.to)?;
            let (before, time) = (self.stored(), self.step.to.t);
            for &rule in &due {
                self.triggers.take(rule);
                fired.push(Fired { time, rule });
                for action in &scene.actuators.rules[rule].actions {
                    ends |= self.step.solver.switch(*action, time)?;
                }
            }
            if !settle(self.step.solver, &mut self.step.to)? {
                return Err(Error::NoEquilibrium { time, fall: None });
            }
            let after = self.stored();
            self.books.book_switch(before.total() - after.total());
            self.books.turn_page(self.step.solver, &self.step.to, after);
            due = self.due()?;
        }
        self.step.note_start();
        Ok((fired, ends))
    }
}

/// Shortest period 2 pi sqrt(m/k) of the wheels that press at `at` by more than rounding, with m g the force of a wheel and k the
/// slope of its law; infinite if none presses.
fn period(solver: &Solver, at: &State) -> f64 {
    let system = solver.system();
    let weight = |i: usize| at.force[i] / system.scene.gravity.max(f64::MIN_POSITIVE);
    let period = |i: usize| {
        let [_, stiffness, _] = solver.law_of(i, at.p[i], 0.0);
        (weight(i).max(0.0) / stiffness).sqrt()
    };
    let verticals = 0..system.verticals();
    let rounding = rounding_among(at.force[verticals.clone()].iter().copied());
    let pressed = verticals.filter(|&i| at.force[i] > rounding).map(period);
    TAU * pressed.fold(f64::INFINITY, f64::min)
}
