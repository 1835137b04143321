//! One-sided contact.

use super::{positive, power};
use crate::{Fault, Scalar};

/// Stiffness, exponent, damping, depth of full damping.
fn law<T: Scalar>(law: &[T]) -> Result<[&T; 4], Fault> {
    let [k, e, c, d] = law else { return Err(Fault::Arguments) };
    let sound = k.value() >= 0.0 && e.value() > 0.0 && c.value() >= 0.0 && d.value() > 0.0;
    if sound { Ok([k, e, c, d]) } else { Err(Fault::Parameter) }
}

/// max(0, k p^e - c xdot), c rising to cmax over the depth d by STEP; p > 0 is the penetration.
///
/// STEP(x, x1 - d, cmax, x1, 0) is cmax STEP(p, 0, 0, d, 1): p and d are known without cancellation.
fn push<T: Scalar>(depth: &T, speed: &T, law: [&T; 4]) -> Result<T, Fault> {
    let [k, e, c, d] = law;
    let zero = T::constant(0.0);
    let damping = super::ramp::step(depth, [&zero, &zero, d, c])?;
    Ok(positive(&k.times(&power(depth, e)).minus(&damping.times(speed))))
}

/// IMPACT(x, xdot, x1, k, e, cmax, d): pushes x up while it is below x1, never pulls.
///
/// # Source
/// Adams Solver reference, IMPACT.
pub(super) fn impact<T: Scalar>(x: &T, speed: &T, x1: &T, parameters: &[T]) -> Result<T, Fault> {
    let law = law(parameters)?;
    let depth = x1.minus(x);
    if depth.value() > 0.0 { push(&depth, speed, law) } else { Ok(T::constant(0.0)) }
}

/// BISTOP(x, xdot, x1, x2, k, e, cmax, d): pushes x back between x1 and x2.
///
/// # Source
/// Adams Solver reference, BISTOP.
pub(super) fn bistop<T: Scalar>(x: &T, speed: &T, stops: [&T; 2], parameters: &[T]) -> Result<T, Fault> {
    let law = law(parameters)?;
    let (low, high) = (stops[0].minus(x), x.minus(stops[1]));
    if low.value() > 0.0 {
        push(&low, speed, law)
    } else if high.value() > 0.0 {
        Ok(push(&high, &speed.negated(), law)?.negated())
    } else {
        Ok(T::constant(0.0))
    }
}
