//! Systems of linear equations that may be singular.

use nalgebra::{DMatrix, DVector, Dyn, FullPivLU, SVD};

/// A square matrix, factored.
///
/// Rows and columns are scaled to largest entries near one. A regular matrix is solved by elimination; a singular
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
    /// `None` for a matrix that is not finite.
    pub fn new(matrix: &DMatrix<f64>) -> Option<Linear> {
        if matrix.iter().any(|value| !value.is_finite()) {
            return None;
        }
        let n = matrix.nrows();
        let mut scaled = matrix.clone();
        let (mut rows, mut columns) = (vec![1.0; n], vec![1.0; n]);
        // Ruiz' scaling: each pass halves the logarithm of the spread.
        for _ in 0..8 {
            let peak = |values: &mut dyn Iterator<Item = f64>| {
                let top = values.fold(0.0_f64, |top, value| top.max(value.abs()));
                if top > 0.0 { 1.0 / top.sqrt() } else { 1.0 }
            };
            let by_row: Vec<f64> = (0..n).map(|i| peak(&mut scaled.row(i).iter().copied())).collect();
            let by_column: Vec<f64> = (0..n).map(|j| peak(&mut scaled.column(j).iter().copied())).collect();
            for j in 0..n {
                for i in 0..n {
                    scaled[(i, j)] *= by_row[i] * by_column[j];
                }
                rows[j] *= by_row[j];
                columns[j] *= by_column[j];
            }
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
