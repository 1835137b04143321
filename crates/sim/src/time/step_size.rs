//! Lengths of steps from their errors.
//!
//! The error of a step is the largest embedded error of a displacement or a speed beside its scale: the largest value
//! so far, at least the penetration at rest carried to each degree of freedom by its lever, and the bounce that
//! belongs to it. A step of error e (by the tolerance) is rejected where e > 1 and followed by one of 0.9 e^(-1/4) of
//! its length; else the next is longer by 0.9 e^(-0.175) e_last^0.1, within a factor of 5.
//!
//! # Source
//! Hairer, Wanner, Solving Ordinary Differential Equations II (1996), section IV.2: a PI controller of step sizes.

use nalgebra::DVector;

use crate::contact::solver::Solver;
use crate::mechanics::state::State;

/// Controls the length of steps.
pub(crate) struct StepSize {
    /// Relative error that a step may make.
    pub tolerance: f64,
    /// Length of every step that no break or event ends; in place of the tolerance.
    pub fixed: Option<f64>,
    /// Length of the next step.
    h: f64,
    last_error: f64,
    /// Scales of displacements and speeds.
    scale: DVector<f64>,
    rate_scale: DVector<f64>,
    /// Radius of the smallest wheel.
    radius: f64,
}

impl StepSize {
    /// Steps from `start`, the first of length `first`.
    pub fn new(solver: &Solver, start: &State, tolerance: f64, fixed: Option<f64>, first: f64) -> Self {
        let wheels = &solver.system().scene.wheels;
        let (scale, rate_scale) = least_scales(solver, start);
        StepSize {
            tolerance,
            fixed,
            h: first,
            last_error: 1.0,
            scale,
            rate_scale,
            radius: wheels.iter().fold(f64::INFINITY, |min, wheel| min.min(wheel.radius)),
        }
    }

    /// Lets the solutions of stages err as far as the tolerance allows, where steps follow it.
    pub fn set_accuracy(&self, solver: &mut Solver) {
        if self.fixed.is_none() {
            solver.set_accuracy(self.tolerance, [&self.scale, &self.rate_scale], self.radius);
        }
    }

    /// Length that is planned for the next step, at most `widest`.
    pub fn planned(&self, widest: f64) -> f64 {
        self.fixed.unwrap_or(self.h.min(widest))
    }

    /// `planned`, cut at `left` before a limit; no sliver is left before it.
    pub fn within(&self, planned: f64, left: f64) -> f64 {
        let h = planned.min(left);
        let sliver = if self.fixed.is_some() { 1e-9 } else { 0.1 };
        if left - h < sliver * h { left } else { h }
    }

    /// Errors of displacement and speed of degree of freedom `k`, per unit of a step of length `h` that ended at `to`,
    /// beside their scales.
    #[inline]
    pub fn weigh(&self, to: &State, h: f64, k: usize, [dq, dv]: [f64; 2]) -> f64 {
        let scale = self.scale[k].max(to.q[k].abs());
        let rate_scale = self.rate_scale[k].max(to.v[k].abs());
        (h * dq / scale).abs().max((h * dv / rate_scale).abs())
    }

    /// Length to try after a step of length `h` and error `error` was rejected.
    pub fn shorter(h: f64, error: f64) -> f64 {
        h * if error.is_finite() { (0.9 * error.powf(-0.25)).clamp(0.1, 0.9) } else { 0.25 }
    }

    /// Plans the next step after one of length `h` and error `error`; `rounded` makes a length one that is known.
    pub fn plan(&mut self, h: f64, error: f64, rounded: impl Fn(f64) -> f64) {
        let growth = if error > 0.0 { 0.9 * error.powf(-0.175) * self.last_error.powf(0.1) } else { 5.0 };
        self.last_error = error.max(1e-4);
        let proposed = h * growth.clamp(0.2, 5.0);
        // A step cut short by a limit says nothing against the longer one that was planned.
        let wanted = if h < self.h && growth > 1.0 { proposed.max(self.h) } else { proposed };
        self.h = rounded(wanted);
    }

    /// Lets the scales grow to the state that a step has reached.
    pub fn grow(&mut self, to: &State) {
        for k in 0..to.q.len() {
            self.scale[k] = self.scale[k].max(to.q[k].abs());
            self.rate_scale[k] = self.rate_scale[k].max(to.v[k].abs());
        }
    }
}

/// Smallest displacements and speeds that the error is measured against: the penetration at rest, carried to each
/// degree of freedom by its lever, and the bounce that belongs to it.
fn least_scales(solver: &Solver, start: &State) -> (DVector<f64>, DVector<f64>) {
    let system = solver.system();
    let n = system.mechanics.dofs;
    let depth = start.p[..system.verticals()].iter().fold(0.0_f64, |max, p| max.max(*p));
    let radius = system.scene.wheels.iter().fold(1.0_f64, |max, wheel| max.max(wheel.radius));
    let depth = if depth > 0.0 { depth } else { 1e-3 * radius };
    let gravity = system.scene.gravity;
    let frequency = if gravity > 0.0 { (gravity / depth).sqrt() } else { 1.0 };
    let rows = solver.geometry().rows();
    let lever = |k: usize| {
        let rows = rows.approach.iter().chain(&rows.rate).skip(k).step_by(n);
        rows.fold(0.0_f64, |max, r| max.max(r.abs()))
    };
    let scale = DVector::from_fn(n, |k, _| {
        let lever = lever(k);
        if lever > 0.0 { depth / lever } else { depth }
    });
    let rates = &scale * frequency;
    (scale, rates)
}
