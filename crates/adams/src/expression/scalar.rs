//! Scalars: plain numbers, and numbers with derivatives for automatic differentiation.

/// A number that expressions compute with: an `f64`, or a [`Dual`] that carries derivatives.
///
/// Every operation is one call of [`Scalar::compose`]: a value and its partial derivatives with respect to
/// the operands.
pub trait Scalar: Clone {
    /// A constant, whose derivatives are zero.
    fn constant(value: f64) -> Self;

    /// The value without derivatives.
    fn value(&self) -> f64;

    /// The function f(a, b, ...) of other scalars by the chain rule, given its value and the pairs (df/da,
    /// a), (df/db, b), ...
    fn compose(value: f64, parts: &[(f64, &Self)]) -> Self;

    /// a + b
    #[must_use]
    fn plus(&self, other: &Self) -> Self {
        Self::compose(self.value() + other.value(), &[(1.0, self), (1.0, other)])
    }

    /// a - b
    #[must_use]
    fn minus(&self, other: &Self) -> Self {
        Self::compose(self.value() - other.value(), &[(1.0, self), (-1.0, other)])
    }

    /// a b
    #[must_use]
    fn times(&self, other: &Self) -> Self {
        let (a, b) = (self.value(), other.value());
        Self::compose(a * b, &[(b, self), (a, other)])
    }

    /// a / b
    #[must_use]
    fn over(&self, other: &Self) -> Self {
        let (a, b) = (self.value(), other.value());
        let ratio = a / b;
        Self::compose(ratio, &[(1.0 / b, self), (-ratio / b, other)])
    }

    /// -a
    #[must_use]
    fn negated(&self) -> Self {
        Self::compose(-self.value(), &[(-1.0, self)])
    }

    /// The product of `factor` and a.
    #[must_use]
    fn scaled(&self, factor: f64) -> Self {
        Self::compose(factor * self.value(), &[(factor, self)])
    }

    /// The function f(a) of this scalar, given its value and derivative at a.
    #[must_use]
    fn mapped(&self, value: f64, slope: f64) -> Self {
        Self::compose(value, &[(slope, self)])
    }
}

impl Scalar for f64 {
    fn constant(value: f64) -> f64 {
        value
    }

    fn value(&self) -> f64 {
        *self
    }

    fn compose(value: f64, _: &[(f64, &f64)]) -> f64 {
        value
    }
}

/// A value and its partial derivatives with respect to numbered unknowns.
///
/// # Source
/// Griewank, Walther, Evaluating Derivatives (2008), chapter 3: forward mode with several directions.
///
/// ```
/// use adams::{Dual, Scalar};
///
/// let (x, y) = (Dual::unknown(3.0, 0, 2), Dual::unknown(4.0, 1, 2));
/// let product = x.times(&y);
/// assert_eq!((product.value(), product.derivative(0), product.derivative(1)), (12.0, 4.0, 3.0));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Dual {
    value: f64,
    /// Derivatives by the unknowns; an empty list means that all are zero.
    slopes: Vec<f64>,
}

impl Dual {
    /// The unknown number `index` of `count`: its derivative with respect to itself is one.
    #[must_use]
    pub fn unknown(value: f64, index: usize, count: usize) -> Dual {
        let mut slopes = vec![0.0; count];
        if let Some(slope) = slopes.get_mut(index) {
            *slope = 1.0;
        }
        Dual { value, slopes }
    }

    /// The derivative with respect to the unknown number `index`.
    #[must_use]
    pub fn derivative(&self, index: usize) -> f64 {
        self.slopes.get(index).copied().unwrap_or(0.0)
    }
}

impl Scalar for Dual {
    fn constant(value: f64) -> Dual {
        Dual {
            value,
            slopes: Vec::new(),
        }
    }

    fn value(&self) -> f64 {
        self.value
    }

    fn compose(value: f64, parts: &[(f64, &Dual)]) -> Dual {
        let mut slopes: Vec<f64> = Vec::new();
        for (factor, part) in parts {
            if part.slopes.is_empty() || *factor == 0.0 {
                continue;
            }
            slopes.resize(slopes.len().max(part.slopes.len()), 0.0);
            for (sum, slope) in slopes.iter_mut().zip(&part.slopes) {
                // Zero slopes are skipped: an infinite factor times zero would be NaN although the quantity
                // does not depend on this unknown.
                if *slope != 0.0 {
                    *sum += factor * slope;
                }
            }
        }
        Dual { value, slopes }
    }
}

#[cfg(test)]
mod tests {
    use super::{Dual, Scalar};

    #[test]
    fn slopes_of_a_quotient_follow_the_rule() {
        let (a, b) = (Dual::unknown(3.0, 0, 2), Dual::unknown(4.0, 1, 2));
        let c = a.times(&a).over(&b).minus(&b.scaled(2.0));
        assert_eq!(
            (c.value(), c.derivative(0), c.derivative(1)),
            (9.0 / 4.0 - 8.0, 1.5, -9.0 / 16.0 - 2.0)
        );
        assert_eq!(Dual::constant(2.0).derivative(7), 0.0);
    }
}
