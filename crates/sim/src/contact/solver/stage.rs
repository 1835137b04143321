//! One stage of a step: Q = q* + g V, V = v* + g A and the forces that belong to them.
//!
//! Unknowns are the accelerations A and the forces F. With the mobility Z = (M + g C + g^2 K)^-1 the motion without
//! forces is a_0 = Z (f - C v* - K (q* + g v*)), and A = a_0 - Z B^T F. The elements see W = G + g^2 R Z B^T and, in
//! their rates, Y = W/g where the rate is that of the penetration, g R' Z B^T where it is that of the degrees of
//! freedom.
//!
//! A pass brings the geometry to the guess of the stage, forms W and Y there, solves F = law(e - W F, r - Y F), and
//! moves the guess to the accelerations found. Passes repeat until they change nothing, or less than the step's
//! accuracy asks ([`Convergence`](super::Convergence)); later passes of a step correct the stage by the factors of an
//! earlier one ([`correct`](super::correct)). Where no row follows the motion, the first pass is the solution.
//!
//! Order of a pass: motion without forces; geometry; idle elements (in the first pass); mobility by the rows; rows of
//! the problem; forces; elements that begin to touch, which repeat the pass; accelerations; displacements, speeds and
//! penetrations of the state; heights of the wheels.

use nalgebra::DVector;

use super::{PASSES, RowKind, Solver};
use crate::Error;
use crate::mechanics::state::{Known, State};

/// Residual of the forces for each unit of the error that passes may leave.
const SLACK: f64 = 0.1;

/// What a pass of a stage did.
enum Pass {
    /// Largest changes beside the degrees of freedom themselves, and beside their scales.
    Moved([f64; 2]),
    /// Elements were found to touch that had been taken as idle.
    Touched,
    /// The forces have no solution.
    Failed,
}

impl Solver<'_> {
    /// Lets stages, compliance and forces err as far as steps of the relative error `tolerance` allow, beside the
    /// scales of displacements and speeds; `radius` is that of the smallest wheel.
    pub fn set_accuracy(&mut self, tolerance: f64, scales: [&DVector<f64>; 2], radius: f64) {
        self.convergence.set_accuracy(tolerance, scales);
        self.geometry.set_accuracy(tolerance, radius);
    }

    /// Begins a step at `from`: chooses the coordinates of hanging bodies, and keeps nothing of earlier stages.
    pub fn begin_step(&mut self, from: &State) {
        if !self.system.springs().is_empty() {
            let (system, active) = (self.system, &self.active);
            let is_taut = |rope: usize| system.rope(rope).is_some_and(|(i, _)| active.has(i));
            self.charts.begin(system, self.geometry.switches(), is_taut, from);
        }
        self.convergence.begin_step();
        self.factored_for = None;
    }

    /// Sets hanging bodies in the known parts of a stage to their coordinates at the start of the step.
    pub fn begin_stage(&self, known: &mut Known) {
        self.charts.set_start(&mut known.q, &mut known.v);
    }

    /// Whether degree of freedom `k` is of a hanging body, in coordinates of its own during the step.
    pub fn is_charted(&self, k: usize) -> bool {
        self.charts.has(k)
    }

    /// Speeds and accelerations of the stage that ended at `at` into `rates`, those of hanging bodies in their
    /// coordinates.
    pub fn end_stage(&mut self, at: &State, rates: [&mut DVector<f64>; 2]) {
        self.charts.set_rates(self.system, self.geometry.switches(), at, rates);
    }

    /// Solves the stage of the coefficient `g` at `at.t` with the elements that are active; `at` brings the previous
    /// solution as a guess. Returns whether it converged.
    ///
    /// # Errors
    /// What the rails refuse, and masses that are not positive definite.
    pub fn stage(&mut self, g: f64, known: &mut Known, at: &mut State) -> Result<bool, Error> {
        let system = self.system;
        let traits = &system.traits;
        self.free.set_step(system, g)?;
        let iterates = traits.follows_motion || traits.uses_heights;
        if traits.follows_motion {
            for k in 0..at.q.len() {
                at.v[k] = known.v[k] + g * at.a[k];
                at.q[k] = known.q[k] + g * at.v[k];
            }
        }
        let hangs = !self.charts.is_empty();
        if hangs {
            self.charts.guess(system, self.geometry.switches(), g, known, at);
        }
        self.problem.slack = self.convergence.allowed().map_or(0.0, |allowed| SLACK * allowed);
        let mut last = f64::INFINITY;
        for pass in 0..PASSES {
            if hangs {
                self.charts.linearise(system, self.geometry.switches(), g, known, at);
            }
            let mut corrected = None;
            if self.may_correct(g) {
                corrected = self.correct(g, known, at)?;
                if corrected.is_none() {
                    self.factored_for = None;
                }
            }
            let [moved, change] = match corrected {
                Some(changes) => changes,
                None => match self.pass(g, known, at, pass == 0)? {
                    Pass::Moved(changes) => changes,
                    Pass::Touched => continue,
                    Pass::Failed => return Ok(false),
                },
            };
            let verdict = self.convergence.judge(change, last);
            // A good guess of where the wheels are says little of their speeds.
            let is_sure = pass > 0 || !system.mechanics.moves_freely;
            if (moved < 1e-13 && is_sure) || !iterates || verdict.has_ended {
                return Ok(true);
            }
            if verdict.is_poor {
                self.factored_for = None;
            }
            last = change;
        }
        Ok(false)
    }

    /// A pass of a stage: all matrices at the places of `at`, and the forces that they give. `begins`: nothing is
    /// known of the stage but the guess in `at`.
    fn pass(&mut self, g: f64, known: &mut Known, at: &mut State, begins: bool) -> Result<Pass, Error> {
        let system = self.system;
        let changes_mass = !system.mechanics.carried.is_empty();
        if begins || changes_mass || !self.charts.is_empty() || self.factored_for.is_none() {
            self.free.move_in_stage(system, g, known, at)?;
        }
        self.factored_for = None;
        self.update(at)?;
        if begins {
            self.find_idle(&at.force);
        }
        self.projection.fill(system, self.geometry.rows(), self.free.mobility(), &self.problem.idle);
        for i in 0..at.force.len() {
            self.fill_row(i, g, &known.p);
        }
        for (i, slot) in self.sliding() {
            self.fill_sliding(i, g, known.p[slot], at);
        }
        let (local, active) = (self.geometry.local(), self.active.flags());
        if !self.problem.solve(system, local, active, &mut at.force) {
            return Ok(Pass::Failed);
        }
        if self.find_touching(&at.force) {
            return Ok(Pass::Touched);
        }
        self.factored_for = Some(g);
        self.projection.add_forces(&self.free.a, -1.0, &at.force, &mut at.a);
        let changes = self.arrive(g, known, at, |solver, i, at| solver.solved_penetration(i, &at.force));
        Ok(Pass::Moved(changes))
    }

    /// Takes what has no force out of the columns of a stage: open contacts, free flanges, drives and brakes that are
    /// off, slack ropes.
    fn find_idle(&mut self, force: &[f64]) {
        let elements = self.system.elements.iter().zip(self.geometry.local());
        for (i, (element, local)) in elements.enumerate() {
            self.problem.idle[i] = element.is_idle(self.active.has(i), local, force[i]);
        }
    }

    /// Finds idle elements that touch under `force`; returns whether any does.
    fn find_touching(&mut self, force: &[f64]) -> bool {
        let mut is_found = false;
        for (i, element) in self.system.elements.iter().enumerate() {
            if self.problem.idle[i]
                && self.system.fixed[i].is_followed
                && element.touches(self.problem.effects.penetration(i, force))
            {
                self.problem.idle[i] = false;
                is_found = true;
            }
        }
        is_found
    }

    /// Row of element `i` in the problem of a stage of the coefficient `g`; `known` are penetrations.
    fn fill_row(&mut self, i: usize, g: f64, known: &[f64]) {
        let (m, remembers) = (self.system.elements.len(), self.remembers(i));
        let span = i * m..(i + 1) * m;
        let effects = &mut self.problem.effects;
        let (w, y) = (&mut effects.w[span.clone()], &mut effects.y[span.clone()]);
        w.copy_from_slice(&self.geometry.rails().value[span]);
        for (&j, mobile) in self.projection.columns().iter().zip(self.projection.approach_row(i)) {
            w[j] += g * g * mobile;
        }
        y.fill(0.0);
        let approach = self.geometry.approach(i, &self.free.q);
        effects.approach[i] = approach;
        effects.rate[i] = 0.0;
        effects.kind[i] = RowKind::Law;
        if remembers {
            y.iter_mut().zip(w).for_each(|(y, w)| *y = *w / g);
            effects.rate[i] = (approach - known[i]) / g;
            effects.kind[i] = RowKind::Memory(1.0 / g);
        } else if self.system.fixed[i].feels_rates {
            for (&j, mobile) in self.projection.columns().iter().zip(self.projection.rate_row(i)) {
                y[j] = g * mobile;
            }
            effects.rate[i] = self.geometry.rate(i, &self.free.v);
        }
    }

    /// Adds to the rate of element `i` along a rail what the rail without mass moves, `known` before the stage: s =
    /// x' + h omega - du/dt at a place of the rail, where du/dt = (G F - u*)/g along the wheel's path, less x' dG/dx
    /// F for the path itself.
    fn fill_sliding(&mut self, i: usize, g: f64, known: f64, at: &State) {
        let m = at.force.len();
        let effects = &mut self.problem.effects;
        effects.rate[i] += known / g;
        for j in i * m..(i + 1) * m {
            effects.y[j] += self.geometry.rails().value[j] / g;
        }
        self.take_passing(i, at);
    }

    /// Ends a pass: puts what the accelerations and forces of `at` give there, with the `penetration` of each vertical
    /// contact; returns the largest changes beside the degrees of freedom themselves and beside their scales.
    pub(super) fn arrive(
        &mut self,
        g: f64,
        known: &Known,
        at: &mut State,
        penetration: impl Fn(&Self, usize, &State) -> f64,
    ) -> [f64; 2] {
        let changes = self.follow_accelerations(g, known, at);
        for i in 0..self.system.verticals() {
            at.p[i] = penetration(self, i, at);
            at.p_rate[i] = (at.p[i] - known.p[i]) / g;
        }
        for (i, slot) in self.sliding() {
            let moved = self.geometry.deflection(i, &at.force);
            at.p_rate[slot] = (moved - known.p[slot]) / g;
            at.p[slot] = moved;
        }
        let rise = self.geometry.update_heights(self.system, at);
        changes.map(|change| change.max(rise))
    }

    /// Largest of the changes from `at` to what its accelerations give, beside the degrees of freedom and beside their
    /// scales, and puts them there.
    fn follow_accelerations(&self, g: f64, known: &Known, at: &mut State) -> [f64; 2] {
        let [mut moved, mut beside] = [0.0_f64; 2];
        for k in 0..at.q.len() {
            let v = known.v[k] + g * at.a[k];
            let q = known.q[k] + g * v;
            let change = (q - at.q[k]).abs();
            moved = moved.max(change / (1.0 + q.abs()));
            beside = beside.max(self.convergence.weigh(k, [change, (v - at.v[k]).abs()], [q, v]));
            (at.q[k], at.v[k]) = (q, v);
        }
        [moved, beside]
    }
}
