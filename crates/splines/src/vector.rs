//! Products of small vectors, each written once.

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
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Unit vector along `axis`, 0, 1 or 2.
pub(crate) fn unit(axis: usize) -> [f64; 3] {
    let mut e = [0.0; 3];
    e[axis] = 1.0;
    e
}
