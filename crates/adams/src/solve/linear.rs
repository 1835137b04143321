//! Linear equations that may be singular.

use nalgebra::{DMatrix, DVector, Dyn, FullPivLU, SVD};

/// A square matrix A with its factorization.
///
/// The scaled matrix R A C, with diagonal R and C, is factored by elimination with full pivoting. If it is
/// singular, equations are solved in the least-squares sense by singular values, with the smallest norm of
/// the scaled unknowns.
pub(super) struct FactoredMatrix {
    /// R.
    rows: Vec<f64>,
    /// C.
    columns: Vec<f64>,
    factor: Factorization,
    /// R A C.
    scaled: DMatrix<f64>,
}

enum Factorization {
    Regular(Box<FullPivLU<f64, Dyn, Dyn>>),
    /// Singular values at and below the number count as zero.
    Singular(Box<SVD<f64, Dyn, Dyn>>, f64),
}

/// Pivots below this fraction of the largest one count as zero.
const PIVOT: f64 = 1e-13;
/// Singular values below this fraction of the largest one count as zero.
const SINGULAR: f64 = 1e-11;

impl FactoredMatrix {
    /// A matrix scaled by its own entries (equilibration). `None` for a matrix that is not finite.
    ///
    /// # Source
    /// D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices, RAL-TR-2001-034.
    pub fn balanced(matrix: &DMatrix<f64>) -> Option<FactoredMatrix> {
        let n = matrix.nrows();
        let mut scaled = matrix.clone();
        let (mut rows, mut columns) = (vec![1.0; n], vec![1.0; n]);
        // Each pass halves the logarithm of the ratio of largest to smallest entries.
        for _ in 0..8 {
            let factor = |peak: f64| if peak > 0.0 { 1.0 / peak.sqrt() } else { 1.0 };
            let by_row: Vec<f64> = (0..n).map(|i| factor(scaled.row(i).amax())).collect();
            let by_column: Vec<f64> = (0..n).map(|j| factor(scaled.column(j).amax())).collect();
            for j in 0..n {
                for i in 0..n {
                    scaled[(i, j)] *= by_row[i] * by_column[j];
                }
                rows[j] *= by_row[j];
                columns[j] *= by_column[j];
            }
        }
        FactoredMatrix::new(matrix, rows, columns)
    }

    /// A matrix scaled by the typical sizes of residuals (`rows`) and unknowns (`columns`): R has the inverse
    /// sizes of residuals, C the sizes of unknowns. `None` for a matrix that is not finite.
    pub fn scaled(matrix: &DMatrix<f64>, rows: &[f64], columns: &[f64]) -> Option<FactoredMatrix> {
        FactoredMatrix::new(
            matrix,
            rows.iter().map(|row| 1.0 / row).collect(),
            columns.to_vec(),
        )
    }

    fn new(matrix: &DMatrix<f64>, rows: Vec<f64>, columns: Vec<f64>) -> Option<FactoredMatrix> {
        let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * rows[i] * columns[j]
        });
        if scaled.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let lu = scaled.clone().full_piv_lu();
        let pivots = lu.u().diagonal();
        let (least, most) = (pivots.amin(), pivots.amax());
        let factor = if least > PIVOT * most {
            Factorization::Regular(Box::new(lu))
        } else {
            let svd = scaled.clone().try_svd(true, true, f64::EPSILON, 10_000)?;
            let top = svd.singular_values.max();
            Factorization::Singular(Box::new(svd), SINGULAR * top)
        };
        Some(FactoredMatrix {
            rows,
            columns,
            factor,
            scaled,
        })
    }

    /// The rank deficiency of the matrix.
    pub fn rank_deficiency(&self) -> usize {
        match &self.factor {
            Factorization::Regular(_) => 0,
            Factorization::Singular(svd, least) => svd
                .singular_values
                .iter()
                .filter(|value| **value <= *least)
                .count(),
        }
    }

    /// The Newton correction -A^-1 r for the Jacobian A and the residual r; `None` if it is not finite.
    pub fn correction(&self, residual: &[f64]) -> Option<Vec<f64>> {
        Some(self.solve(residual)?.iter().map(|value| -value).collect())
    }

    /// The solution x of A x = b; `None` if it is not finite.
    pub fn solve(&self, b: &[f64]) -> Option<Vec<f64>> {
        let right =
            DVector::from_iterator(b.len(), b.iter().zip(&self.rows).map(|(b, row)| b * row));
        let x = match &self.factor {
            Factorization::Regular(lu) => {
                let x = lu.solve(&right)?;
                // One step of iterative refinement removes the error that the scaling left.
                let left = &right - &self.scaled * &x;
                let more = lu.solve(&left)?;
                x + more
            }
            Factorization::Singular(svd, least) => svd.solve(&right, *least).ok()?,
        };
        let out: Vec<f64> = x
            .iter()
            .zip(&self.columns)
            .map(|(x, column)| x * column)
            .collect();
        out.iter().all(|value| value.is_finite()).then_some(out)
    }
}
