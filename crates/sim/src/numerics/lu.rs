//! LU factors of a general square matrix with partial pivoting: those of `dense`, without allocation, where it is small,
//! and those of faer, in blocks, where it is large.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{MatMut, MatRef};
use nalgebra::DMatrix;
use smallvec::SmallVec;

use super::dense::{BLOCKED, factor_general, solve_factored, solve_four_factored};

/// Entries of a matrix, without allocation up to the order 4.
pub(crate) type Entries = SmallVec<[f64; 16]>;

/// The factors of a matrix, P A = L U. Their memory serves for one matrix after the other.
#[derive(Default)]
pub(crate) struct LuFactors {
    /// Entries of the matrix, row by row; of a small one its factors.
    entries: Entries,
    /// The row with which each row of a small matrix was exchanged.
    pivots: SmallVec<[usize; 4]>,
    is_regular: bool,
    large: Option<PartialPivLu<f64>>,
}

impl LuFactors {
    /// Factors `matrix`.
    pub fn new(matrix: &DMatrix<f64>) -> Self {
        let mut factors = LuFactors::default();
        factors.replace(matrix.nrows(), |entries| {
            entries.extend_from_slice(matrix.transpose().as_slice())
        });
        factors
    }

    /// Replaces the matrix by one of this order, whose rows `fill` adds one after the other.
    pub fn replace(&mut self, order: usize, fill: impl FnOnce(&mut Entries)) {
        self.entries.clear();
        fill(&mut self.entries);
        self.large = (order >= BLOCKED)
            .then(|| MatRef::from_row_major_slice(&self.entries, order, order).partial_piv_lu());
        if self.large.is_none() {
            self.pivots.resize(order, 0);
            self.is_regular = factor_general(&mut self.entries, &mut self.pivots);
        }
    }

    /// Replaces b by the solution of A x = b; false where A is singular.
    pub fn solve(&self, b: &mut [f64]) -> bool {
        if let Some(factors) = &self.large {
            let order = b.len();
            factors.solve_in_place(MatMut::from_column_major_slice_mut(b, order, 1));
            return b.iter().all(|x| x.is_finite());
        }
        if self.is_regular {
            solve_factored(&self.entries, &self.pivots, b);
        }
        self.is_regular
    }

    /// Replaces four right sides, the columns of `b`, by their solutions; false where A is singular.
    pub fn solve_four(&self, b: &mut [[f64; 4]]) -> bool {
        if let Some(factors) = &self.large {
            let order = b.len();
            factors.solve_in_place(MatMut::from_row_major_slice_mut(
                b.as_flattened_mut(),
                order,
                4,
            ));
            return b.as_flattened().iter().all(|x| x.is_finite());
        }
        if self.is_regular {
            solve_four_factored(&self.entries, &self.pivots, b);
        }
        self.is_regular
    }
}

#[cfg(test)]
mod tests {
    use super::LuFactors;
    use crate::numerics::dense::BLOCKED;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn small_and_large_matrices_recover_a_planted_solution() {
        for n in [1, 2, 5, BLOCKED - 1, BLOCKED, 150] {
            let entry = |i: usize, j: usize| {
                ((7 * i + 3 * j) % 11) as f64 - 5.0 + if i + j == n - 1 { 60.0 } else { 0.0 }
            };
            let matrix = DMatrix::from_fn(n, n, entry);
            let x = DVector::from_fn(n, |i, _| (i as f64).cos());
            let b = &matrix * &x;
            let mut found = b.clone();
            assert!(
                LuFactors::new(&matrix).solve(found.as_mut_slice()),
                "the matrix is regular"
            );
            assert!((found - &x).amax() < 1e-11, "n {n}");
            let mut four: Vec<[f64; 4]> = b
                .iter()
                .map(|b| [1.0, -2.0, 0.0, 0.5].map(|scale| scale * b))
                .collect();
            assert!(
                LuFactors::new(&matrix).solve_four(&mut four),
                "the matrix is regular"
            );
            for (found, x) in four.iter().zip(x.iter()) {
                for (found, scale) in found.iter().zip([1.0, -2.0, 0.0, 0.5]) {
                    assert!((found - scale * x).abs() < 1e-11, "n {n}");
                }
            }
        }
    }

    #[test]
    fn singular_matrices_have_no_solution() {
        for n in [2, 3, BLOCKED] {
            let factors = LuFactors::new(&DMatrix::zeros(n, n));
            assert!(!factors.solve(&mut vec![1.0; n]));
        }
    }
}
