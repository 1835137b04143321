//! The natural cubic spline.

use nalgebra::DMatrix;

use super::cubic::{PiecewiseCubic, check_points};
use crate::error::Error;

/// Natural cubic spline through at least two points, x increasing.
///
/// With h_i = x_{i+1} - x_i and the secants m_i, the slopes t solve the tridiagonal system
///
/// t_{i-1}/h_{i-1} + 2 (1/h_{i-1} + 1/h_i) t_i + t_{i+1}/h_i = 3 (m_{i-1}/h_{i-1} + m_i/h_i),
///
/// with 2 t_0 + t_1 = 3 m_0 at the first point, likewise at the last.
///
/// Guarantee: the curve passes through the points, is twice continuously differentiable, and has no curvature
/// at either end.
///
/// # Errors
/// Fewer than two points, x not increasing, or numbers that are not finite.
///
/// # Source
/// de Boor, A Practical Guide to Splines (1978), chapter IV.
///
/// ```
/// let curve = splines::natural_spline(&[0.0, 1.0, 2.0], &[0.0, 1.0, 0.0])?;
/// assert_eq!(curve.at(1.0).slope, 0.0);
/// // y = (3 x - x^3)/2 on the first interval.
/// assert!((curve.at(0.5).value - 0.6875).abs() < 1e-15);
/// # Ok::<(), splines::Error>(())
/// ```
pub fn natural_spline(x: &[f64], y: &[f64]) -> Result<PiecewiseCubic, Error> {
    check_points(x, y, 2)?;
    Ok(PiecewiseCubic::new(x, y, slopes(x, y, [false; 2])))
}

/// Slopes of the cubic spline at its points. At each end the curvature is zero, or the slope where `clamped`.
fn slopes(x: &[f64], y: &[f64], clamped: [bool; 2]) -> Vec<f64> {
    let n = x.len();
    let h = |i: usize| x[i + 1] - x[i];
    let m = |i: usize| (y[i + 1] - y[i]) / h(i);
    // Gaussian elimination of a tridiagonal, diagonally dominant matrix, without pivoting (Thomas'
    // algorithm).
    let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
    for i in 0..n {
        if (i == 0 && clamped[0]) || (i == n - 1 && clamped[1]) {
            continue;
        }
        let below = if i > 0 { 1.0 / h(i - 1) } else { 0.0 };
        let above = if i + 1 < n { 1.0 / h(i) } else { 0.0 };
        let mut load = 0.0;
        if i > 0 {
            load += 3.0 * m(i - 1) * below;
        }
        if i + 1 < n {
            load += 3.0 * m(i) * above;
        }
        let (factor, previous) = if i > 0 {
            (upper[i - 1], right[i - 1])
        } else {
            (0.0, 0.0)
        };
        let pivot = 2.0 * (below + above) - below * factor;
        upper[i] = above / pivot;
        right[i] = (load - below * previous) / pivot;
    }
    for i in (0..n - 1).rev() {
        right[i] -= upper[i] * right[i + 1];
    }
    right
}

/// The matrix B, 2 N x N, that takes N values to the values and slopes of their spline: rows 2 i and 2 i + 1
/// are value and slope at point i. The ends have no curvature, or no slope where `clamped`.
pub(crate) fn values_and_slopes(x: &[f64], clamped: [bool; 2]) -> DMatrix<f64> {
    let n = x.len();
    let mut out = DMatrix::zeros(2 * n, n);
    let mut unit = vec![0.0; n];
    for j in 0..n {
        unit[j] = 1.0;
        out[(2 * j, j)] = 1.0;
        for (i, slope) in slopes(x, &unit, clamped).into_iter().enumerate() {
            out[(2 * i + 1, j)] = slope;
        }
        unit[j] = 0.0;
    }
    out
}
