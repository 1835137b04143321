//! The adaptive force-form stepper: every stage of an SDIRK method is one contact solution.
//!
//! Within a step the set of wheels in contact is fixed, so that the solution is smooth and the method keeps
//! its order; the instant at which a wheel leaves or meets the rail is located on the step's interpolant and
//! the step is taken again to end there. Steps also end at the breaks of motions and rails.

use nalgebra::DVector;

use crate::contact::solver::Solver;
use crate::mechanics::state::{Known, State};
use crate::record::energy::{Exchanged, boundary, power, stored};
use crate::time::collocation::Collocation;
use crate::time::counts::Counts;
use crate::time::nodes::Nodes;
use crate::time::tableau::{SDIRK4, Tableau};
use crate::time::triggers::Triggers;
use crate::{Audit, Error, Method};

/// How often a step is taken again to end at an event.
const REFINEMENTS: usize = 40;

/// How many of these end where the event is guessed to be.
const GUESSES: usize = 20;

/// How often a step is taken again to end at a corner of a drive.
const CORNERS: usize = 12;

/// Share of the step planned below which what happens is taken to happen where it starts: shorter steps have rounding
/// for rates.
const NOW: f64 = 1e-6;

/// Steps in a row that may end at events: beyond, contacts chatter and the run cannot get on.
const CHATTER: usize = 1000;

/// Steps in a row that may end at events before the next is at most [`WIDER`] times the last: from far beyond an event a
/// secant always falls short of it.
const SHORT: usize = 2;
const WIDER: f64 = 16.0;

/// What the passes of a stage may leave of the error a step may make.
const SETTLED: f64 = 1e-6;

/// Error of a step above which the passes of one stage tell those of the next all they need to know.
const LOOSE: f64 = 1e-4;

/// Way of a wheel, beside its radius and for each unit of the error a step may make, over which the slope of its rail
/// stands for its compliance.
const NEAR: f64 = 1e-3;

/// Steps for which the way of the wheels is laid.
const WAY: f64 = 4.0;

/// Force by which a step may end beyond an event, relative to the largest contact force.
pub(crate) const OVERSHOOT: f64 = 1e-9;

/// Times as far before a break a step may start and cross it: what ends there has passed all breaks that near, and every
/// stage is beyond them.
pub(crate) const PASSED: f64 = 8.0;

/// How often a step is taken again to end where a rule acts.
const TRIALS: usize = 20;

/// Why a step could not be taken.
pub(crate) enum Failure {
    TooSmall,
    Refused(Error),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Failure::Refused(error)
    }
}

/// A run in progress.
pub(crate) struct Stepper<'a, 'b> {
    pub solver: &'b mut Solver<'a>,
    pub from: State,
    pub to: State,
    /// The end of the step as the step reached it, before a break or an event changed its forces.
    pub arrived: State,
    pub counts: Counts,
    pub audit: Audit,
    tableau: &'static Tableau,
    /// In place of the tableau.
    pub(crate) collocation: Option<Collocation>,
    pub(crate) tolerance: f64,
    /// Length of every step that no break or event ends; in place of the tolerance.
    pub fixed: Option<f64>,
    scale: DVector<f64>,
    rate_scale: DVector<f64>,
    /// Of the smallest wheel.
    radius: f64,
    h: f64,
    last_error: f64,
    limit: f64,
    /// Largest contact force so far, at least the weight.
    pub(crate) force_scale: f64,
    /// Smallest steps in a row.
    stalled: usize,
    /// Steps in a row that ended at an event.
    chatter: usize,
    stage: State,
    known: Known,
    accelerations: Vec<DVector<f64>>,
    rates: Vec<DVector<f64>>,
    p_rates: Vec<Vec<f64>>,
    forces: Vec<Vec<f64>>,
    powers: Vec<Exchanged>,
    pub(crate) probe: State,
    /// Overlaps of the flanges where the next step starts.
    pub(crate) overlaps: Vec<f64>,
    pub(crate) triggers: Triggers,
    begun: f64,
    /// The wheel that meets a break of its rail where the step ends.
    pub(crate) meets: Option<usize>,
    /// Boundary term of the grounded dampers where the next step starts.
    pub(crate) boundary: f64,
}

impl<'a, 'b> Stepper<'a, 'b> {
    /// A run from `start`, in which the solver's active contacts are settled.
    ///
    /// # Errors
    /// A rule of something that is not recorded.
    pub fn new(solver: &'b mut Solver<'a>, start: State, tolerance: f64, first: f64) -> Result<Self, Error> {
        let system = solver.system;
        let (n, count) = (system.mechanics.dofs, start.p.len());
        let tableau = &SDIRK4;
        let energy = stored(system, &solver.geometry, &start);
        let (scale, rate_scale) = floors(solver, &start);
        for i in 0..system.mechanics.groups.len() {
            if !solver.active[i] && solver.kept[i].is_none() {
                solver.keep(i, &start);
            }
        }
        Ok(Stepper {
            triggers: Triggers::new(system)?,
            to: start.clone(),
            arrived: start.clone(),
            stage: start.clone(),
            probe: start.clone(),
            boundary: boundary(system, &solver.geometry, &start),
            overlaps: solver.overlaps(&start),
            from: start,
            counts: Counts::default(),
            audit: Audit { start: energy, end: energy, ..Audit::default() },
            tableau,
            collocation: None,
            tolerance,
            fixed: None,
            scale,
            rate_scale,
            radius: system.scene.wheels.iter().fold(f64::INFINITY, |min, wheel| min.min(wheel.radius)),
            h: first,
            last_error: 1.0,
            limit: f64::INFINITY,
            force_scale: system.scene.bodies.iter().map(|body| body.mass * system.scene.gravity).sum(),
            stalled: 0,
            chatter: 0,
            known: Known { q: DVector::zeros(n), v: DVector::zeros(n), p: vec![0.0; count] },
            accelerations: vec![DVector::zeros(n); tableau.stages()],
            rates: vec![DVector::zeros(n); tableau.stages()],
            p_rates: vec![vec![0.0; count]; tableau.stages()],
            forces: vec![vec![0.0; system.components()]; tableau.stages()],
            powers: vec![Exchanged::default(); tableau.stages()],
            begun: energy.total(),
            meets: None,
            solver,
        })
    }

    /// Takes the steps by `method`, which suits the scene.
    pub fn by(mut self, method: Method) -> Self {
        self.collocation =
            Nodes::new(method).map(|nodes| Collocation::new(self.solver.system, nodes, &self.to));
        self
    }

    /// Lets the passes of a stage end where what is left of them is [`SETTLED`] of the error a step may make.
    fn relax(&mut self) {
        if self.fixed.is_some() || self.collocation.is_some() {
            return;
        }
        let by_others = (self.tolerance / LOOSE).min(1.0).powi(2);
        self.solver.settled = [1.0, by_others].map(|share| share * SETTLED * self.tolerance);
        self.solver.geometry.near = NEAR * self.tolerance;
        self.solver.geometry.reach = (NEAR * self.tolerance).sqrt() * self.radius;
        match &mut self.solver.scales {
            Some([scale, rate_scale]) => {
                scale.copy_from(&self.scale);
                rate_scale.copy_from(&self.rate_scale);
            }
            none => *none = Some([self.scale.clone(), self.rate_scale.clone()]),
        }
    }

    /// Takes one accepted step, at most to `limit`; `from` and `to` are its ends.
    pub fn advance(&mut self, limit: f64) -> Result<(), Failure> {
        self.limit = limit;
        self.relax();
        let widest = if self.chatter > SHORT { WIDER * (self.to.t - self.from.t) } else { f64::INFINITY };
        self.from.copy_from(&self.to);
        let start = self.from.t;
        let smallest = 1e-13 * limit.abs().max(1e-3);
        let planned = self.fixed.unwrap_or(self.h.min(widest));
        let shortest = (NOW * planned).max(2.0 * smallest);
        let mut h = planned.min(limit - start);
        // Do not leave a sliver before the limit.
        if limit - start - h < if self.fixed.is_some() { 1e-9 } else { 0.1 } * h {
            h = limit - start;
        }
        let mut ends_at_event = false;
        self.meets = None;
        let (mut refined, mut corners, mut breaks, mut trials) = (0, 0, 0, 0);
        if let Some(share) = self.predicted_break(h).filter(|share| h * share > 2.0 * smallest) {
            breaks += 1;
            ends_at_event = true;
            h *= share;
        }
        self.lay_way(h);
        loop {
            if h < smallest {
                return Err(Failure::TooSmall);
            }
            if let Some(shorter) = self.prescribed_break(start, h) {
                h = shorter;
            }
            let error = match (self.attempt(h)?, self.fixed) {
                (false, _) => f64::INFINITY,
                (true, None) => self.error(),
                (true, Some(_)) => 0.0,
            };
            // Beyond a break the error says nothing of the step that ends before it.
            if error.is_finite()
                && breaks < REFINEMENTS
                && let Some(share) = self.rolling_break()
            {
                breaks += 1;
                ends_at_event = true;
                h = (h * share).max(2.0 * smallest);
                continue;
            }
            // A flange that touches or lets go within a step matters where the step errs by more than it may.
            let locates = error.is_finite() && (error > 1.0 || self.fixed.is_some()) && corners < CORNERS;
            if locates
                && h > shortest
                && let Some(share) = self.first_touch()?
            {
                corners += 1;
                ends_at_event = true;
                h = (h * share).max(shortest);
                continue;
            }
            if error > 1.0 {
                self.counts.rejected += 1;
                h *= if error.is_finite() { (0.9 * error.powf(-0.25)).clamp(0.1, 0.9) } else { 0.25 };
                h = self.rounded(h);
                ends_at_event = false;
                continue;
            }
            if let Some((share, excess)) = self.first_event()? {
                ends_at_event = true;
                let is_beyond = excess > OVERSHOOT * self.largest_force();
                if is_beyond && h > shortest && refined < REFINEMENTS {
                    refined += 1;
                    // Where guesses do not come nearer, half of the step does.
                    h *= if refined < GUESSES { share } else { 0.5 };
                    h = h.max(shortest);
                    continue;
                }
            }
            if trials < TRIALS
                && let Some(shorter) = self.first_trigger(h)?
            {
                trials += 1;
                ends_at_event = true;
                h = shorter.max(2.0 * smallest);
                continue;
            }
            if let Some(share) = self.first_corner().filter(|_| corners < CORNERS && h > shortest) {
                corners += 1;
                ends_at_event = true;
                h = (h * share).max(shortest);
                continue;
            }
            let growth = if error > 0.0 { 0.9 * error.powf(-0.175) * self.last_error.powf(0.1) } else { 5.0 };
            // A step cut short says nothing of the error of longer ones.
            if !ends_at_event {
                self.last_error = error.max(1e-4);
                let proposed = h * growth.clamp(0.2, 5.0);
                // A step cut short by a limit says nothing against the longer one that was planned.
                let wanted = if h < self.h && growth > 1.0 { proposed.max(self.h) } else { proposed };
                self.h = self.rounded(wanted);
            }
            break;
        }
        self.stalled = if h <= 4.0 * smallest { self.stalled + 1 } else { 0 };
        self.chatter = if ends_at_event && breaks == 0 { self.chatter + 1 } else { 0 };
        if self.stalled > REFINEMENTS || self.chatter > CHATTER {
            return Err(Failure::TooSmall);
        }
        self.accept(h)?;
        Ok(())
    }

    /// Lays the way of the wheels in a step of length `h`, by the accelerations where it starts.
    fn lay_way(&mut self, h: f64) {
        if self.solver.geometry.reach == 0.0 {
            return;
        }
        let (from, to, beyond) = (&self.from, &mut self.probe, &mut self.stage);
        for (h, at) in [(h, &mut *to), (WAY * h, &mut *beyond)] {
            at.t = from.t + h;
            at.q.copy_from(&from.q);
            at.q.axpy(h, &from.v, 1.0);
            at.q.axpy(0.5 * h * h, &from.a, 1.0);
        }
        let ends = [from, &*to, &*beyond].map(|at| (at.t, &at.q));
        self.solver.geometry.lay(self.solver.system, ends);
    }

    /// `h`, brought down to a power of 2^(1/4) where answers of modes are kept by the length of step.
    fn rounded(&self, h: f64) -> f64 {
        match &self.collocation {
            Some(collocation) if collocation.is_modal() => ((4.0 * h.log2() + 1e-9).floor() / 4.0).exp2(),
            _ => h,
        }
    }

    /// One step of the method with the active contacts; false where a stage does not converge.
    fn attempt(&mut self, h: f64) -> Result<bool, Error> {
        if let Some(collocation) = &mut self.collocation {
            self.counts.stages += collocation.count();
            let done = collocation.attempt(self.solver, &self.from, h, self.limit, &mut self.to)?;
            self.stage.t = self.to.t;
            self.end_at_limit(h);
            return Ok(done);
        }
        let tableau = self.tableau;
        let gamma_h = tableau.gamma * h;
        self.stage.copy_from(&self.from);
        self.solver.chart(&self.from);
        self.solver.contraction = f64::INFINITY;
        self.solver.factors_of = None;
        for i in 0..tableau.stages() {
            self.known.q.copy_from(&self.from.q);
            self.known.v.copy_from(&self.from.v);
            self.solver.charts.begun(&mut self.known.q, &mut self.known.v);
            self.known.p.copy_from_slice(&self.from.p);
            for (j, weight) in tableau.a[i].iter().enumerate() {
                self.known.q.axpy(h * weight, &self.rates[j], 1.0);
                self.known.v.axpy(h * weight, &self.accelerations[j], 1.0);
                for (p, rate) in self.known.p.iter_mut().zip(&self.p_rates[j]) {
                    *p += h * weight * rate;
                }
            }
            // just before the end: a prescribed motion may jump there
            self.stage.t = (self.from.t + tableau.c[i] * h).min(self.limit.next_down());
            self.guess(i);
            self.counts.stages += 1;
            if !self.solver.stage(gamma_h, &mut self.known, &mut self.stage)? {
                return Ok(false);
            }
            self.forces[i].copy_from_slice(&self.stage.force);
            self.accelerations[i].copy_from(&self.stage.a);
            self.rates[i].copy_from(&self.stage.v);
            let switches = &self.solver.geometry.switches;
            let rates = [&mut self.rates[i], &mut self.accelerations[i]];
            self.solver.charts.settle(self.solver.system, switches, &self.stage, rates);
            self.p_rates[i].copy_from_slice(&self.stage.p_rate);
            self.solver.geometry.update_rail_slope(self.solver.system, &self.stage.q, &self.stage.force);
            self.powers[i] = power(self.solver.system, &self.solver.geometry, &self.stage);
        }
        self.to.copy_from(&self.stage);
        self.end_at_limit(h);
        Ok(self.to.q.iter().chain(self.to.v.iter()).all(|x| x.is_finite()))
    }

    /// Guesses accelerations and forces of stage `i` from the step's start and its stages before.
    fn guess(&mut self, i: usize) {
        if i == 0 || !self.solver.system.moves_freely {
            return;
        }
        let c = self.tableau.c;
        // Lagrange's weights of 0 and the abscissae before.
        let node = |j: usize| j.checked_sub(1).map_or(0.0, |j| c[j]);
        let weight = |j: usize| {
            let others = (0..=i).filter(|&k| k != j);
            others.map(|k| (c[i] - node(k)) / (node(j) - node(k))).product::<f64>()
        };
        let charts = &self.solver.charts;
        let guided = |k: &usize| !charts.has(*k);
        let first = weight(0);
        for k in (0..self.stage.a.len()).filter(guided) {
            self.stage.a[k] = first * self.from.a[k];
        }
        self.stage.force.iter_mut().zip(&self.from.force).for_each(|(to, from)| *to = first * from);
        for j in 0..i {
            let share = weight(j + 1);
            for k in (0..self.stage.a.len()).filter(guided) {
                self.stage.a[k] += share * self.accelerations[j][k];
            }
            self.stage.force.iter_mut().zip(&self.forces[j]).for_each(|(to, from)| *to += share * from);
        }
    }

    fn end_at_limit(&mut self, h: f64) {
        self.to.t = (self.from.t + h).min(self.limit);
        if self.limit - self.to.t < 1e-14 * self.limit {
            self.to.t = self.limit;
        }
    }

    /// Sets `at` to the interpolant of the step just taken, at its share `share`.
    ///
    /// # Errors
    /// What the rail refuses.
    pub fn sample(&mut self, share: f64, at: &mut State) -> Result<(), Error> {
        interpolate(self.solver, self.collocation.as_ref(), [&self.from, &self.arrived], share, at)
    }

    /// Embedded error relative to the tolerance.
    fn error(&self) -> f64 {
        let h = self.to.t - self.from.t;
        let mut largest = 0.0_f64;
        let of = |i: usize| {
            let mut error = [0.0; 2];
            if let Some(collocation) = &self.collocation {
                return collocation.error(i).map(|error| error / h);
            }
            for (j, weight) in self.tableau.error.iter().enumerate() {
                error[0] += weight * self.rates[j][i];
                error[1] += weight * self.accelerations[j][i];
            }
            error
        };
        let mut weigh = |i: usize, [dq, dv]: [f64; 2]| {
            let scale = self.scale[i].max(self.to.q[i].abs());
            let rate_scale = self.rate_scale[i].max(self.to.v[i].abs());
            largest = largest.max((h * dq / scale).abs()).max((h * dv / rate_scale).abs());
        };
        let charts = &self.solver.charts;
        (0..self.to.q.len()).filter(|&i| !charts.has(i)).for_each(|i| weigh(i, of(i)));
        charts.errors(self.solver.system, &self.solver.geometry.switches, &self.to, of, weigh);
        largest / self.tolerance
    }

    /// Books the step: audit, scales, and the contacts that open or close at its end.
    fn accept(&mut self, h: f64) -> Result<(), Error> {
        let system = self.solver.system;
        self.counts.steps += 1;
        self.arrived.copy_from(&self.to);
        self.force_scale = self.largest_force();
        let mut booked = Exchanged::default();
        if let Some(collocation) = &self.collocation {
            booked = collocation.booked();
        } else {
            for (i, power) in self.powers.iter().enumerate() {
                booked.add(power, h * self.tableau.weight(i));
            }
        }
        self.audit.exchanged.add(&booked, 1.0);
        // Before a turn or an event changes the forces: that is the next step's start.
        let end = boundary(system, &self.solver.geometry, &self.to);
        self.audit.exchanged.dampers += end - self.boundary;
        self.reach_end()?;
        for i in 0..self.to.q.len() {
            self.scale[i] = self.scale[i].max(self.to.q[i].abs());
            self.rate_scale[i] = self.rate_scale[i].max(self.to.v[i].abs());
        }
        if self.to.t >= self.limit {
            self.turn()?;
        }
        self.audit.exchanged.steps += self.pass_joint()?;
        let before = stored(system, &self.solver.geometry, &self.to);
        let crosses = system.is_uneven && self.solver.cross(&mut self.to)?;
        let due = crosses
            || (0..system.mechanics.groups.len()).any(|i| {
                (self.solver.active[i] && self.solver.opens(i, &self.to)) || self.event(i, &self.to) > 0.0
            })
            || (0..system.links.len()).any(|i| self.event(system.link(i), &self.to) > 0.0);
        let mut after = before;
        if due {
            let flags = self.solver.active.clone();
            let taut = self.solver.taut();
            if self.solver.settle(&mut self.to)? {
                self.counts.events += usize::from(flags != self.solver.active || taut != self.solver.taut());
                after = stored(system, &self.solver.geometry, &self.to);
                let gained = after.total() - before.total();
                let exchanged = &mut self.audit.exchanged;
                *(if crosses { &mut exchanged.steps } else { &mut exchanged.switches }) +=
                    if crosses { gained } else { -gained };
            }
        }
        self.boundary = boundary(system, &self.solver.geometry, &self.to);
        self.overlaps = self.solver.overlaps(&self.to);
        self.audit.end = after;
        let mut elastic = after.contact + after.structure + after.ropes;
        if !system.links.is_empty() {
            elastic = elastic.max(after.kinetic);
        }
        self.audit.peak_stored = self.audit.peak_stored.max(elastic);
        let imbalance = (after.total() + self.audit.exchanged.net_loss() - self.begun).abs();
        self.audit.imbalance = self.audit.imbalance.max(imbalance);
        Ok(())
    }

    /// Brings the geometry of grounded wheels from the last stage to the end of the step. It is there already where
    /// places depend on time alone and the stage was not held just before a limit.
    fn reach_end(&mut self) -> Result<(), Error> {
        let system = self.solver.system;
        let is_there = system.constant_rows && self.stage.t == self.to.t;
        let grounded = system.scene.wheels.iter().any(|wheel| wheel.normal.is_grounded());
        if grounded && !is_there {
            self.solver.geometry.update(system, self.to.t, &self.to.q, &self.to.force)?;
        }
        Ok(())
    }

    /// Passes a break of the prescribed motions: what a jump of speed does to the energy is their work, and
    /// accelerations are those after the break.
    fn turn(&mut self) -> Result<(), Error> {
        let system = self.solver.system;
        let after = stored(system, &self.solver.geometry, &self.to).kinetic;
        let t = self.to.t;
        self.to.t = t.next_down();
        let before = stored(system, &self.solver.geometry, &self.to).kinetic;
        self.to.t = t;
        self.audit.exchanged.drives += after - before;
        self.solver.instant(&mut self.to)?;
        Ok(())
    }
}

/// Sets `at` to the interpolant between the ends of the step last tried, at its share `share`; modes where `collocation`
/// has them.
///
/// # Errors
/// What the rail refuses.
pub(crate) fn interpolate(
    solver: &mut Solver,
    collocation: Option<&Collocation>,
    ends: [&State; 2],
    share: f64,
    at: &mut State,
) -> Result<(), Error> {
    solver.interpolate(ends, share, at)?;
    if let Some(collocation) = collocation {
        collocation.interpolate(ends[0], share, at);
    }
    Ok(())
}

/// Smallest displacements and rates that the error is measured against: the penetration at rest, carried
/// to each freedom by its lever, and the bounce that belongs to it.
fn floors(solver: &Solver, start: &State) -> (DVector<f64>, DVector<f64>) {
    let system = solver.system;
    let n = system.mechanics.dofs;
    let depth = start.p[..system.mechanics.groups.len()].iter().fold(0.0_f64, |max, p| max.max(*p));
    let radius = system.scene.wheels.iter().fold(1.0_f64, |max, wheel| max.max(wheel.radius));
    let depth = if depth > 0.0 { depth } else { 1e-3 * radius };
    let frequency = if system.scene.gravity > 0.0 { (system.scene.gravity / depth).sqrt() } else { 1.0 };
    let lever = |k: usize| {
        let rows = solver.geometry.rows.iter().chain(&solver.geometry.rate_rows).skip(k).step_by(n);
        rows.fold(0.0_f64, |max, r| max.max(r.abs()))
    };
    let scale = DVector::from_fn(n, |k, _| {
        let lever = lever(k);
        if lever > 0.0 { depth / lever } else { depth }
    });
    let rates = &scale * frequency;
    (scale, rates)
}

#[cfg(test)]
mod tests;
