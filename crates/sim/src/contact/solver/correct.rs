//! Corrections of a stage with matrices that were factored in an earlier pass of the same step.
//!
//! This is Newton's method with a frozen Jacobian. The residuals are those of the stage itself,
//! r_a = M a + C v + K q + B^T F - f at (q, v) = (q*, v*) + g (v, a), r_F = F - law(p, r),
//! and the matrices Z, W and J = I + F_p W + F_r Y are those of the earlier pass:
//!
//! a <- a - Z r_a,   dF = -J^-1 r_F,   F <- F + dF,   a <- a - Z B^T dF.
//!
//! A correction reduces the error by a factor of the order of the change of the matrices since they were factored. It
//! costs a few matrix-vector products. The geometry is evaluated in the first correction of a stage, and again only
//! where [`Geometry::nearness`] says that the bodies have moved far: from one correction to the next they move by some
//! 1e-9 of the radius of a wheel. Where they are close, the rows of the forces alone follow the slopes of the rails.
//!
//! # Source
//! Hairer, Wanner, Solving Ordinary Differential Equations II (1996), section IV.8: simplified Newton iterations.

use super::Solver;
use crate::Error;
use crate::contact::element::passing;
use crate::contact::forces::ActingLaws;
#[cfg(doc)]
use crate::contact::geometry::Geometry;
use crate::contact::geometry::Nearness;
use crate::mechanics::state::{Known, State};

impl Solver<'_> {
    /// Whether a stage with coefficient `g` may be corrected: the matrices for `g` are factored, and the step has no
    /// charts.
    pub(super) fn may_correct(&self, g: f64) -> bool {
        let is_factored = self.factored_for == Some(g) && self.problem.is_factored();
        is_factored && self.charts.is_empty()
    }

    /// Corrects the stage at `at`. Returns the largest change of the degrees of freedom relative to themselves, the
    /// largest change of degrees of freedom and forces relative to their scales, and which laws act; if `holds` is true, those
    /// of the last pass. Returns `None` if their Jacobian is singular; then only the free motion has been improved.
    pub(super) fn correct(
        &mut self,
        g: f64,
        known: &Known,
        at: &mut State,
        holds: bool,
    ) -> Result<Option<([f64; 2], ActingLaws)>, Error> {
        let system = self.system;
        match self.nearness(at) {
            Nearness::Near => {}
            Nearness::Close => {
                self.geometry
                    .turn_forces(system, &at.q, &at.force, &self.problem.candidates);
            }
            Nearness::Far => {
                self.evaluate_at(at)?;
                self.free.fill_given(system, at);
            }
        }
        let rows = self.geometry.rows();
        self.free
            .improve(system, g, known, at, self.projection.columns(), |j| {
                rows.force_row(j)
            });
        self.reach(g, &known.p, at);
        let (local, active) = (self.geometry.local(), self.active.flags());
        let Some((change, laws)) = self
            .problem
            .corrections(system, local, active, &at.force, holds)
        else {
            return Ok(None);
        };
        let size = at
            .force
            .iter()
            .fold(f64::MIN_POSITIVE, |max, force| force.abs().max(max));
        let largest = change
            .iter()
            .fold(0.0_f64, |max, change| change.abs().max(max));
        at.force
            .iter_mut()
            .zip(change)
            .for_each(|(force, change)| *force -= change);
        self.projection
            .add_forces(&self.free.a, 1.0, change, &mut at.a);
        let [moved, beside] = self.arrive(g, known, at, |solver, i, at| {
            solver.geometry.penetration(i, at)
        });
        Ok(Some(([moved, beside.max(largest / size)], laws)))
    }

    /// Computes penetrations and rates of the elements of the problem for the free motion under the forces of `at`.
    fn reach(&mut self, g: f64, known: &[f64], at: &State) {
        let system = self.system;
        for k in 0..self.problem.sought.len() {
            let i = self.problem.sought[k];
            let fixed = system.fixed[i];
            let deflection = self.geometry.deflection(i, &at.force) - self.geometry.drift(i);
            let penetration = self.geometry.approach(i, &self.free.q) - deflection;
            let mut rate = 0.0;
            if self.follows_motion(i) {
                rate = self.free_approach_rate(i, system.contact_speed(i, at));
            } else if self.remembers(i) {
                rate = (penetration - known[i]) / g;
            } else if fixed.feels_rates {
                rate = self.geometry.rate(i, &self.free.v);
            }
            if fixed.is_tangential
                && let Some(slot) = system.probes.slots[i]
            {
                rate -= (deflection - known[slot]) / g;
                let rails = self.geometry.rails();
                rate += passing(&system.mechanics, &system.probes, rails, at, i);
            }
            self.problem.set_reached(i, [penetration, rate]);
        }
    }
}
