//! LU factors of a general square matrix with partial pivoting, by nalgebra where it is small and by faer, in blocks,
//! where it is large.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{MatMut, MatRef};
use nalgebra::{DMatrix, DVector, Dyn, LU};

use super::dense::BLOCKED;

/// The factors of a matrix.
pub(crate) enum LuFactors {
    Small(LU<f64, Dyn, Dyn>),
    Large(PartialPivLu<f64>),
}

impl LuFactors {
    /// Factors `matrix`.
    pub fn new(matrix: DMatrix<f64>) -> Self {
        if matrix.nrows() < BLOCKED {
            return LuFactors::Small(matrix.lu());
        }
        let (rows, columns) = matrix.shape();
        let matrix = MatRef::from_column_major_slice(matrix.as_slice(), rows, columns);
        LuFactors::Large(matrix.partial_piv_lu())
    }

    /// The solution of A x = b; `None` where A is singular.
    pub fn solve(&self, b: &DVector<f64>) -> Option<DVector<f64>> {
        match self {
            LuFactors::Small(factors) => factors.solve(b),
            LuFactors::Large(factors) => {
                let mut x = b.clone();
                let n = x.len();
                factors.solve_in_place(MatMut::from_column_major_slice_mut(x.as_mut_slice(), n, 1));
                x.iter().all(|x| x.is_finite()).then_some(x)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::LuFactors;
    use crate::numerics::dense::BLOCKED;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn small_and_large_matrices_recover_a_planted_solution() {
        for n in [1, 5, BLOCKED - 1, BLOCKED, 150] {
            let entry = |i: usize, j: usize| {
                ((7 * i + 3 * j) % 11) as f64 - 5.0 + if i + j == n - 1 { 60.0 } else { 0.0 }
            };
            let matrix = DMatrix::from_fn(n, n, entry);
            let x = DVector::from_fn(n, |i, _| (i as f64).cos());
            let b = &matrix * &x;
            let found = LuFactors::new(matrix).solve(&b).expect("the matrix is regular");
            assert!((found - x).amax() < 1e-11, "n {n}");
        }
    }

    #[test]
    fn singular_matrices_have_no_solution() {
        for n in [2, BLOCKED] {
            let factors = LuFactors::new(DMatrix::zeros(n, n));
            assert!(factors.solve(&DVector::from_element(n, 1.0)).is_none());
        }
    }
}
