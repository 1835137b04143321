//! Akima's curve of 1970.

use super::cubic::{PiecewiseCubic, check_points};
use crate::error::Error;

/// Akima's piecewise cubic through at least three points, x increasing.
///
/// The slope at each point follows from the secants around it, m_i = (y_{i+1} - y_i)/(x_{i+1} - x_i), of
/// which two more are extrapolated at each end (m_{-1} = 2 m_0 - m_1 and so on):
///
/// t_i = (|m_{i+1} - m_i| m_{i-1} + |m_{i-1} - m_{i-2}| m_i) / (|m_{i+1} - m_i| + |m_{i-1} - m_{i-2}|),
///
/// and t_i = (m_{i-1} + m_i)/2 where the denominator is exactly zero. (Other programs compare it with a small
/// tolerance; the exact comparison makes the curve independent of the scale of y.)
///
/// Guarantee: the curve passes through the points and is once continuously differentiable; second derivatives
/// jump at the points. A value depends on the six nearest points only.
///
/// # Errors
/// Fewer than three points, x not increasing, or numbers that are not finite.
///
/// # Source
/// Akima, A new method of interpolation and smooth curve fitting based on local procedures,
/// J. ACM 17(4), 589-602 (1970).
///
/// ```
/// let (x, y) = ([0.0, 1.0, 2.0, 3.0, 4.0], [0.0, 0.0, 0.0, 1.0, 1.0]);
/// let curve = splines::akima(&x, &y)?;
/// assert_eq!(curve.at(2.0).value, 0.0);
/// // Unlike a spline, the curve does not oscillate where the points lie on a straight line.
/// assert_eq!(curve.at(0.5).value, 0.0);
/// # Ok::<(), splines::Error>(())
/// ```
pub fn akima(x: &[f64], y: &[f64]) -> Result<PiecewiseCubic, Error> {
    check_points(x, y, 3)?;
    let n = x.len();
    // Two extrapolated secants in front and two behind: m[i + 2] belongs to the interval from i to i + 1.
    let mut m = vec![0.0; n + 3];
    for i in 0..n - 1 {
        m[i + 2] = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    }
    m[1] = 2.0 * m[2] - m[3];
    m[0] = 2.0 * m[1] - m[2];
    m[n + 1] = 2.0 * m[n] - m[n - 1];
    m[n + 2] = 2.0 * m[n + 1] - m[n];
    let slope = |i: usize| {
        let (before, after) = ((m[i + 1] - m[i]).abs(), (m[i + 3] - m[i + 2]).abs());
        let sum = before + after;
        if sum == 0.0 {
            0.5 * (m[i + 1] + m[i + 2])
        } else {
            (after * m[i + 1] + before * m[i + 2]) / sum
        }
    };
    Ok(PiecewiseCubic::new(x, y, (0..n).map(slope).collect()))
}
