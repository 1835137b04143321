//! Products of small vectors, each written once, and the number types that they are written for.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A real number type in which shape functions and Green's function can be evaluated: doubles, or a wider one.
///
/// ```
/// fn is_number<T: splines::RealNumber>() {}
/// is_number::<f64>();
/// ```
pub trait RealNumber:
    Copy
    + PartialOrd
    + From<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
}

impl<T> RealNumber for T where
    T: Copy
        + PartialOrd
        + From<f64>
        + Add<Output = T>
        + Sub<Output = T>
        + Mul<Output = T>
        + Div<Output = T>
        + Neg<Output = T>
{
}

/// Scalar product of two vectors of space.
#[inline]
pub(crate) fn dot3<T: RealNumber>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Scalar product a . b, summed from the first entry to the last. Entries beyond the shorter one do not
/// count.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Scalar product of four entries, summed in two pairs: (a0 b0 + a2 b2) + (a1 b1 + a3 b3).
///
/// The two sums do not wait for each other, which shortens the chain of additions in the inner loops.
#[inline]
pub(crate) fn dot4(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    (a[0] * b[0] + a[2] * b[2]) + (a[1] * b[1] + a[3] * b[3])
}

/// Vector product a x b.
pub(crate) fn cross<T: RealNumber>(a: [T; 3], b: [T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Unit vector along `axis`, 0, 1 or 2.
pub(crate) fn unit<T: RealNumber>(axis: usize) -> [T; 3] {
    let mut e = [T::from(0.0); 3];
    e[axis] = T::from(1.0);
    e
}
