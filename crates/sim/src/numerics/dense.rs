//! Dense products and linear systems of the contact solver: small ones without allocation, for its innermost loop, large
//! ones in blocks.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{
    LltRegularization, cholesky_in_place, cholesky_in_place_scratch,
};
use faer::linalg::cholesky::llt::solve::solve_in_place;
use faer::linalg::solvers::Solve;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::{MatMut, MatRef, Par};

/// Scalar product of two vectors of equal length. It uses four partial sums in a fixed order, so the result is the
/// same on every machine.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        sums = std::array::from_fn(|k| sums[k] + a[k] * b[k]);
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

/// Product of row `i` of a row-major matrix and `vector`, whose length is that of the row.
#[inline]
pub(crate) fn along(rows: &[f64], i: usize, vector: &[f64]) -> f64 {
    let n = vector.len();
    dot(&rows[i * n..(i + 1) * n], vector)
}

/// Adds `lines`, each times its share, to `sum` in their order, four at a time: every sum is loaded and stored once for four
/// of them. Lines with the share zero are left out.
#[inline]
pub(crate) fn add_lines<'m>(lines: impl Iterator<Item = (f64, &'m [f64])>, sum: &mut [f64]) {
    let mut four: [(f64, &[f64]); 4] = [(0.0, &[]); 4];
    let mut known = 0;
    for line in lines.filter(|(share, _)| *share != 0.0) {
        four[known] = line;
        known += 1;
        if known == 4 {
            add_four(four, sum);
            known = 0;
        }
    }
    for (share, line) in &four[..known] {
        sum.iter_mut()
            .zip(*line)
            .for_each(|(sum, entry)| *sum += share * entry);
    }
}

fn add_four(
    [(a, first), (b, second), (c, third), (d, fourth)]: [(f64, &[f64]); 4],
    sum: &mut [f64],
) {
    let lines = first.iter().zip(second).zip(third.iter().zip(fourth));
    for (sum, ((e, f), (g, h))) in sum.iter_mut().zip(lines) {
        *sum = *sum + a * e + b * f + c * g + d * h;
    }
}

/// Order of a matrix from which blocked factorization is faster.
pub(crate) const BLOCKED: usize = 64;

/// Solves A x = b by Cholesky factorization for a symmetric positive definite A (n x n, both triangles given) and one or
/// more right sides, which follow each other in `b`.
///
/// `a` is overwritten and `b` becomes the solutions. The factor of a small matrix is computed row by row from the
/// top, so that every scalar product uses contiguous memory, that of a large one by faer in blocks. Returns false where A
/// is not positive definite to working precision; the contents of `a` and `b` are then undefined.
#[must_use]
pub(crate) fn solve_spd(a: &mut [f64], b: &mut [f64]) -> bool {
    match a.len().isqrt() {
        0 => true,
        n @ 1..BLOCKED => factor_and_solve(a, b, n),
        n => factor_and_solve_in_blocks(a, b, n),
    }
}

fn factor_and_solve_in_blocks(a: &mut [f64], b: &mut [f64], n: usize) -> bool {
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(
        n,
        Par::Seq,
        Default::default(),
    ));
    let stack = MemStack::new(&mut memory);
    let mut matrix = MatMut::from_column_major_slice_mut(a, n, n);
    let limits = LltRegularization::default();
    if cholesky_in_place(matrix.rb_mut(), limits, Par::Seq, stack, Default::default()).is_err() {
        return false;
    }
    let columns = b.len() / n;
    let right = MatMut::from_column_major_slice_mut(&mut *b, n, columns);
    solve_in_place(matrix.rb(), right, Par::Seq, MemStack::new(&mut []));
    b.iter().all(|x| x.is_finite())
}

/// Replaces the lower triangle of a symmetric positive definite matrix (n x n, row-major) by its Cholesky factor with the
/// reciprocals of its diagonal, row by row from the top: each row is the solution of the rows above it, and so are the right
/// sides. Returns false where a pivot is not positive.
fn factor_spd(a: &mut [f64], n: usize) -> bool {
    for i in 0..n {
        let (above, row) = a.split_at_mut(i * n);
        let row = &mut row[..=i];
        solve_lower(above, n, &mut row[..i], |reciprocal| reciprocal);
        let pivot = row[i] - dot(&row[..i], &row[..i]);
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        row[i] = 1.0 / pivot.sqrt();
    }
    true
}

/// Solves L x = b, where L are the leading rows of `a` (n columns) on and below its diagonal, of whose entries `reciprocal` makes the
/// reciprocals of the diagonal of L; `b` is overwritten by x. Four rows at a time: the sums over the unknowns that are known
/// before them, which all four read together, and then the unknowns of the four one by one, each of which waits for the one
/// before.
#[inline]
fn solve_lower(a: &[f64], n: usize, b: &mut [f64], reciprocal: impl Fn(f64) -> f64) {
    let count = b.len();
    let whole = count / 4 * 4;
    for i in (0..whole).step_by(4) {
        let (known, own) = b.split_at_mut(i);
        let lines: [&[f64]; 4] = std::array::from_fn(|k| &a[(i + k) * n..(i + k) * n + i + 4]);
        let sums = four_dots(lines.map(|line| &line[..i]), known);
        for k in 0..4 {
            let line = &lines[k][i..];
            let late = line[..k].iter().zip(&own[..k]);
            own[k] = late.fold(own[k] - sums[k], |sum, (entry, b)| sum - entry * b)
                * reciprocal(line[k]);
        }
    }
    for i in whole..count {
        let (row, (known, own)) = (&a[i * n..=i * n + i], b.split_at_mut(whole));
        let sum = own[i - whole] - dot(&row[..whole], known);
        let late = row[whole..i].iter().zip(&own[..i - whole]);
        own[i - whole] = late.fold(sum, |sum, (entry, b)| sum - entry * b) * reciprocal(row[i]);
    }
}

fn factor_and_solve(a: &mut [f64], b: &mut [f64], n: usize) -> bool {
    if !factor_spd(a, n) {
        return false;
    }
    for b in b.chunks_exact_mut(n) {
        solve_lower(a, n, b, |reciprocal| reciprocal);
        // The columns of the transposed factor are the rows of the factor.
        for i in (0..n).rev() {
            let (before, rest) = b.split_at_mut(i);
            let row = &a[i * n..=i * n + i];
            rest[0] *= row[i];
            before
                .iter_mut()
                .zip(row)
                .for_each(|(b, l)| *b -= rest[0] * l);
        }
    }
    true
}

/// Solves A x = b (n x n, row-major) by Gaussian elimination with partial pivoting, in blocks where A is large. `a` is
/// overwritten, and `b` is overwritten by x.
///
/// Returns false where A is singular.
#[must_use]
pub(crate) fn solve_general(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    if n >= BLOCKED {
        let factors = MatRef::from_row_major_slice(a, n, n).partial_piv_lu();
        factors.solve_in_place(MatMut::from_column_major_slice_mut(&mut *b, n, 1));
        return b.iter().all(|x| x.is_finite());
    }
    for j in 0..n {
        let Some(pivot) = exchange(a, j, n) else {
            return false;
        };
        b.swap(pivot, j);
        eliminate(a, j, n);
        let (known, later) = b.split_at_mut(j + 1);
        let factors = a[(j + 1) * n..].chunks_exact(n).map(|line| line[j]);
        later
            .iter_mut()
            .zip(factors)
            .for_each(|(b, factor)| *b -= factor * known[j]);
    }
    substitute(a, b);
    true
}

/// Replaces A (n x n, row-major) by its factors P A = L U with partial pivoting. L is stored below the diagonal
/// without its unit diagonal, U with the reciprocals of its diagonal, and `pivots` receives the row exchanges.
///
/// Returns false where A is singular.
#[must_use]
pub(crate) fn factor_general(a: &mut [f64], pivots: &mut [usize]) -> bool {
    let n = pivots.len();
    for (j, pivot) in pivots.iter_mut().enumerate() {
        let Some(row) = exchange(a, j, n) else {
            return false;
        };
        *pivot = row;
        eliminate(a, j, n);
    }
    true
}

/// Solves A x = b with the factors and row exchanges of [`factor_general`]; `b` is overwritten by x.
pub(crate) fn solve_factored(a: &[f64], pivots: &[usize], b: &mut [f64]) {
    let n = b.len();
    for (j, &pivot) in pivots.iter().enumerate() {
        b.swap(j, pivot);
    }
    // the diagonal of L is one; its place has that of U
    solve_lower(a, n, b, |_| 1.0);
    substitute(a, b);
}

/// Solves A x = b for four right sides, the columns of `b`, with the factors and row exchanges of [`factor_general`]. Each
/// unknown is taken from all later equations at once, which do not wait for each other.
pub(crate) fn solve_four_factored(a: &[f64], pivots: &[usize], b: &mut [[f64; 4]]) {
    let n = b.len();
    for (j, &pivot) in pivots.iter().enumerate() {
        b.swap(j, pivot);
    }
    let take = |own: [f64; 4], entry: f64, from: &mut [f64; 4]| {
        *from = std::array::from_fn(|k| from[k] - entry * own[k]);
    };
    for j in 0..n {
        let (known, later) = b.split_at_mut(j + 1);
        let column = a[(j + 1) * n..].chunks_exact(n).map(|line| line[j]);
        later
            .iter_mut()
            .zip(column)
            .for_each(|(b, entry)| take(known[j], entry, b));
    }
    for j in (0..n).rev() {
        let (later, known) = b.split_at_mut(j);
        known[0] = known[0].map(|x| x * a[j * n + j]);
        let column = a.chunks_exact(n).map(|line| line[j]);
        later
            .iter_mut()
            .zip(column)
            .for_each(|(b, entry)| take(known[0], entry, b));
    }
}

/// Scalar products of four lines with `vector`, whose length is a multiple of four: those of [`dot`].
#[inline]
fn four_dots(lines: [&[f64]; 4], vector: &[f64]) -> [f64; 4] {
    let [a, b, c, d] = lines.map(|line| line.as_chunks::<4>().0);
    let mut sums = [[0.0; 4]; 4];
    let fours = vector.as_chunks::<4>().0.iter();
    for (v, ((a, b), (c, d))) in fours.zip(a.iter().zip(b).zip(c.iter().zip(d))) {
        for (sum, line) in sums.iter_mut().zip([a, b, c, d]) {
            *sum = std::array::from_fn(|k| sum[k] + line[k] * v[k]);
        }
    }
    sums.map(|sum| (sum[0] + sum[2]) + (sum[1] + sum[3]))
}

/// Exchanges row `j` with the row that has the largest entry of column `j` on or below the diagonal, and returns the
/// index of that row; `None` where all these entries are zero or the largest is not finite.
fn exchange(a: &mut [f64], j: usize, n: usize) -> Option<usize> {
    let (mut pivot, mut largest) = (j, 0.0);
    for (row, line) in a.chunks_exact(n).enumerate().skip(j) {
        let size = line[j].abs();
        // Of equal entries the last, and one that is no number before all others.
        if size >= largest || size.is_nan() {
            (pivot, largest) = (row, size);
        }
    }
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    if pivot != j {
        let (above, below) = a.split_at_mut(pivot * n);
        above[j * n..(j + 1) * n].swap_with_slice(&mut below[..n]);
    }
    Some(pivot)
}

/// Eliminates column `j` from the rows below row `j` and stores the multipliers in column `j`, and the reciprocal of the
/// pivot in its place.
fn eliminate(a: &mut [f64], j: usize, n: usize) {
    let (above, below) = a.split_at_mut((j + 1) * n);
    let row = &mut above[j * n..];
    let scale = 1.0 / row[j];
    row[j] = scale;
    for line in below.chunks_exact_mut(n) {
        let factor = line[j] * scale;
        line[j] = factor;
        if factor != 0.0 {
            line[j + 1..]
                .iter_mut()
                .zip(&row[j + 1..])
                .for_each(|(x, y)| *x -= factor * y);
        }
    }
}

/// Solves U x = b by back substitution, where U is stored on and above the diagonal of `a`, with the reciprocals of its
/// diagonal.
fn substitute(a: &[f64], b: &mut [f64]) {
    let n = b.len();
    let first = n % 4;
    // As in the forward substitution, four rows at a time from the last.
    for i in (first..n).step_by(4).rev() {
        let (own, known) = b[i..].split_at_mut(4);
        let sums = four_dots(
            std::array::from_fn(|k| &a[(i + k) * n + i + 4..(i + k + 1) * n]),
            known,
        );
        for k in (0..4).rev() {
            let line = &a[(i + k) * n + i..(i + k) * n + i + 4];
            let late = line[k + 1..].iter().zip(&own[k + 1..]).rev();
            own[k] = late.fold(own[k] - sums[k], |sum, (entry, b)| sum - entry * b) * line[k];
        }
    }
    for i in (0..first).rev() {
        let line = &a[i * n..(i + 1) * n];
        let sum = b[i] - dot(&line[first..], &b[first..]);
        let late = line[i + 1..first].iter().zip(&b[i + 1..first]).rev();
        b[i] = late.fold(sum, |sum, (entry, b)| sum - entry * b) * line[i];
    }
}

/// Replaces a symmetric positive definite matrix (n x n, row-major) by its inverse. Gauss-Jordan elimination without
/// exchanges is stable for such matrices; its pivots are the squares of those of Cholesky's factor.
///
/// Returns false where the matrix is not positive definite to working precision; the contents of `a` are then
/// undefined.
#[must_use]
pub(crate) fn invert_spd(a: &mut [f64], n: usize) -> bool {
    for k in 0..n {
        let (above, rest) = a.split_at_mut(k * n);
        let (row, below) = rest.split_at_mut(n);
        if !(row[k] > 0.0 && row[k].is_finite()) {
            return false;
        }
        let scale = 1.0 / row[k];
        row[k] = 1.0;
        row.iter_mut().for_each(|x| *x *= scale);
        for lines in [above, below] {
            for line in lines.chunks_exact_mut(n) {
                let factor = std::mem::take(&mut line[k]);
                // Bodies that are not coupled leave blocks of zeros.
                if factor == 0.0 {
                    continue;
                }
                line.iter_mut()
                    .zip(&*row)
                    .for_each(|(x, entry)| *x -= factor * entry);
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::{factor_general, invert_spd, solve_factored, solve_general, solve_spd};

    #[test]
    fn both_solvers_recover_a_planted_solution() {
        let a = [4.0, 1.0, -2.0, 1.0, 5.0, 0.5, -2.0, 0.5, 6.0];
        let x = [1.0, -2.0, 3.0];
        let b: Vec<f64> = (0..3)
            .map(|i| (0..3).map(|j| a[3 * i + j] * x[j]).sum())
            .collect();
        for solve in [
            solve_spd as fn(&mut [f64], &mut [f64]) -> bool,
            solve_general,
        ] {
            let (mut m, mut r) = (a, b.clone());
            assert!(solve(&mut m, &mut r));
            for (found, planted) in r.iter().zip(x) {
                assert!((found - planted).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn large_definite_systems_recover_a_planted_solution() {
        for n in [15, 16, 17, 31, 32, 33, 64, 100, 257] {
            // Green's function of a string, min(x, y) (1 - max(x, y)), plus springs on the diagonal.
            let at = |i: usize| (i + 1) as f64 / (n + 1) as f64;
            let entry = |i: usize, j: usize| {
                at(i.min(j)) * (1.0 - at(i.max(j))) + if i == j { 0.1 } else { 0.0 }
            };
            let mut a: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
            let x: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
            let mut b: Vec<f64> = (0..n)
                .map(|i| (0..n).map(|j| entry(i, j) * x[j]).sum())
                .collect();
            assert!(solve_spd(&mut a, &mut b));
            let error = b
                .iter()
                .zip(&x)
                .fold(0.0_f64, |max, (b, x)| max.max((b - x).abs()));
            assert!(error < 1e-11, "n {n}: {error}");
            // A value of -1 in the last diagonal entry makes the matrix indefinite and must be rejected.
            let mut a: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
            a[n * n - 1] = -1.0;
            assert!(!solve_spd(&mut a, &mut b));
        }
    }

    #[test]
    fn factors_of_a_matrix_whose_rows_are_exchanged_solve_for_every_right_side() {
        let n = 9;
        let entry = |i: usize, j: usize| {
            ((7 * i + 3 * j) % 11) as f64 - 5.0 + if i + j == n - 1 { 30.0 } else { 0.0 }
        };
        let a: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
        let (mut factors, mut pivots) = (a.clone(), vec![0; n]);
        assert!(factor_general(&mut factors, &mut pivots));
        for k in 0..3 {
            let x: Vec<f64> = (0..n).map(|i| (i as f64 + f64::from(k)).cos()).collect();
            let mut b: Vec<f64> = (0..n)
                .map(|i| (0..n).map(|j| a[i * n + j] * x[j]).sum())
                .collect();
            solve_factored(&factors, &pivots, &mut b);
            assert!(b.iter().zip(&x).all(|(b, x)| (b - x).abs() < 1e-13));
        }
    }

    #[test]
    fn inverse_times_the_matrix_is_the_identity() {
        for n in [1, 2, 5, 13] {
            let entry =
                |i: usize, j: usize| 1.0 / (1 + i + j) as f64 + if i == j { 1.0 } else { 0.0 };
            let a: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
            let mut inverse = a.clone();
            assert!(invert_spd(&mut inverse, n));
            for i in 0..n {
                for j in 0..n {
                    let sum: f64 = (0..n).map(|k| a[i * n + k] * inverse[k * n + j]).sum();
                    assert!((sum - if i == j { 1.0 } else { 0.0 }).abs() < 1e-13);
                }
            }
        }
        assert!(!invert_spd(&mut [-1.0], 1));
    }

    #[test]
    fn refuses_what_they_cannot_factor() {
        assert!(!solve_spd(&mut [1.0, 2.0, 2.0, 1.0], &mut [1.0, 1.0]));
        assert!(!solve_general(&mut [1.0, 2.0, 2.0, 4.0], &mut [1.0, 1.0]));
    }
}
