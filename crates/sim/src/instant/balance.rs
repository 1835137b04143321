//! Equilibrium of weights and loads on one-sided contacts at fixed positions.
//!
//! The unknowns are the penetrations p and forces F of the vertical contacts and flanges and the degrees of freedom q, with
//!
//! p + A F = c + R q, F = law(p), R^T F + K q = w.
//!
//! A: static compliance of the rails, R: approach of the contacts by the degrees of freedom, K: stiffness of ropes and stops, w:
//! weights and loads. The laws do not decrease: a one-sided contact has no force for p <= 0, and a flange none within its
//! clearance. With forces f on the rails as unknowns of their own, the solution is the minimum of the potential energy
//!
//! E(q, f) = sum V_i(p_i) + f^T A f / 2 + q^T K q / 2 - w^T q, with V_i' = law and p = c + R q - A f,
//!
//! which is convex and has a continuous gradient. Newton's method takes the contacts as acting whose law has a force at p. Where
//! the whole step passes the minimum of the energy along it, because contacts open or close on the way, the step ends at this
//! minimum: the energy falls in every step, and no set of contacts returns. Where the acting contacts leave a motion free, the
//! step is that of an energy with a small stiffness about the present position, and it is as long as the energy falls: until
//! contacts close. Under linear laws the step from the right set of contacts is the solution.
//!
//! The energy has a minimum exactly if forces that only push can balance the load. Otherwise the residual of the nearest such
//! forces ([`nonnegative`]) is a motion in which no contact is pressed and the energy falls: the fall of the bodies.

use std::borrow::Cow;

use nalgebra::{DMatrix, DMatrixView, DVector};
use smallvec::SmallVec;

use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::instant::springs::followed;
use crate::mechanics::state::State;
use crate::numerics::lu::{Entries, LuFactors};
use crate::numerics::nonnegative::nonnegative;
use crate::{Error, Fall, NormalLaw};

/// Largest number of Newton steps.
const STEPS: usize = 300;
/// Change of the penetrations, relative to the largest, at which Newton's method ends.
const CONVERGED: f64 = 1e-14;
/// The same where the change has stopped falling: penetrations that are small beside the deflection of the rails keep the
/// rounding of it.
const STAGNANT: f64 = 1e-9;
/// Relative residual of the equations of a Newton step above which the acting contacts leave a motion free.
const BALANCE: f64 = 1e-6;
/// Stiffness that is added where a motion is free, relative to that of all contacts.
const ADDED: f64 = 1e-8;
/// Penetration at which a power law has the slope of a smaller one, relative to that where all contacts carry the same.
const LEAST: f64 = 1e-12;
/// Slope of the energy at the end of a step, relative to its terms, below which it counts as rounding.
const FLAT: f64 = 1e-10;
/// Number of times that a step in which the energy still falls is doubled.
const DOUBLINGS: usize = 100;
/// Part of the largest penetration below which the sign of a penetration is rounding.
const NO_DEPTH: f64 = 1e-13;
/// Part of a load, relative to the levers of the contacts, that counts as balanced.
const BALANCED: f64 = 1e-9;

/// Numbers of contacts or of degrees of freedom, and a value for each of them; few of them need no allocation.
pub(crate) type Numbers = SmallVec<[usize; 8]>;
pub(crate) type Values = SmallVec<[f64; 8]>;
type Pieces = SmallVec<[i8; 8]>;

/// The equations of the equilibrium, and their solution.
pub(crate) struct Balance<'a> {
    system: &'a System<'a>,
    /// Number of each contact among the elements: the vertical ones, then the flanges.
    pub elements: Numbers,
    laws: SmallVec<[RestLaw<'a>; 8]>,
    /// Numbers of the unknown degrees of freedom q.
    pub moving: Numbers,
    /// Compliance matrix A of the contacts.
    compliance: DMatrix<f64>,
    /// R: contacts x degrees of freedom, column by column.
    rows: Entries,
    constant: Values,
    weight: Values,
    /// Stiffness K of ropes and stops by the unknown degrees of freedom ([`followed`]), and K q0, with q0 where
    /// their forces are part of the weight; empty without such springs.
    springs: Entries,
    pull: Values,
    /// Force of each contact where all carry the same, for the first step.
    each: f64,
    /// The piece of its law on which each contact acts ([`RestLaw::piece`]); 0 where it does not.
    pub pieces: Pieces,
    pub at: Place,
    /// Memory of the factors of the contacts and of the degrees of freedom.
    factors: [LuFactors; 2],
}

/// Degrees of freedom, forces on the rails, and the penetrations that follow from them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Place {
    pub q: Values,
    pub force: Values,
    pub p: Values,
}

/// A step of Newton's method: its end, and the energy of the small stiffness that was added where contacts leave a motion free,
/// times 2; 0 where they leave none.
struct Step {
    place: Place,
    added: f64,
}

/// The law of a contact at rest.
#[derive(Clone, Copy)]
enum RestLaw<'a> {
    /// That of wheels, times the part of them that acts.
    Wheels { law: &'a NormalLaw, share: f64 },
    /// A stiffness beyond a clearance to either side.
    Flange { stiffness: f64, clearance: f64 },
}

impl RestLaw<'_> {
    /// The piece on which it acts at penetration `p`: 1, or -1 for a flange on its other side; 0 where it does not act.
    fn piece(&self, p: f64) -> i8 {
        match *self {
            RestLaw::Wheels { law, share } => i8::from(share > 0.0 && (law.bilateral || p > 0.0)),
            RestLaw::Flange {
                stiffness,
                clearance,
            } => {
                let beyond = |p: f64| i8::from(stiffness > 0.0 && p > clearance);
                beyond(p) - beyond(-p)
            }
        }
    }

    /// The force of a piece at penetration `p`, continued beyond the piece, and its slope at a penetration of no less than `least`.
    fn on_piece(&self, piece: i8, p: f64, least: f64) -> [f64; 2] {
        match *self {
            RestLaw::Wheels { law, share } => {
                let slope = law.at(p.abs().max(least), 0.0).by_penetration;
                [share * law.at(p, 0.0).force, share * slope]
            }
            RestLaw::Flange {
                stiffness,
                clearance,
            } => [stiffness * (p - f64::from(piece) * clearance), stiffness],
        }
    }

    fn force(&self, p: f64) -> f64 {
        match self.piece(p) {
            0 => 0.0,
            piece => self.on_piece(piece, p, 0.0)[0],
        }
    }

    fn is_linear(&self) -> bool {
        match self {
            RestLaw::Wheels { law, .. } => law.is_linear(),
            RestLaw::Flange { .. } => true,
        }
    }

    /// Whether it may have a force.
    fn may_act(&self) -> bool {
        match *self {
            RestLaw::Wheels { share, .. } => share > 0.0,
            RestLaw::Flange { stiffness, .. } => stiffness > 0.0,
        }
    }

    /// Whether it resists a motion that goes on in either direction.
    fn holds(&self) -> bool {
        match self {
            RestLaw::Wheels { law, .. } => law.bilateral,
            RestLaw::Flange { .. } => true,
        }
    }

    /// The penetration at which wheels carry the force `each`; 0 for a flange.
    fn penetration(&self, each: f64) -> f64 {
        match self {
            RestLaw::Wheels { law, .. } => law.penetration(each),
            RestLaw::Flange { .. } => 0.0,
        }
    }
}

/// The largest absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| most.max(value.abs()))
}

/// Number of rows and columns up to which products are sums of columns.
const FEW: usize = 5;

/// A^T B for matrices with a number of rows, column by column.
fn transposed_product(a: &[f64], b: &[f64], rows: usize) -> Entries {
    let counts = [a, b].map(|own| own.len() / rows);
    if rows > FEW && counts.iter().all(|count| *count > FEW) {
        let [a, b] =
            [(a, counts[0]), (b, counts[1])].map(|(of, n)| DMatrixView::from_slice(of, rows, n));
        return SmallVec::from_vec((a.transpose() * b).data.into());
    }
    let mut out = Entries::new();
    for own in b.chunks_exact(rows) {
        out.extend(
            a.chunks_exact(rows)
                .map(|other| sum_of_products(other, own)),
        );
    }
    out
}

/// The sum of products in their order, without a zero in front.
fn sum_of_products(a: &[f64], b: &[f64]) -> f64 {
    let products = a.iter().zip(b).map(|(a, b)| a * b);
    products.reduce(|sum, product| sum + product).unwrap_or(0.0)
}

/// q^T K q for a square matrix K, column by column, or an empty one for zero.
pub(crate) fn quadratic(columns: &[f64], q: &[f64]) -> f64 {
    let columns = columns.chunks(q.len().max(1)).zip(q);
    columns
        .map(|(column, own)| own * sum_of_products(column, q))
        .sum()
}

/// The sum of products of row `r` of a matrix, column by column, with `q`.
fn product(columns: &[f64], r: usize, rows: usize, q: &[f64]) -> f64 {
    let terms = columns[r..]
        .iter()
        .step_by(rows)
        .zip(q)
        .map(|(entry, q)| entry * q);
    terms.reduce(|sum, term| sum + term).unwrap_or(0.0)
}

/// The degrees of freedom for a stiffness, column by column, and a load; `None` where the stiffness is singular: where the residual
/// exceeds [`BALANCE`] times `scale`.
fn solved(
    factors: &mut LuFactors,
    stiffness: &Entries,
    load: &Values,
    scale: f64,
) -> Option<Values> {
    let moving = load.len();
    let mut q = load.clone();
    factors.replace(moving, |matrix| {
        (0..moving).for_each(|r| matrix.extend(stiffness[r..].iter().step_by(moving).copied()));
    });
    let is_solved = factors.solve(&mut q)
        && q.iter().all(|q| q.is_finite())
        && (0..moving)
            .all(|j| (product(stiffness, j, moving, &q) - load[j]).abs() <= BALANCE * scale);
    is_solved.then_some(q)
}

impl<'a> Balance<'a> {
    /// Sets up the equilibrium of the degrees of freedom `moving` for the current geometry of the solver. As a first
    /// estimate, all wheels that may act carry the same force. If no degree of freedom is unknown, the wheels with
    /// positive penetration carry.
    pub fn new(
        solver: &Solver<'a>,
        moving: Numbers,
        entry: &[f64],
        at: &State,
    ) -> Result<Self, Error> {
        let (system, geometry) = (solver.system(), solver.geometry());
        let rows = geometry.rows();
        let elements: Numbers = pressing(system).into_iter().collect();
        let stays = |k: usize| {
            !moving.contains(&k)
                && !system
                    .mechanics
                    .structures
                    .iter()
                    .any(|range| range.contains(&k))
        };
        let staying: Numbers = (0..system.mechanics.dofs).filter(|&k| stays(k)).collect();
        let constant: Values = elements
            .iter()
            .map(|&i| {
                let staid = staying.iter().map(|&k| rows.approach_row(i)[k] * at.q[k]);
                rows.approach_offset[i] + staid.sum::<f64>()
            })
            .collect();
        let law = |&i: &usize| match system.elements[i].flange(at) {
            Some([stiffness, clearance]) => RestLaw::Flange {
                stiffness,
                clearance,
            },
            None => RestLaw::Wheels {
                law: system.law(i),
                share: system.mechanics.groups[i].count() * geometry.fraction(i),
            },
        };
        let laws: SmallVec<[RestLaw<'a>; 8]> = elements.iter().map(law).collect();
        let mut gravity = Cow::Borrowed(&system.mechanics.gravity);
        if !system.mechanics.carried.is_empty() {
            let weight = gravity.to_mut();
            system
                .mechanics
                .carried
                .weigh(&system.mechanics.kinematics, (at.t, &at.q), weight);
        }
        let mut weight: Values = moving
            .iter()
            .map(|&k| gravity[k] + pull_of_springs(solver, k, at))
            .collect();
        for load in &system.scene.actuators.loads {
            if let Some(j) = moving
                .iter()
                .position(|&k| system.mechanics.loaded(load) == Some(k))
            {
                weight[j] += load.value.at(at.t);
            }
        }
        // Where a rail slopes, its force on the hub has a longitudinal component, which turns the body.
        let tilted =
            |i: usize, k: usize| (rows.force_row(i)[k] - rows.approach_row(i)[k]) * at.force[i];
        for (j, &k) in moving.iter().enumerate() {
            weight[j] -= elements.iter().map(|&i| tilted(i, k)).sum::<f64>();
        }
        let carrying = laws[..system.verticals()]
            .iter()
            .filter(|law| law.may_act());
        let each = largest(&weight) / carrying.count().max(1) as f64;
        let p: Values = match moving.is_empty() {
            true => constant.clone(),
            false => laws.iter().map(|law| law.penetration(each)).collect(),
        };
        let springs = followed(solver, &moving, at);
        let begun: Values = moving.iter().map(|&k| entry[k]).collect();
        let pull = springs
            .chunks(moving.len().max(1))
            .map(|column| sum_of_products(column, &begun))
            .collect();
        let column = |&k: &usize| {
            let elements = elements.iter();
            elements.map(move |&i| rows.approach_row(i)[k])
        };
        Ok(Balance {
            compliance: static_compliance(solver)?,
            rows: moving.iter().flat_map(column).collect(),
            pieces: laws.iter().zip(&p).map(|(law, p)| law.piece(*p)).collect(),
            at: Place {
                q: begun,
                force: SmallVec::from_elem(0.0, laws.len()),
                p,
            },
            each,
            factors: Default::default(),
            springs,
            pull,
            system,
            elements,
            laws,
            moving,
            constant,
            weight,
        })
    }

    /// Finds the equilibrium; returns false if the energy has no minimum, or none is found.
    pub fn solve(&mut self) -> bool {
        // without contacts no degree of freedom is one of the equilibrium
        if self.laws.is_empty() {
            return true;
        }
        let mut before = f64::INFINITY;
        for step in 0..STEPS {
            let Some(to) = self.newton() else {
                return false;
            };
            // the forces of the first estimate belong to no position, so that the first step is a whole one
            let share = match step {
                0 => Some(1.0),
                _ => self.minimum(&to),
            };
            let Some(share) = share else {
                return false;
            };
            let depth = largest(&to.place.p);
            let pairs = to.place.p.iter().zip(&self.at.p);
            let change = pairs.fold(0.0_f64, |most, (new, old)| most.max((new - old).abs()));
            let pieces = self.pieces_at(&to.place);
            let is_linear = self.acting().all(|i| self.laws[i].is_linear());
            let has_ended = is_linear
                || change <= CONVERGED * depth
                || (change <= STAGNANT * depth && change >= 0.5 * before);
            let is_same = share == 1.0 && pieces == self.pieces;
            before = change;
            if share == 1.0 {
                (self.at, self.pieces) = (to.place, pieces);
            } else {
                self.at = self.at.towards(&to.place, share);
                self.pieces = self.pieces_at(&self.at);
            }
            let is_held = to.added == 0.0 || change <= STAGNANT * depth;
            if is_same && has_ended && is_held {
                return true;
            }
        }
        false
    }

    /// The pieces of their laws on which the contacts act at a place.
    fn pieces_at(&self, at: &Place) -> Pieces {
        let pairs = self.laws.iter().zip(&at.p);
        pairs.map(|(law, p)| law.piece(*p)).collect()
    }

    /// The contacts that act.
    fn acting(&self) -> impl Iterator<Item = usize> {
        (0..self.pieces.len()).filter(|&i| self.pieces[i] != 0)
    }

    /// The force of an acting contact, and its slope for the next step. That of a power law is zero without penetration; it is
    /// taken at a small one.
    fn acting_law(&self, i: usize) -> [f64; 2] {
        let least = LEAST * self.laws[i].penetration(self.each);
        self.laws[i].on_piece(self.pieces[i], self.at.p[i], least)
    }

    /// The part of the step to `to` at which the energy is least; `None` where it falls without end.
    ///
    /// With the change dp of the penetrations, the slope of the energy along the step is
    /// (law(p(s)) - F) . dp - (1 - s) (dq . K dq + df . A df) - dq . T dq, F: forces at the end of the step, T: the added stiffness.
    /// It increases with s.
    fn minimum(&self, to: &Step) -> Option<f64> {
        let from = &self.at;
        let difference =
            |a: &Values, b: &Values| -> Values { a.iter().zip(b).map(|(a, b)| a - b).collect() };
        let (dp, dq) = (
            difference(&to.place.p, &from.p),
            difference(&to.place.q, &from.q),
        );
        let df = difference(&to.place.force, &from.force);
        let bent: f64 = (0..df.len())
            .map(|i| {
                df[i]
                    * (0..df.len())
                        .map(|j| self.compliance[(i, j)] * df[j])
                        .sum::<f64>()
            })
            .sum();
        let stretched = quadratic(&self.springs, &dq);
        let slope = |s: f64| {
            let mut sum = -(1.0 - s) * (bent + stretched) - to.added;
            let mut size = sum.abs();
            for (i, dp) in dp.iter().enumerate() {
                let force = self.laws[i].force(from.p[i] + s * dp);
                sum += (force - to.place.force[i]) * dp;
                size += (force.abs() + to.place.force[i].abs()) * dp.abs();
            }
            (sum, FLAT * size)
        };
        let (mut low, mut high) = (0.0, 1.0);
        let (mut end, flat) = slope(high);
        if end.abs() <= flat || (end < 0.0 && to.added == 0.0) {
            return Some(1.0);
        }
        let mut doublings = 0;
        while end < 0.0 {
            (low, high) = (high, 2.0 * high);
            end = slope(high).0;
            doublings += 1;
            if doublings > DOUBLINGS {
                return None;
            }
        }
        // the energy falls up to `low` and rises from `high` on
        let begin = slope(0.0).0;
        let mut at_low = slope(low).0;
        while at_low < 0.1 * begin && high - low > 1e-12 * high {
            let middle = 0.5 * (low + high);
            let own = slope(middle).0;
            if own <= 0.0 {
                (low, at_low) = (middle, own);
            } else {
                high = middle;
            }
        }
        Some(low)
    }

    /// Newton's step with the acting contacts: the forces from (A + 1/k) F = R q + c - p + f/k and R^T F + K q = w, where f and k
    /// are force and stiffness of the laws at p. `None` where it is not finite.
    fn newton(&mut self) -> Option<Step> {
        let active: Numbers = self.acting().collect();
        let (size, count, moving) = (active.len(), self.laws.len(), self.moving.len());
        let mut free = Values::new();
        let mut own = Values::new();
        for &i in &active {
            let [force, stiffness] = self.acting_law(i);
            own.push(1.0 / stiffness);
            free.push(self.constant[i] - self.at.p[i] + force / stiffness);
        }
        let Balance {
            compliance,
            factors: [factors, _],
            ..
        } = self;
        factors.replace(size, |matrix| {
            for (r, (&row, own)) in active.iter().zip(own).enumerate() {
                matrix.extend(active.iter().map(|&column| compliance[(row, column)]));
                matrix[r * (size + 1)] += own;
            }
        });
        let mut lever = Entries::new();
        for rows in self.rows.chunks_exact(count) {
            lever.extend(active.iter().map(|&i| rows[i]));
        }
        let mut by_lever = lever.clone();
        if size > 0
            && !(by_lever
                .chunks_exact_mut(size)
                .all(|column| factors.solve(column))
                && factors.solve(&mut free))
        {
            return None;
        }
        let by_free = free;
        let mut stiffness = match size {
            0 => SmallVec::from_elem(0.0, moving * moving),
            _ => transposed_product(&lever, &by_lever, size),
        };
        let mut load = self.weight.clone();
        if size > 0 {
            let carried = lever
                .chunks_exact(size)
                .map(|lever| sum_of_products(lever, &by_free));
            load.iter_mut()
                .zip(carried)
                .for_each(|(load, carried)| *load -= carried);
        }
        let add = |sum: &mut [f64], own: &[f64]| {
            sum.iter_mut().zip(own).for_each(|(sum, own)| *sum += own)
        };
        add(&mut stiffness, &self.springs);
        add(&mut load, &self.pull);
        let scale = largest(&self.weight).max(f64::MIN_POSITIVE);
        let mut added = 0.0;
        let q = if moving == 0 {
            Values::new()
        } else if let Some(next) = solved(&mut self.factors[1], &stiffness, &load, scale) {
            next
        } else {
            let small = self.added_stiffness();
            for (j, own) in small.iter().enumerate() {
                stiffness[j * (moving + 1)] += own;
                load[j] += own * self.at.q[j];
            }
            let next = solved(&mut self.factors[1], &stiffness, &load, scale)?;
            let pairs = small.iter().zip(next.iter().zip(&self.at.q));
            added = pairs
                .map(|(own, (new, old))| own * (new - old).powi(2))
                .sum();
            next
        };
        let mut place = Place {
            force: SmallVec::from_elem(0.0, count),
            p: SmallVec::from_elem(0.0, count),
            q,
        };
        for (r, &i) in active.iter().enumerate() {
            place.force[i] = by_free[r]
                + if moving == 0 {
                    0.0
                } else {
                    product(&by_lever, r, size, &place.q)
                };
        }
        self.reach(&mut place);
        Some(Step { place, added })
    }

    /// Sets the penetrations: those of acting contacts by their linearised laws, and those of the others by the positions.
    fn reach(&self, to: &mut Place) {
        for i in self.acting() {
            let [force, stiffness] = self.acting_law(i);
            to.p[i] = self.at.p[i] + (to.force[i] - force) / stiffness;
        }
        let deepest = largest(&to.p);
        for i in (0..self.laws.len()).filter(|&i| self.pieces[i] == 0) {
            let row = self.rows.iter().skip(i).step_by(self.laws.len());
            let [mut sum, mut size] = [self.constant[i], self.constant[i].abs()];
            let moved = row.zip(&to.q).map(|(row, q)| row * q);
            let bent = self.compliance.row(i).into_iter().zip(&to.force);
            for term in moved.chain(bent.map(|(g, force)| -g * force)) {
                sum += term;
                size += term.abs();
            }
            let noise = NO_DEPTH * deepest + 4.0 * f64::EPSILON * size;
            to.p[i] = if sum.abs() <= noise { 0.0 } else { sum };
        }
    }

    /// A small stiffness of every degree of freedom: a part of that of all contacts that may act.
    fn added_stiffness(&self) -> Values {
        let of_contact = |i: usize| {
            let law = &self.laws[i];
            let [_, stiffness] = law.on_piece(1, law.penetration(self.each), 0.0);
            1.0 / (self.compliance[(i, i)] + 1.0 / stiffness)
        };
        let may_act = || (0..self.laws.len()).filter(|&i| self.laws[i].may_act());
        let own: Values = may_act().map(of_contact).collect();
        let columns = self.rows.chunks_exact(self.laws.len());
        columns
            .map(|column| {
                let terms = may_act()
                    .zip(&own)
                    .map(|(i, own)| own * column[i] * column[i]);
                ADDED * terms.sum::<f64>()
            })
            .collect()
    }

    /// The motion in which the bodies fall: no contact that only pushes is pressed, others and springs are not moved, and weights
    /// and loads do work. `None` where contacts can balance the loads.
    pub fn fall(&self) -> Option<Fall> {
        if self.moving.is_empty() {
            return None;
        }
        let (count, moving) = (self.laws.len(), self.moving.len());
        let may_act: Vec<usize> = (0..count).filter(|&i| self.laws[i].may_act()).collect();
        let (both, one): (Vec<usize>, Vec<usize>) =
            may_act.iter().partition(|&&i| self.laws[i].holds());
        // every degree of freedom counts by the displacement of the contacts
        let lever = |j: usize| {
            let column = &self.rows[j * count..(j + 1) * count];
            let most = may_act
                .iter()
                .fold(0.0_f64, |most, &i| most.max(column[i].abs()));
            if most > 0.0 { most } else { 1.0 }
        };
        let levers: Values = (0..moving).map(lever).collect();
        let held = both.len() + self.springs.len() / moving.max(1);
        let columns = DMatrix::from_fn(moving, held + one.len(), |j, k| {
            let entry = if k < both.len() {
                self.rows[j * count + both[k]]
            } else if k < held {
                self.springs[(k - both.len()) * moving + j]
            } else {
                self.rows[j * count + one[k - held]]
            };
            entry / levers[j]
        });
        let load = DVector::from_fn(moving, |j, _| {
            (self.weight[j] + self.pull.get(j).copied().unwrap_or(0.0)) / levers[j]
        });
        let (_, residual) = nonnegative(&columns, &load, held);
        if residual.norm() <= BALANCED * load.norm() {
            return None;
        }
        let numbers = &self.system.mechanics.kinematics.numbers;
        let place = |number: &Option<usize>| {
            number.and_then(|own| self.moving.iter().position(|&k| k == own))
        };
        let work = |own: &[Option<usize>; 6]| -> f64 {
            own.iter()
                .filter_map(place)
                .map(|j| load[j] * residual[j])
                .sum()
        };
        let body =
            (0..numbers.len()).max_by(|&a, &b| work(&numbers[a]).total_cmp(&work(&numbers[b])))?;
        let own = numbers[body].map(|number| place(&number));
        let most = own
            .iter()
            .flatten()
            .fold(0.0_f64, |most, &j| most.max(residual[j].abs()));
        let motion = own.map(|at| at.map_or(0.0, |j| residual[j] / most));
        Some(Fall { body, motion })
    }
}

impl Place {
    /// The place at part `share` of the way to another.
    fn towards(&self, to: &Place, share: f64) -> Place {
        let between = |from: &Values, to: &Values| {
            from.iter()
                .zip(to)
                .map(|(a, b)| a + share * (b - a))
                .collect()
        };
        Place {
            q: between(&self.q, &to.q),
            force: between(&self.force, &to.force),
            p: between(&self.p, &to.p),
        }
    }
}

/// Elements that can load the rails at rest: the vertical contacts, then the guides.
pub(crate) fn pressing(system: &System) -> Vec<usize> {
    (0..system.verticals())
        .chain(system.guides().iter().copied())
        .collect()
}

/// Static compliance G + Phi K^-1 Phi^T of the elements that can load the rails at rest.
fn static_compliance(solver: &Solver) -> Result<DMatrix<f64>, Error> {
    let system = solver.system();
    let (m, pressing) = (system.elements.len(), pressing(system));
    let count = pressing.len();
    let (value, rows) = (&solver.geometry().rails().value, solver.geometry().rows());
    let mut compliance =
        DMatrix::from_fn(count, count, |i, j| value[pressing[i] * m + pressing[j]]);
    for block in &system.mechanics.blocks[1..] {
        let first = block.range.start;
        let phi = DMatrix::from_fn(block.range.len(), count, |k, i| {
            rows.approach_row(pressing[i])[first + k]
        });
        compliance += phi.transpose() * block.rest(&phi)?;
    }
    Ok(compliance)
}

/// Load on degree of freedom `number` from ropes and stops, for the forces of `at`.
pub(crate) fn pull_of_springs(solver: &Solver, number: usize, at: &State) -> f64 {
    let rows = solver.geometry().rows();
    solver
        .system()
        .springs()
        .iter()
        .map(|&i| -rows.approach_row(i)[number] * at.force[i])
        .sum()
}
