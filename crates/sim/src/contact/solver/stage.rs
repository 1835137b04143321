//! Solution of one stage of a step: Q = q* + g V, V = v* + g A, and the associated forces.
//!
//! The unknowns are the accelerations A and the forces F. With the mobility Z = (M + g C + g^2 K)^-1 the motion
//! without forces is a_0 = Z (f - C v* - K (q* + g v*)), and A = a_0 - Z B^T F. The elements depend on W = G + g^2 R
//! Z B^T and, through their rates, on Y: Y = W/g if the rate is that of the penetration, and Y = g R' Z B^T if it is
//! that of the degrees of freedom.
//!
//! A pass updates the geometry to the current guess of the stage, forms W and Y there, solves F = law(e - W F, r - Y
//! F), and updates the guess with the resulting accelerations. Passes are repeated until the changes are within
//! rounding or the remaining error is within the accuracy of the step ([`Convergence`](super::Convergence)). Later
//! passes of a step correct the stage with the factors of an earlier one ([`correct`](super::correct)). If no row
//! depends on the motion, the first pass is the solution. The last pass moves the wheels from the places of its geometry;
//! the penetrations of the state follow them to first order (`Geometry::drift_to`), so that the energy of penetrations
//! and rails is that of the state.
//!
//! A pass is executed in this order: motion without forces; geometry; idle elements (first pass only); mobility
//! projected on the rows; rows of the problem; forces; check for elements that begin to touch, which repeats the
//! pass; accelerations; displacements, speeds and penetrations of the state; heights of the wheels.

use nalgebra::DVector;

use super::{Evaluated, PASSES, Problem, RowKind, Solver};
use crate::Error;
use crate::contact::forces::ActingLaws;
use crate::contact::geometry::Nearness;
use crate::mechanics::state::{Known, State};

/// Allowed relative residual of the forces, per unit of the allowed error of the passes: of a pass that another one follows, and
/// of one that may be the last.
const SLACK: [f64; 2] = [10.0, 0.1];

/// Number of changes of the set of acting laws in a stage up to which it is corrected with W and Y of an earlier pass.
const CHANGES: usize = 2;

/// Result of a pass of a stage.
enum Pass {
    /// Largest changes of the degrees of freedom, relative to themselves and relative to their scales.
    Moved([f64; 2]),
    /// The problem of the forces did not converge.
    Failed,
}

impl Solver<'_> {
    /// Sets the accuracy of stages, compliance and forces for steps with the relative error `tolerance`, relative to
    /// the scales of displacements and speeds. `radius` is the radius of the smallest wheel.
    pub fn set_accuracy(&mut self, tolerance: f64, scales: [&DVector<f64>; 2], radius: f64) {
        self.convergence.set_accuracy(tolerance, scales);
        self.geometry.set_accuracy(tolerance, radius);
    }

    /// Begins a step of length `h` at `from`: selects the elements that may act in it, or all of them, and the local coordinates
    /// of hanging bodies, and discards the results of earlier stages.
    pub fn begin_step(&mut self, from: &State, h: f64, takes_all: bool) {
        let (system, geometry) = (self.system, &self.geometry);
        let frame = geometry.frame(system, from);
        let may_act = |i: usize| {
            takes_all || from.force[i] != 0.0 || system.elements[i].may_act(&frame.at(i), h)
        };
        self.problem.candidates.choose(may_act);
        if !self.system.springs().is_empty() {
            let (system, active) = (self.system, &self.active);
            let is_taut = |rope: usize| system.rope(rope).is_some_and(|(i, _)| active.has(i));
            self.charts
                .begin(system, self.geometry.switches(), is_taut, from);
        }
        self.convergence.begin_step();
        self.factored_for = None;
    }

    /// Whether none of the elements that were not selected for the step touches at its end `to`; else it must be repeated with
    /// all of them.
    pub fn is_complete(&self, to: &State) -> bool {
        let touches = |i: usize| {
            let is_left_out = self.system.fixed[i].is_followed && !self.problem.candidates.has(i);
            is_left_out && self.system.elements[i].touches(self.geometry.penetration(i, to))
        };
        self.problem.candidates.are_all() || !(0..self.system.elements.len()).any(touches)
    }

    /// How well the geometry that was evaluated last in the present stage serves at `at`.
    pub(super) fn nearness(&self, at: &State) -> Nearness {
        let Evaluated { q, is_valid, .. } = &self.evaluated;
        if *is_valid {
            self.geometry.nearness(self.system, q, &at.q)
        } else {
            Nearness::Far
        }
    }

    /// Updates the geometry of the elements that may act in the step to `at`, in a stage; in its last stage that of all.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub(super) fn evaluate_at(&mut self, at: &State) -> Result<(), Error> {
        self.evaluated
            .q
            .as_mut_slice()
            .copy_from_slice(at.q.as_slice());
        self.evaluated.is_valid = true;
        let elements = if self.evaluated.ends_step {
            &self.system.all
        } else {
            &self.problem.candidates
        };
        self.geometry
            .update_some(self.system, (at.t, &at.q), &at.force, elements)
    }

    /// Replaces the constant terms of hanging bodies by their local coordinates and rates at the start of the step.
    pub fn begin_stage(&self, known: &mut Known) {
        self.charts.set_start(&mut known.q, &mut known.v);
    }

    /// Whether degree of freedom `k` belongs to a hanging body, which has local coordinates during the step.
    pub fn is_charted(&self, k: usize) -> bool {
        self.charts.has(k)
    }

    /// Writes speeds and accelerations of the stage that ended at `at` into `rates`; those of hanging bodies in local
    /// coordinates.
    pub fn end_stage(&mut self, at: &State, rates: [&mut DVector<f64>; 2]) {
        self.charts
            .set_rates(self.system, self.geometry.switches(), at, rates);
    }

    /// Solves the stage with coefficient `g` at `at.t` with the present active set; `at` contains the previous
    /// solution as the initial guess. Each iteration is a correction where `may_correct` allows it, else a
    /// full pass. `ends_step` marks the last stage of a step. Returns whether the iteration converged.
    ///
    /// # Errors
    /// Errors of the rail models, and masses that are not positive definite.
    pub fn stage(
        &mut self,
        g: f64,
        known: &mut Known,
        at: &mut State,
        ends_step: bool,
    ) -> Result<bool, Error> {
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
            self.charts
                .guess(system, self.geometry.switches(), g, known, at);
        }
        let slack = SLACK[usize::from(!iterates || self.convergence.knows_ratio())];
        self.problem.slack = slack * self.allowed_error();
        let (mut last, mut changes_of_set) = (f64::INFINITY, 0);
        (self.evaluated.is_valid, self.evaluated.ends_step) = (false, ends_step);
        for pass in 0..PASSES {
            if hangs {
                self.charts
                    .linearise(system, self.geometry.switches(), g, known, at);
            }
            let mut corrected = None;
            if self.may_correct(g) {
                corrected = self.correct(g, known, at, pass == 0)?;
                if corrected.is_none() {
                    self.factored_for = None;
                }
            }
            let is_correction = corrected.is_some();
            let ([moved, change], laws) = match corrected {
                Some(changes) => changes,
                None => match self.pass(g, known, at, pass == 0)? {
                    Pass::Moved(changes) => (changes, ActingLaws::Same),
                    Pass::Failed => return Ok(false),
                },
            };
            // Changes before and after a change of the set of acting laws say nothing of how the iteration contracts.
            let is_same = laws == ActingLaws::Same;
            let compared = if laws == ActingLaws::Changed {
                f64::INFINITY
            } else {
                last
            };
            let verdict = self.convergence.judge(change, compared, is_correction);
            // In the first pass of a free motion, a small change of positions does not imply accurate speeds.
            let is_sure = pass > 0 || !system.mechanics.moves_freely;
            // Where nothing depends on the motion within the stage, a full pass is its solution; a correction is not, where
            // laws are not linear.
            let is_solved = !iterates && !is_correction;
            // After a change of the set of acting laws, it may change again.
            let ends = is_solved || (is_same && (moved < 1e-13 && is_sure || verdict.has_ended));
            // An element that touches is part of the problem from the next pass on.
            if (ends || !is_correction) && self.find_touching(at) {
                self.factored_for = None;
                last = f64::INFINITY;
                continue;
            }
            if ends {
                return Ok(true);
            }
            changes_of_set += usize::from(laws == ActingLaws::Changed);
            if verdict.is_poor || changes_of_set > CHANGES {
                self.factored_for = None;
            }
            last = change;
        }
        Ok(false)
    }

    /// One pass of a stage: forms all matrices at the positions of `at` and solves for the forces. `begins` is true
    /// if only the guess in `at` is available for this stage.
    fn pass(
        &mut self,
        g: f64,
        known: &mut Known,
        at: &mut State,
        begins: bool,
    ) -> Result<Pass, Error> {
        let system = self.system;
        let changes_mass = !system.mechanics.carried.is_empty();
        if begins || changes_mass || !self.charts.is_empty() || self.factored_for.is_none() {
            self.free.move_in_stage(system, g, known, at)?;
        }
        self.factored_for = None;
        if begins || self.nearness(at) != Nearness::Near {
            self.evaluate_at(at)?;
        }
        if begins {
            self.find_idle(&at.force);
        }
        self.problem.seek(system.verticals(), &at.force);
        let elements = (&self.problem.sought[..], &self.problem.idle[..]);
        self.projection
            .fill(system, self.geometry.rows(), self.free.mobility(), elements);
        for k in 0..self.problem.sought.len() {
            let i = self.problem.sought[k];
            self.fill_row(i, g, &known.p);
            if self.follows_motion(i) {
                self.fill_passing(i, g, at);
            }
        }
        for (i, slot) in self.sliding() {
            self.fill_sliding(i, g, known.p[slot], at);
        }
        let (local, active) = (self.geometry.local(), self.active.flags());
        if !self.problem.solve(system, local, active, &mut at.force) {
            return Ok(Pass::Failed);
        }
        self.factored_for = Some(g);
        self.projection
            .add_forces(&self.free.a, -1.0, &at.force, &mut at.a);
        let changes = self.arrive(g, known, at, |solver, i, at| {
            solver.solved_penetration(i, &at.force)
        });
        Ok(Pass::Moved(changes))
    }

    /// Marks the elements that have no force in a stage, so that their columns are omitted: open contacts, flanges
    /// without contact, inactive drives and brakes, slack ropes.
    fn find_idle(&mut self, force: &[f64]) {
        let elements = self.system.elements.iter().zip(self.geometry.local());
        for (i, (element, local)) in elements.enumerate() {
            let can_act = self.problem.candidates.has(i);
            self.problem.idle[i] = !can_act || element.is_idle(self.active.has(i), local, force[i]);
        }
    }

    /// Removes the idle mark of elements that touch at `at`; returns whether there are any.
    fn find_touching(&mut self, at: &State) -> bool {
        let mut is_found = false;
        let Problem {
            candidates, idle, ..
        } = &mut self.problem;
        for &i in candidates
            .list()
            .iter()
            .filter(|&&i| self.system.fixed[i].is_followed)
        {
            if idle[i] && self.system.elements[i].touches(self.geometry.penetration(i, at)) {
                idle[i] = false;
                is_found = true;
            }
        }
        is_found
    }

    /// Fills the row of element `i` in the problem of a stage with coefficient `g`; `known` contains the constant
    /// terms of the penetrations.
    fn fill_row(&mut self, i: usize, g: f64, known: &[f64]) {
        let (m, remembers) = (self.system.elements.len(), self.remembers(i));
        let span = i * m..(i + 1) * m;
        let effects = &mut self.problem.effects;
        let (w, y) = (&mut effects.w[span.clone()], &mut effects.y[span.clone()]);
        w.copy_from_slice(&self.geometry.rails().value[span]);
        for (&j, mobile) in self
            .projection
            .columns()
            .iter()
            .zip(self.projection.approach_row(i))
        {
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
            for (&j, mobile) in self
                .projection
                .columns()
                .iter()
                .zip(self.projection.rate_row(i))
            {
                y[j] = g * mobile;
            }
            effects.rate[i] = self.geometry.rate(i, &self.free.v);
        }
    }

    /// Whether the rate of penetration `i` is a function of the motion. It is then not formed from differences of
    /// penetrations, whose order in a Runge-Kutta method is two.
    pub(super) fn follows_motion(&self, i: usize) -> bool {
        self.remembers(i) && self.system.follows_motion[i]
    }

    /// Rate of the approach of vertical contact `i` in the motion of the stage without forces, r = R v + x' (h' - w'), with
    /// the slopes h' of the unloaded rail and w' = S q of the structure at the `speed` x' along the rail.
    pub(super) fn free_approach_rate(&self, i: usize, speed: f64) -> f64 {
        let rows = self.geometry.rows();
        let slope = rows.rise[i] - self.geometry.shape_slope(i, &self.free.q);
        rows.approach_along(i, &self.free.v) + speed * slope
    }

    /// Replaces the rate of vertical contact `i` by that of the motion at the speed x' of `at`: r_0 is that without forces
    /// ([`Solver::free_approach_rate`]), and Y = g R Z B^T - g^2 x' S Z B^T.
    fn fill_passing(&mut self, i: usize, g: f64, at: &State) {
        let m = at.force.len();
        let speed = self.system.contact_speed(i, at);
        let rate = self.free_approach_rate(i, speed);
        let effects = &mut self.problem.effects;
        effects.rate[i] = rate;
        if self.system.mechanics.has_structures() && speed != 0.0 {
            let own = &mut effects.y[i * m..(i + 1) * m];
            for (&j, by_slope) in self.projection.product(self.geometry.shape_row(i)) {
                own[j] -= g * g * speed * by_slope;
            }
            effects.kind[i] = RowKind::Passing;
        }
    }

    /// Adds the motion of the massless rail to the rate of tangential element `i`: s = x' + h omega - du/dt at a
    /// fixed point of the rail, where du/dt = (G F - u*)/g is taken along the path of the wheel, minus x' dG/dx F for
    /// the motion along that path. `known` is the constant term u* of the displacement.
    fn fill_sliding(&mut self, i: usize, g: f64, known: f64, at: &State) {
        let m = at.force.len();
        let effects = &mut self.problem.effects;
        effects.rate[i] += known / g;
        for j in i * m..(i + 1) * m {
            effects.y[j] += self.geometry.rails().value[j] / g;
        }
        self.take_passing(i, at);
    }

    /// Completes a pass: updates the state `at` from its accelerations and forces, with the `penetration` of each
    /// vertical contact. Returns the largest changes relative to the degrees of freedom themselves and relative to
    /// their scales.
    pub(super) fn arrive(
        &mut self,
        g: f64,
        known: &Known,
        at: &mut State,
        penetration: impl Fn(&Self, usize, &State) -> f64,
    ) -> [f64; 2] {
        let changes = self.follow_accelerations(g, known, at);
        self.geometry.drift_to(self.system, &at.q, &at.force);
        for i in 0..self.system.verticals() {
            at.p[i] = penetration(self, i, at) + self.geometry.drift(i);
            at.p_rate[i] = if self.follows_motion(i) {
                self.approach_rate(i, at)
            } else {
                (at.p[i] - known.p[i]) / g
            };
        }
        for (i, slot) in self.sliding() {
            let moved = self.geometry.deflection(i, &at.force) - self.geometry.drift(i);
            at.p_rate[slot] = (moved - known.p[slot]) / g;
            at.p[slot] = moved;
        }
        let rise = self.geometry.update_heights(self.system, at);
        changes.map(|change| change.max(rise))
    }

    /// Updates displacements and speeds of `at` from its accelerations. Returns the largest changes relative to the
    /// degrees of freedom themselves and relative to their scales.
    fn follow_accelerations(&self, g: f64, known: &Known, at: &mut State) -> [f64; 2] {
        let [mut moved, mut beside] = [0.0_f64; 2];
        let accelerations = at.a.as_slice().iter();
        let known = known.q.as_slice().iter().zip(known.v.as_slice());
        let motion = at.q.as_mut_slice().iter_mut().zip(at.v.as_mut_slice());
        for (k, ((a, (known_q, known_v)), (q, v))) in
            accelerations.zip(known).zip(motion).enumerate()
        {
            let next_v = known_v + g * a;
            let next_q = known_q + g * next_v;
            let change = (next_q - *q).abs();
            moved = moved.max(change / (1.0 + next_q.abs()));
            beside = beside.max(self.convergence.weigh(
                k,
                [change, (next_v - *v).abs()],
                [next_q, next_v],
            ));
            (*q, *v) = (next_q, next_v);
        }
        [moved, beside]
    }
}
