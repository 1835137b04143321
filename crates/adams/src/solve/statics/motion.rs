//! The displacements that motions prescribe.

use crate::model::{Constraint, Evaluation};
use crate::{AdamsFault, Error, Scalar, StatementId};

/// Largest number of times that the interval of an integral is halved.
const DEEPEST: usize = 30;

/// The displacement or rotation that a MOTION prescribes at the time of the evaluation; zero for joints.
///
/// A prescribed velocity is integrated from time zero by adaptive Gauss quadrature.
pub(super) fn prescribed<T: Scalar>(
    constraint: &Constraint,
    on: &mut Evaluation<'_, T>,
) -> Result<T, Error> {
    let refuse = |fault: AdamsFault| Error::In {
        statement: StatementId::new(constraint.keyword, constraint.id),
        argument: "FUNCTION",
        offset: 0,
        fault: Box::new(fault),
    };
    let Some(motion) = &constraint.motion else {
        return Ok(T::constant(0.0));
    };
    let Some(start) = motion.start else {
        return motion.formula.value(on).map_err(refuse);
    };
    let end = on.at.time;
    let mut speed = |time: f64| {
        on.at.time = time;
        let value = motion.formula.value(on).map_err(refuse);
        value.map(|value| value.value())
    };
    let whole = gauss(&mut speed, 0.0, end);
    let path = whole.and_then(|whole| integral(&mut speed, [0.0, end], whole, DEEPEST));
    on.at.time = end;
    Ok(T::constant(start + path?))
}

/// The integral of the speed over an interval whose first estimate `whole` is known. The interval is halved
/// until the sum of both halves agrees with the whole.
fn integral(
    speed: &mut impl FnMut(f64) -> Result<f64, Error>,
    [a, b]: [f64; 2],
    whole: f64,
    depth: usize,
) -> Result<f64, Error> {
    let middle = 0.5 * (a + b);
    let (left, right) = (gauss(speed, a, middle)?, gauss(speed, middle, b)?);
    let sum = left + right;
    if depth == 0 || (sum - whole).abs() <= 1e-14 * (left.abs() + right.abs()) {
        return Ok(sum);
    }
    Ok(integral(speed, [a, middle], left, depth - 1)?
        + integral(speed, [middle, b], right, depth - 1)?)
}

/// The integral over an interval by Gauss quadrature with five points.
fn gauss(speed: &mut impl FnMut(f64) -> Result<f64, Error>, a: f64, b: f64) -> Result<f64, Error> {
    const POINTS: [(f64, f64); 5] = [
        (0.0, 128.0 / 225.0),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mut sum = 0.0;
    for (point, weight) in POINTS {
        sum += weight * half * speed(middle + half * point)?;
    }
    Ok(sum)
}
