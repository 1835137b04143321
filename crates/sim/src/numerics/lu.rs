//! LU factors of a general square matrix with partial pivoting: column by column and without allocation where it is
//! small, by faer, in blocks, where it is large.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{MatMut, MatRef};
use nalgebra::DMatrix;
use smallvec::SmallVec;

use super::dense::BLOCKED;

/// Entries of a matrix, column by column; up to an order of 8 they need no allocation.
pub(crate) type Entries = SmallVec<[f64; 64]>;

/// The factors of a matrix.
pub(crate) enum LuFactors {
    Small(SmallFactors),
    Large(PartialPivLu<f64>),
}

/// P A = L U, L below the diagonal without its unit diagonal.
pub(crate) struct SmallFactors {
    columns: Entries,
    /// The row with which each row was exchanged.
    pivots: SmallVec<[usize; 8]>,
}

impl LuFactors {
    /// Factors `matrix`.
    pub fn new(matrix: DMatrix<f64>) -> Self {
        let order = matrix.nrows();
        LuFactors::of(SmallVec::from_vec(matrix.data.into()), order)
    }

    /// Factors the matrix with these entries and this order.
    pub fn of(columns: Entries, order: usize) -> Self {
        if order < BLOCKED {
            return LuFactors::Small(SmallFactors::new(columns, order));
        }
        LuFactors::Large(MatRef::from_column_major_slice(&columns, order, order).partial_piv_lu())
    }

    /// Replaces b by the solution of A x = b; false where A is singular.
    pub fn solve(&self, b: &mut [f64]) -> bool {
        match self {
            LuFactors::Small(factors) => factors.solve(b),
            LuFactors::Large(factors) => {
                let n = b.len();
                factors.solve_in_place(MatMut::from_column_major_slice_mut(b, n, 1));
                b.iter().all(|x| x.is_finite())
            }
        }
    }
}

impl SmallFactors {
    fn new(mut columns: Entries, order: usize) -> Self {
        let mut pivots: SmallVec<[usize; 8]> = (0..order).collect();
        for i in 0..order {
            let own = &columns[i * order..(i + 1) * order];
            let larger = |most: usize, row: usize| if own[row].abs() > own[most].abs() { row } else { most };
            let pivot = (i + 1..order).fold(i, larger);
            let diagonal = own[pivot];
            if diagonal == 0.0 {
                continue;
            }
            pivots[i] = pivot;
            columns.chunks_exact_mut(order).for_each(|column| column.swap(i, pivot));
            let (before, behind) = columns.split_at_mut((i + 1) * order);
            let factors = &mut before[i * order + i + 1..];
            let scale = 1.0 / diagonal;
            factors.iter_mut().for_each(|factor| *factor *= scale);
            for column in behind.chunks_exact_mut(order) {
                let (own, below) = column[i..].split_at_mut(1);
                below.iter_mut().zip(&*factors).for_each(|(x, factor)| *x -= own[0] * factor);
            }
        }
        SmallFactors { columns, pivots }
    }

    fn solve(&self, b: &mut [f64]) -> bool {
        let order = b.len();
        let column = |i: usize| &self.columns[i * order..(i + 1) * order];
        self.pivots.iter().enumerate().for_each(|(i, pivot)| b.swap(i, *pivot));
        for i in 0..order {
            let (own, below) = b[i..].split_at_mut(1);
            below.iter_mut().zip(&column(i)[i + 1..]).for_each(|(x, factor)| *x -= own[0] * factor);
        }
        for i in (0..order).rev() {
            let (above, own) = b.split_at_mut(i);
            let column = column(i);
            if column[i] == 0.0 {
                return false;
            }
            own[0] /= column[i];
            above.iter_mut().zip(column).for_each(|(x, entry)| *x -= own[0] * entry);
        }
        true
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
            let mut found = b.clone();
            assert!(LuFactors::new(matrix).solve(found.as_mut_slice()), "the matrix is regular");
            assert!((found - x).amax() < 1e-11, "n {n}");
        }
    }

    #[test]
    fn singular_matrices_have_no_solution() {
        for n in [2, BLOCKED] {
            let factors = LuFactors::new(DMatrix::zeros(n, n));
            assert!(!factors.solve(&mut vec![1.0; n]));
        }
    }
}
