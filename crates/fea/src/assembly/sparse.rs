//! Symmetric sparse matrices by their upper triangle: sums of entries, norm, product.

use nalgebra::{DVector, DVectorView};
use sprs::CsMat;

use crate::assembly::precision::Real;

/// Entries of a square matrix as (row, column, value); several may have the same place.
#[derive(Debug)]
pub(crate) struct Triplets<T> {
    n: usize,
    entries: Vec<(u32, u32, T)>,
}

impl<T: Real> Triplets<T> {
    /// An empty list for an n x n matrix, n at most 2^32, with room for `count` entries.
    pub fn new(n: usize, count: usize) -> Triplets<T> {
        Triplets { n, entries: Vec::with_capacity(count) }
    }

    pub fn add(&mut self, row: usize, column: usize, value: T) {
        self.entries.push((row as u32, column as u32, value));
    }

    /// The matrix by compressed columns, rows increasing within each. Entries of the same place are added in
    /// the order in which they were given, so that the result does not depend on the sorting.
    pub fn sum(self) -> CsMat<T> {
        let n = self.n;
        let mut ends = vec![0_usize; n + 1];
        self.entries.iter().for_each(|entry| ends[entry.1 as usize + 1] += 1);
        (0..n).for_each(|column| ends[column + 1] += ends[column]);
        let mut next = ends.clone();
        let mut sorted = vec![(0_u32, T::zero()); self.entries.len()];
        for (row, column, value) in self.entries {
            let place = &mut next[column as usize];
            sorted[*place] = (row, value);
            *place += 1;
        }
        let mut starts = Vec::with_capacity(n + 1);
        let (mut rows, mut values) = (Vec::with_capacity(sorted.len()), Vec::with_capacity(sorted.len()));
        // Index of each row in `order`, valid if the entry there has this row.
        let mut place = vec![usize::MAX; n];
        let mut order: Vec<(u32, T)> = Vec::new();
        for column in 0..n {
            starts.push(rows.len());
            order.clear();
            for &(row, value) in &sorted[ends[column]..ends[column + 1]] {
                match order.get_mut(place[row as usize]) {
                    Some(known) if known.0 == row => known.1 += value,
                    _ => {
                        place[row as usize] = order.len();
                        order.push((row, value));
                    }
                }
            }
            order.sort_unstable_by_key(|entry| entry.0);
            rows.extend(order.iter().map(|entry| entry.0 as usize));
            values.extend(order.iter().map(|entry| entry.1));
        }
        starts.push(rows.len());
        CsMat::new_csc((n, n), starts, rows, values)
    }
}

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
pub(crate) fn symmetric_product_lanes<const W: usize>(upper: &CsMat<f64>, x: &[[f64; W]]) -> Vec<[f64; W]> {
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
    (0..n).map(|k| 1.0 + 0.5 * ((k * 7919 % 1009) as f64 / 1009.0)).collect()
}

/// Takes steps of inverse iteration from `x`, each divided by its largest component. `solve` applies the inverse in place.
pub(crate) fn inverse_iterations(x: &mut [f64], steps: usize, mut solve: impl FnMut(&mut [f64])) {
    for _ in 0..steps {
        solve(x);
        let size = x.iter().fold(0.0_f64, |most, component| most.max(component.abs()));
        x.iter_mut().for_each(|component| *component /= size);
    }
}

#[cfg(test)]
mod tests {
    use super::Triplets;

    #[test]
    fn entries_of_one_place_add_up_wherever_they_stand() {
        let given =
            [(2, 0, 1.0), (0, 3, 2.0), (1, 1, 3.0), (2, 0, 4.0), (0, 0, 5.0), (0, 3, -2.5), (3, 3, 6.0)];
        let mut triplets = Triplets::new(4, given.len());
        given.iter().for_each(|&(row, column, value)| triplets.add(row, column, value));
        let found: Vec<_> = triplets.sum().iter().map(|(&value, place)| (place, value)).collect();
        let wanted = [((0, 0), 5.0), ((2, 0), 5.0), ((1, 1), 3.0), ((0, 3), -0.5), ((3, 3), 6.0)];
        assert_eq!(found, wanted);
    }
}
