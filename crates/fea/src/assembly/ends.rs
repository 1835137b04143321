//! Motions of the ends of a member by those of its two bodies, and its stiffness over their columns.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use crate::assembly::bodies::{Bodies, arm as motion_of_tip};
use crate::assembly::element::{Element, Matrix6, Matrix12, diagonal_blocks};
use crate::assembly::precision::Real;

/// Size of an entry of a transformation, in roundings of the magnitudes behind it, at which it counts as zero.
const CANCELLED: f64 = 8.0;

/// B, 12 x 12: local end displacements of a member (tips of its rigid offsets) by the motions of the
/// references of its two bodies.
pub(crate) fn transformation<T: Real>(element: &Element<T>, bodies: &Bodies<T>) -> Matrix12<T> {
    block_diagonal(&end_motions(element, bodies).0)
}

/// Local end displacements of a member in motions of all bodies; `None` for a member between points of one body.
pub(crate) fn end_displacements(
    element: &Element,
    bodies: &Bodies,
    motions: &[SVector<f64, 6>],
) -> Option<SVector<f64, 12>> {
    let pair = bodies.pair(element.points);
    if pair[0] == pair[1] {
        return None;
    }
    let both = SVector::<f64, 12>::from_fn(|k, _| motions[pair[k / 6]][k % 6]);
    Some(transformation(element, bodies) * both)
}

/// The two diagonal blocks of B, one for each end, and the sum of the magnitudes behind each of their entries. Entries
/// that are only rounding are zero.
pub(crate) fn end_motions<T: Real>(
    element: &Element<T>,
    bodies: &Bodies<T>,
) -> ([Matrix6<T>; 2], [Matrix6; 2]) {
    let sizes =
        Matrix3::from_fn(|i, j| element.axes[(i, j)].double().abs() + element.axes_error[i]);
    let clean = |v: T, b: f64| {
        if v.double().abs() <= CANCELLED * T::ROUNDING * b {
            T::zero()
        } else {
            v
        }
    };
    let mut ends = [diagonal_blocks(&element.axes.zip_map(&sizes, clean)); 2];
    let mut bulks = [diagonal_blocks(&sizes); 2];
    for (end, (value, bulk)) in ends.iter_mut().zip(&mut bulks).enumerate() {
        let arm = bodies.arm(element.points[end], &element.offsets[end]);
        if arm != Vector3::zeros() {
            let motion = motion_of_tip(&arm);
            *bulk = product(bulk, &magnitudes(&motion));
            *value = product(&element.rotation(), &motion).zip_map(bulk, clean);
        }
    }
    (ends, bulks)
}

/// The matrix with two diagonal blocks.
pub(crate) fn block_diagonal<T: Real>(blocks: &[Matrix6<T>; 2]) -> Matrix12<T> {
    let mut out = Matrix12::zeros();
    for (end, block) in blocks.iter().enumerate() {
        out.fixed_view_mut::<6, 6>(6 * end, 6 * end)
            .copy_from(block);
    }
    out
}

/// The absolute values of the entries, in doubles.
pub(super) fn magnitudes<T: Real>(m: &Matrix6<T>) -> Matrix6 {
    m.map(|x| x.double().abs())
}

/// A B, N x N.
pub(crate) fn product<T: Real, const N: usize>(
    a: &SMatrix<T, N, N>,
    b: &SMatrix<T, N, N>,
) -> SMatrix<T, N, N> {
    let mut out = SMatrix::<T, N, N>::zeros();
    out.data
        .0
        .iter_mut()
        .zip(&b.data.0)
        .for_each(|(out, factors)| *out = combined(&a.data.0, factors));
    out
}

/// B^T K B for a symmetric K and B with two diagonal blocks, symmetric to the last bit.
pub(super) fn congruence<T: Real>(k: &Matrix12<T>, b: &[Matrix6<T>; 2]) -> Matrix12<T> {
    let mut out = times_blocks(&times_blocks(k, b).transpose(), b);
    for i in 0..12 {
        for j in i + 1..12 {
            out[(i, j)] = out[(j, i)];
        }
    }
    out
}

/// A B for B with two diagonal blocks.
fn times_blocks<T: Real>(a: &Matrix12<T>, b: &[Matrix6<T>; 2]) -> Matrix12<T> {
    let mut out = Matrix12::zeros();
    let ends = out
        .data
        .0
        .chunks_exact_mut(6)
        .zip(a.data.0.chunks_exact(6))
        .zip(b);
    for ((out, columns), block) in ends {
        out.iter_mut()
            .zip(&block.data.0)
            .for_each(|(out, factors)| *out = combined(columns, factors));
    }
    out
}

/// The sum of some columns times their factors; skips factors of zero, which are most.
fn combined<T: Real, const N: usize>(columns: &[[T; N]], factors: &[T]) -> [T; N] {
    let zero = T::zero();
    let mut sum = [zero; N];
    for (column, &factor) in columns
        .iter()
        .zip(factors)
        .filter(|(_, factor)| **factor != zero)
    {
        for (sum, &value) in sum
            .iter_mut()
            .zip(column)
            .filter(|(_, value)| T::NATIVE || **value != zero)
        {
            *sum += value * factor;
        }
    }
    sum
}
