//! Systems of linear equations that may be singular.

use nalgebra::{DMatrix, DVector, Dyn, FullPivLU, SVD};

/// A square matrix, factored.
///
/// A regular matrix is solved by elimination; a singular
/// one by least squares and, among their solutions, with the least norm of the scaled unknowns.
pub(crate) struct Linear {
    rows: Vec<f64>,
    columns: Vec<f64>,
    factor: Factor,
    /// What the matrix does to scaled unknowns.
    scaled: DMatrix<f64>,
}

enum Factor {
    Regular(Box<FullPivLU<f64, Dyn, Dyn>>),
    Singular(Box<SVD<f64, Dyn, Dyn>>, f64),
}

/// Pivots below this share of the largest one count as zero.
const PIVOT: f64 = 1e-13;
/// Singular values below this share of the largest one count as zero.
const SINGULAR: f64 = 1e-11;

impl Linear {
    /// Scaled by its own entries. `None` for a matrix that is not finite.
    pub fn balanced(matrix: &DMatrix<f64>) -> Option<Linear> {
        let n = matrix.nrows();
        let mut scaled = matrix.clone();
        let (mut rows, mut columns) = (vec![1.0; n], vec![1.0; n]);
        // Ruiz' scaling: each pass halves the logarithm of the spread.
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
        Linear::new(matrix, rows, columns)
    }

    /// Scaled by what counts as large: the inverse for rows, itself for columns.
    pub fn scaled(matrix: &DMatrix<f64>, rows: &[f64], columns: &[f64]) -> Option<Linear> {
        Linear::new(matrix, rows.iter().map(|row| 1.0 / row).collect(), columns.to_vec())
    }

    fn new(matrix: &DMatrix<f64>, rows: Vec<f64>, columns: Vec<f64>) -> Option<Linear> {
        let scaled =
            DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)] * rows[i] * columns[j]);
        if scaled.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let lu = scaled.clone().full_piv_lu();
        let pivots = lu.u().diagonal();
        let (least, most) = (pivots.amin(), pivots.amax());
        let factor = if least > PIVOT * most {
            Factor::Regular(Box::new(lu))
        } else {
            let svd = scaled.clone().try_svd(true, true, f64::EPSILON, 10_000)?;
            let top = svd.singular_values.max();
            Factor::Singular(Box::new(svd), SINGULAR * top)
        };
        Some(Linear { rows, columns, factor, scaled })
    }

    /// How far the rank is below full.
    pub fn missing(&self) -> usize {
        match &self.factor {
            Factor::Regular(_) => 0,
            Factor::Singular(svd, least) => {
                svd.singular_values.iter().filter(|value| **value <= *least).count()
            }
        }
    }

    /// x of A x = b.
    pub fn solve(&self, b: &[f64]) -> Option<Vec<f64>> {
        let right = DVector::from_iterator(b.len(), b.iter().zip(&self.rows).map(|(b, row)| b * row));
        let x = match &self.factor {
            Factor::Regular(lu) => {
                let x = lu.solve(&right)?;
                // One step of refinement takes out what the scaling left.
                let left = &right - &self.scaled * &x;
                let more = lu.solve(&left)?;
                x + more
            }
            Factor::Singular(svd, least) => svd.solve(&right, *least).ok()?,
        };
        let out: Vec<f64> = x.iter().zip(&self.columns).map(|(x, column)| x * column).collect();
        out.iter().all(|value| value.is_finite()).then_some(out)
    }
}
