//! Small dense products and systems, without allocation: the innermost loop of the contact solver.

/// Scalar product of two vectors of one length, summed from their first entries on.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Row `i` of a row-major matrix times `vector`, whose length is the row's.
pub(crate) fn along(rows: &[f64], i: usize, vector: &[f64]) -> f64 {
    let n = vector.len();
    dot(&rows[i * n..(i + 1) * n], vector)
}

/// Solves A x = b for a symmetric positive definite A (n x n, row-major, lower triangle used), by Cholesky.
///
/// `a` is overwritten by its factor and `b` by x. Returns false, with both spoilt, where A is not positive
/// definite to working precision.
#[must_use]
pub(crate) fn solve_spd(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    for j in 0..n {
        let mut pivot = a[j * n + j];
        for k in 0..j {
            pivot -= a[j * n + k] * a[j * n + k];
        }
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            let mut entry = a[i * n + j];
            for k in 0..j {
                entry -= a[i * n + k] * a[j * n + k];
            }
            a[i * n + j] = entry / root;
        }
    }
    for i in 0..n {
        let mut sum = b[i];
        for k in 0..i {
            sum -= a[i * n + k] * b[k];
        }
        b[i] = sum / a[i * n + i];
    }
    for i in (0..n).rev() {
        let mut sum = b[i];
        for k in i + 1..n {
            sum -= a[k * n + i] * b[k];
        }
        b[i] = sum / a[i * n + i];
    }
    true
}

/// Solves A x = b (n x n, row-major) by elimination with partial pivoting; `a` and `b` are overwritten, `b` by x.
///
/// Returns false where A is singular.
#[must_use]
pub(crate) fn solve_general(a: &mut [f64], b: &mut [f64]) -> bool {
    let n = b.len();
    for j in 0..n {
        let pivot = (j..n).max_by(|&p, &q| a[p * n + j].abs().total_cmp(&a[q * n + j].abs())).unwrap_or(j);
        let size = a[pivot * n + j].abs();
        if !(size > 0.0 && size.is_finite()) {
            return false;
        }
        if pivot != j {
            for k in 0..n {
                a.swap(pivot * n + k, j * n + k);
            }
            b.swap(pivot, j);
        }
        for i in j + 1..n {
            let factor = a[i * n + j] / a[j * n + j];
            if factor != 0.0 {
                for k in j + 1..n {
                    a[i * n + k] -= factor * a[j * n + k];
                }
                b[i] -= factor * b[j];
            }
        }
    }
    for i in (0..n).rev() {
        let mut sum = b[i];
        for k in i + 1..n {
            sum -= a[i * n + k] * b[k];
        }
        b[i] = sum / a[i * n + i];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::{solve_general, solve_spd};

    #[test]
    fn both_solvers_recover_a_planted_solution() {
        let a = [4.0, 1.0, -2.0, 1.0, 5.0, 0.5, -2.0, 0.5, 6.0];
        let x = [1.0, -2.0, 3.0];
        let b: Vec<f64> = (0..3).map(|i| (0..3).map(|j| a[3 * i + j] * x[j]).sum()).collect();
        for solve in [solve_spd, solve_general] {
            let (mut m, mut r) = (a, b.clone());
            assert!(solve(&mut m, &mut r));
            for (found, planted) in r.iter().zip(x) {
                assert!((found - planted).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn refuses_what_they_cannot_factor() {
        assert!(!solve_spd(&mut [1.0, 2.0, 2.0, 1.0], &mut [1.0, 1.0]));
        assert!(!solve_general(&mut [1.0, 2.0, 2.0, 4.0], &mut [1.0, 1.0]));
    }
}
