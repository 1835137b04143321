//! What motions prescribe.

use crate::code::View;
use crate::model::Constraint;
use crate::{Error, Fault, Scalar};

/// Halvings of an interval at most.
const DEEPEST: usize = 30;

/// The displacement that a motion holds; zero for joints.
pub(super) fn held<T: Scalar>(constraint: &Constraint, view: &mut View<'_, T>) -> Result<T, Error> {
    let refuse = |fault: Fault| Error::In {
        keyword: constraint.keyword.to_owned(),
        id: constraint.id,
        argument: "FUNCTION".to_owned(),
        offset: 0,
        fault: Box::new(fault),
    };
    let Some(drive) = &constraint.drive else { return Ok(T::constant(0.0)) };
    let Some(start) = drive.start else { return drive.code.value(view).map_err(refuse) };
    let end = view.time;
    let mut speed = |time: f64| {
        view.time = time;
        let value = drive.code.value(view).map_err(refuse);
        value.map(|value| value.value())
    };
    let whole = gauss(&mut speed, 0.0, end);
    let path = whole.and_then(|whole| integral(&mut speed, [0.0, end], whole, DEEPEST));
    view.time = end;
    Ok(T::constant(start + path?))
}

/// The integral over an interval whose first estimate is known: halved until the halves agree with the whole.
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
    Ok(integral(speed, [a, middle], left, depth - 1)? + integral(speed, [middle, b], right, depth - 1)?)
}

/// Gauss' rule with five points.
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
    for (place, weight) in POINTS {
        sum += weight * half * speed(middle + half * place)?;
    }
    Ok(sum)
}
