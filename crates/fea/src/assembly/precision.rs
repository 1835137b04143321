//! Number types in which the stiffness is formed and factored: doubles and double-doubles.

use std::ops::{AddAssign, Div, DivAssign, MulAssign, Neg, SubAssign};

use nalgebra::Scalar;
use num_traits::{One, Zero};

/// Double-double: an unevaluated sum of two doubles, 104 bits.
///
/// The error of a sum is 2^-104 of its terms, not of the sum itself; the error analysis of a Cholesky factor
/// needs no more.
///
/// # Source
/// Dekker (1971), Numer. Math. 18; Joldes, Muller and Popescu (2017), ACM Trans. Math. Softw. 44.
pub(crate) type Extended = faer::fx128;

/// A real number type: `f64` or [`Extended`].
pub(crate) trait Real:
    Scalar
    + Copy
    + PartialOrd
    + From<f64>
    + Zero
    + One
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + std::ops::Sub<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + faer::traits::ComplexField<Real = Self>
    + faer::traits::RealField
{
    /// Twice the largest relative rounding error of one operation.
    const ROUNDING: f64;

    /// Whether processors have instructions for these numbers: faer has dense kernels for them alone, and a product costs
    /// less than to find out that it is zero.
    const NATIVE: bool;

    /// The nearest double.
    fn double(self) -> f64;

    /// The same number as a double-double.
    fn wide(self) -> Extended;

    /// A double-double rounded to this type.
    fn rounded(wide: Extended) -> Self;

    /// Square root.
    fn root(self) -> Self;

    /// Absolute value.
    fn magnitude(self) -> Self {
        if self < Self::zero() { -self } else { self }
    }
}

impl Real for f64 {
    const ROUNDING: f64 = f64::EPSILON;
    const NATIVE: bool = true;

    fn double(self) -> f64 {
        self
    }

    fn wide(self) -> Extended {
        self.into()
    }

    fn rounded(wide: Extended) -> f64 {
        wide.double()
    }

    fn root(self) -> f64 {
        self.sqrt()
    }
}

impl Real for Extended {
    // The error of sums and products of this implementation is a few units of 2^-104.
    const ROUNDING: f64 = 4.0 * f64::EPSILON * f64::EPSILON;
    const NATIVE: bool = false;

    fn double(self) -> f64 {
        self.0 + self.1
    }

    fn wide(self) -> Extended {
        self
    }

    fn rounded(wide: Extended) -> Extended {
        wide
    }

    fn root(self) -> Extended {
        self.sqrt()
    }
}

/// Sum of doubles, to all digits of a double-double however much cancels.
///
/// The sum is kept as an expansion of doubles that do not overlap, to which one term after the other is added without
/// error.
///
/// # Source
/// Shewchuk (1997), Discrete Comput. Geom. 18, theorem 10.
pub(crate) fn exact_sum<const N: usize>(terms: [f64; N]) -> Extended {
    let mut expansion = [0.0; N];
    for (count, term) in terms.into_iter().enumerate() {
        let mut carried = term;
        for part in &mut expansion[..count] {
            let sum = carried + *part;
            let virtual_part = sum - carried;
            *part = (carried - (sum - virtual_part)) + (*part - virtual_part);
            carried = sum;
        }
        expansion[count] = carried;
    }
    expansion
        .into_iter()
        .fold(Extended::zero(), |sum, part| sum + Extended::from(part))
}

#[cfg(test)]
mod tests {
    use super::{Extended, Real, exact_sum};

    #[test]
    fn sums_keep_what_is_left_of_large_terms() {
        let [large, small, tiny] = [1e30, 3.0, f64::powi(2.0, -60)];
        let sum = exact_sum([large, small, -large, tiny]);
        assert_eq!((sum - Extended::from(small)).double(), tiny);
        assert_eq!(exact_sum([0.1, -1e6, 1e6]).double(), 0.1);
    }

    #[test]
    fn extended_numbers_keep_what_doubles_lose() {
        let tiny = f64::powi(2.0, -90);
        let [one, two, three, tiny_too]: [Extended; 4] = [1.0, 2.0, 3.0, tiny].map(From::from);
        assert_eq!((one + tiny_too - one).double(), tiny);
        assert!((one / three * three - one).double().abs() <= Extended::ROUNDING);
        let root = two.root();
        assert!((root * root - two).double().abs() <= 2.0 * Extended::ROUNDING);
    }
}
