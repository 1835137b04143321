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

mod linear;
mod newton;

use super::candidates::Candidates;
use super::element::{Coupling, Law, Local, Query};
use super::system::System;
use crate::numerics::dense::along;

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
    /// Elements whose laws were kept acting.
    held: Vec<usize>,
}

/// The laws that are to act.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wanted {
    /// Those that act at the present penetrations and rates.
    Natural,
    /// These, and those of elements with a force, as far as they can be continued.
    Continued,
    /// The first, and those of the factored Jacobian, as far as they can be continued.
    Factored,
}

/// Whether the laws that act in a correction are those of the factored Jacobian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ActingLaws {
    Same,
    /// Laws among them were kept acting that do not act under the forces found.
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
    /// Whether W and Y are those of the last solution, whose factors then serve while the same laws act.
    pub is_repeated: bool,
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
        let RowKind::Keeps(displacement) = self.kind[i] else {
            return None;
        };
        let own = self.w[i * force.len() + i];
        Some(force[i] + (displacement - along(&self.w, i, force)) / own)
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
            is_repeated: false,
            residuals: Residuals {
                reached: vec![[0.0; 2]; m],
                value: vec![0.0; m],
                acting: Vec::with_capacity(m),
                slopes: Vec::with_capacity(m),
                couplings: Vec::new(),
                released: Vec::new(),
                held: Vec::with_capacity(m),
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
        let Problem {
            candidates,
            idle,
            sought,
            ..
        } = self;
        let is_sought = |i: &usize| !idle[*i] || *i < verticals || force[*i] != 0.0;
        sought.clear();
        sought.extend(candidates.list().iter().copied().filter(is_sought));
    }

    /// Solves for the forces of the `active` elements; `force` contains the initial guess. Returns false if the
    /// solution fails.
    pub fn solve(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &mut [f64],
    ) -> bool {
        if system.traits.has_linear_laws && system.traits.is_vertical {
            return self.solve_linear(system, local, active, force);
        }
        self.solve_newton(system, local, active, force)
            || self.hold_penetrations(active, force)
                && self.solve_newton(system, local, active, force)
    }

    /// Evaluates the laws under `force` and factors their Jacobian with the W and Y of the last problem. Returns false if it is
    /// singular.
    pub fn linearise(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &[f64],
    ) -> bool {
        self.evaluate(system, local, active, force, Wanted::Natural);
        self.factor()
    }

    /// Sums of the magnitudes of the changes of the forces by each set of `errors` of penetrations and rates, times its
    /// weight, into `out`, with the laws evaluated last and the W and Y of the last problem. Returns false if the Jacobian is
    /// singular.
    pub fn add_responses(&mut self, errors: [(&[[f64; 2]], f64); 3], out: &mut [f64]) -> bool {
        out.fill(0.0);
        if !(self.residuals.acting == self.factors.elements || self.factor()) {
            return false;
        }
        self.residuals.released.clear();
        for (errors, weight) in errors {
            self.residuals.value.fill(0.0);
            for (&i, law) in self.residuals.acting.iter().zip(&self.residuals.slopes) {
                let by_other = law
                    .by_other
                    .map_or(0.0, |(other, slope)| slope * errors[other][0]);
                self.residuals.value[i] =
                    law.by_penetration * errors[i][0] + law.by_rate * errors[i][1] + by_other;
            }
            self.take_newton_step();
            out.iter_mut()
                .zip(&self.residuals.value)
                .for_each(|(out, by)| *out += weight * by.abs());
        }
        true
    }

    /// Whether a factored Jacobian is available.
    pub fn is_factored(&self) -> bool {
        !self.factors.elements.is_empty()
    }

    /// Newton's change of the forces at penetrations and rates that the caller has set, with the factors of an
    /// earlier Jacobian. If `holds` is true, the laws of the factored one are kept acting, as far as they can be
    /// continued: under a first guess of the forces they may seem to have ceased. If the set of acting laws differs from the
    /// factored one, the Jacobian is that of these laws and the W and Y of the earlier one. Returns `None` if it is singular.
    pub fn corrections(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &[f64],
        holds: bool,
    ) -> Option<(&[f64], ActingLaws)> {
        let wanted = if holds {
            Wanted::Factored
        } else {
            Wanted::Natural
        };
        self.evaluate_laws(system, local, active, force, wanted);
        let is_earlier = self.residuals.acting == self.factors.elements;
        if !(is_earlier || self.factor()) {
            return None;
        }
        self.take_newton_step();
        // A law that was kept acting does act where the forces found push.
        let Residuals {
            held,
            value,
            reached,
            ..
        } = &self.residuals;
        let pushes = |&i: &usize| (force[i] - value[i]) * reached[i][0] > 0.0;
        let laws = match (is_earlier, held.iter().all(pushes)) {
            (true, true) => ActingLaws::Same,
            (true, false) => ActingLaws::Held,
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
    values
        .iter()
        .fold(0.0_f64, |max, value| max.max(value.abs()))
}
