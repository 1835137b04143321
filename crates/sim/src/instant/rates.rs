//! Rates of given penetrations, by Newton's method.

use nalgebra::{DMatrix, DVector};

use crate::Error;
use crate::contact::solver::Solver;
use crate::mechanics::state::State;

/// Largest number of Newton iterations on the rates of penetration.
const ITERATIONS: usize = 30;

/// Finds the penetration rates of the contacts `unknown` for which their given penetrations satisfy p + G F = e. In
/// each Newton iteration the contact forces are solved at the current rates, and the rates are corrected by the
/// solution of G C dr = residual of p, where C holds the derivatives of the laws with respect to the rates. The
/// iteration stops when the residual is at the level of rounding and no longer halves. Returns whether it converged.
pub(crate) fn solve_rates_of(
    solver: &mut Solver,
    unknown: &[usize],
    at: &mut State,
) -> Result<bool, Error> {
    let system = solver.system();
    let m = system.elements.len();
    let slope = |solver: &Solver, at: &State, i: usize| {
        let scale = system.mechanics.groups[i].count() * solver.geometry().fraction(i);
        scale * system.law(i).at(at.p[i], at.p_rate[i]).by_rate
    };
    let mut last = f64::INFINITY;
    for _ in 0..ITERATIONS {
        if !solver.instant(at)? {
            return Ok(false);
        }
        let residual = DVector::from_iterator(
            unknown.len(),
            unknown
                .iter()
                .map(|&i| at.p[i] - solver.solved_penetration(i, &at.force)),
        );
        let size = residual.amax();
        let scale = unknown.iter().map(|&i| at.p[i].abs()).fold(0.0, f64::max);
        if size == 0.0 || (size >= 0.5 * last && size <= 1e-12 * scale) {
            return Ok(true);
        }
        last = last.min(size);
        let matrix = DMatrix::from_fn(unknown.len(), unknown.len(), |r, c| {
            let (i, j) = (unknown[r], unknown[c]);
            solver.geometry().rails().value[i * m + j] * slope(solver, at, j)
        });
        let Some(change) = matrix.lu().solve(&residual) else {
            return Ok(false);
        };
        for (&i, change) in unknown.iter().zip(change.iter()) {
            at.p_rate[i] -= change;
        }
    }
    Ok(unknown.is_empty()
        || last
            <= 1e-9
                * at.p[..system.verticals()]
                    .iter()
                    .fold(0.0, |max, p| p.abs().max(max)))
}
