//! Newton's method with step halving, and pseudo-transient continuation where it fails.

use super::linear::FactoredMatrix;
use nalgebra::DMatrix;

/// The iteration has not converged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NotConverged {
    /// Iterations done.
    pub iterations: usize,
    /// The unknown with the largest scaled correction.
    pub worst: usize,
}

/// Largest number of iterations.
const MOST: usize = 200;
/// Corrections of at most this size, relative to the unknown, are at the level of rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Corrections that no longer decrease count as rounding if they are below this size.
const STALLED: f64 = 1e-11;

/// The residual r and its Jacobian J = dr/dx.
type Linearization = (Vec<f64>, DMatrix<f64>);

/// Solves r(x) = 0 from an initial value, and returns x and the number of iterations.
///
/// Newton's method is tried first. Where it does not converge, for instance at a kink of r on the side from
/// which steps lead back, the initial value first follows the differential equation x' = -r(x) by implicit
/// Euler steps of growing length (pseudo-transient continuation), and Newton's method starts again from
/// there. Only the unknowns marked in `continued` have a time derivative; the equations of the others hold at
/// every step.
///
/// `linearize` gives r and J, `residual_at` gives r alone. Their errors at the start of Newton's method are
/// returned.
///
/// # Source
/// C. T. Kelley, D. E. Keyes, Convergence analysis of pseudo-transient continuation, SIAM Journal on
/// Numerical Analysis 35(2), 1998.
pub(super) fn solve<E>(
    start: Vec<f64>,
    continued: &[bool],
    mut linearize: impl FnMut(&[f64]) -> Result<Linearization, E>,
    mut residual_at: impl FnMut(&[f64]) -> Result<Vec<f64>, E>,
) -> Result<Result<(Vec<f64>, usize), NotConverged>, E> {
    let first = newton(start.clone(), &mut linearize, &mut residual_at)?;
    let Err(failure) = first else {
        return Ok(first);
    };
    let Some((near, iterations)) = continuation(start, continued, &mut linearize, &mut residual_at)
    else {
        return Ok(first);
    };
    let iterations = failure.iterations + iterations;
    Ok(match newton(near, linearize, residual_at)? {
        Ok((x, more)) => Ok((x, iterations + more)),
        Err(failure) => Err(NotConverged {
            iterations: iterations + failure.iterations,
            ..failure
        }),
    })
}

/// The end of pseudo-transient continuation and the number of steps; `None` if the steps fail.
///
/// Each step solves (J + rate) dx = -r. The rate, the inverse of the time step, decreases with the residual;
/// a step that increases the residual too much is repeated with an eightfold rate.
fn continuation<E>(
    mut x: Vec<f64>,
    continued: &[bool],
    linearize: &mut impl FnMut(&[f64]) -> Result<Linearization, E>,
    residual_at: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, E>,
) -> Option<(Vec<f64>, usize)> {
    let top = |all: &[f64]| all.iter().fold(0.0_f64, |top, one| top.max(one.abs()));
    // The inverse of the time step.
    let mut rate = 1.0;
    for iterations in 1..=MOST {
        let (residual, mut matrix) = linearize(&x).ok()?;
        let before = top(&residual);
        if before == 0.0 || rate < 1e-4 {
            return Some((x, iterations));
        }
        for (k, _) in continued
            .iter()
            .enumerate()
            .filter(|(_, continued)| **continued)
        {
            matrix[(k, k)] += rate;
        }
        let step = FactoredMatrix::balanced(&matrix).and_then(|linear| linear.solve(&residual))?;
        let next: Vec<f64> = x.iter().zip(&step).map(|(x, d)| x - d).collect();
        match residual_at(&next).map(|residual| top(&residual)) {
            Ok(after) if after <= 1.5 * before => {
                x = next;
                rate *= (after / before).clamp(0.1, 0.8);
            }
            _ => rate *= 8.0,
        }
        if rate > 1e12 {
            return None;
        }
    }
    Some((x, MOST))
}

/// Newton's method for r(x) = 0; returns x and the number of iterations.
///
/// The step -J^-1 r is halved until the simplified correction -J^-1 r(x + step), with the same J, is smaller
/// than the step. This test of natural monotonicity does not depend on the units of x and r. The iteration
/// ends when the corrections are at the level of rounding. A step by a singular J is accepted as the last one
/// only if it solves the linear equations.
///
/// # Source
/// P. Deuflhard, Newton Methods for Nonlinear Problems (2004), section 3.3: natural monotonicity.
fn newton<E>(
    mut x: Vec<f64>,
    mut linearize: impl FnMut(&[f64]) -> Result<Linearization, E>,
    mut residual_at: impl FnMut(&[f64]) -> Result<Vec<f64>, E>,
) -> Result<Result<(Vec<f64>, usize), NotConverged>, E> {
    let mut top: Vec<f64> = x.iter().map(|x| x.abs()).collect();
    let mut before = f64::INFINITY;
    for iterations in 0..MOST {
        let (residual, matrix) = linearize(&x)?;
        let linear = FactoredMatrix::balanced(&matrix);
        let step = linear
            .as_ref()
            .and_then(|linear| linear.correction(&residual));
        let (Some(linear), Some(step)) = (linear, step) else {
            return Ok(Err(NotConverged {
                iterations,
                worst: largest(&residual),
            }));
        };
        let goal = advanced(&x, &step, 1.0);
        let now: Vec<f64> = x
            .iter()
            .zip(&goal)
            .map(|(a, b)| a.abs().max(b.abs()))
            .collect();
        if step
            .iter()
            .zip(&now)
            .all(|(d, scale)| d.abs() <= ROUNDING * scale)
        {
            let closed =
                linear.rank_deficiency() == 0 || is_solution(&matrix, &step, &residual, &goal);
            return Ok(if closed {
                Ok((goal, iterations + 1))
            } else {
                Err(NotConverged {
                    iterations,
                    worst: largest(&residual),
                })
            });
        }
        let most = top.iter().copied().fold(0.0, f64::max);
        let scales: Vec<f64> = top
            .iter()
            .zip(&now)
            .map(|(a, b)| a.max(*b).max(1e-9 * most))
            .collect();
        let length = scaled_size(&step, &scales);
        let rounding = length <= STALLED;
        if rounding && length >= 0.1 * before {
            return Ok(Ok((x, iterations + 1)));
        }
        before = length;
        match damped_step(&x, &step, &scales, &linear, &mut residual_at) {
            Some(candidate) => x = candidate,
            None if rounding => return Ok(Ok((x, iterations + 1))),
            None => {
                let worst = step
                    .iter()
                    .zip(&scales)
                    .map(|(d, s)| d / s)
                    .collect::<Vec<f64>>();
                return Ok(Err(NotConverged {
                    iterations,
                    worst: largest(&worst),
                }));
            }
        }
        for (top, x) in top.iter_mut().zip(&x) {
            *top = top.max(x.abs());
        }
    }
    Ok(Err(NotConverged {
        iterations: MOST,
        worst: 0,
    }))
}

/// The unknowns after the largest fraction of a step that passes the test of natural monotonicity; `None` if
/// no fraction above 1e-9 does.
fn damped_step<E>(
    x: &[f64],
    step: &[f64],
    scales: &[f64],
    linear: &FactoredMatrix,
    residual_at: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, E>,
) -> Option<Vec<f64>> {
    let length = scaled_size(step, scales);
    let mut fraction = 1.0;
    while fraction >= 1e-9 {
        let candidate = advanced(x, step, fraction);
        let after = residual_at(&candidate)
            .ok()
            .and_then(|residual| linear.correction(&residual));
        if after
            .is_some_and(|after| scaled_size(&after, scales) <= (1.0 - 0.25 * fraction) * length)
        {
            return Some(candidate);
        }
        fraction *= 0.5;
    }
    None
}

/// x plus a fraction of a step.
fn advanced(x: &[f64], step: &[f64], fraction: f64) -> Vec<f64> {
    x.iter().zip(step).map(|(x, d)| x + fraction * d).collect()
}

/// The largest ratio of a step to its scale.
fn scaled_size(step: &[f64], scales: &[f64]) -> f64 {
    let ratio = |(d, s): (&f64, &f64)| if *d == 0.0 { 0.0 } else { d.abs() / s };
    step.iter().zip(scales).map(ratio).fold(0.0, f64::max)
}

/// Whether a step satisfies J step + r = 0. Singular equations may have no solution.
fn is_solution(matrix: &DMatrix<f64>, step: &[f64], residual: &[f64], x: &[f64]) -> bool {
    let sum = |i: usize, of: &dyn Fn(usize) -> f64| (0..x.len()).map(of).sum::<f64>() + residual[i];
    (0..x.len()).all(|i| {
        let left = sum(i, &|j| matrix[(i, j)] * step[j]);
        let scale: f64 = (0..x.len()).map(|j| (matrix[(i, j)] * x[j]).abs()).sum();
        left.abs() <= 1e-10 * scale + 1e-13
    })
}

/// The index of the number with the largest magnitude.
fn largest(all: &[f64]) -> usize {
    let size = |k: &usize| all[*k].abs();
    (0..all.len())
        .max_by(|a, b| size(a).total_cmp(&size(b)))
        .unwrap_or(0)
}
