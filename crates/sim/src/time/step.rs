//! One step: its ends, the method that takes it, and evaluation inside it.

use super::collocation::Collocation;
use super::nodes::Nodes;
use super::sdirk::Sdirk;
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::{Error, Exchanged, Method};

/// Number of step lengths covered by the path along which the compliance is interpolated.
const PATH: f64 = 4.0;

/// A method of integration with its working memory.
enum Integrator {
    Sdirk(Box<Sdirk>),
    Collocation(Box<Collocation>),
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
    /// Working memory for the end of a path.
    beyond: State,
}

impl<'a, 'b> Step<'a, 'b> {
    /// Creates steps from `start` by `method`, which must suit the scene.
    pub fn new(solver: &'b mut Solver<'a>, start: State, method: Method) -> Self {
        let system = solver.system();
        let integrator = match Nodes::new(method) {
            Some(nodes) => Integrator::Collocation(Box::new(Collocation::new(system, nodes, &start))),
            None => Integrator::Sdirk(Box::new(Sdirk::new(system, &start))),
        };
        Step {
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

    /// Length of the step.
    pub fn length(&self) -> f64 {
        self.to.t - self.from.t
    }

    /// Starts the next step at the end of this one.
    pub fn begin(&mut self) {
        self.from.copy_from(&self.to);
    }

    /// Takes a step of length `h` with the active elements, which ends at `limit` at the latest; returns false if it
    /// does not converge. `stages` counts the stages.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn attempt(&mut self, h: f64, limit: f64, stages: &mut usize) -> Result<bool, Error> {
        let has_converged = match &mut self.integrator {
            Integrator::Collocation(collocation) => {
                *stages += collocation.count();
                let done = collocation.attempt(self.solver, &self.from, h, limit, &mut self.to)?;
                self.geometry_time = self.to.t;
                done
            }
            Integrator::Sdirk(sdirk) => {
                let done = sdirk.attempt(self.solver, &self.from, h, limit, (&mut self.to, stages))?;
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

    /// Length `h`, reduced to a power of 2^(1/4) if modal responses are stored by step length.
    pub fn rounded(&self, h: f64) -> f64 {
        match &self.integrator {
            Integrator::Collocation(collocation) if collocation.is_modal() => {
                ((4.0 * h.log2() + 1e-9).floor() / 4.0).exp2()
            }
            _ => h,
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
        self.solver.for_errors(&self.to, of, |k, errors| largest = largest.max(weigh(k, errors)));
        largest
    }

    /// Energy exchanged in the step just taken, of length `h`.
    pub fn exchanged(&self, h: f64) -> Exchanged {
        match &self.integrator {
            Integrator::Collocation(collocation) => collocation.exchanged(),
            Integrator::Sdirk(sdirk) => sdirk.exchanged(h),
        }
    }

    /// Sets `at` to the interpolant of the step just taken, at the given fraction.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn sample(&mut self, fraction: f64, at: &mut State) -> Result<(), Error> {
        self.solver.interpolate([&self.from, &self.arrived], fraction, at)?;
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
        self.probe.copy_from(&self.to);
        self.solver.interpolate([&self.from, &self.to], fraction, &mut self.probe)?;
        if let Integrator::Collocation(collocation) = &self.integrator {
            collocation.interpolate(&self.from, fraction, &mut self.probe);
        }
        self.solver.instant(&mut self.probe)
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
        let has_grounded = system.scene.wheels.iter().any(|wheel| wheel.normal.is_grounded());
        if has_grounded && !is_there { self.solver.update(&self.to) } else { Ok(()) }
    }

    /// Sets the paths of the wheels in a step of length `h` and the following ones, extrapolated with the
    /// accelerations at the start of the step.
    pub fn set_paths(&mut self, h: f64) {
        if !self.solver.wants_paths() {
            return;
        }
        let (from, to, beyond) = (&self.from, &mut self.probe, &mut self.beyond);
        for (h, at) in [(h, &mut *to), (PATH * h, &mut *beyond)] {
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
