//! Newton's method for the forces, with the laws that act.

use super::{Effects, Factors, Problem, Residuals, RowKind, Wanted, largest};
use crate::contact::element::{Coupling, Law, Local, Query};
use crate::contact::system::System;
use crate::numerics::dense::{along, factor_general, solve_factored};

/// Relative change of the forces at which Newton's method ends.
const TOLERANCE: f64 = 1e-13;
/// Relative change of the forces, or residual, at which Newton's method ends where rounding prevents a smaller one.
const STAGNANT: f64 = 1e-9;
/// Residual, relative to the parts of a law by penetration and by rate, that is their rounding: as a wheel leaves its rail, they
/// cancel.
const ROUNDING: f64 = 8.0 * f64::EPSILON;
const ITERATIONS: usize = 60;
/// Part of the residual up to which a step may leave it, for the factors to serve in the next one.
const CHORD: f64 = 1e-3;
/// Damping factor of the Newton step below which the step is not halved again. A brake on
/// a compliant rail sticks only within 1e-6 of the forces on either side, and within less in short steps.
const SHORTEST: f64 = 1e-12;
/// Number of whole steps to another set of acting laws that may increase the residual; if they do not lead to the solution,
/// it is sought from the first guess without them.
const LEAPS: usize = 6;
/// Number of steps no part of which lowers the residual, after which Newton's method ends: of a million solutions six needed one
/// or two.
const STALLS: usize = 3;
/// A rate at which every tangential law is at its limit.
const SATURATED: f64 = 1e150;

impl Residuals {
    fn clear(&mut self) {
        self.acting.clear();
        self.slopes.clear();
        self.couplings.clear();
        self.value.fill(0.0);
        self.released.clear();
        self.held.clear();
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
    /// Newton's method with step halving for F - law(F) = 0. The factors of a Jacobian serve while the same laws act and
    /// every step leaves at most [`CHORD`] of the residual.
    pub(super) fn solve_newton(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &mut [f64],
    ) -> bool {
        for i in (0..system.verticals()).filter(|&i| !active[i]) {
            force[i] = 0.0;
        }
        self.first.copy_from_slice(force);
        // Under a first guess of the forces, laws that act may seem to have ceased.
        let mut size = self.evaluate(system, local, active, force, Wanted::Continued);
        let (mut is_current, mut leaps) = (std::mem::take(&mut self.is_repeated), LEAPS);
        let mut stalls = 0;
        for _ in 0..ITERATIONS {
            let before = size;
            if !(is_current && self.residuals.acting == self.factors.elements || self.factor()) {
                return false;
            }
            self.take_newton_step();
            let scale = largest(force);
            let rounding = ROUNDING * self.largest_part();
            let change = largest(&self.residuals.value);
            self.start.copy_from_slice(force);
            self.newton.copy_from_slice(&self.residuals.value);
            let mut damping = 1.0;
            loop {
                for (f, (start, newton)) in
                    force.iter_mut().zip(self.start.iter().zip(&self.newton))
                {
                    *f = start - damping * newton;
                }
                let now = self.evaluate(system, local, active, force, Wanted::Natural);
                if now <= size || now <= (TOLERANCE * scale).max(rounding) || damping < SHORTEST {
                    stalls += usize::from(now > size);
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
            if change <= done || size <= (0.1 * done).max(self.slack * scale).max(rounding) {
                return true;
            }
            if stalls == STALLS {
                break;
            }
            is_current = size <= CHORD * before;
        }
        // The residual may stagnate at rounding; it is accepted if it is small relative to the forces.
        size <= STAGNANT * largest(force)
    }

    /// The largest part of the force of a law by its penetration or its rate alone.
    fn largest_part(&self) -> f64 {
        let pairs = self.residuals.acting.iter().zip(&self.residuals.slopes);
        let parts = pairs.map(|(&i, law)| {
            let [p, rate] = self.residuals.reached[i];
            (law.by_penetration * p)
                .abs()
                .max((law.by_rate * rate).abs())
        });
        parts.fold(0.0, f64::max)
    }

    /// Evaluates the residuals of the laws under `force` with W and Y; returns the largest absolute residual.
    pub(super) fn evaluate(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &[f64],
        wanted: Wanted,
    ) -> f64 {
        for &i in &self.sought {
            let effects = &self.effects;
            let sunk = along(&effects.w, i, force);
            let rate = match effects.kind[i] {
                RowKind::Memory(per_step) => effects.rate[i] - per_step * sunk,
                _ if system.fixed[i].feels_rates || system.fixed[i].has_memory => {
                    effects.rate_under(i, force)
                }
                // The rates of other elements depend on no force.
                _ => effects.rate[i],
            };
            self.residuals.reached[i] = [effects.approach[i] - sunk, rate];
        }
        self.evaluate_laws(system, local, active, force, wanted);
        largest(&self.residuals.value)
    }

    /// Fills the residuals F - law(p, r) under `force` at the stored penetrations and rates, the list of acting
    /// elements, and the slopes of their laws. The residual of an element that does not act is its force.
    pub(super) fn evaluate_laws(
        &mut self,
        system: &System,
        local: &[Local],
        active: &[bool],
        force: &[f64],
        wanted: Wanted,
    ) {
        let holds = wanted == Wanted::Factored;
        let Problem {
            effects,
            idle,
            sought,
            residuals,
            factors,
            ..
        } = self;
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
            if is_held && found.is_none() {
                residuals.held.push(i);
                residuals.couplings.truncate(known);
                query.continues = true;
                found = system.elements[i].law(&query, &mut residuals.couplings);
            }
            let Some(mut law) = found else {
                residuals.set_idle(i, force[i]);
                continue;
            };
            if let Some(wanted) = keeping {
                law = Law {
                    force: law.force,
                    ..Law::default()
                };
                if wanted.abs() <= law.force * wanted.signum() {
                    // The residual is (W F - displacement)/W_ii, so the row of the Jacobian is that of W/W_ii. The
                    // coupling of slope 1 cancels the diagonal entry of the identity.
                    residuals.couplings.truncate(known);
                    residuals.couplings.push(Coupling {
                        element: i,
                        by: i,
                        slope: 1.0,
                    });
                    law = Law {
                        force: wanted,
                        by_penetration: 1.0 / effects.w[i * m + i],
                        ..Law::default()
                    };
                }
            }
            residuals.set_acting(i, force[i], law);
        }
    }

    /// Factors the Jacobian of the acting laws: I + law_p W + law_r Y minus the slopes with respect to other forces.
    /// Returns false if it is singular.
    pub(super) fn factor(&mut self) -> bool {
        let Problem {
            effects: Effects { w, y, kind, .. },
            residuals,
            factors,
            ..
        } = self;
        let Factors {
            elements,
            jacobian,
            pivots,
        } = factors;
        let (m, count) = (residuals.value.len(), residuals.acting.len());
        for (row, &i) in residuals.acting.iter().enumerate() {
            let line = &mut jacobian[row * count..(row + 1) * count];
            let (own_w, own_y) = (&w[i * m..(i + 1) * m], &y[i * m..(i + 1) * m]);
            let Law {
                mut by_penetration,
                mut by_rate,
                by_other,
                ..
            } = residuals.slopes[row];
            if let RowKind::Memory(per_step) = kind[i] {
                (by_penetration, by_rate) = (by_penetration + by_rate * per_step, 0.0);
            }
            line.iter_mut()
                .zip(&residuals.acting)
                .for_each(|(entry, &j)| *entry = by_penetration * own_w[j]);
            if by_rate != 0.0 {
                line.iter_mut()
                    .zip(&residuals.acting)
                    .for_each(|(entry, &j)| *entry += by_rate * own_y[j]);
            }
            if let Some((other, slope)) = by_other {
                let w = &w[other * m..(other + 1) * m];
                line.iter_mut()
                    .zip(&residuals.acting)
                    .for_each(|(entry, &j)| *entry += slope * w[j]);
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
    pub(super) fn take_newton_step(&mut self) {
        let Problem {
            effects: Effects { w, y, .. },
            residuals,
            factors,
            change,
            ..
        } = self;
        let (m, count) = (residuals.value.len(), factors.elements.len());
        for (row, &i) in factors.elements.iter().enumerate() {
            change[row] = residuals.value[i];
            for &j in &residuals.released {
                let Law {
                    by_penetration,
                    by_rate,
                    ..
                } = residuals.slopes[row];
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
}
