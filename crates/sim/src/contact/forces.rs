//! The forces of all elements at one instant or one stage of a step: F = law(p, r), p = e - W F, r = r_0 - Y F.
//!
//! W contains the compliance G of the rails and, inside a step, the mobility of the bodies. Y is the mobility that
//! acts on the rates. The active set is given; the caller checks that active elements push and that inactive ones
//! remain open.
//!
//! Newton's method is applied to rho(F) = F - law(e - W F, r_0 - Y F). The Jacobian is I + law_p W + law_r Y minus
//! the slopes of the laws with respect to other forces, over the elements whose laws act; the other elements have the
//! row F_i = 0. The step is halved while the residual increases, but not where another set of laws acts at its end: laws
//! that begin and cease to act are pieces of a function that is nearly linear in each of them, and a whole step reaches
//! the right piece sooner than many short ones. The iteration ends when the change of the forces or
//! their residual is within rounding, or when the residual is within the slack that the caller allows. If all
//! elements are linear vertical contacts, a single linear system is solved instead.

use super::candidates::Candidates;
use super::element::{Coupling, Law, Local, Query};
use super::system::System;
use crate::numerics::dense::{along, factor_general, solve_factored, solve_general, solve_spd};

/// Relative change of the forces at which Newton's method ends.
const TOLERANCE: f64 = 1e-13;
/// Relative change of the forces, or residual, at which Newton's method ends where rounding prevents a smaller one.
const STAGNANT: f64 = 1e-9;
const ITERATIONS: usize = 60;
/// Part of the residual up to which a step may leave it, for the factors to serve in the next one.
const CHORD: f64 = 1e-3;
/// Damping factor of the Newton step below which the step is not halved again. A brake on
/// a compliant rail sticks only within 1e-6 of the forces on either side, and within less in short steps.
const SHORTEST: f64 = 1e-12;
/// Number of whole steps to another set of acting laws that may increase the residual; if they do not lead to the solution,
/// it is sought from the first guess without them.
const LEAPS: usize = 6;
/// A rate at which every tangential law is at its limit.
const SATURATED: f64 = 1e150;

/// Type of the row of an element in the problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RowKind {
    /// The force follows from the law.
    Law,
    /// The force follows from the law, with the rate of the penetration: the row of Y is the row of W times this
    /// number.
    Memory(f64),
    /// The force follows from the law, with the rate of the penetration of a wheel that passes over a sloping rail: the row
    /// of Y is no multiple of that of W, and the problem is not symmetric.
    Passing,
    /// The force is prescribed.
    Given,
    /// The force keeps the displacement of the rail at this value, within the limits of the law.
    Keeps(f64),
}

/// The effect of all forces on penetrations and rates. The matrices are over all elements, row-major.
pub(crate) struct Effects {
    pub w: Vec<f64>,
    pub y: Vec<f64>,
    /// Approach e and rate r_0 without forces.
    pub approach: Vec<f64>,
    pub rate: Vec<f64>,
    pub kind: Vec<RowKind>,
}

/// Residuals of the laws, and their slopes.
struct Residuals {
    /// Penetration and rate of each element under the present forces; not updated for idle elements.
    reached: Vec<[f64; 2]>,
    /// Residual F - law(F) of every element; after the solution, Newton's change of the forces.
    value: Vec<f64>,
    /// Elements whose laws act, and the slopes of these laws.
    acting: Vec<usize>,
    slopes: Vec<Law>,
    couplings: Vec<Coupling>,
    /// Elements that do not act, but have a force.
    released: Vec<usize>,
    /// Whether a law was kept acting, or from acting.
    is_held: bool,
}

/// The laws that are to act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    /// Those that act at the present penetrations and rates.
    Natural,
    /// These, and those of elements with a force, as far as they can be continued.
    Continued,
    /// Those of the factored Jacobian, as far as they can be continued.
    Factored,
}

/// Whether the laws that act in a correction are those of the factored Jacobian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ActingLaws {
    Same,
    /// They were held to be those, where others would act.
    Held,
    Changed,
}

/// LU factors of a Jacobian over the elements that acted when it was built.
struct Factors {
    elements: Vec<usize>,
    jacobian: Vec<f64>,
    pivots: Vec<usize>,
}

/// The problem of the forces, solved repeatedly without allocation.
pub(crate) struct Problem {
    pub effects: Effects,
    /// Elements that may have a force; the others have none.
    pub candidates: Candidates,
    /// Elements that are assumed to have no force, independent of their laws; their columns of the mobility are not
    /// filled.
    pub idle: Vec<bool>,
    /// The candidates of which the problem consists: those that are not idle, and idle ones with a force to be released
    /// or on whose penetration others depend. Nothing is evaluated for other elements.
    pub sought: Vec<usize>,
    /// Allowed relative residual of the forces; zero if only rounding is allowed.
    pub slack: f64,
    residuals: Residuals,
    factors: Factors,
    /// Scratch: matrix and unknowns of the linear problem, forces and changes of Newton's method.
    matrix: Vec<f64>,
    unknown: Vec<usize>,
    first: Vec<f64>,
    start: Vec<f64>,
    newton: Vec<f64>,
    change: Vec<f64>,
}

impl Effects {
    /// Penetration of element `i` under `force`.
    pub fn penetration(&self, i: usize, force: &[f64]) -> f64 {
        self.approach[i] - along(&self.w, i, force)
    }

    fn rate_under(&self, i: usize, force: &[f64]) -> f64 {
        self.rate[i] - along(&self.y, i, force)
    }

    /// Force of element `i` that keeps the displacement of its rail, with the other forces of `force` unchanged.
    fn keeping(&self, i: usize, force: &[f64]) -> Option<f64> {
        let RowKind::Keeps(displacement) = self.kind[i] else { return None };
        let own = self.w[i * force.len() + i];
        Some(force[i] + (displacement - along(&self.w, i, force)) / own)
    }
}

impl Residuals {
    fn clear(&mut self) {
        self.acting.clear();
        self.slopes.clear();
        self.couplings.clear();
        self.value.fill(0.0);
        self.released.clear();
        self.is_held = false;
    }

    fn set_idle(&mut self, i: usize, force: f64) {
        self.value[i] = force;
        if force != 0.0 {
            self.released.push(i);
        }
    }

    fn set_acting(&mut self, i: usize, force: f64, law: Law) {
        self.value[i] = force - law.force;
        self.acting.push(i);
        self.slopes.push(law);
    }
}

impl Problem {
    pub fn new(elements: usize) -> Self {
        let m = elements;
        Problem {
            effects: Effects {
                w: vec![0.0; m * m],
                y: vec![0.0; m * m],
                approach: vec![0.0; m],
                rate: vec![0.0; m],
                kind: vec![RowKind::Law; m],
            },
            candidates: Candidates::all(m),
            idle: vec![false; m],
            sought: (0..m).collect(),
            slack: 0.0,
            residuals: Residuals {
                reached: vec![[0.0; 2]; m],
                value: vec![0.0; m],
                acting: Vec::with_capacity(m),
                slopes: Vec::with_capacity(m),
                couplings: Vec::new(),
                released: Vec::new(),
                is_held: false,
            },
            factors: Factors {
                elements: Vec::with_capacity(m),
                jacobian: vec![0.0; m * m],
                pivots: vec![0; m],
            },
            matrix: vec![0.0; m * m],
            unknown: Vec::with_capacity(m),
            first: vec![0.0; m],
            start: vec![0.0; m],
            newton: vec![0.0; m],
            change: vec![0.0; m],
        }
    }

    /// Makes all elements part of the problem.
    pub fn seek_all(&mut self) {
        self.idle.fill(false);
        self.candidates.choose(|_| true);
        self.seek(0, &[]);
    }

    /// Lists the elements of which the problem consists, where the first `verticals` elements are vertical contacts and
    /// `force` are the forces at the start.
    pub fn seek(&mut self, verticals: usize, force: &[f64]) {
        let Problem { candidates, idle, sought, .. } = self;
        let is_sought = |i: &usize| !idle[*i] || *i < verticals || force[*i] != 0.0;
        sought.clear();
        sought.extend(candidates.list().iter().copied().filter(is_sought));
    }

    /// Solves for the forces of the `active` elements; `force` contains the initial guess. Returns false if the
    /// solution fails.
    pub fn solve(&mut self, system: &System, local: &[Local], active: &[bool], force: &mut [f64]) -> bool {
        if system.traits.has_linear_laws && system.traits.is_vertical {
            return self.solve_linear(system, local, active, force);
        }
        self.solve_newton(system, local, active, force)
            || self.hold_penetrations(active, force) && self.solve_newton(system, local, active, force)
    }

    /// Sets `force` to the forces at which the penetrations that are states keep the values p* they had, W F = e - p*, and
    /// to zero in all other active elements. The law of a damper whose coefficient grows with the penetration is not monotone in
    /// it, so that Newton's method may end at p = 0 where it begins far from p*; in a short step the solution is near p*.
    /// Returns false if there are no such penetrations, or W is singular.
    fn hold_penetrations(&mut self, active: &[bool], force: &mut [f64]) -> bool {
        let m = force.len();
        let Effects { w, rate, kind, .. } = &self.effects;
        self.unknown.clear();
        self.unknown.extend((0..m).filter(|&i| active[i] && matches!(kind[i], RowKind::Memory(_))));
        let count = self.unknown.len();
        if count == 0 {
            return false;
        }
        for (row, &i) in self.unknown.iter().enumerate() {
            let RowKind::Memory(per_step) = kind[i] else { continue };
            // e - p* = g r_0.
            self.residuals.value[row] = rate[i] / per_step;
            for (column, &j) in self.unknown.iter().enumerate() {
                self.matrix[row * count + column] = w[i * m + j];
            }
        }
        let (matrix, held) = (&mut self.matrix[..count * count], &mut self.residuals.value[..count]);
        if !solve_general(matrix, held) {
            return false;
        }
        force.fill(0.0);
        for (&i, held) in self.unknown.iter().zip(held) {
            force[i] = *held;
        }
        true
    }

    /// Solves the linear system F/k + W F + (c/k) Y F = e + (c/k) r, with k and c multiplied by the number of wheels
    /// and the fraction.
    fn solve_linear(&mut self, system: &System, local: &[Local], active: &[bool], force: &mut [f64]) -> bool {
        let m = force.len();
        let Effects { w, y, approach, rate, kind } = &self.effects;
        self.factors.elements.clear();
        self.unknown.clear();
        self.unknown.extend((0..m).filter(|&i| active[i] && kind[i] != RowKind::Given));
        let count = self.unknown.len();
        for (row, &i) in self.unknown.iter().enumerate() {
            let law = system.law(i);
            let ratio = law.damping / law.stiffness;
            // A damper between wheel and rail has Y = W/step, so its row is divided by 1 + ratio/step.
            let (scale, by_rate) = match kind[i] {
                RowKind::Memory(per_step) => (1.0 / (1.0 + ratio * per_step), 0.0),
                _ => (1.0, ratio),
            };
            let mut rhs = (approach[i] + ratio * rate[i]) * scale;
            for (column, &j) in self.unknown.iter().enumerate() {
                self.matrix[row * count + column] = w[i * m + j] + by_rate * y[i * m + j];
            }
            for j in (0..m).filter(|&j| kind[j] == RowKind::Given) {
                rhs -= (w[i * m + j] + by_rate * y[i * m + j]) * force[j];
            }
            let wheels = system.mechanics.groups[i].count();
            self.matrix[row * count + row] += scale / (law.stiffness * wheels * local[i].fraction[0]);
            self.residuals.value[row] = rhs;
        }
        let (matrix, rhs) = (&mut self.matrix[..count * count], &mut self.residuals.value[..count]);
        let is_symmetric =
            system.traits.is_symmetric && !self.unknown.iter().any(|&i| kind[i] == RowKind::Passing);
        let is_solved = if is_symmetric { solve_spd(matrix, rhs) } else { solve_general(matrix, rhs) };
        for i in (0..m).filter(|&i| kind[i] != RowKind::Given) {
            force[i] = 0.0;
        }
        for (row, &i) in self.unknown.iter().enumerate() {
            force[i] = self.residuals.value[row];
        }
        is_solved
    }

    /// Newton's method with step halving for F - law(F) = 0. The factors of a Jacobian serve while the same laws act and
    /// every step leaves at most [`CHORD`] of the residual.
    fn solve_newton(&mut self, system: &System, local: &[Local], active: &[bool], force: &mut [f64]) -> bool {
        for i in (0..system.verticals()).filter(|&i| !active[i]) {
            force[i] = 0.0;
        }
        self.first.copy_from_slice(force);
        // Under a first guess of the forces, laws that act may seem to have ceased.
        let mut size = self.evaluate(system, local, active, force, Wanted::Continued);
        let (mut is_current, mut leaps) = (false, LEAPS);
        for _ in 0..ITERATIONS {
            let before = size;
            if !(is_current && self.residuals.acting == self.factors.elements || self.factor()) {
                return false;
            }
            self.take_newton_step();
            let scale = largest(force);
            let change = largest(&self.residuals.value);
            self.start.copy_from_slice(force);
            self.newton.copy_from_slice(&self.residuals.value);
            let mut damping = 1.0;
            loop {
                for (f, (start, newton)) in force.iter_mut().zip(self.start.iter().zip(&self.newton)) {
                    *f = start - damping * newton;
                }
                let now = self.evaluate(system, local, active, force, Wanted::Natural);
                if now <= size || now <= TOLERANCE * scale || damping < SHORTEST {
                    size = now;
                    break;
                }
                let is_elsewhere = self.residuals.acting != self.factors.elements;
                if damping == 1.0 && is_elsewhere && leaps > 0 && now.is_finite() {
                    size = now;
                    leaps -= 1;
                    if leaps == 0 {
                        force.copy_from_slice(&self.first);
                        size = self.evaluate(system, local, active, force, Wanted::Natural);
                    }
                    break;
                }
                // In very short steps, c times the rounding error of a rate exceeds the residual that is allowed, but the
                // forces change by far less.
                if damping == 1.0 && change <= STAGNANT * scale {
                    return true;
                }
                damping *= 0.5;
            }
            let done = TOLERANCE * scale.max(f64::MIN_POSITIVE);
            if change <= done || size <= (0.1 * done).max(self.slack * scale) {
                return true;
            }
            is_current = size <= CHORD * before;
        }
        // The residual may stagnate at rounding; it is accepted if it is small relative to the forces.
        size <= STAGNANT * largest(force)
    }

    /// Evaluates the residuals of the laws under `force` with W and Y; returns the largest absolute residual.
    fn evaluate(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &[f64],
        wanted: Wanted,
    ) -> f64 {
        for &i in &self.sought {
            // The rates of other elements depend on no force.
            let has_rate = system.fixed[i].feels_rates || system.fixed[i].has_memory;
            let effects = &self.effects;
            let rate = if has_rate { effects.rate_under(i, force) } else { effects.rate[i] };
            self.residuals.reached[i] = [effects.penetration(i, force), rate];
        }
        self.evaluate_laws(system, local, active, force, wanted);
        largest(&self.residuals.value)
    }

    /// Fills the residuals F - law(p, r) under `force` at the stored penetrations and rates, the list of acting
    /// elements, and the slopes of their laws. The residual of an element that does not act is its force.
    fn evaluate_laws(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &[f64],
        wanted: Wanted,
    ) {
        let holds = wanted == Wanted::Factored;
        let Problem { effects, idle, sought, residuals, factors, .. } = self;
        residuals.clear();
        let m = force.len();
        let mut held = factors.elements.iter().peekable();
        for &i in &*sought {
            let is_held = holds && held.next_if_eq(&&i).is_some();
            if effects.kind[i] == RowKind::Given {
                continue;
            }
            let mut query = Query {
                index: i,
                rate: residuals.reached[i][1],
                reached: &residuals.reached,
                force,
                local: &local[i],
                is_active: active[i] && !idle[i],
                fall: effects.y[i * m + i],
                continues: wanted == Wanted::Continued,
            };
            let keeping = effects.keeping(i, force);
            if let Some(wanted) = keeping {
                // The force that keeps the rail displacement is bounded by the force of the law at a saturated rate.
                (query.rate, query.fall) = (SATURATED.copysign(wanted), 0.0);
            }
            let known = residuals.couplings.len();
            let mut found = system.elements[i].law(&query, &mut residuals.couplings);
            if holds && found.is_some() != is_held {
                residuals.is_held = true;
                residuals.couplings.truncate(known);
                query.continues = is_held;
                found = if is_held { system.elements[i].law(&query, &mut residuals.couplings) } else { None };
            }
            let Some(mut law) = found else {
                residuals.set_idle(i, force[i]);
                continue;
            };
            if let Some(wanted) = keeping {
                law = Law { force: law.force, ..Law::default() };
                if wanted.abs() <= law.force * wanted.signum() {
                    // The residual is (W F - displacement)/W_ii, so the row of the Jacobian is that of W/W_ii. The
                    // coupling of slope 1 cancels the diagonal entry of the identity.
                    residuals.couplings.truncate(known);
                    residuals.couplings.push(Coupling { element: i, by: i, slope: 1.0 });
                    law = Law { force: wanted, by_penetration: 1.0 / effects.w[i * m + i], ..Law::default() };
                }
            }
            residuals.set_acting(i, force[i], law);
        }
    }

    /// Factors the Jacobian of the acting laws: I + law_p W + law_r Y minus the slopes with respect to other forces.
    /// Returns false if it is singular.
    fn factor(&mut self) -> bool {
        let Problem { effects: Effects { w, y, .. }, residuals, factors, .. } = self;
        let Factors { elements, jacobian, pivots } = factors;
        let (m, count) = (residuals.value.len(), residuals.acting.len());
        for (row, &i) in residuals.acting.iter().enumerate() {
            let line = &mut jacobian[row * count..(row + 1) * count];
            let (own_w, own_y) = (&w[i * m..(i + 1) * m], &y[i * m..(i + 1) * m]);
            let Law { by_penetration, by_rate, by_other, .. } = residuals.slopes[row];
            for (entry, &j) in line.iter_mut().zip(&residuals.acting) {
                *entry = by_penetration * own_w[j] + by_rate * own_y[j];
            }
            if let Some((other, slope)) = by_other {
                let w = &w[other * m..(other + 1) * m];
                line.iter_mut().zip(&residuals.acting).for_each(|(entry, &j)| *entry += slope * w[j]);
            }
            line[row] += 1.0;
        }
        elements.clear();
        elements.extend_from_slice(&residuals.acting);
        for &Coupling { element, by, slope } in &residuals.couplings {
            let place = |of| residuals.acting.iter().position(|own| *own == of);
            if let (Some(row), Some(column)) = (place(element), place(by)) {
                jacobian[row * count + column] -= slope;
            }
        }
        factor_general(&mut jacobian[..count * count], &mut pivots[..count])
    }

    /// Replaces the residuals by Newton's change of the forces, using the factored Jacobian. The rows of elements
    /// that do not act are those of the identity.
    fn take_newton_step(&mut self) {
        let Problem { effects: Effects { w, y, .. }, residuals, factors, change, .. } = self;
        let (m, count) = (residuals.value.len(), factors.elements.len());
        for (row, &i) in factors.elements.iter().enumerate() {
            change[row] = residuals.value[i];
            for &j in &residuals.released {
                let Law { by_penetration, by_rate, .. } = residuals.slopes[row];
                let entry = by_penetration * w[i * m + j] + by_rate * y[i * m + j];
                change[row] -= entry * residuals.value[j];
            }
        }
        let (jacobian, pivots) = (&factors.jacobian[..count * count], &factors.pivots[..count]);
        solve_factored(jacobian, pivots, &mut change[..count]);
        for (row, &i) in factors.elements.iter().enumerate() {
            residuals.value[i] = change[row];
        }
    }

    /// Sums of the magnitudes of the changes of the forces by each set of `errors` of penetrations and rates, times its
    /// weight, with the W and Y of the last problem, into `out`. `forces` are the system, the local properties of the elements,
    /// the active elements and the forces; `None` if the laws were evaluated under these forces last, and the Jacobian is
    /// that of W and Y. Returns false if the Jacobian is singular.
    pub fn add_responses(
        &mut self,
        forces: Option<(&System, &[Local], &[bool], &[f64])>,
        errors: [(&[[f64; 2]], f64); 3],
        out: &mut [f64],
    ) -> bool {
        out.fill(0.0);
        if let Some((system, local, active, force)) = forces {
            self.evaluate(system, local, active, force, Wanted::Natural);
        }
        let is_current = forces.is_none() && self.residuals.acting == self.factors.elements;
        if !(is_current || self.factor()) {
            return false;
        }
        self.residuals.released.clear();
        for (errors, weight) in errors {
            self.residuals.value.fill(0.0);
            for (&i, law) in self.residuals.acting.iter().zip(&self.residuals.slopes) {
                let by_other = law.by_other.map_or(0.0, |(other, slope)| slope * errors[other][0]);
                self.residuals.value[i] =
                    law.by_penetration * errors[i][0] + law.by_rate * errors[i][1] + by_other;
            }
            self.take_newton_step();
            out.iter_mut().zip(&self.residuals.value).for_each(|(out, by)| *out += weight * by.abs());
        }
        true
    }

    /// Whether a factored Jacobian is available.
    pub fn is_factored(&self) -> bool {
        !self.factors.elements.is_empty()
    }

    /// Newton's change of the forces at penetrations and rates that the caller has set, with the factors of an
    /// earlier Jacobian. If `holds` is true, the laws that act are those of the factored one, as far as they can be
    /// continued: under a first guess of the forces others may seem to act. If the set of acting laws differs from the
    /// factored one, the Jacobian is that of these laws and the W and Y of the earlier one. Returns `None` if it is singular.
    pub fn corrections(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &[f64],
        holds: bool,
    ) -> Option<(&[f64], ActingLaws)> {
        let wanted = if holds { Wanted::Factored } else { Wanted::Natural };
        self.evaluate_laws(system, local, active, force, wanted);
        let is_earlier = self.residuals.acting == self.factors.elements;
        if !(is_earlier || self.factor()) {
            return None;
        }
        self.take_newton_step();
        let laws = match (is_earlier, self.residuals.is_held) {
            (true, false) => ActingLaws::Same,
            (true, true) => ActingLaws::Held,
            (false, _) => ActingLaws::Changed,
        };
        Some((&self.residuals.value, laws))
    }

    /// Force of element `i` at a given penetration and rate.
    pub fn force_at(
        &mut self,
        system: &System,
        local: &[Local],
        i: usize,
        reached: [f64; 2],
        force: &[f64],
    ) -> f64 {
        self.residuals.reached[i] = reached;
        let query = Query {
            index: i,
            rate: reached[1],
            reached: &self.residuals.reached,
            force,
            local: &local[i],
            is_active: true,
            fall: 0.0,
            continues: false,
        };
        let known = self.residuals.couplings.len();
        let law = system.elements[i].law(&query, &mut self.residuals.couplings);
        self.residuals.couplings.truncate(known);
        law.map_or(0.0, |law| law.force)
    }

    /// Sets the penetration and the rate of element `i`.
    pub fn set_reached(&mut self, i: usize, reached: [f64; 2]) {
        self.residuals.reached[i] = reached;
    }
}

/// Largest absolute entry.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0_f64, |max, value| max.max(value.abs()))
}
