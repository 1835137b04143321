//! Akima's curve of 1970.

use crate::Error;
use crate::curve::{Curve, check};

/// Akima's piecewise cubic through at least three points, x increasing.
///
/// With secants m_i = (y_{i+1} - y_i)/(x_{i+1} - x_i), two more at each end by m_0 = 2 m_1 - m_2 and so on,
///
/// t_i = (|m_{i+1} - m_i| m_{i-1} + |m_{i-1} - m_{i-2}| m_i) / (|m_{i+1} - m_i| + |m_{i-1} - m_{i-2}|),
///
/// and t_i = (m_{i-1} + m_i)/2 where the denominator is exactly zero. (Others test it against a small
/// tolerance; with the exact test the curve does not depend on the scale of y.)
///
/// Guarantee: once continuously differentiable; second derivatives jump at the points.
///
/// # Errors
/// Fewer than three points, x not increasing, or numbers that are not finite.
///
/// # Source
/// Akima, A new method of interpolation and smooth curve fitting based on local procedures,
/// J. ACM 17(4), 589-602 (1970).
pub fn akima(x: &[f64], y: &[f64]) -> Result<Curve, Error> {
    check(x, y, 3)?;
    let n = x.len();
    // Secants with two ghosts in front and two behind: m[i + 2] belongs to the interval i, i + 1.
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
        if sum == 0.0 { 0.5 * (m[i + 1] + m[i + 2]) } else { (after * m[i + 1] + before * m[i + 2]) / sum }
    };
    Ok(Curve::new(x, y, (0..n).map(slope).collect()))
}
