//! LU factors of a general square matrix with partial pivoting: column by column and without allocation where it is
//! small, by faer, in blocks, where it is large.

use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{MatMut, MatRef};
use nalgebra::DMatrix;

use super::dense::BLOCKED;

/// The factors of a matrix, P A = L U. Their memory serves for one matrix after the other.
#[derive(Default)]
pub(crate) struct LuFactors {
    /// Entries of the matrix, column by column; once it is factored those of U, and of L below the diagonal without its
    /// unit diagonal.
    columns: Vec<f64>,
    /// The row with which each row was exchanged.
    pivots: Vec<usize>,
    large: Option<PartialPivLu<f64>>,
}

impl LuFactors {
    /// Factors `matrix`.
    pub fn new(matrix: DMatrix<f64>) -> Self {
        let order = matrix.nrows();
        let mut factors = LuFactors { columns: matrix.data.into(), ..LuFactors::default() };
        factors.factor(order);
        factors
    }

    /// Replaces the matrix by one of this order, whose columns `fill` adds one after the other.
    pub fn replace(&mut self, order: usize, fill: impl FnOnce(&mut Vec<f64>)) {
        self.columns.clear();
        fill(&mut self.columns);
        self.factor(order);
    }

    fn factor(&mut self, order: usize) {
        self.pivots.clear();
        if order >= BLOCKED {
            let matrix = MatRef::from_column_major_slice(&self.columns, order, order);
            self.large = Some(matrix.partial_piv_lu());
            return;
        }
        self.large = None;
        if let [a, c, b, d] = &mut self.columns[..] {
            // the same for two rows, without loops
            let is_exchanged = c.abs() > a.abs();
            if is_exchanged {
                std::mem::swap(a, c);
                std::mem::swap(b, d);
            }
            if *a != 0.0 {
                *c *= 1.0 / *a;
                *d -= *b * *c;
            }
            self.pivots.extend([usize::from(is_exchanged), 1]);
            return;
        }
        for i in 0..order {
            let own = &self.columns[i * order..(i + 1) * order];
            let mut pivot = i;
            for row in i + 1..order {
                if own[row].abs() > own[pivot].abs() {
                    pivot = row;
                }
            }
            let diagonal = own[pivot];
            if diagonal == 0.0 {
                self.pivots.push(i);
                continue;
            }
            self.pivots.push(pivot);
            if pivot != i {
                self.columns.chunks_exact_mut(order).for_each(|column| column.swap(i, pivot));
            }
            let (before, behind) = self.columns.split_at_mut((i + 1) * order);
            let factors = &mut before[i * order + i + 1..];
            let scale = 1.0 / diagonal;
            factors.iter_mut().for_each(|factor| *factor *= scale);
            for column in behind.chunks_exact_mut(order) {
                let (own, below) = column[i..].split_at_mut(1);
                below.iter_mut().zip(&*factors).for_each(|(x, factor)| *x -= own[0] * factor);
            }
        }
    }

    /// Replaces b by the solution of A x = b; false where A is singular.
    pub fn solve(&self, b: &mut [f64]) -> bool {
        let order = b.len();
        if let Some(factors) = &self.large {
            factors.solve_in_place(MatMut::from_column_major_slice_mut(b, order, 1));
            return b.iter().all(|x| x.is_finite());
        }
        if let ([a, c, b, d], [x, y]) = (&self.columns[..], &mut *b) {
            if self.pivots[0] == 1 {
                std::mem::swap(x, y);
            }
            *y = (*y - *x * c) / d;
            *x = (*x - *y * b) / a;
            return *a != 0.0 && *d != 0.0;
        }
        self.pivots.iter().enumerate().for_each(|(i, pivot)| b.swap(i, *pivot));
        for (i, column) in self.columns.chunks_exact(order.max(1)).enumerate() {
            let (own, below) = b[i..].split_at_mut(1);
            below.iter_mut().zip(&column[i + 1..]).for_each(|(x, factor)| *x -= own[0] * factor);
        }
        for (i, column) in self.columns.chunks_exact(order.max(1)).enumerate().rev() {
            let (above, own) = b.split_at_mut(i);
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
        for n in [1, 2, 5, BLOCKED - 1, BLOCKED, 150] {
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
        for n in [2, 3, BLOCKED] {
            let factors = LuFactors::new(DMatrix::zeros(n, n));
            assert!(!factors.solve(&mut vec![1.0; n]));
        }
    }
}
