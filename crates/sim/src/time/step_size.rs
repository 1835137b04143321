//! Step size control.
//!
//! The error of a step is the largest embedded error of all displacements and speeds, each divided by its scale. The
//! scale of a displacement is its largest value so far, and at least the penetration at rest divided by the lever arm
//! of the degree of freedom; the scale of a speed is its largest value so far, and at least the least scale of the
//! displacement times the bounce frequency. Let e be the error divided by the tolerance. A step with e > 1 is
//! rejected and repeated with 0.9 e^(-1/k) of its length, where k is the power of the length with which e decreases.
//! Otherwise the next step is 0.9 e^(-0.7/k) e_last^(0.4/k) times as long, where the factor is limited to the range from 1/5
//! to 5. After breaks and events a step of another method may follow: lengths are planned for steps that begin smoothly, and
//! those of other steps are in a constant ratio to them.
//!
//! # Source
//! Hairer, Wanner, Solving Ordinary Differential Equations II (1996), section IV.2: a PI controller of step sizes.

use nalgebra::DVector;

use crate::contact::solver::Solver;
use crate::mechanics::state::State;

/// Controller of the step size.
pub(crate) struct StepSize {
    /// Relative error allowed in a step.
    pub tolerance: f64,
    /// Length of every step that does not end at a break or an event, if the step is fixed; the tolerance is then not
    /// used.
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
    /// Creates a controller for a run from `start`, whose first step has the length `first`.
    pub fn new(
        solver: &Solver,
        start: &State,
        tolerance: f64,
        fixed: Option<f64>,
        first: f64,
    ) -> Self {
        let wheels = &solver.system().scene.wheels;
        let (scale, rate_scale) = least_scales(solver, start);
        StepSize {
            tolerance,
            fixed,
            h: first,
            last_error: 1.0,
            scale,
            rate_scale,
            radius: wheels
                .iter()
                .fold(f64::INFINITY, |min, wheel| min.min(wheel.radius)),
        }
    }

    /// Passes the tolerance and the scales to the solver, which adapts to them the accuracy of the stage solutions
    /// and of the compliance. Fixed steps have no tolerance, and nothing is passed.
    pub fn set_accuracy(&self, solver: &mut Solver) {
        if self.fixed.is_none() {
            solver.set_accuracy(self.tolerance, [&self.scale, &self.rate_scale], self.radius);
        }
    }

    /// Planned length of the next step, `share` times that of one that begins smoothly, at most `widest`.
    pub fn planned(&self, share: f64, widest: f64) -> f64 {
        self.fixed.unwrap_or((share * self.h).min(widest))
    }

    /// Length `planned`, limited to the time `left` before a limit. The step is extended to the limit if otherwise
    /// less than a tenth of its length would remain (1e-9 of it for fixed steps).
    pub fn within(&self, planned: f64, left: f64) -> f64 {
        let h = planned.min(left);
        let sliver = if self.fixed.is_some() { 1e-9 } else { 0.1 };
        if left - h < sliver * h { left } else { h }
    }

    /// Larger of the errors of displacement and speed of degree of freedom `k`, relative to their scales, for a step
    /// of length `h` that ended at `to`; `dq` and `dv` are errors per unit of step length.
    #[inline]
    pub fn weigh(&self, to: &State, h: f64, k: usize, [dq, dv]: [f64; 2]) -> f64 {
        let scale = self.scale[k].max(to.q[k].abs());
        let rate_scale = self.rate_scale[k].max(to.v[k].abs());
        (h * dq / scale).abs().max((h * dv / rate_scale).abs())
    }

    /// Length of the next trial after a step of length `h` with error `error` was rejected, where the error decreases with the
    /// given power of the length.
    pub fn shorter(h: f64, error: f64, power: f64) -> f64 {
        h * if error.is_finite() {
            (0.9 * error.powf(-1.0 / power)).clamp(0.1, 0.9)
        } else {
            0.25
        }
    }

    /// Plans the next step after a step of length `h` with error `error`, which was `share` times as long as one that begins
    /// smoothly and whose error decreases with the given `power` of the length; `rounded` reduces a length to one for which the
    /// modal responses are stored.
    pub fn plan(
        &mut self,
        h: f64,
        error: f64,
        [share, power]: [f64; 2],
        rounded: impl Fn(f64) -> f64,
    ) {
        let h = h / share;
        let factor = || 0.9 * error.powf(-0.7 / power) * self.last_error.powf(0.4 / power);
        let growth = if error > 0.0 { factor() } else { 5.0 };
        self.last_error = error.max(1e-4);
        let proposed = h * growth.clamp(0.2, 5.0);
        // A step that was shortened by a limit is no reason to shorten the planned step.
        let wanted = if h < self.h && growth > 1.0 {
            proposed.max(self.h)
        } else {
            proposed
        };
        self.h = rounded(wanted);
    }

    /// Increases the scales to the displacements and speeds at the end of a step.
    pub fn grow(&mut self, to: &State) {
        for k in 0..to.q.len() {
            self.scale[k] = self.scale[k].max(to.q[k].abs());
            self.rate_scale[k] = self.rate_scale[k].max(to.v[k].abs());
        }
    }
}

/// Lower bounds of the scales: the penetration at rest, divided by the lever arm of each degree of freedom, and the
/// speed of an oscillation of this amplitude at the bounce frequency.
fn least_scales(solver: &Solver, start: &State) -> (DVector<f64>, DVector<f64>) {
    let system = solver.system();
    let n = system.mechanics.dofs;
    let depth = start.p[..system.verticals()]
        .iter()
        .fold(0.0_f64, |max, p| max.max(*p));
    let radius = system
        .scene
        .wheels
        .iter()
        .fold(1.0_f64, |max, wheel| max.max(wheel.radius));
    let depth = if depth > 0.0 { depth } else { 1e-3 * radius };
    let gravity = system.scene.gravity;
    let frequency = if gravity > 0.0 {
        (gravity / depth).sqrt()
    } else {
        1.0
    };
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
