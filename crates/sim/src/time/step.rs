//! One step: its ends, the method that takes it, and evaluation inside it.

use super::collocation::Collocation;
use super::nodes::Nodes;
use super::penetrations::Penetrations;
use super::sdirk::Sdirk;
use crate::contact::solver::Solver;
use crate::contact::solver::errors::{Ringing, StateErrors};
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::{Error, Exchanged, Method};

/// Largest number of step lengths covered by the path along which the compliance is interpolated.
const PATH: f64 = 8.0;

/// Largest tolerance of a step of collocation for the errors of forces: at larger ones these errors are not yet proportional
/// to powers of the step.
const LOOSEST: f64 = 8e-3;

/// Power of the step length with which the errors of collocation are taken to decrease.
const ERROR_POWER: f64 = 4.0;

/// Number of bounces of a wheel up to which the errors of their forces may add up.
pub(crate) const BOUNCES: f64 = 100.0;

/// Time in which a penetration under a damper between wheel and rail follows its force, per step, below which it has no
/// error of its own.
const QUICK: f64 = 0.25;

/// Number of these times after a break or an event at which penetrations have settled.
const SETTLED: f64 = 12.0;

/// A method of integration with its working memory.
enum Integrator {
    Sdirk(Box<Sdirk>),
    Collocation(Box<Collocation>),
}

/// Where paths of wheels begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PathStart {
    /// At the start of the step.
    StepStart,
    /// At its end, where the next step begins.
    StepEnd,
}

/// A step from `from` to `to`.
pub(crate) struct Step<'a, 'b> {
    pub solver: &'b mut Solver<'a>,
    pub from: State,
    pub to: State,
    /// The end of the step before a break or an event changed its forces.
    pub arrived: State,
    /// The state evaluated last inside the step.
    pub probe: State,
    integrator: Integrator,
    /// Time of the geometry of the solver after the step.
    geometry_time: f64,
    /// Number of bounces in the whole run over which errors would add up if all were as in the step just taken.
    pub bounces: f64,
    /// Working memory for the end of a path.
    beyond: State,
    errors: Errors,
    /// Time of the last break or event.
    pub last_jump: f64,
    /// Shortest time in which a penetration follows its force for which this is resolved after a break or an event.
    pub shortest_delay: f64,
    /// Whether the step just taken begins neither at a break nor at an event.
    pub begins_smoothly: bool,
    /// Whether it ends neither at a break nor at an event.
    pub ends_smoothly: bool,
    /// Whether a rail was displaced along itself at once in the step before it.
    has_snapped: bool,
    /// Penetrations in the step just taken, known from its first sample on.
    penetrations: Penetrations,
}

/// Working memory for the errors of a step: of displacements, speeds, penetration rates and forces.
struct Errors {
    q: Vec<f64>,
    v: Vec<f64>,
    rate: Vec<f64>,
    force: Vec<f64>,
    /// Frequencies of the degrees of freedom.
    frequency: Vec<f64>,
    /// Free vibrations of the natural modes among them.
    ringing: Vec<Ringing>,
}

impl<'a, 'b> Step<'a, 'b> {
    /// Creates steps from `start` by `method`, which must suit the scene.
    pub fn new(solver: &'b mut Solver<'a>, start: State, method: Method) -> Self {
        let system = solver.system();
        let integrator = match Nodes::new(method, system.traits.has_memory) {
            Some(nodes) => {
                Integrator::Collocation(Box::new(Collocation::new(system, nodes, &start)))
            }
            None => Integrator::Sdirk(Box::new(Sdirk::new(system, &start, method))),
        };
        let zeros = |count: usize| vec![0.0; count];
        let errors = Errors {
            q: zeros(start.q.len()),
            v: zeros(start.v.len()),
            rate: zeros(system.verticals()),
            force: zeros(start.force.len()),
            frequency: zeros(start.q.len()),
            ringing: vec![Ringing::default(); start.q.len()],
        };
        Step {
            errors,
            bounces: 0.0,
            last_jump: start.t,
            shortest_delay: 0.0,
            begins_smoothly: false,
            ends_smoothly: false,
            has_snapped: false,
            penetrations: Penetrations::default(),
            from: start.clone(),
            arrived: start.clone(),
            probe: start.clone(),
            beyond: start.clone(),
            geometry_time: start.t,
            to: start,
            integrator,
            solver,
        }
    }

    /// The numbered system.
    pub fn system(&self) -> &'a System<'a> {
        self.solver.system()
    }

    /// Whether the method is a collocation method.
    pub fn is_collocation(&self) -> bool {
        matches!(self.integrator, Integrator::Collocation(_))
    }

    /// Whether the method is a collocation method, and natural modes move by their propagators.
    pub fn propagates_modes(&self) -> bool {
        matches!(&self.integrator, Integrator::Collocation(collocation) if collocation.is_modal())
    }

    /// Length of the step.
    pub fn length(&self) -> f64 {
        self.to.t - self.from.t
    }

    /// Whether a damper acts between an active wheel and its rail.
    pub fn has_damped_rails(&self) -> bool {
        (0..self.system().verticals()).any(|i| self.solver.remembers(i))
    }

    /// Starts the next step at the end of this one.
    pub fn begin(&mut self) {
        self.penetrations.forget();
        self.has_snapped = self.solver.snaps([&self.from, &self.to]);
        self.from.copy_from(&self.to);
    }

    /// Whether the rates at the start of the step are those of a motion that steps resolve.
    fn starts_from_rates(&self) -> bool {
        self.begins_smoothly && !self.has_snapped
    }

    /// Takes a step of length `h` with the active elements, which ends at `limit` at the latest; returns false if it
    /// does not converge. `stages` counts the stages.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn attempt(&mut self, h: f64, limit: f64, stages: &mut usize) -> Result<bool, Error> {
        let how = (limit, self.starts_from_rates());
        let has_converged = match &mut self.integrator {
            Integrator::Collocation(collocation) => {
                *stages += collocation.count();
                let done = collocation.attempt(self.solver, &self.from, h, limit, &mut self.to)?;
                self.geometry_time = self.to.t;
                done
            }
            Integrator::Sdirk(sdirk) => {
                let done =
                    sdirk.attempt(self.solver, &self.from, h, how, (&mut self.to, stages))?;
                self.geometry_time = sdirk.time();
                done
            }
        };
        if has_converged || self.is_collocation() {
            self.to.t = (self.from.t + h).min(limit);
            if limit - self.to.t < 1e-14 * limit {
                self.to.t = limit;
            }
        }
        Ok(has_converged)
    }

    /// Length of the step, relative to one that begins smoothly with the same error, and the power of the length with which its
    /// estimated error decreases.
    pub fn lengths(&self) -> [f64; 2] {
        self.lengths_of(self.starts_from_rates())
    }

    /// The same of a step that `begins_smoothly`, or after a break or an event.
    pub fn lengths_of(&self, begins_smoothly: bool) -> [f64; 2] {
        match &self.integrator {
            Integrator::Sdirk(sdirk) => sdirk.lengths(begins_smoothly),
            Integrator::Collocation(_) => [1.0, ERROR_POWER],
        }
    }

    /// Largest tolerance of a step for the errors of forces.
    pub fn loosest(&self) -> f64 {
        match &self.integrator {
            Integrator::Sdirk(sdirk) => sdirk.loosest(),
            Integrator::Collocation(_) => LOOSEST,
        }
    }

    /// Notes that the next step starts at the end of this one, to which the geometry of the solver must belong.
    pub fn note_start(&mut self) {
        if let Integrator::Sdirk(sdirk) = &mut self.integrator {
            sdirk.note_start(self.solver, &self.to);
        }
    }

    /// Length `h`, reduced to a power of 2^(1/4) if modal responses are stored by step length.
    pub fn rounded(&self, h: f64) -> f64 {
        if self.propagates_modes() {
            ((4.0 * h.log2() + 1e-9).floor() / 4.0).exp2()
        } else {
            h
        }
    }

    /// Embedded error of the step just taken: the largest value of `weigh` over the degrees of freedom. Its arguments
    /// are the number of the degree of freedom and the errors of displacement and speed per unit of step length.
    pub fn error(&self, weigh: impl Fn(usize, [f64; 2]) -> f64) -> f64 {
        let (h, mut largest) = (self.length(), 0.0_f64);
        let of = |k: usize| match &self.integrator {
            Integrator::Collocation(collocation) => collocation.error(k).map(|error| error / h),
            Integrator::Sdirk(sdirk) => sdirk.error(k),
        };
        self.solver.for_errors(&self.to, of, |k, errors| {
            largest = largest.max(weigh(k, errors))
        });
        largest
    }

    /// Errors of the forces of the elements at the end of the step just taken, which follow from the embedded errors
    /// of the degrees of freedom. Those of bodies count for every bounce over which they add up, at most [`BOUNCES`], and
    /// those of natural modes for every period.
    pub fn force_errors(&mut self) -> &[f64] {
        let (h, end) = (self.length(), self.system().scene.end);
        let Step {
            solver,
            from,
            to,
            integrator,
            errors,
            bounces: total,
            ..
        } = self;
        let Errors {
            q,
            v,
            rate,
            force,
            frequency,
            ringing,
        } = errors;
        let of = |k: usize| match &*integrator {
            Integrator::Collocation(collocation) => collocation.error(k),
            Integrator::Sdirk(sdirk) => sdirk.error(k).map(|error| h * error),
        };
        solver.for_errors(to, of, |k, [dq, dv]| (q[k], v[k]) = (dq, dv));
        for (i, rate) in rate.iter_mut().enumerate() {
            let delay = if solver.remembers(i) {
                solver.delay(i, to)
            } else {
                0.0
            };
            let is_settling =
                delay > self.shortest_delay && from.t - self.last_jump < SETTLED * delay;
            *rate = match &*integrator {
                Integrator::Sdirk(sdirk) if is_settling || delay > QUICK * h => sdirk.rate_error(i),
                Integrator::Collocation(collocation) if is_settling => {
                    collocation.rate_error(from, i)
                }
                _ => 0.0,
            };
        }
        *total = solver.bounces(to, end, frequency);
        let bounces = total.min(BOUNCES);
        let is_staged = matches!(integrator, Integrator::Sdirk(_));
        solver.ringing([&*from, &*to], end, is_staged, ringing);
        let errors = StateErrors {
            at: to,
            h,
            is_staged,
            q,
            v,
            rate,
            frequency,
            bounces,
            ringing,
        };
        if !solver.force_errors(&errors, force) {
            force.fill(f64::INFINITY);
        }
        force
    }

    /// The first place before the end of the step just taken at which a vertical contact must open or close by more than
    /// `slack`, as a fraction of the step, and by which force: a wheel may leave its rail, or meet it, for less than a step.
    pub fn passed_switch(&self, slack: f64) -> Option<(f64, f64)> {
        let first = |places: &mut dyn Iterator<Item = (f64, f64)>| {
            let passed = places.filter(|(share, excess)| *share < 1.0 && *excess > slack);
            passed.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        match &self.integrator {
            Integrator::Collocation(collocation) => {
                first(&mut collocation.excesses(self.solver).into_iter())
            }
            Integrator::Sdirk(sdirk) => first(&mut sdirk.excesses()),
        }
    }

    /// The method, where natural modes move by their propagators.
    pub fn propagated(&self) -> Option<&Collocation> {
        match &self.integrator {
            Integrator::Collocation(own) if own.is_modal() => Some(own),
            _ => None,
        }
    }

    /// Energy exchanged in the step just taken, of length `h`.
    pub fn exchanged(&self, h: f64) -> Exchanged {
        match &self.integrator {
            Integrator::Collocation(collocation) => collocation.exchanged(),
            Integrator::Sdirk(sdirk) => sdirk.exchanged(h),
        }
    }

    /// Sets `at` to the interpolant of the step just taken, at the given fraction. The rates of penetrations under
    /// dampers between wheel and rail follow from the motion ([`Penetrations`]); returns whether all penetrations do.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn sample(&mut self, fraction: f64, at: &mut State) -> Result<bool, Error> {
        if !self.penetrations.is_known() {
            self.find_penetrations(at)?;
        }
        self.interpolate(fraction, at)?;
        self.penetrations.set_rates(self.solver, fraction, at)
    }

    /// Sets the forces of a sample all of whose penetrations follow from the motion; returns whether they are found.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn apply_laws(&mut self, at: &mut State) -> Result<bool, Error> {
        self.penetrations.apply_laws(self.solver, at)
    }

    /// Replaces forces, accelerations and rates at the start, which are those before the break of a rail, by those of `behind` it,
    /// so that the motion in the step just taken is interpolated between values of one side.
    pub fn begin_behind_break(&mut self, behind: &State) {
        self.from.a.copy_from(&behind.a);
        self.from.p_rate.copy_from_slice(&behind.p_rate);
        self.from.force.copy_from_slice(&behind.force);
        self.penetrations.forget();
    }

    /// Finds the penetrations in the step just taken; `at` is overwritten.
    fn find_penetrations(&mut self, at: &mut State) -> Result<(), Error> {
        let settled = if self.begins_smoothly {
            f64::INFINITY
        } else {
            self.shortest_delay
        };
        // at a break rates jump, and natural modes that move by their propagators may have many periods in a step
        let is_even = self.begins_smoothly && self.ends_smoothly && !self.propagates_modes();
        let h = self.length();
        self.penetrations
            .begin(self.solver, &self.from, h, (settled, is_even));
        for fraction in self.penetrations.fractions() {
            self.interpolate(fraction, at)?;
            self.penetrations.add(self.solver, at)?;
        }
        self.penetrations.solve(self.solver);
        Ok(())
    }

    /// Sets `at` to the interpolating polynomials of the step just taken; collocation has its own for the motion.
    fn interpolate(&mut self, fraction: f64, at: &mut State) -> Result<(), Error> {
        self.solver
            .interpolate([&self.from, &self.arrived], fraction, at)?;
        if let Integrator::Collocation(collocation) = &self.integrator {
            collocation.interpolate(&self.from, fraction, at);
        }
        Ok(())
    }

    /// Sets `probe` to the state at a fraction of the step just tried and solves its forces; returns whether they
    /// converged.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn look_at(&mut self, fraction: f64) -> Result<bool, Error> {
        self.look_within(fraction, [0.0; 2])
    }

    /// As [`Step::look_at`], where the forces and the heights of the wheels may err by the `slack`
    /// ([`Solver::instant_within`]).
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn look_within(&mut self, fraction: f64, slack: [f64; 2]) -> Result<bool, Error> {
        self.probe.copy_from(&self.to);
        self.solver
            .interpolate([&self.from, &self.to], fraction, &mut self.probe)?;
        if let Integrator::Collocation(collocation) = &self.integrator {
            collocation.interpolate(&self.from, fraction, &mut self.probe);
        }
        self.solver.instant_within(&mut self.probe, slack)
    }

    /// Resets the geometry of the solver to the end of the step, after states inside the step were evaluated.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn return_to_end(&mut self) -> Result<(), Error> {
        self.probe.copy_from(&self.to);
        self.solver.instant(&mut self.probe)?;
        Ok(())
    }

    /// Updates the geometry of dampers to ground to the end of the step. It is already there if the rows are constant
    /// and the last stage was not moved to just before a limit.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn reach_end(&mut self) -> Result<(), Error> {
        let system = self.system();
        let is_there = system.traits.has_constant_rows && self.geometry_time == self.to.t;
        let has_grounded = system
            .scene
            .wheels
            .iter()
            .any(|wheel| wheel.normal.is_grounded());
        if has_grounded && !is_there {
            self.solver.update(&self.to)
        } else {
            Ok(())
        }
    }

    /// Sets the paths of the wheels in a step of length `h` and in those that follow it, of the length `usual`, from `start`,
    /// which is the start of the step, or the end of the step before it. They are extrapolated with the accelerations there.
    pub fn set_paths(&mut self, start: PathStart, [h, usual]: [f64; 2]) {
        if !self.solver.wants_paths() {
            return;
        }
        let from = match start {
            PathStart::StepStart => &self.from,
            PathStart::StepEnd => &self.to,
        };
        let (to, beyond) = (&mut self.probe, &mut self.beyond);
        for (h, at) in [(h, &mut *to), (PATH * usual.max(h), &mut *beyond)] {
            extrapolate(from, h, at);
        }
        let ends = [from, &*to, &*beyond].map(|at| (at.t, &at.q));
        self.solver.set_paths(ends);
    }

    /// Sets `to` to an estimate of the end of a step of length `h`, extrapolated with the accelerations at the start.
    pub fn guess_end(&mut self, h: f64) {
        extrapolate(&self.from, h, &mut self.to);
        self.to.v.copy_from(&self.from.v);
        self.to.v.axpy(h, &self.from.a, 1.0);
    }
}

/// Sets time and displacements of `at` to those extrapolated from `from` over the time `h`, with its accelerations.
fn extrapolate(from: &State, h: f64, at: &mut State) {
    at.t = from.t + h;
    at.q.copy_from(&from.q);
    at.q.axpy(h, &from.v, 1.0);
    at.q.axpy(0.5 * h * h, &from.a, 1.0);
}

#[cfg(test)]
mod tests;
