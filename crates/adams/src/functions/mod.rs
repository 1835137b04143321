//! Functions of numbers alone.

mod contact;
mod ramp;

use crate::{Fault, Scalar};

/// A function whose value follows from the values of its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    /// One of [`Unary`].
    Unary(Unary),
    /// ATAN2(y, x)
    Atan2,
    /// MOD(a, b) with the sign of a.
    Mod,
    /// SIGN(a, b): |a| with the sign of b.
    Sign,
    /// DIM(a, b): a - b if positive, or 0.
    Dim,
    /// MAX of two or more.
    Max,
    /// MIN of two or more.
    Min,
    /// POLY(x, x0, a0, a1, ...)
    Poly,
    /// STEP(x, x0, h0, x1, h1)
    Step,
    /// STEP5, the same with a quintic.
    Step5,
    /// HAVSIN, the same with half a wave.
    Havsin,
    /// IMPACT(x, xdot, x1, k, e, cmax, d)
    Impact,
    /// BISTOP(x, xdot, x1, x2, k, e, cmax, d)
    Bistop,
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// Magnitude.
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
    /// e to a power.
    Exp,
    /// Natural logarithm.
    Log,
    /// Logarithm to base ten.
    Log10,
    /// Towards zero.
    Aint,
    /// To the nearest whole number.
    Anint,
}

const UNARY: &[(&str, Unary)] = &[
    ("ABS", Unary::Abs),
    ("SQRT", Unary::Sqrt),
    ("SIN", Unary::Sin),
    ("COS", Unary::Cos),
    ("TAN", Unary::Tan),
    ("ASIN", Unary::Asin),
    ("ACOS", Unary::Acos),
    ("ATAN", Unary::Atan),
    ("SINH", Unary::Sinh),
    ("COSH", Unary::Cosh),
    ("TANH", Unary::Tanh),
    ("EXP", Unary::Exp),
    ("LOG", Unary::Log),
    ("LOG10", Unary::Log10),
    ("AINT", Unary::Aint),
    ("ANINT", Unary::Anint),
];

impl Function {
    /// The function of a name in capitals, with the least and the greatest number of its arguments.
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

    /// The value, with derivatives. Where two branches meet, one of their slopes.
    ///
    /// # Errors
    /// A number of arguments that it has not; a ramp without length; stiffness, exponent or damping that make no
    /// contact. A value that is not finite is not found here.
    pub fn value<T: Scalar>(self, arguments: &[T]) -> Result<T, Fault> {
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
            (Function::Max, [first, rest @ ..]) => Ok(rest.iter().fold(first.clone(), |a, b| max(&a, b))),
            (Function::Min, [first, rest @ ..]) => Ok(rest.iter().fold(first.clone(), |a, b| min(&a, b))),
            (Function::Poly, [x, origin, coefficients @ ..]) => {
                let d = x.minus(origin);
                let zero = T::constant(0.0);
                Ok(coefficients.iter().rev().fold(zero, |sum, one| sum.times(&d).plus(one)))
            }
            (Function::Step, [x, x0, h0, x1, h1]) => ramp::step(x, [x0, h0, x1, h1]),
            (Function::Step5, [x, x0, h0, x1, h1]) => ramp::step5(x, [x0, h0, x1, h1]),
            (Function::Havsin, [x, x0, h0, x1, h1]) => ramp::havsin(x, [x0, h0, x1, h1]),
            (Function::Impact, [x, v, x1, law @ ..]) => contact::impact(x, v, x1, law),
            (Function::Bistop, [x, v, x1, x2, law @ ..]) => contact::bistop(x, v, [x1, x2], law),
            _ => Err(Fault::Arguments),
        }
    }
}

impl Unary {
    fn value<T: Scalar>(self, a: &T) -> T {
        let x = a.value();
        let (value, slope) = match self {
            Unary::Abs => (x.abs(), if x < 0.0 { -1.0 } else { 1.0 }),
            Unary::Sqrt => (x.sqrt(), 0.5 / x.sqrt()),
            Unary::Sin => (x.sin(), x.cos()),
            Unary::Cos => (x.cos(), -x.sin()),
            Unary::Tan => (x.tan(), 1.0 + x.tan() * x.tan()),
            Unary::Asin => (x.asin(), 1.0 / (1.0 - x * x).sqrt()),
            Unary::Acos => (x.acos(), -1.0 / (1.0 - x * x).sqrt()),
            Unary::Atan => (x.atan(), 1.0 / (1.0 + x * x)),
            Unary::Sinh => (x.sinh(), x.cosh()),
            Unary::Cosh => (x.cosh(), x.sinh()),
            Unary::Tanh => (x.tanh(), 1.0 - x.tanh() * x.tanh()),
            Unary::Exp => (x.exp(), x.exp()),
            Unary::Log => (x.ln(), 1.0 / x),
            Unary::Log10 => (x.log10(), std::f64::consts::LOG10_E / x),
            Unary::Aint => (x.trunc(), 0.0),
            Unary::Anint => (x.round(), 0.0),
        };
        a.mapped(value, slope)
    }
}

/// The angle of (x, y), from -pi to pi.
pub(crate) fn atan2<T: Scalar>(y: &T, x: &T) -> T {
    let (a, b) = (y.value(), x.value());
    let square = a * a + b * b;
    T::compose(a.atan2(b), &[(b / square, y), (-a / square, x)])
}

/// A power. The base may be negative where the exponent is a whole number that does not change.
pub(crate) fn power<T: Scalar>(base: &T, exponent: &T) -> T {
    let (a, b) = (base.value(), exponent.value());
    let value = a.powf(b);
    let slope = if b == 0.0 { 0.0 } else { b * a.powf(b - 1.0) };
    let by_exponent = if a > 0.0 { value * a.ln() } else { 0.0 };
    T::compose(value, &[(slope, base), (by_exponent, exponent)])
}

fn max<T: Scalar>(a: &T, b: &T) -> T {
    if a.value() >= b.value() { a.clone() } else { b.clone() }
}

fn min<T: Scalar>(a: &T, b: &T) -> T {
    if a.value() <= b.value() { a.clone() } else { b.clone() }
}

/// a if positive, or zero.
fn positive<T: Scalar>(a: &T) -> T {
    if a.value() > 0.0 { a.clone() } else { T::constant(0.0) }
}
