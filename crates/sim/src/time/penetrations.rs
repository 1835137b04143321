//! Penetrations of wheels with a damper to their rail inside a step.
//!
//! Such a penetration p is a state with the equation p + G F = e(t), F = F(p, p'). Its time constant, c G/(1 + k G),
//! is mostly much shorter than a step, so that the rates p' of a Runge-Kutta method, and those of a polynomial through
//! its results, have a low order. The motion of the bodies has the full order. The equation is therefore solved again
//! in each step in which samples are taken, along the motion, by collocation of the small difference s = p - g from
//! the penetrations g of the springs alone, (I + G K) g = e, whose rates are known exactly.

use nalgebra::{DMatrix, DVector};

use super::nodes::Nodes;
use crate::Error;
use crate::contact::solver::Solver;
use crate::contact::solver::follow::Followed;
use crate::mechanics::state::State;
use crate::numerics::lu::LuFactors;

/// Number of Newton iterations at most; linear laws need one or two.
const ITERATIONS: usize = 12;

/// Time in which a penetration follows its force, per step, below which its value at the start may be free.
const QUICK: f64 = 0.25;

/// Change of the penetrations, relative to the largest of them, at which no iteration improves them, and at which they are
/// used.
const ROUNDING: f64 = 1e-14;
const CONVERGED: f64 = 1e-9;

/// Number of contacts from which the compliance of one place serves for all, in more iterations, and that place. With 8 contacts
/// a step takes a fifth less time by the whole matrix, with 24 a twentieth, with 32 as much.
const MANY: usize = 32;
const MIDDLE: usize = 2;

/// The start and the nodes.
const PLACES: [f64; 4] = [0.0, Nodes::RADAU_3[0], Nodes::RADAU_3[1], Nodes::RADAU_3[2]];

/// The penetrations of the active contacts in one step. Their memory serves for one step after the other.
#[derive(Default)]
pub(crate) struct Penetrations {
    /// Whether they are those of the present step.
    is_known: bool,
    h: f64,
    /// The active vertical contacts; none if no equation is solved.
    contacts: Vec<usize>,
    stiffness: Vec<f64>,
    /// s at the start and at the nodes, place by place.
    differences: Vec<f64>,
    /// Whether the equation holds at the start, instead of s there, for each contact.
    is_free: Vec<bool>,
    /// The contacts at the start and at the nodes, and the number of places at which they are known.
    followed: [Followed; 4],
    places: usize,
    /// The contacts at a sample.
    at_sample: Followed,
    newton: Newton,
}

/// Memory of Newton's method.
#[derive(Default)]
struct Newton {
    /// Force, stiffness and damping of every contact at the start and at the nodes.
    laws: Vec<[f64; 3]>,
    /// The residual, then the change.
    residual: Vec<f64>,
    factors: Factors,
}

impl Penetrations {
    /// Whether they are those of the present step.
    pub fn is_known(&self) -> bool {
        self.is_known
    }

    /// Forgets them: another step is taken.
    pub fn forget(&mut self) {
        self.is_known = false;
    }

    /// Begins a step of length `h` from `from`, with the active contacts of the solver. A penetration that follows its
    /// force within a fraction of the step, and in at most the time `settled`, is independent of its value at the start,
    /// whose error is then of no effect. This time is infinite in the course of a motion without a jump; after a jump it is
    /// that below which the transient is not resolved.
    pub fn begin(&mut self, solver: &mut Solver, from: &State, h: f64, settled: f64) {
        (self.is_known, self.h, self.places) = (true, h, 0);
        self.contacts.clear();
        self.differences.clear();
        if !(is_suited(solver) && solver.active_contacts().any(|i| solver.remembers(i))) {
            return;
        }
        let Penetrations { contacts, stiffness, differences, is_free, followed, .. } = self;
        contacts.extend(solver.active_contacts());
        stiffness.clear();
        stiffness.extend(contacts.iter().map(|&i| solver.law_of(i, from.p[i], from.p_rate[i])[1].max(0.0)));
        if solver.update(from).is_err() || !solver.follow(from, contacts, stiffness, &mut followed[0]) {
            contacts.clear();
            return;
        }
        differences.extend(contacts.iter().zip(&followed[0].value).map(|(&i, value)| from.p[i] - value));
        is_free.clear();
        is_free.extend(contacts.iter().map(|&i| solver.delay(i, from) < settled.min(QUICK * h)));
        self.places = 1;
    }

    /// Fractions of the step at which states must be [added](Self::add), in this order.
    pub fn fractions(&self) -> impl Iterator<Item = f64> + use<> {
        Nodes::RADAU_3.into_iter().filter({
            let is_solved = !self.contacts.is_empty();
            move |_| is_solved
        })
    }

    /// Adds the interpolated state `at` of the next node.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn add(&mut self, solver: &mut Solver, at: &State) -> Result<(), Error> {
        solver.update(at)?;
        let node = &mut self.followed[self.places];
        if solver.follow(at, &self.contacts, &self.stiffness, node) {
            self.differences.extend(self.contacts.iter().zip(&node.value).map(|(&i, value)| at.p[i] - value));
            self.places += 1;
        }
        Ok(())
    }

    /// Solves the equation at all nodes, from the interpolated penetrations. Without a solution the rates stay interpolated.
    pub fn solve(&mut self, solver: &Solver) {
        if self.places < PLACES.len() || !self.converges(solver) {
            self.contacts.clear();
        }
    }

    /// Newton's method; returns whether it has converged. Under linear laws the matrix stays, and further iterations refine
    /// what the first has rounded: short steps divide small differences by their length.
    fn converges(&mut self, solver: &Solver) -> bool {
        let is_linear = solver.system().traits.has_linear_laws;
        let weights = PLACES.map(slopes);
        let mut newton = std::mem::take(&mut self.newton);
        let mut last = f64::INFINITY;
        for iteration in 0..ITERATIONS {
            let Newton { laws, residual, factors } = &mut newton;
            self.set_laws(solver, &weights, laws);
            self.set_residual(laws, residual);
            if iteration == 0 || !is_linear {
                self.factor(laws, &weights, factors);
            }
            if !factors.solve(residual) || !residual.iter().all(|x| x.is_finite()) {
                last = f64::INFINITY;
                break;
            }
            let (mut size, mut largest) = (0.0_f64, 0.0_f64);
            let values = self.followed.iter().flat_map(|node| &node.value);
            for ((own, change), value) in self.differences.iter_mut().zip(residual).zip(values) {
                *own -= *change;
                size = size.max(own.abs() + value.abs());
                largest = largest.max(change.abs());
            }
            last = largest / size;
            if last <= ROUNDING {
                break;
            }
        }
        self.newton = newton;
        last <= CONVERGED
    }

    /// Sets `laws` to force, stiffness and damping of every contact at the start and at the nodes, for the present
    /// differences.
    fn set_laws(&self, solver: &Solver, weights: &[[f64; 4]; 4], laws: &mut Vec<[f64; 3]>) {
        laws.clear();
        for ((node, weights), own) in self.followed.iter().zip(weights).zip(self.at_places()) {
            for (c, (&i, own)) in self.contacts.iter().zip(own).enumerate() {
                let rate = node.rate[c] + self.slope(*weights, c);
                laws.push(solver.law_of(i, node.value[c] + own, rate));
            }
        }
    }

    /// The differences, place by place.
    fn at_places(&self) -> impl Iterator<Item = &[f64]> {
        self.differences.chunks_exact(self.contacts.len())
    }

    /// Rate of the difference of contact `r` where the slopes have these weights.
    fn slope(&self, weights: [f64; 4], r: usize) -> f64 {
        self.at_places().zip(weights).map(|(own, weight)| weight * own[r]).sum::<f64>() / self.h
    }

    /// Whether the equation holds for contact `r` at place `a`, instead of a difference that is known.
    fn is_solved(&self, a: usize, r: usize) -> bool {
        a > 0 || self.is_free[r]
    }

    /// Sets `out` to p + G F - e by the forces of the `laws`; 0 for differences that are known.
    fn set_residual(&self, laws: &[[f64; 3]], out: &mut Vec<f64>) {
        let count = self.contacts.len();
        out.clear();
        for ((a, node), laws) in self.followed.iter().enumerate().zip(laws.chunks_exact(count)) {
            for r in 0..count {
                if !self.is_solved(a, r) {
                    out.push(0.0);
                    continue;
                }
                let forces = laws.iter().enumerate();
                let deflection: f64 = forces.map(|(c, [force, ..])| node.compliance(r, c) * force).sum();
                out.push(node.value[r] + self.differences[a * count + r] - node.approach[r] + deflection);
            }
        }
    }

    /// Sets the factors of the derivatives of the residual; approximate ones for many contacts that are all free at the
    /// start.
    fn factor(&self, laws: &[[f64; 3]], weights: &[[f64; 4]; 4], factors: &mut Factors) {
        let count = self.contacts.len();
        if count < MANY || self.is_free.contains(&false) {
            factors.by_slope = None;
            let size = PLACES.len() * count;
            return factors.own.replace(size, |matrix| self.fill_matrix(laws, weights, matrix));
        }
        let middle = &self.followed[MIDDLE];
        let laws = &laws[MIDDLE * count..(MIDDLE + 1) * count];
        let scaled =
            |part: usize| DMatrix::from_fn(count, count, |r, c| middle.compliance(r, c) * laws[c][part]);
        let in_place = DMatrix::identity(count, count) + scaled(1);
        *factors = Factors { own: LuFactors::new(&in_place), by_slope: Some(scaled(2) / self.h) };
    }

    /// Adds the derivatives of the residual by the differences, row by row.
    fn fill_matrix(&self, laws: &[[f64; 3]], weights: &[[f64; 4]; 4], matrix: &mut Vec<f64>) {
        let count = self.contacts.len();
        let size = PLACES.len() * count;
        matrix.resize(size * size, 0.0);
        matrix.iter_mut().step_by(size + 1).for_each(|own| *own = 1.0);
        for (a, (node, weights)) in self.followed.iter().zip(weights).enumerate() {
            for r in (0..count).filter(|&r| self.is_solved(a, r)) {
                let row = a * count + r;
                for (c, [_, by_place, by_rate]) in laws[a * count..(a + 1) * count].iter().enumerate() {
                    let compliance = node.compliance(r, c);
                    matrix[row * size + a * count + c] += compliance * by_place;
                    for (b, weight) in weights.iter().enumerate() {
                        matrix[row * size + b * count + c] += compliance * by_rate * weight / self.h;
                    }
                }
            }
        }
    }

    /// Sets the penetration rates of the interpolated state `at`, at the fraction `share` of the step.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn set_rates(&mut self, solver: &mut Solver, share: f64, at: &mut State) -> Result<(), Error> {
        if self.contacts.is_empty() {
            return Ok(());
        }
        solver.update(at)?;
        if !solver.follow(at, &self.contacts, &self.stiffness, &mut self.at_sample) {
            return Ok(());
        }
        let (followed, weights) = (&self.at_sample, slopes(share));
        for (r, &i) in self.contacts.iter().enumerate().filter(|(_, i)| solver.remembers(**i)) {
            at.p_rate[i] = followed.rate[r] + self.slope(weights, r);
        }
        Ok(())
    }
}

/// Factors of the derivatives of the residual by the differences at all places.
///
/// With the compliance G of one place for all, stiffnesses K and dampings C, these are I + G K at each place and (d/h) G C
/// between places, where d are the weights of the slopes at the places. The derivative of a cubic polynomial taken four times is zero,
/// d^4 = 0, so that the series of the inverse ends: with B = (I + G K)^-1 G C/h
///
/// x = sum over j from 0 to 3 of (-1)^j d^j B^j (I + G K)^-1 r,
///
/// which takes factors of the order of the contacts in place of four times that.
#[derive(Default)]
struct Factors {
    /// Of the whole matrix; where the compliance is that of one place, of I + G K.
    own: LuFactors,
    /// G C/h of the one place.
    by_slope: Option<DMatrix<f64>>,
}

impl Factors {
    /// Replaces the `residual` by the change of the differences that brings it to zero; false where the factors are
    /// singular.
    fn solve(&self, residual: &mut [f64]) -> bool {
        let Some(by_slope) = &self.by_slope else { return self.own.solve(residual) };
        let solved = self.solve_by_series(by_slope, residual);
        if let Some(solved) = &solved {
            let solved = solved.iter().flat_map(|own| own.iter());
            residual.iter_mut().zip(solved).for_each(|(change, own)| *change = *own);
        }
        solved.is_some()
    }

    fn solve_by_series(&self, by_slope: &DMatrix<f64>, residual: &[f64]) -> Option<Vec<DVector<f64>>> {
        let solve = |mut right: DVector<f64>| self.own.solve(right.as_mut_slice()).then_some(right);
        let count = by_slope.nrows();
        let mut term = (0..PLACES.len())
            .map(|a| solve(DVector::from_column_slice(&residual[a * count..(a + 1) * count])))
            .collect::<Option<Vec<_>>>()?;
        let mut sum = term.clone();
        for _ in 1..PLACES.len() {
            let loads: Vec<DVector<f64>> = term.iter().map(|own| by_slope * own).collect();
            let slope_at = |a: usize| {
                let mut slope = DVector::zeros(count);
                loads.iter().zip(slopes(PLACES[a])).for_each(|(load, weight)| slope.axpy(-weight, load, 1.0));
                solve(slope)
            };
            term = (0..PLACES.len()).map(slope_at).collect::<Option<Vec<_>>>()?;
            sum.iter_mut().zip(&term).for_each(|(sum, term)| *sum += term);
        }
        Some(sum)
    }
}

/// Whether the rates of the springs' penetrations are known: rails on the ground with a symmetric compliance, and one
/// force for each wheel.
fn is_suited(solver: &Solver) -> bool {
    let system = solver.system();
    system.mechanics.carried.is_empty()
        && system.mechanics.couplings.is_empty()
        && system.foundations.iter().all(|foundation| {
            let is_symmetric = foundation.compliance.as_ref().is_none_or(|own| own.is_symmetric());
            foundation.parts.is_none() && foundation.carrier.is_none() && is_symmetric
        })
}

/// Derivatives at `share` of the cubic Lagrange polynomials through the places.
fn slopes(share: f64) -> [f64; 4] {
    let places = PLACES;
    std::array::from_fn(|j| {
        let others = [0, 1, 2, 3].into_iter().filter(|&k| k != j);
        let scale: f64 = others.clone().map(|k| places[j] - places[k]).product();
        let term = |left: usize| -> f64 {
            others.clone().filter(|&k| k != left).map(|k| share - places[k]).product()
        };
        others.clone().map(term).sum::<f64>() / scale
    })
}

#[cfg(test)]
mod tests {
    use super::{Factors, LuFactors, PLACES, slopes};
    use nalgebra::{DMatrix, DVector};

    /// Identity: where the compliance is the same at all places, the ended series is the inverse of the whole matrix.
    #[test]
    fn factors_of_one_place_solve_the_equation_of_all_places() {
        let count = 5;
        let compliance = DMatrix::from_fn(count, count, |i, j| 1e-3 / (1.0 + i.abs_diff(j) as f64));
        let diagonal =
            |from: f64| DMatrix::from_diagonal(&DVector::from_fn(count, |i, _| from * (1.0 + i as f64)));
        let in_place = DMatrix::identity(count, count) + &compliance * diagonal(400.0);
        let by_slope = &compliance * diagonal(30.0);
        let size = PLACES.len() * count;
        let mut whole = DMatrix::zeros(size, size);
        for (a, place) in PLACES.into_iter().enumerate() {
            whole.view_mut((a * count, a * count), (count, count)).copy_from(&in_place);
            for (b, weight) in slopes(place).into_iter().enumerate() {
                let mut block = whole.view_mut((a * count, b * count), (count, count));
                block += weight * &by_slope;
            }
        }
        let residual = DVector::from_fn(size, |i, _| (1.0 + i as f64).sin());
        let mut expected = residual.clone();
        assert!(LuFactors::new(&whole).solve(expected.as_mut_slice()), "the matrix is regular");
        let factors = Factors { own: LuFactors::new(&in_place), by_slope: Some(by_slope) };
        let mut found = residual.clone();
        assert!(factors.solve(found.as_mut_slice()), "I + G K is regular");
        assert!((&found - &expected).amax() < 1e-12 * expected.amax(), "{found} for {expected}");
    }
}
