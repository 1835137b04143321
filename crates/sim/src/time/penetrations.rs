//! Penetrations of wheels with a damper to their rail inside a step.
//!
//! Such a penetration p is a state with the equation p + G F = e(t), F = F(p, p'). Its time constant, c G/(1 + k G),
//! is mostly much shorter than a step, so that the rates p' of a Runge-Kutta method, and those of a polynomial through
//! its results, have a low order. The motion of the bodies has the full order. The equation is therefore solved again
//! in each step in which samples are taken, along the motion, by collocation of the small difference s = p - g from
//! the penetrations g of the springs alone, (I + G K) g = e, whose rates are known exactly. Between the places of the
//! collocation, g is the polynomial of the seventh degree through its values and rates there.

mod factors;
mod places;

use super::nodes::Nodes;
use crate::Error;
use crate::contact::solver::Solver;
use crate::contact::solver::follow::{Followed, delay_of};
use crate::mechanics::state::State;
use factors::{Factors, MIDDLE};
use places::{COUNT, SpringPolynomial, slopes, sum_of, values, weights};

/// Number of iterations at most; with the factors of all places linear laws need one or two.
const ITERATIONS: usize = 12;

/// Time in which a penetration follows its force, per step, below which its value at the start may be free.
const QUICK: f64 = 0.25;

/// Change of the penetrations, relative to the largest of them, at which no iteration improves them, and at which they are
/// used.
const ROUNDING: f64 = 1e-14;
const CONVERGED: f64 = 1e-9;

/// Error of the penetrations that the iterations under linear laws may leave, per unit of the accuracy of the scene.
const LEFT: f64 = 1e-4;

/// Error, relative to the change, that factors of the whole matrix leave by rounding.
const ROUNDED: f64 = 1e-12;

/// Largest weight of a slope at a place, rounded up.
const STEEP: f64 = 10.0;

/// Step, relative to the longest time c/k of a contact, below which the division by it would show the rounding of the springs'
/// penetrations in the forces.
const SHORT: f64 = 1e-2;

/// The penetrations of the active contacts in one step. Their memory serves for one step after the other.
#[derive(Default)]
pub(crate) struct Penetrations {
    /// Whether they are those of the present step.
    is_known: bool,
    h: f64,
    /// The active vertical contacts; none if no equation is solved.
    contacts: Vec<usize>,
    stiffness: Vec<f64>,
    /// s at the start and at the nodes, for each contact.
    differences: Vec<[f64; COUNT]>,
    /// Whether the equation holds at the start, instead of s there, for each contact.
    is_free: Vec<bool>,
    /// The contacts at the start and at the nodes, and the number of places at which they are known.
    followed: [Followed; COUNT],
    places: usize,
    /// Whether those of the last place are known from the step before this one.
    is_continued: bool,
    /// Longest time c/k of a contact.
    delay: f64,
    /// Whether the springs' penetrations are a polynomial in the step.
    is_polynomial: bool,
    /// The contacts at a sample, where they are not, and the residual of the equation there, where they are.
    at_sample: Followed,
    residual: Vec<f64>,
    newton: Newton,
}

/// Memory of Newton's method.
#[derive(Default)]
struct Newton {
    /// Force, stiffness and damping of every contact at the start and at the nodes, place by place.
    laws: Vec<[f64; 3]>,
    /// The residual at the start and at the nodes, for each contact; then the change.
    residual: Vec<[f64; COUNT]>,
    factors: Factors,
}

impl Penetrations {
    /// Whether they are those of the present step.
    pub fn is_known(&self) -> bool {
        self.is_known
    }

    /// Forgets them: the next step is taken.
    pub fn forget(&mut self) {
        self.is_continued = self.is_known && self.places == COUNT;
        self.is_known = false;
    }

    /// Begins a step of length `h` from `from`, with the active contacts of the solver. A penetration that follows its
    /// force within a fraction of the step, and in at most the time `settled`, is independent of its value at the start,
    /// whose error is then of no effect. This time is infinite in the course of a motion without a jump; after a jump it is
    /// that below which the transient is not resolved. The springs' penetrations follow a polynomial where the motion
    /// `is_even`: it has no break at the ends of the step, and no waves that are shorter.
    pub fn begin(
        &mut self,
        solver: &mut Solver,
        from: &State,
        h: f64,
        (settled, is_even): (f64, bool),
    ) {
        (self.is_known, self.h, self.places) = (true, h, 0);
        self.differences.clear();
        if !(is_suited(solver) && solver.active_contacts().any(|i| solver.remembers(i))) {
            self.contacts.clear();
            return;
        }
        let is_other = !solver.active_contacts().eq(self.contacts.iter().copied());
        let Penetrations {
            contacts,
            stiffness,
            differences,
            is_free,
            followed,
            ..
        } = self;
        contacts.clear();
        contacts.extend(solver.active_contacts());
        // the course of a motion under linear laws goes on from the end of the step before
        let is_continued = self.is_continued
            && !is_other
            && settled.is_infinite()
            && solver.system().traits.has_linear_laws;
        if is_continued {
            followed.swap(0, COUNT - 1);
        } else {
            stiffness.clear();
            let law = |&i: &usize| solver.law_of(i, from.p[i], from.p_rate[i])[1].max(0.0);
            stiffness.extend(contacts.iter().map(law));
            if solver.update(from).is_err()
                || !solver.follow(from, contacts, stiffness, &mut followed[0])
            {
                contacts.clear();
                return;
            }
        }
        let start = &followed[0];
        differences.extend(
            contacts
                .iter()
                .zip(&start.value)
                .map(|(&i, value)| [from.p[i] - value; COUNT]),
        );
        is_free.clear();
        self.delay = 0.0;
        for (r, &i) in contacts.iter().enumerate() {
            let law = solver.law_of(i, from.p[i], from.p_rate[i]);
            let [_, by_place, by_rate] = law;
            is_free.push(delay_of(law, start.own_compliance(r)) < settled.min(QUICK * h));
            self.delay = self.delay.max(by_rate / by_place.max(0.0));
        }
        self.is_polynomial = is_even && h >= SHORT * self.delay;
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
            for ((&i, value), own) in self
                .contacts
                .iter()
                .zip(&node.value)
                .zip(&mut self.differences)
            {
                own[self.places] = at.p[i] - value;
            }
            self.places += 1;
        }
        Ok(())
    }

    /// Solves the equation at all nodes, from the interpolated penetrations. Without a solution the rates stay interpolated.
    pub fn solve(&mut self, solver: &Solver) {
        if self.places < COUNT || !self.converges(solver) {
            self.contacts.clear();
        }
    }

    /// Newton's method; returns whether it has converged. Under linear laws the matrix stays, and further iterations refine
    /// what the first has rounded, where this would show: short steps divide small differences by their length.
    fn converges(&mut self, solver: &Solver) -> bool {
        let is_linear = solver.system().traits.has_linear_laws;
        let mut newton = std::mem::take(&mut self.newton);
        // a rate is felt by c/k of it
        let allowed = LEFT * solver.system().scene.accuracy / (1.0 + STEEP * self.delay / self.h);
        let (mut last, mut has_ended) = (f64::INFINITY, false);
        for iteration in 0..ITERATIONS {
            let Newton {
                laws,
                residual,
                factors,
            } = &mut newton;
            self.set_laws(solver, laws);
            self.set_residual(laws, residual);
            if iteration == 0 || !is_linear {
                let is_alike = is_linear && !self.is_free.contains(&false);
                factors.set(&self.followed, laws, (self.h, is_alike), |a, r| {
                    self.is_solved(a, r)
                });
            }
            if !factors.solve(&self.followed, residual)
                || !residual.iter().flatten().all(|x| x.is_finite())
            {
                last = f64::INFINITY;
                break;
            }
            let (mut size, mut largest) = (0.0_f64, 0.0_f64);
            for (r, (own, change)) in self.differences.iter_mut().zip(residual).enumerate() {
                for (node, (own, change)) in self.followed.iter().zip(own.iter_mut().zip(change)) {
                    *own -= *change;
                    size = size.max(own.abs() + node.value[r].abs());
                    largest = largest.max(change.abs());
                }
            }
            let ratio = match (is_linear, iteration) {
                (false, _) => f64::INFINITY,
                (true, 0) if factors.are_whole() => ROUNDED,
                (true, 0) => f64::INFINITY,
                (true, _) => largest / size / last,
            };
            last = largest / size;
            has_ended = last <= ROUNDING || ratio < 1.0 && last * ratio / (1.0 - ratio) <= allowed;
            if has_ended {
                break;
            }
        }
        self.newton = newton;
        has_ended || last <= CONVERGED
    }

    /// Sets `laws` to force, stiffness and damping of every contact at the start and at the nodes, for the present
    /// differences.
    fn set_laws(&self, solver: &Solver, laws: &mut Vec<[f64; 3]>) {
        laws.clear();
        for (a, (node, weights)) in self.followed.iter().zip(weights()).enumerate() {
            for (c, (&i, own)) in self.contacts.iter().zip(&self.differences).enumerate() {
                let rate = node.rate[c] + sum_of(weights, own) / self.h;
                laws.push(solver.law_of(i, node.value[c] + own[a], rate));
            }
        }
    }

    /// Whether the equation holds for contact `r` at place `a`, instead of a difference that is known.
    fn is_solved(&self, a: usize, r: usize) -> bool {
        a > 0 || self.is_free[r]
    }

    /// Sets `out` to p + G F - e by the forces of the `laws`; 0 for differences that are known.
    fn set_residual(&self, laws: &[[f64; 3]], out: &mut Vec<[f64; COUNT]>) {
        let count = self.contacts.len();
        out.clear();
        out.resize(count, [0.0; COUNT]);
        for ((a, node), laws) in self
            .followed
            .iter()
            .enumerate()
            .zip(laws.chunks_exact(count))
        {
            for (r, (out, own)) in out.iter_mut().zip(&self.differences).enumerate() {
                if self.is_solved(a, r) {
                    let forces = node.compliances(r).iter().zip(laws);
                    let deflection: f64 = forces
                        .map(|(compliance, [force, ..])| compliance * force)
                        .sum();
                    out[a] = node.value[r] + own[a] - node.approach[r] + deflection;
                }
            }
        }
    }

    /// Sets the penetration rates of the interpolated state `at`, at the fraction `share` of the step, and the penetrations
    /// themselves where those of the springs follow a polynomial; returns whether these are known for all active contacts.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn set_rates(
        &mut self,
        solver: &mut Solver,
        share: f64,
        at: &mut State,
    ) -> Result<bool, Error> {
        if self.contacts.is_empty() {
            return Ok(false);
        }
        if !self.is_polynomial {
            solver.update(at)?;
            if !solver.follow(at, &self.contacts, &self.stiffness, &mut self.at_sample) {
                return Ok(false);
            }
        }
        let (values, slopes) = (values(share), slopes(share));
        let springs = self
            .is_polynomial
            .then(|| SpringPolynomial::new(share, &values, &slopes));
        for (r, &i) in self
            .contacts
            .iter()
            .enumerate()
            .filter(|(_, i)| solver.remembers(**i))
        {
            let own = &self.differences[r];
            let by_springs = if let Some(springs) = &springs {
                let [value, rate] = springs.at(&self.followed, r, self.h);
                at.p[i] = value + sum_of(&values, own);
                rate
            } else {
                self.at_sample.rate[r]
            };
            at.p_rate[i] = by_springs + sum_of(&slopes, own) / self.h;
        }
        Ok(self.is_polynomial && self.contacts.iter().all(|i| solver.remembers(*i)))
    }

    /// Sets the forces of a state whose penetrations are known by [`Penetrations::set_rates`]; see [`Solver::apply_laws`].
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn apply_laws(&mut self, solver: &mut Solver, at: &mut State) -> Result<bool, Error> {
        let Penetrations {
            followed, residual, ..
        } = self;
        solver.apply_laws(at, followed[MIDDLE].factors(), residual)
    }
}

/// Whether the rates of the springs' penetrations are known: rails on the ground with a symmetric compliance, and one
/// force for each wheel.
fn is_suited(solver: &Solver) -> bool {
    let system = solver.system();
    system.mechanics.carried.is_empty()
        && system.mechanics.couplings.is_empty()
        && system.foundations.iter().all(|foundation| {
            let is_symmetric = foundation
                .compliance
                .as_ref()
                .is_none_or(|own| own.is_symmetric());
            foundation.parts.is_none() && foundation.carrier.is_none() && is_symmetric
        })
}
