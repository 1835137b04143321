//! Newton's method with step halving.

use crate::linear::Linear;
use nalgebra::DMatrix;

/// Why no solution was found: iterations done, and the unknown that moved most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stuck {
    pub iterations: usize,
    pub worst: usize,
}

/// Iterations before giving up.
const MOST: usize = 200;
/// Corrections of this size, relative to the unknown, are rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Corrections that no longer shrink are rounding below this size.
const STALLED: f64 = 1e-11;

/// r and its derivatives.
type Slope = (Vec<f64>, DMatrix<f64>);

/// x with r(x) = 0 from a first guess, and the iterations done.
///
/// Newton's method; where it gets stuck, as at a kink from the side that does not lead on, the guess first flows
/// along x' = -r(x), implicitly and in growing steps, in the unknowns that `flows`.
///
/// # Source
/// C. T. Kelley, D. E. Keyes, Convergence analysis of pseudo-transient continuation, SIAM Journal on Numerical
/// Analysis 35(2), 1998.
pub(crate) fn solve<E>(
    start: Vec<f64>,
    flows: &[bool],
    mut slope: impl FnMut(&[f64]) -> Result<Slope, E>,
    mut value: impl FnMut(&[f64]) -> Result<Vec<f64>, E>,
) -> Result<Result<(Vec<f64>, usize), Stuck>, E> {
    let first = newton(start.clone(), &mut slope, &mut value)?;
    let Err(stuck) = first else { return Ok(first) };
    let Some((near, iterations)) = flow(start, flows, &mut slope, &mut value) else { return Ok(first) };
    let iterations = stuck.iterations + iterations;
    Ok(match newton(near, slope, value)? {
        Ok((x, more)) => Ok((x, iterations + more)),
        Err(stuck) => Err(Stuck { iterations: iterations + stuck.iterations, ..stuck }),
    })
}

/// Where the flow leads; `None` where it leads nowhere.
fn flow<E>(
    mut x: Vec<f64>,
    flows: &[bool],
    slope: &mut impl FnMut(&[f64]) -> Result<Slope, E>,
    value: &mut impl FnMut(&[f64]) -> Result<Vec<f64>, E>,
) -> Option<(Vec<f64>, usize)> {
    let top = |all: &[f64]| all.iter().fold(0.0_f64, |top, one| top.max(one.abs()));
    // Inverse of the step in time.
    let mut rate = 1.0;
    for iterations in 1..=MOST {
        let (residual, mut matrix) = slope(&x).ok()?;
        let before = top(&residual);
        if before == 0.0 || rate < 1e-4 {
            return Some((x, iterations));
        }
        for (k, _) in flows.iter().enumerate().filter(|(_, flows)| **flows) {
            matrix[(k, k)] += rate;
        }
        let step = Linear::balanced(&matrix).and_then(|linear| linear.solve(&residual))?;
        let next: Vec<f64> = x.iter().zip(&step).map(|(x, d)| x - d).collect();
        match value(&next).map(|residual| top(&residual)) {
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

/// x with r(x) = 0, and the iterations done.
///
/// The full step J^-1 r is halved until the correction that the same J gives at the new place is smaller:
/// a test that neither units of x nor of r change. Ends when corrections are rounding.
///
/// # Source
/// P. Deuflhard, Newton Methods for Nonlinear Problems (2004), section 3.3: natural monotonicity.
fn newton<E>(
    mut x: Vec<f64>,
    mut slope: impl FnMut(&[f64]) -> Result<Slope, E>,
    mut value: impl FnMut(&[f64]) -> Result<Vec<f64>, E>,
) -> Result<Result<(Vec<f64>, usize), Stuck>, E> {
    let mut top: Vec<f64> = x.iter().map(|x| x.abs()).collect();
    let mut before = f64::INFINITY;
    for iterations in 0..MOST {
        let (residual, matrix) = slope(&x)?;
        let correct = |linear: &Linear, residual: &[f64]| {
            let all = linear.solve(residual)?;
            Some(all.iter().map(|value| -value).collect::<Vec<f64>>())
        };
        let linear = Linear::balanced(&matrix);
        let step = linear.as_ref().and_then(|linear| correct(linear, &residual));
        let (Some(linear), Some(step)) = (linear, step) else {
            return Ok(Err(Stuck { iterations, worst: largest(&residual) }));
        };
        let ahead = |share: f64| x.iter().zip(&step).map(|(x, d)| x + share * d).collect::<Vec<f64>>();
        let goal = ahead(1.0);
        let now: Vec<f64> = x.iter().zip(&goal).map(|(a, b)| a.abs().max(b.abs())).collect();
        if step.iter().zip(&now).all(|(d, scale)| d.abs() <= ROUNDING * scale) {
            // A singular matrix may have no step to offer.
            let closed =
                residual.iter().all(|r| *r == 0.0) || step.iter().any(|d| *d != 0.0) || small(&residual);
            return Ok(if closed {
                Ok((goal, iterations + 1))
            } else {
                Err(Stuck { iterations, worst: largest(&residual) })
            });
        }
        let most = top.iter().copied().fold(0.0, f64::max);
        let scales: Vec<f64> = top.iter().zip(&now).map(|(a, b)| a.max(*b).max(1e-9 * most)).collect();
        let size = |step: &[f64]| {
            step.iter()
                .zip(&scales)
                .map(|(d, s)| if *d == 0.0 { 0.0 } else { d.abs() / s })
                .fold(0.0, f64::max)
        };
        let length = size(&step);
        let rounding = length <= STALLED;
        if rounding && length >= 0.1 * before {
            return Ok(Ok((x, iterations + 1)));
        }
        before = length;
        let mut share = 1.0;
        let next = loop {
            let candidate = ahead(share);
            let found = value(&candidate).ok().and_then(|residual| correct(&linear, &residual));
            if found.is_some_and(|step| size(&step) <= (1.0 - 0.25 * share) * length) {
                break Some(candidate);
            }
            share *= 0.5;
            if share < 1e-9 {
                break None;
            }
        };
        match next {
            Some(candidate) => x = candidate,
            None if rounding => return Ok(Ok((x, iterations + 1))),
            None => {
                let worst = step.iter().zip(&scales).map(|(d, s)| d / s).collect::<Vec<f64>>();
                return Ok(Err(Stuck { iterations, worst: largest(&worst) }));
            }
        }
        for (top, x) in top.iter_mut().zip(&x) {
            *top = top.max(x.abs());
        }
    }
    Ok(Err(Stuck { iterations: MOST, worst: 0 }))
}

fn small(residual: &[f64]) -> bool {
    residual.iter().all(|r| r.abs() < 1e-13)
}

fn largest(all: &[f64]) -> usize {
    let size = |k: &usize| all[*k].abs();
    (0..all.len()).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(0)
}
