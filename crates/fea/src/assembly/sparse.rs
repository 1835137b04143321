//! Symmetric sparse matrices by their upper triangle: norm, products, iterations.

use nalgebra::{DVector, DVectorView};
use sprs::CsMat;

use crate::assembly::precision::Real;

/// Largest column sum of the magnitudes of the symmetric matrix whose upper triangle is given: its 1-norm.
pub(crate) fn column_norm<T: Real>(upper: &CsMat<T>) -> f64 {
    let mut sums = vec![0.0_f64; upper.cols()];
    for (value, (i, j)) in upper.iter() {
        let size = value.double().abs();
        sums[i] += size;
        if i != j {
            sums[j] += size;
        }
    }
    sums.into_iter().fold(0.0, f64::max)
}

/// Product of the symmetric matrix whose upper triangle is given with a vector.
pub(crate) fn symmetric_product(upper: &CsMat<f64>, x: DVectorView<'_, f64>) -> DVector<f64> {
    let mut y = DVector::zeros(x.len());
    let (x, out) = (x.as_slice(), y.as_mut_slice());
    for (j, column) in upper.outer_iterator().enumerate() {
        let (value, mut sum) = (x[j], 0.0);
        for (i, &entry) in column.iter() {
            if i == j {
                sum += entry * value;
            } else {
                sum += entry * x[i];
                out[i] += entry * value;
            }
        }
        out[j] += sum;
    }
    y
}

/// Product of the symmetric matrix whose upper triangle is given with W vectors, side by side in each row.
pub(crate) fn symmetric_product_lanes<const W: usize>(
    upper: &CsMat<f64>,
    x: &[[f64; W]],
) -> Vec<[f64; W]> {
    let mut out = vec![[0.0; W]; x.len()];
    for (j, column) in upper.outer_iterator().enumerate() {
        let (value, mut sum) = (x[j], [0.0; W]);
        for (i, &entry) in column.iter() {
            (0..W).for_each(|w| sum[w] += entry * x[i][w]);
            if i != j {
                (0..W).for_each(|w| out[i][w] += entry * value[w]);
            }
        }
        (0..W).for_each(|w| out[j][w] += sum[w]);
    }
    out
}

/// Start vector of power and inverse iterations: without structure, so that no eigenvector is orthogonal to
/// it by symmetry.
pub(crate) fn irregular_vector(n: usize) -> Vec<f64> {
    (0..n)
        .map(|k| 1.0 + 0.5 * ((k * 7919 % 1009) as f64 / 1009.0))
        .collect()
}

/// Takes steps of inverse iteration from `x`, each divided by its largest component. `solve` applies the inverse in place.
pub(crate) fn inverse_iterations(x: &mut [f64], steps: usize, mut solve: impl FnMut(&mut [f64])) {
    for _ in 0..steps {
        solve(x);
        let size = x
            .iter()
            .fold(0.0_f64, |most, component| most.max(component.abs()));
        x.iter_mut().for_each(|component| *component /= size);
    }
}
