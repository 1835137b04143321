//! Solutions at one instant and at one stage of a step, over the numbered scene.

use nalgebra::{DMatrix, DVector, SVector};

use crate::contact::charts::Charts;
use crate::contact::forces::Problem;
use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::mobility::Mobility;
use crate::mechanics::state::{Known, State};
use crate::numerics::dense::dot;
use crate::{Damper, Error};

/// Give of a rail, relative to the wheel's, below which it counts as rigid.
pub(crate) const RIGID: f64 = 1e-9;

/// Iterations on the wheels' places and heights inside one solution.
const PASSES: usize = 30;

/// Margin of the share that a pass leaves of what it changes, where another stage has it.
const MARGIN: f64 = 100.0;

/// The least such share that counts: less is rounding.
const LEAST: f64 = 1e-7;

/// Residual of the forces for each unit of what passes may leave.
const SLACK: f64 = 0.1;

/// Share that a pass leaves of what it changes, above which the matrices are formed again.
const POOR: f64 = 0.2;

/// What a pass of a stage did.
enum Pass {
    /// Largest changes beside the freedoms themselves, and beside their scales.
    Moved([f64; 2]),
    /// Flanges were found to touch that had been taken as free.
    Woken,
    /// The forces have no solution.
    Failed,
}

/// The scene with everything needed to solve it again and again without allocation.
pub(crate) struct Solver<'a> {
    pub system: &'a System<'a>,
    pub geometry: Geometry,
    /// Coordinates of hung bodies during a step.
    pub charts: Charts,
    /// Which vertical contacts act.
    pub active: Vec<bool>,
    /// Penetration that the damper of each contact kept as it opened, and when; `None`: not opened on the way.
    pub kept: Vec<Option<[f64; 2]>>,
    pub problem: Problem,
    /// Whether the displacements of massless rails along x are known at an instant.
    pub keeps_rails: bool,
    pub(crate) inverse: Mobility<'a>,
    pub(crate) mobility: Mobility<'a>,
    /// Scales of displacements and rates, where passes may end before rounding does; how near beside them, by the passes
    /// of the stage itself and by those of another one.
    pub scales: Option<[DVector<f64>; 2]>,
    pub settled: [f64; 2],
    /// Share that a pass leaves of what it changes, from stages of the same step; infinite where it is not known.
    pub contraction: f64,
    /// Coefficient g of the stage whose matrices the problem of the forces has factored.
    pub factors_of: Option<f64>,
    /// Components that may press, the columns of `spread` and `mobile`.
    pub(crate) awake: Vec<usize>,
    /// Their forces.
    pub(crate) pressing: Vec<f64>,
    /// Z R^T, freedoms x awake components, row-major.
    pub(crate) spread: Vec<f64>,
    /// R Z R^T, components x awake components, row-major; and the same with the rows of rates that are felt.
    mobile: Vec<f64>,
    mobile_rate: Vec<f64>,
    pub(crate) answer: DVector<f64>,
    pub(crate) free_a: DVector<f64>,
    pub(crate) free_q: DVector<f64>,
    pub(crate) free_v: DVector<f64>,
    pub(crate) load: DVector<f64>,
    /// Mass of the bodies, those that ride among them, and scratch for it.
    pub(crate) mass: DMatrix<f64>,
    pub(crate) columns: Vec<SVector<f64, 6>>,
    spread_is_fixed: bool,
}

impl<'a> Solver<'a> {
    pub fn new(system: &'a System<'a>) -> Result<Self, Error> {
        let n = system.mechanics.dofs;
        Ok(Solver {
            system,
            geometry: Geometry::new(system),
            charts: Charts::default(),
            active: vec![false; system.mechanics.groups.len()],
            kept: vec![None; system.mechanics.groups.len()],
            problem: Problem::new(system),
            keeps_rails: true,
            scales: None,
            settled: [0.0; 2],
            contraction: f64::INFINITY,
            factors_of: None,
            awake: Vec::with_capacity(system.components()),
            mobility: Mobility::new(&system.mechanics)?,
            inverse: Mobility::new(&system.mechanics)?,
            spread: vec![0.0; n * system.components()],
            mobile: vec![0.0; system.components() * system.components()],
            mobile_rate: vec![0.0; system.components() * system.components()],
            answer: DVector::zeros(n),
            pressing: Vec::with_capacity(system.components()),
            free_a: DVector::zeros(n),
            free_q: DVector::zeros(n),
            free_v: DVector::zeros(n),
            load: DVector::zeros(n),
            mass: DMatrix::zeros(system.mechanics.body_dofs(), system.mechanics.body_dofs()),
            columns: Vec::new(),
            spread_is_fixed: false,
        })
    }

    /// Whether vertical contact `i` keeps its penetration as a state while it acts.
    pub fn remembers(&self, i: usize) -> bool {
        self.active[i] && self.system.law(i).has_memory()
    }

    /// Forces that do not depend on the contacts: weight, loads, and what a prescribed x does to the other freedoms.
    pub(crate) fn fill_load(&mut self, t: f64) {
        self.load.copy_from(&self.system.mechanics.gravity);
        for load in &self.system.scene.actuators.loads {
            if let Some(number) = self.system.mechanics.loaded(load) {
                self.load[number] += load.value.at(t);
            }
        }
        for (b, body) in self.system.scene.bodies.iter().enumerate() {
            let Some(profile) = &body.motion else { continue };
            let acceleration = profile.at(t).a;
            if acceleration == 0.0 {
                continue;
            }
            for &(number, inertia) in self.system.mechanics.kinematics.travel_inertia(b) {
                self.load[number] -= inertia * acceleration;
            }
        }
    }

    /// Which ropes and stops act.
    pub fn taut(&self) -> Vec<bool> {
        self.geometry.links.iter().map(|hold| hold.taut).collect()
    }

    /// Inertia of the bodies that ride on others at `at`, and the forces it adds to the load; the mobility of a stage
    /// or of an instant follows.
    fn fill_mass(&mut self, at: &State, in_stage: bool) -> Result<(), Error> {
        let system = self.system;
        let Some(fixed) =
            system.mechanics.blocks[0].body_mass().filter(|_| !system.mechanics.carried.is_empty())
        else {
            return Ok(());
        };
        self.mass.copy_from(fixed);
        let sums = (&mut self.mass, &mut self.load);
        system.mechanics.carried.add(
            &system.mechanics.kinematics,
            (at.t, &at.q, &at.v),
            sums,
            &mut self.columns,
        );
        let mobility = if in_stage { &mut self.mobility } else { &mut self.inverse };
        mobility.set_mass(&self.mass)
    }

    /// M^-1 times the forces at `t` that do not depend on the contacts.
    pub(crate) fn accelerate(&mut self, t: f64) -> &DVector<f64> {
        self.fill_load(t);
        self.inverse.apply(self.load.as_slice(), self.free_a.as_mut_slice());
        &self.free_a
    }

    /// M^-1 times a row of forces.
    pub(crate) fn spread_row(&self, row: &[f64], spread: &mut [f64]) {
        self.inverse.apply(row, spread);
    }

    fn fill_spread(&mut self) {
        if self.spread_is_fixed {
            return;
        }
        let (n, m) = (self.system.mechanics.dofs, self.system.components());
        // Rows that stay serve whatever acts later.
        let all = self.spread_is_fixed_by_rows();
        self.awake.clear();
        self.awake.extend((0..m).filter(|&j| all || !self.problem.asleep[j]));
        let count = self.awake.len();
        for (column, &j) in self.awake.iter().enumerate() {
            self.mobility.apply(&self.geometry.force_rows[j * n..(j + 1) * n], self.answer.as_mut_slice());
            for (k, answer) in self.answer.iter().enumerate() {
                self.spread[k * count + column] = *answer;
            }
        }
        let spread = &self.spread[..n * count];
        for i in 0..m {
            let span = i * count..(i + 1) * count;
            product(&self.geometry.rows[i * n..(i + 1) * n], spread, &mut self.mobile[span.clone()]);
            if self.feels_rates(i) {
                let row = &self.geometry.rate_rows[i * n..(i + 1) * n];
                product(row, spread, &mut self.mobile_rate[span]);
            }
        }
        self.spread_is_fixed = all;
    }

    /// Whether the law of component `i` feels a rate of the freedoms themselves.
    pub(crate) fn feels_rates(&self, i: usize) -> bool {
        match i < self.system.mechanics.groups.len() {
            true => self.system.law(i).damper == Damper::Ground,
            false => i >= self.system.traction(0),
        }
    }

    fn spread_is_fixed_by_rows(&self) -> bool {
        self.system.constant_rows && self.system.mechanics.carried.is_empty()
    }

    /// Takes what does not press out of the columns of a stage: open contacts, free flanges, drives and brakes that do
    /// not act, slack ropes.
    fn lull(&mut self, force: &[f64]) {
        let system = self.system;
        let asleep = &mut self.problem.asleep;
        for (asleep, active) in asleep.iter_mut().zip(&self.active) {
            *asleep = !active;
        }
        for i in system.lateral(0)..system.traction(0) {
            asleep[i] = force[i] == 0.0;
        }
        for (asleep, acts) in asleep[system.pull(0)..].iter_mut().zip(&self.geometry.pulls) {
            *asleep = !acts;
        }
        for (asleep, hold) in asleep[system.link(0)..].iter_mut().zip(&self.geometry.links) {
            *asleep = !hold.taut;
        }
    }

    /// Wakes flanges that overlap their rail under `force`; returns whether any did.
    fn wake(&mut self, force: &[f64]) -> bool {
        let system = self.system;
        let mut woken = false;
        for index in 0..system.laterals.len() {
            let i = system.lateral(index);
            let Some(flange) = system.flange(index) else { continue };
            if self.problem.asleep[i] && flange.overlap(self.problem.penetration(i, force)) != 0.0 {
                self.problem.asleep[i] = false;
                woken = true;
            }
        }
        woken
    }

    /// Ends a pass: puts what the accelerations and forces of `at` give there, with the `penetration` of each vertical
    /// contact; returns the largest changes beside the freedoms themselves and beside their scales.
    pub(crate) fn arrive(
        &mut self,
        g: f64,
        known: &Known,
        at: &mut State,
        penetration: impl Fn(&Self, usize, &State) -> f64,
    ) -> [f64; 2] {
        let changes = self.follow_accelerations(g, known, at);
        for i in 0..self.system.mechanics.groups.len() {
            at.p[i] = penetration(self, i, at);
            at.p_rate[i] = (at.p[i] - known.p[i]) / g;
        }
        self.drag_end(g, &known.p, at);
        let rise = self.update_heights(at);
        changes.map(|change| change.max(rise))
    }

    /// Largest of the changes from `at` to what its accelerations `at.a` give, beside their scales, and puts them there.
    fn follow_accelerations(&self, g: f64, known: &Known, at: &mut State) -> [f64; 2] {
        let [mut moved, mut beside] = [0.0_f64; 2];
        for i in 0..self.system.mechanics.dofs {
            let v = known.v[i] + g * at.a[i];
            let q = known.q[i] + g * v;
            let change = (q - at.q[i]).abs();
            moved = moved.max(change / (1.0 + q.abs()));
            if let Some([scale, rate_scale]) = &self.scales {
                beside = beside
                    .max(change / scale[i].max(q.abs()))
                    .max((v - at.v[i]).abs() / rate_scale[i].max(v.abs()));
            }
            (at.q[i], at.v[i]) = (q, v);
        }
        [moved, beside]
    }

    /// Solves the stage Q = q* + g V, V = v* + g A at `at.t` with the contacts that are active; `at` brings
    /// the previous solution as a guess. Returns whether it converged.
    pub fn stage(&mut self, g: f64, known: &mut Known, at: &mut State) -> Result<bool, Error> {
        let system = self.system;
        let n = system.mechanics.dofs;
        self.mobility.set_step(&system.mechanics, g)?;
        let rides = !system.mechanics.carried.is_empty();
        let places_move =
            system.moves_freely || rides || !system.laterals.is_empty() || !system.links.is_empty();
        let iterates = places_move || !system.tractions.is_empty();
        if places_move {
            for i in 0..n {
                at.v[i] = known.v[i] + g * at.a[i];
                at.q[i] = known.q[i] + g * at.v[i];
            }
        }
        let hangs = !self.charts.is_empty();
        if hangs {
            self.charts.guess(system, &self.geometry.switches, g, known, at);
        }
        self.problem.slack = if self.scales.is_some() { SLACK * self.settled[1] } else { 0.0 };
        let mut last = f64::INFINITY;
        for pass in 0..PASSES {
            if hangs {
                self.charts.flatten(system, &self.geometry.switches, g, known, at);
            }
            let mut corrected = None;
            if self.may_correct(g) {
                corrected = self.correct(g, known, at)?;
                if corrected.is_none() {
                    self.factors_of = None;
                }
            }
            let [moved, change] = match corrected {
                Some(changes) => changes,
                None => match self.pass(g, known, at, pass == 0)? {
                    Pass::Moved(changes) => changes,
                    Pass::Woken => continue,
                    Pass::Failed => return Ok(false),
                },
            };
            let known = last.is_finite();
            if known {
                self.contraction = (change / last).max(LEAST);
            }
            // What is left after this pass, from how much less a pass changes than the one before.
            let rate = if known { self.contraction } else { MARGIN * self.contraction };
            let left = if rate < 1.0 { change * rate / (1.0 - rate) } else { f64::INFINITY };
            // A good guess of where the wheels are says little of their speeds.
            let is_told = pass > 0 || !system.moves_freely;
            if (moved < 1e-13 && is_told)
                || !iterates
                || (self.scales.is_some() && left < self.settled[usize::from(!known)])
            {
                return Ok(true);
            }
            if known && self.contraction > POOR {
                self.factors_of = None;
            }
            last = change;
        }
        Ok(false)
    }

    /// A pass of a stage: all matrices at the places of `at`, and the forces that they give. `begins`: nothing is known of
    /// the stage but the guess in `at`.
    fn pass(&mut self, g: f64, known: &mut Known, at: &mut State, begins: bool) -> Result<Pass, Error> {
        let system = self.system;
        let (n, m) = (system.mechanics.dofs, system.components());
        let rides = !system.mechanics.carried.is_empty();
        if begins || rides || !self.charts.is_empty() || self.factors_of.is_none() {
            self.move_freely(g, known, at)?;
        }
        self.factors_of = None;
        self.geometry.update(system, at.t, &at.q, &at.force)?;
        if begins {
            self.lull(&at.force);
        }
        self.fill_spread();
        for i in 0..m {
            self.fill_row(i, g, &known.p);
        }
        self.drag_stage(g, &known.p, at);
        if !self.problem.solve(system, &self.geometry, &self.active, &mut at.force) {
            return Ok(Pass::Failed);
        }
        if self.wake(&at.force) {
            return Ok(Pass::Woken);
        }
        self.factors_of = Some(g);
        let count = self.awake.len();
        self.pressing.clear();
        self.pressing.extend(self.awake.iter().map(|&j| at.force[j]));
        for k in 0..n {
            let spread = &self.spread[k * count..(k + 1) * count];
            at.a[k] = self.free_a[k] - dot(spread, &self.pressing);
        }
        let changes = self.arrive(g, known, at, |solver, i, at| solver.problem.penetration(i, &at.force));
        Ok(Pass::Moved(changes))
    }

    /// What a stage of the coefficient `g` puts into row `i` of the contact problem; `known` are penetrations.
    fn fill_row(&mut self, i: usize, g: f64, known: &[f64]) {
        let (system, m, count) = (self.system, self.system.components(), self.awake.len());
        let memory = i < system.mechanics.groups.len() && self.remembers(i);
        let (span, own) = (i * m..(i + 1) * m, i * count..(i + 1) * count);
        let (w, y) = (&mut self.problem.w[span.clone()], &mut self.problem.y[span.clone()]);
        w.copy_from_slice(&self.geometry.compliance[span]);
        for (&j, mobile) in self.awake.iter().zip(&self.mobile[own.clone()]) {
            w[j] += g * g * mobile;
        }
        y.fill(0.0);
        let approach = self.geometry.approach(i, &self.free_q);
        self.problem.approach[i] = approach;
        self.problem.rate[i] = 0.0;
        if memory {
            y.iter_mut().zip(w).for_each(|(y, w)| *y = *w / g);
            self.problem.rate[i] = (approach - known[i]) / g;
        } else if self.feels_rates(i) {
            for (&j, mobile) in self.awake.iter().zip(&self.mobile_rate[own]) {
                self.problem.y[i * m + j] = g * mobile;
            }
            self.problem.rate[i] = self.geometry.rate(i, &self.free_v);
        }
        self.problem.memory[i] = memory.then_some(1.0 / g);
        self.problem.known[i] = false;
    }

    /// Motion of a stage without contacts.
    fn move_freely(&mut self, g: f64, known: &Known, at: &State) -> Result<(), Error> {
        let system = self.system;
        self.fill_load(at.t);
        self.fill_mass(at, true)?;
        if system.mechanics.has_structures() {
            self.free_q.copy_from(&known.q);
            self.free_q.axpy(g, &known.v, 1.0);
            for block in &system.mechanics.blocks {
                block.resist(known.v.as_slice(), self.free_q.as_slice(), self.load.as_mut_slice());
            }
        }
        self.mobility.apply(self.load.as_slice(), self.free_a.as_mut_slice());
        for i in 0..system.mechanics.dofs {
            self.free_v[i] = known.v[i] + g * self.free_a[i];
            self.free_q[i] = known.q[i] + g * self.free_v[i];
        }
        Ok(())
    }

    /// Forces, penetrations and accelerations at (t, q, v) for the contacts that are active; the
    /// penetration of those that remember it is given, inside a step its rate: p + G F = e with F = k p + c p' errs by
    /// c/(1 + k G) of the rate's error, where F = k p + c p' alone errs by k of the penetration's. Returns whether it converged.
    pub fn instant(&mut self, at: &mut State) -> Result<bool, Error> {
        let system = self.system;
        let (n, m) = (system.mechanics.dofs, system.components());
        self.problem.asleep.fill(false);
        self.factors_of = None;
        self.problem.slack = 0.0;
        for _ in 0..PASSES {
            self.geometry.update(system, at.t, &at.q, &at.force)?;
            for i in 0..m {
                self.problem.approach[i] = self.geometry.approach(i, &at.q);
                self.problem.rate[i] = self.geometry.rate(i, &at.v);
                self.problem.memory[i] = None;
                let remembers = i < system.mechanics.groups.len() && self.remembers(i);
                self.problem.known[i] = remembers && !at.is_between;
                if remembers && at.is_between {
                    self.problem.rate[i] = at.p_rate[i];
                }
                if self.problem.known[i] {
                    let scale = system.mechanics.groups[i].count() * self.geometry.share[i][0];
                    at.force[i] = scale * system.law(i).at(at.p[i], at.p_rate[i]).force;
                }
            }
            self.problem.w.copy_from_slice(&self.geometry.compliance);
            self.problem.y.fill(0.0);
            self.drag_instant(at);
            if !self.problem.solve(system, &self.geometry, &self.active, &mut at.force) {
                return Ok(false);
            }
            for i in 0..system.mechanics.groups.len() {
                if !self.problem.known[i] {
                    at.p[i] = self.problem.penetration(i, &at.force);
                }
            }
            if self.update_heights(at) < 1e-13 {
                break;
            }
        }
        self.geometry.update(system, at.t, &at.q, &at.force)?;
        self.geometry.update_rail_slope(system, &at.q, &at.force);
        self.fill_load(at.t);
        self.fill_mass(at, false)?;
        for block in &system.mechanics.blocks {
            block.resist(at.v.as_slice(), at.q.as_slice(), self.load.as_mut_slice());
        }
        for j in 0..m {
            for i in 0..n {
                self.load[i] -= self.geometry.force_rows[j * n + i] * at.force[j];
            }
        }
        self.inverse.apply(self.load.as_slice(), at.a.as_mut_slice());
        Ok(true)
    }

    /// Sets `at` to the interpolant between the ends of the step just tried, at its share `share`.
    ///
    /// # Errors
    /// What the rail refuses.
    pub fn interpolate(&mut self, [from, to]: [&State; 2], share: f64, at: &mut State) -> Result<(), Error> {
        at.interpolate(from, to, share);
        self.charts.interpolate(self.system, &self.geometry.switches, [from, to], share, at);
        self.stretch_ropes(to.t - from.t, at)
    }

    /// Heights of the wheels' centres above their rails; returns the largest change where it matters.
    pub(crate) fn update_heights(&mut self, at: &State) -> f64 {
        if self.system.laterals.is_empty() && self.system.tractions.is_empty() {
            return 0.0;
        }
        let mut moved = 0.0_f64;
        for w in 0..self.system.mechanics.wheels.len() {
            let deepest =
                self.system.mechanics.groups_of(w).map(|i| at.p[i]).fold(f64::NEG_INFINITY, f64::max);
            let height = self.system.scene.wheels[self.system.mechanics.wheels[w].kind].radius - deepest;
            moved = moved.max((height - self.geometry.height[w]).abs() / height.abs());
            self.geometry.height[w] = height;
        }
        moved
    }
}

/// `sum` = `row` times a row-major matrix as wide as `sum`.
fn product(row: &[f64], matrix: &[f64], sum: &mut [f64]) {
    sum.fill(0.0);
    let width = sum.len().max(1);
    for (share, line) in row.iter().zip(matrix.chunks_exact(width)).filter(|(share, _)| **share != 0.0) {
        sum.iter_mut().zip(line).for_each(|(sum, entry)| *sum += share * entry);
    }
}
