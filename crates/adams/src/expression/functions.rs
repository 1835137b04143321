//! Functions of expressions that depend on the values of their arguments alone, from ABS to IMPACT.

use super::scalar::Scalar;
use crate::AdamsFault;
use std::f64::consts::PI;

/// A function whose value depends on the values of its arguments alone.
///
/// ```
/// use adams::functions::Function;
///
/// let (step, least, most) = Function::find("STEP").expect("a function");
/// assert_eq!((least, most), (5, 5));
/// assert_eq!(step.value(&[0.5, 0.0, 0.0, 1.0, 8.0]), Ok(4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// One of [`UnaryFunction`].
    Unary(UnaryFunction),
    /// ATAN2(y, x)
    Atan2,
    /// MOD(a, b): the remainder of a/b, with the sign of a.
    Mod,
    /// SIGN(a, b): |a| with the sign of b.
    Sign,
    /// DIM(a, b): max(0, a - b).
    Dim,
    /// MAX of two or more arguments.
    Max,
    /// MIN of two or more arguments.
    Min,
    /// POLY(x, x0, a0, a1, ...) = a0 + a1 (x - x0) + a2 (x - x0)^2 + ...
    Poly,
    /// STEP(x, x0, h0, x1, h1): from h0 to h1 by a cubic.
    Step,
    /// STEP5(x, x0, h0, x1, h1): from h0 to h1 by a quintic.
    Step5,
    /// HAVSIN(x, x0, h0, x1, h1): from h0 to h1 by half a sine wave.
    Havsin,
    /// IMPACT(x, xdot, x1, k, e, cmax, d): one-sided contact.
    Impact,
    /// BISTOP(x, xdot, x1, x2, k, e, cmax, d): contact at both ends of a gap.
    Bistop,
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnaryFunction {
    /// Absolute value.
    Abs,
    /// Square root.
    Sqrt,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Inverse sine.
    Asin,
    /// Inverse cosine.
    Acos,
    /// Inverse tangent.
    Atan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Exponential function.
    Exp,
    /// Natural logarithm.
    Log,
    /// Logarithm to base ten.
    Log10,
    /// The whole number next towards zero.
    Aint,
    /// The nearest whole number.
    Anint,
}

const UNARY: &[(&str, UnaryFunction)] = &[
    ("ABS", UnaryFunction::Abs),
    ("SQRT", UnaryFunction::Sqrt),
    ("SIN", UnaryFunction::Sin),
    ("COS", UnaryFunction::Cos),
    ("TAN", UnaryFunction::Tan),
    ("ASIN", UnaryFunction::Asin),
    ("ACOS", UnaryFunction::Acos),
    ("ATAN", UnaryFunction::Atan),
    ("SINH", UnaryFunction::Sinh),
    ("COSH", UnaryFunction::Cosh),
    ("TANH", UnaryFunction::Tanh),
    ("EXP", UnaryFunction::Exp),
    ("LOG", UnaryFunction::Log),
    ("LOG10", UnaryFunction::Log10),
    ("AINT", UnaryFunction::Aint),
    ("ANINT", UnaryFunction::Anint),
];

impl Function {
    /// The function of a name in capitals, with the smallest and largest number of its arguments.
    #[must_use]
    pub fn find(name: &str) -> Option<(Function, usize, usize)> {
        if let Some((_, unary)) = UNARY.iter().find(|(word, _)| *word == name) {
            return Some((Function::Unary(*unary), 1, 1));
        }
        Some(match name {
            "ATAN2" => (Function::Atan2, 2, 2),
            "MOD" => (Function::Mod, 2, 2),
            "SIGN" => (Function::Sign, 2, 2),
            "DIM" => (Function::Dim, 2, 2),
            "MAX" => (Function::Max, 2, usize::MAX),
            "MIN" => (Function::Min, 2, usize::MAX),
            "POLY" => (Function::Poly, 3, 33),
            "STEP" => (Function::Step, 5, 5),
            "STEP5" => (Function::Step5, 5, 5),
            "HAVSIN" => (Function::Havsin, 5, 5),
            "IMPACT" => (Function::Impact, 7, 7),
            "BISTOP" => (Function::Bistop, 8, 8),
            _ => return None,
        })
    }

    /// The value, with derivatives where the arguments carry them. At a kink it has the slope of one branch.
    ///
    /// The value may be infinite or NaN: callers check.
    ///
    /// # Errors
    /// [`AdamsFault::Arguments`] for a wrong number of arguments; [`AdamsFault::Parameter`] for a ramp without
    /// length, or a stiffness, exponent, damping or penetration outside the range of a contact law.
    pub fn value<T: Scalar>(self, arguments: &[T]) -> Result<T, AdamsFault> {
        match (self, arguments) {
            (Function::Unary(unary), [a]) => Ok(unary.value(a)),
            (Function::Atan2, [y, x]) => Ok(atan2(y, x)),
            (Function::Mod, [a, b]) => {
                let (p, q) = (a.value(), b.value());
                Ok(T::compose(p % q, &[(1.0, a), (-(p / q).trunc(), b)]))
            }
            (Function::Sign, [a, b]) => {
                let flip = (a.value() < 0.0) != (b.value() < 0.0);
                Ok(a.scaled(if flip { -1.0 } else { 1.0 }))
            }
            (Function::Dim, [a, b]) => Ok(positive(&a.minus(b))),
            (Function::Max, [first, rest @ ..]) => {
                Ok(rest.iter().fold(first.clone(), |a, b| max(&a, b)))
            }
            (Function::Min, [first, rest @ ..]) => {
                Ok(rest.iter().fold(first.clone(), |a, b| min(&a, b)))
            }
            (Function::Poly, [x, origin, coefficients @ ..]) => {
                let d = x.minus(origin);
                let zero = T::constant(0.0);
                Ok(coefficients
                    .iter()
                    .rev()
                    .fold(zero, |sum, one| sum.times(&d).plus(one)))
            }
            (Function::Step, [x, x0, h0, x1, h1]) => step(x, [x0, h0, x1, h1]),
            (Function::Step5, [x, x0, h0, x1, h1]) => step5(x, [x0, h0, x1, h1]),
            (Function::Havsin, [x, x0, h0, x1, h1]) => havsin(x, [x0, h0, x1, h1]),
            (Function::Impact, [x, v, x1, law @ ..]) => impact(x, v, x1, law),
            (Function::Bistop, [x, v, x1, x2, law @ ..]) => bistop(x, v, [x1, x2], law),
            _ => Err(AdamsFault::Arguments),
        }
    }
}

impl UnaryFunction {
    fn value<T: Scalar>(self, a: &T) -> T {
        let x = a.value();
        let (value, slope) = match self {
            UnaryFunction::Abs => (x.abs(), if x < 0.0 { -1.0 } else { 1.0 }),
            UnaryFunction::Sqrt => (x.sqrt(), 0.5 / x.sqrt()),
            UnaryFunction::Sin => (x.sin(), x.cos()),
            UnaryFunction::Cos => (x.cos(), -x.sin()),
            UnaryFunction::Tan => (x.tan(), 1.0 + x.tan() * x.tan()),
            UnaryFunction::Asin => (x.asin(), 1.0 / (1.0 - x * x).sqrt()),
            UnaryFunction::Acos => (x.acos(), -1.0 / (1.0 - x * x).sqrt()),
            UnaryFunction::Atan => (x.atan(), 1.0 / (1.0 + x * x)),
            UnaryFunction::Sinh => (x.sinh(), x.cosh()),
            UnaryFunction::Cosh => (x.cosh(), x.sinh()),
            UnaryFunction::Tanh => (x.tanh(), 1.0 - x.tanh() * x.tanh()),
            UnaryFunction::Exp => (x.exp(), x.exp()),
            UnaryFunction::Log => (x.ln(), 1.0 / x),
            UnaryFunction::Log10 => (x.log10(), std::f64::consts::LOG10_E / x),
            UnaryFunction::Aint => (x.trunc(), 0.0),
            UnaryFunction::Anint => (x.round(), 0.0),
        };
        a.mapped(value, slope)
    }
}

/// The angle of the point (x, y), from -pi to pi.
pub(crate) fn atan2<T: Scalar>(y: &T, x: &T) -> T {
    let (a, b) = (y.value(), x.value());
    let square = a * a + b * b;
    T::compose(a.atan2(b), &[(b / square, y), (-a / square, x)])
}

/// The power a^b. A negative base gives a number where b is a whole number; the derivative with respect to b
/// is then taken as zero.
pub(crate) fn power<T: Scalar>(base: &T, exponent: &T) -> T {
    let (a, b) = (base.value(), exponent.value());
    let value = a.powf(b);
    let slope = if b == 0.0 { 0.0 } else { b * a.powf(b - 1.0) };
    let by_exponent = if a > 0.0 { value * a.ln() } else { 0.0 };
    T::compose(value, &[(slope, base), (by_exponent, exponent)])
}

fn max<T: Scalar>(a: &T, b: &T) -> T {
    if a.value() >= b.value() {
        a.clone()
    } else {
        b.clone()
    }
}

fn min<T: Scalar>(a: &T, b: &T) -> T {
    if a.value() <= b.value() {
        a.clone()
    } else {
        b.clone()
    }
}

/// max(0, a)
fn positive<T: Scalar>(a: &T) -> T {
    if a.value() > 0.0 {
        a.clone()
    } else {
        T::constant(0.0)
    }
}

/// h0 + (h1 - h0) s(D) with D = (x - x0) / (x1 - x0); s is 0 below D = 0 and 1 above D = 1. Between them the
/// closure gives s and its slope.
fn ramp<T: Scalar>(x: &T, ends: [&T; 4], s: impl Fn(f64) -> (f64, f64)) -> Result<T, AdamsFault> {
    let [x0, h0, x1, h1] = ends;
    let length = x1.minus(x0);
    if length.value() <= 0.0 || !length.value().is_finite() {
        return Err(AdamsFault::Parameter);
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

/// STEP: s = D^2 (3 - 2 D), once continuously differentiable.
///
/// # Source
/// Adams Solver reference, STEP.
fn step<T: Scalar>(x: &T, ends: [&T; 4]) -> Result<T, AdamsFault> {
    ramp(x, ends, |d| (d * d * (3.0 - 2.0 * d), 6.0 * d * (1.0 - d)))
}

/// STEP5: s = D^3 (10 - 15 D + 6 D^2), twice continuously differentiable.
///
/// # Source
/// Adams Solver reference, STEP5.
fn step5<T: Scalar>(x: &T, ends: [&T; 4]) -> Result<T, AdamsFault> {
    let slope = |d: f64| 30.0 * d * d * (1.0 - d) * (1.0 - d);
    ramp(x, ends, |d| {
        (d * d * d * (10.0 - 15.0 * d + 6.0 * d * d), slope(d))
    })
}

/// HAVSIN: s = (1 + sin(pi D - pi/2)) / 2.
///
/// # Source
/// Adams Solver reference, HAVSIN.
fn havsin<T: Scalar>(x: &T, ends: [&T; 4]) -> Result<T, AdamsFault> {
    let angle = |d: f64| PI * d - 0.5 * PI;
    ramp(x, ends, |d| {
        (0.5 * (1.0 + angle(d).sin()), 0.5 * PI * angle(d).cos())
    })
}

/// Parameters of a contact law, checked: stiffness k >= 0, exponent e > 0, damping cmax >= 0 and the
/// penetration d > 0 at which the damping is fully applied.
fn contact_parameters<T: Scalar>(law: &[T]) -> Result<[&T; 4], AdamsFault> {
    let [k, e, c, d] = law else {
        return Err(AdamsFault::Arguments);
    };
    let sound = k.value() >= 0.0 && e.value() > 0.0 && c.value() >= 0.0 && d.value() > 0.0;
    if sound {
        Ok([k, e, c, d])
    } else {
        Err(AdamsFault::Parameter)
    }
}

/// Contact force max(0, k p^e - c xdot) at the penetration p > 0 (`depth`); c rises to cmax over the
/// penetration d by STEP.
///
/// The reference writes c as STEP(x, x1 - d, cmax, x1, 0). The equal form cmax STEP(p, 0, 0, d, 1) is used
/// here because p and d are known without cancellation.
fn contact_force<T: Scalar>(depth: &T, speed: &T, law: [&T; 4]) -> Result<T, AdamsFault> {
    let [k, e, c, d] = law;
    let zero = T::constant(0.0);
    let damping = step(depth, [&zero, &zero, d, c])?;
    Ok(positive(
        &k.times(&power(depth, e)).minus(&damping.times(speed)),
    ))
}

/// IMPACT(x, xdot, x1, k, e, cmax, d): a force on x towards larger values while x < x1, and never below zero.
///
/// # Source
/// Adams Solver reference, IMPACT.
fn impact<T: Scalar>(x: &T, speed: &T, x1: &T, parameters: &[T]) -> Result<T, AdamsFault> {
    let law = contact_parameters(parameters)?;
    let depth = x1.minus(x);
    if depth.value() > 0.0 {
        contact_force(&depth, speed, law)
    } else {
        Ok(T::constant(0.0))
    }
}

/// BISTOP(x, xdot, x1, x2, k, e, cmax, d): a force on x that returns it between x1 and x2.
///
/// # Source
/// Adams Solver reference, BISTOP.
fn bistop<T: Scalar>(x: &T, speed: &T, stops: [&T; 2], parameters: &[T]) -> Result<T, AdamsFault> {
    let law = contact_parameters(parameters)?;
    let (low, high) = (stops[0].minus(x), x.minus(stops[1]));
    if low.value() > 0.0 {
        contact_force(&low, speed, law)
    } else if high.value() > 0.0 {
        Ok(contact_force(&high, &speed.negated(), law)?.negated())
    } else {
        Ok(T::constant(0.0))
    }
}
