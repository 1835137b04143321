//! Corrections of a stage by matrices that an earlier pass of the step left factored.
//!
//! Newton's method with a Jacobian that is kept: the residuals are those of the stage itself,
//! r_a = M a + C v + K q + R_f^T F - f at (q, v) = (q*, v*) + g (v, a), r_F = F - law(p, r),
//! and with Z, W and J = I + F_p W + F_r Y of the earlier pass
//!
//! a <- a - Z r_a,   dF = -J^-1 r_F,   F <- F + dF,   a <- a - Z R_f^T dF.
//!
//! A pass leaves as much of an error as the matrices have changed since, and costs a few products of vectors.
//!
//! # Source
//! Hairer, Wanner, Solving Ordinary Differential Equations II (1996), section IV.8: simplified Newton iterations.

use crate::Error;
use crate::contact::drag::passing;
use crate::contact::solver::Solver;
use crate::mechanics::state::{Known, State};
use crate::numerics::dense::{along, dot};

impl Solver<'_> {
    /// Whether a stage of the coefficient `g` may be corrected: matrices of such a stage are factored, of bodies alone.
    pub(crate) fn may_correct(&self, g: f64) -> bool {
        let is_factored = self.factors_of == Some(g) && !self.problem.factored.is_empty();
        is_factored && !self.system.mechanics.has_structures() && self.charts.is_empty()
    }

    /// Corrects the stage at `at`. Returns the largest changes beside the freedoms themselves and beside their scales;
    /// `None` where other laws act than those whose slopes are factored: only the accelerations are better then.
    pub(crate) fn correct(
        &mut self,
        g: f64,
        known: &Known,
        at: &mut State,
    ) -> Result<Option<[f64; 2]>, Error> {
        let system = self.system;
        self.geometry.update(system, at.t, &at.q, &at.force)?;
        self.lack(at);
        for k in 0..system.mechanics.dofs {
            self.free_a[k] = at.a[k] + self.answer[k];
            self.free_v[k] = known.v[k] + g * self.free_a[k];
            self.free_q[k] = known.q[k] + g * self.free_v[k];
        }
        if !self.reach_out(g, &known.p, at) {
            return Ok(None);
        }
        self.problem.answer(system, &self.geometry, &self.active, &at.force);
        if self.problem.acting != self.problem.factored {
            return Ok(None);
        }
        let size = at.force.iter().fold(f64::MIN_POSITIVE, |max, force| force.abs().max(max));
        self.problem.step_back();
        let change = &self.problem.residual;
        self.pressing.clear();
        self.pressing.extend(self.awake.iter().map(|&j| change[j]));
        let largest = change.iter().fold(0.0_f64, |max, change| change.abs().max(max));
        at.force.iter_mut().zip(change).for_each(|(force, change)| *force -= change);
        let count = self.awake.len();
        for (k, a) in at.a.iter_mut().enumerate() {
            *a = self.free_a[k] + dot(&self.spread[k * count..(k + 1) * count], &self.pressing);
        }
        let [moved, beside] = self.arrive(g, known, at, |solver, i, at| {
            solver.geometry.approach(i, &at.q) - along(&solver.geometry.compliance, i, &at.force)
        });
        Ok(Some([moved, beside.max(largest / size)]))
    }

    /// Puts into `answer` what the accelerations of `at` lack: Z (f - M a - R_f^T F).
    fn lack(&mut self, at: &State) {
        let (system, n) = (self.system, self.system.mechanics.dofs);
        self.fill_load(at.t);
        if let Some(fixed) = system.mechanics.blocks[0].body_mass() {
            self.mass.copy_from(fixed);
            if !system.mechanics.carried.is_empty() {
                let sums = (&mut self.mass, &mut self.load);
                system.mechanics.carried.add(
                    &system.mechanics.kinematics,
                    (at.t, &at.q, &at.v),
                    sums,
                    &mut self.columns,
                );
            }
            for (column, a) in self.mass.column_iter().zip(at.a.iter()) {
                self.load.iter_mut().zip(column.iter()).for_each(|(load, mass)| *load -= mass * a);
            }
        }
        for &j in &self.awake {
            let row = &self.geometry.force_rows[j * n..(j + 1) * n];
            let force = at.force[j];
            self.load.iter_mut().zip(row).for_each(|(load, share)| *load -= share * force);
        }
        self.mobility.apply(self.load.as_slice(), self.answer.as_mut_slice());
    }

    /// Penetrations and rates at `free_q`, `free_v` under the forces of `at`; false where a flange touches that is taken as
    /// free.
    fn reach_out(&mut self, g: f64, known: &[f64], at: &State) -> bool {
        let system = self.system;
        let normals = system.mechanics.groups.len();
        for i in 0..at.force.len() {
            let is_lateral = (system.lateral(0)..system.traction(0)).contains(&i);
            if i >= normals && !is_lateral && self.problem.asleep[i] {
                continue;
            }
            let give = along(&self.geometry.compliance, i, &at.force);
            let penetration = self.geometry.approach(i, &self.free_q) - give;
            let mut rate = 0.0;
            if i < normals && self.remembers(i) {
                rate = (penetration - known[i]) / g;
            } else if self.feels_rates(i) {
                rate = self.geometry.rate(i, &self.free_v);
            }
            if system.drags().contains(&i) {
                rate -= (give - known[normals + i - system.traction(0)]) / g;
                rate += passing(system, &self.geometry, at, i);
            }
            if is_lateral
                && self.problem.asleep[i]
                && system.flange(i - normals).is_some_and(|flange| flange.overlap(penetration) != 0.0)
            {
                return false;
            }
            self.problem.reach[i] = [penetration, rate];
        }
        true
    }
}
