//! From one level to another.

use crate::{Fault, Scalar};
use std::f64::consts::PI;

/// h0 + (h1 - h0) s(D), D = (x - x0) / (x1 - x0), with s = 0 before and 1 after.
fn ramp<T: Scalar>(x: &T, ends: [&T; 4], s: impl Fn(f64) -> (f64, f64)) -> Result<T, Fault> {
    let [x0, h0, x1, h1] = ends;
    let length = x1.minus(x0);
    if length.value() <= 0.0 || !length.value().is_finite() {
        return Err(Fault::Parameter);
    }
    let d = x.minus(x0).over(&length);
    if d.value() <= 0.0 {
        return Ok(h0.clone());
    }
    if d.value() >= 1.0 {
        return Ok(h1.clone());
    }
    let (value, slope) = s(d.value());
    Ok(h0.plus(&h1.minus(h0).times(&d.mapped(value, slope))))
}

/// s = D^2 (3 - 2 D): once differentiable.
///
/// # Source
/// Adams Solver reference, STEP.
pub(super) fn step<T: Scalar>(x: &T, ends: [&T; 4]) -> Result<T, Fault> {
    ramp(x, ends, |d| (d * d * (3.0 - 2.0 * d), 6.0 * d * (1.0 - d)))
}

/// s = D^3 (10 - 15 D + 6 D^2): twice differentiable.
///
/// # Source
/// Adams Solver reference, STEP5.
pub(super) fn step5<T: Scalar>(x: &T, ends: [&T; 4]) -> Result<T, Fault> {
    let slope = |d: f64| 30.0 * d * d * (1.0 - d) * (1.0 - d);
    ramp(x, ends, |d| (d * d * d * (10.0 - 15.0 * d + 6.0 * d * d), slope(d)))
}

/// s = (1 + sin(pi D - pi/2)) / 2
///
/// # Source
/// Adams Solver reference, HAVSIN.
pub(super) fn havsin<T: Scalar>(x: &T, ends: [&T; 4]) -> Result<T, Fault> {
    let angle = |d: f64| PI * d - 0.5 * PI;
    ramp(x, ends, |d| (0.5 * (1.0 + angle(d).sin()), 0.5 * PI * angle(d).cos()))
}
