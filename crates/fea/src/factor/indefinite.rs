//! Factor L D L^T of a matrix that need not be positive, and the number of its negative eigenvalues by the signs of D.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::SparseColMatRef;
use faer::sparse::linalg::cholesky::{CholeskySymbolicParams, LdltRef, SymbolicCholesky};
use faer::{Conj, MatMut, Par, Side};
use sprs::CsMat;

use crate::assembly::irregular_vector;
use crate::factor::cholesky::{Analysis, FactorError, analyse, for_each_entry};

/// Steps of the power iteration for the norm of the inverse.
const POWER_STEPS: usize = 8;
/// Factor on the estimate of the norm of the inverse, which is a lower bound.
const ESTIMATE_MARGIN: f64 = 3.0;

/// A = L D L^T without exchanges of rows, L with a unit diagonal.
pub(crate) struct IndefiniteFactor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl IndefiniteFactor {
    /// Factors the symmetric matrix whose upper triangle is given; `None` if a pivot is zero or a number is not finite.
    ///
    /// # Errors
    /// A factor that is too large.
    pub fn new(upper: &CsMat<f64>) -> Result<Option<IndefiniteFactor>, FactorError> {
        let Analysis {
            pattern,
            symbolic,
            mut values,
        } = analyse(upper, CholeskySymbolicParams::default())?;
        let request = StackReq::any_of(&[
            symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]);
        let mut memory = MemBuffer::try_new(request).map_err(|_| FactorError::TooLarge(0))?;
        let done = symbolic.factorize_numeric_ldlt(
            &mut values,
            SparseColMatRef::new(pattern, upper.data()),
            Side::Upper,
            LdltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        if done.is_err() {
            return Ok(None);
        }
        Ok(Some(IndefiniteFactor {
            symbolic,
            values,
            memory,
        }))
    }

    /// Number of negative pivots, and whether rounding cannot have changed it ([`negative_eigenvalues`]); `None` if a number
    /// is not finite.
    pub fn negative_pivots(&mut self) -> Option<(usize, bool)> {
        let size = FactorSize::new(&self.symbolic, &self.values)?;
        let inverse = estimate_inverse_norm(self.symbolic.nrows(), |x| self.solve(x));
        let error = f64::EPSILON * (size.longest + 1) as f64 * size.growth;
        Some((size.negative, error * ESTIMATE_MARGIN * inverse < 1.0))
    }

    /// Solves A x = x in place.
    pub fn solve(&mut self, x: &mut [f64]) {
        let n = x.len();
        let x = MatMut::from_column_major_slice_mut(x, n, 1);
        let factor = LdltRef::new(&self.symbolic, &self.values);
        factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut self.memory));
    }
}

/// Number of negative eigenvalues of the symmetric matrix A whose upper triangle is given; `None` if rounding
/// may have changed it.
///
/// A = L D L^T without exchanges of rows; by Sylvester's law of inertia D has as many negative entries as A has
/// negative eigenvalues. The factor is exact for A + E with |E| <= eps (k + 1) | |L| |D| |L^T| |, where k is the
/// length of the longest row of L. If |E| |A^-1| < 1, no eigenvalue of A + t E passes zero for t from 0 to 1, and
/// the count is that of A. The norm of the inverse is estimated by power iteration, with a margin.
///
/// # Source
/// Higham, Accuracy and Stability of Numerical Algorithms (2002), theorems 10.3 and 11.3; Parlett, The
/// Symmetric Eigenvalue Problem (1980), section 3.3.
pub(crate) fn negative_eigenvalues(upper: &CsMat<f64>) -> Result<Option<usize>, FactorError> {
    let Some(mut factor) = IndefiniteFactor::new(upper)? else {
        return Ok(None);
    };
    Ok(factor
        .negative_pivots()
        .and_then(|(count, is_certain)| is_certain.then_some(count)))
}

struct FactorSize {
    /// Number of negative pivots.
    negative: usize,
    /// Largest row sum of |L| |D| |L^T|.
    growth: f64,
    /// Largest number of entries in a row of L.
    longest: usize,
}

impl FactorSize {
    /// `None` if a number is not finite.
    fn new(symbolic: &SymbolicCholesky<usize>, values: &[f64]) -> Option<FactorSize> {
        let n = symbolic.nrows();
        let mut pivot = vec![0.0; n];
        let mut columns = vec![1.0; n];
        for_each_entry(symbolic, values, |row, column, value| {
            if row == column {
                pivot[row] = value;
            } else {
                columns[column] += value.abs();
            }
        });
        let weight = |column: usize| (pivot[column] * columns[column]).abs();
        let mut rows: Vec<f64> = (0..n).map(weight).collect();
        let mut lengths = vec![1_usize; n];
        for_each_entry(symbolic, values, |row, column, value| {
            if row != column {
                rows[row] += value.abs() * weight(column);
                lengths[row] += 1;
            }
        });
        let growth = rows
            .into_iter()
            .fold(0.0, |a: f64, b| if b > a || b.is_nan() { b } else { a });
        let longest = lengths.into_iter().max().unwrap_or(0);
        let negative = pivot.iter().filter(|&&d| d < 0.0).count();
        growth.is_finite().then_some(FactorSize {
            negative,
            growth,
            longest,
        })
    }
}

/// Estimate of the 2-norm of the inverse of a symmetric matrix, by power iteration: a lower bound.
fn estimate_inverse_norm(n: usize, mut solve: impl FnMut(&mut [f64])) -> f64 {
    let mut x = irregular_vector(n);
    let mut norm = 0.0_f64;
    for _ in 0..POWER_STEPS {
        let size = x.iter().map(|v| v * v).sum::<f64>().sqrt();
        if !(size > 0.0 && size.is_finite()) {
            return f64::INFINITY;
        }
        x.iter_mut().for_each(|v| *v /= size);
        solve(&mut x);
        norm = norm.max(x.iter().map(|v| v * v).sum::<f64>().sqrt());
    }
    if norm.is_finite() {
        norm
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use sprs::TriMat;

    use super::*;
    use crate::factor::banded;

    #[test]
    fn negative_pivots_count_the_negative_eigenvalues_in_columns_and_in_panels() {
        for (n, width) in [(60, 1), (60, 7), (300, 299)] {
            for shift in [-8.3, 0.4, 3.7, 9.1, 40.2] {
                let (dense, upper) = banded(n, width, |i, j| match i.abs_diff(j) {
                    0 => (i % 17) as f64 - shift,
                    _ => 0.3 * ((i * j) % 13) as f64 / width as f64,
                });
                let eigenvalues = dense.symmetric_eigenvalues();
                let exact = eigenvalues.iter().filter(|&&value| value < 0.0).count();
                assert_eq!(
                    negative_eigenvalues(&upper),
                    Ok(Some(exact)),
                    "n {n}, width {width}, shift {shift}"
                );
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_no_trusted_count() {
        let mut upper = TriMat::new((3, 3));
        for (i, j, value) in [(0, 0, 1.0), (0, 1, 3.0), (1, 1, 9.0), (2, 2, 1.0)] {
            upper.add_triplet(i, j, value);
        }
        assert_eq!(negative_eigenvalues(&upper.to_csc()), Ok(None));
        let mut nearly = TriMat::new((3, 3));
        for (i, j, value) in [(0, 0, 0.1), (0, 1, 0.3), (1, 1, 0.9), (2, 2, 1.0)] {
            nearly.add_triplet(i, j, value);
        }
        assert_eq!(negative_eigenvalues(&nearly.to_csc()), Ok(None));
    }
}
