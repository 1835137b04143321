//! Least squares with coefficients that must not be negative, which also decides whether forces that only push can balance a
//! load.

use nalgebra::{DMatrix, DVector};

/// Part of the size of a product by which rounding may change its sign.
const ROUNDING: f64 = 1e-12;

/// The coefficients x that minimise |A x - b|, where those of the columns before `pushing` may have either sign and the others
/// must not be negative.
///
/// The active set method of Lawson and Hanson: a set of columns is free, and x are their coefficients by least squares. As long
/// as another column would reduce the residual r = b - A x, the one that reduces it most joins. If coefficients of the enlarged
/// set are negative, x moves towards them until the first one is zero, which leaves the set. The residual becomes smaller with
/// every column that joins, so that no set occurs twice.
///
/// By the conditions of the minimum, the residual r satisfies a . r = 0 for the columns before `pushing`, a . r <= 0 for all
/// others and b . r = r . r. Where r is not zero it therefore proves, by Farkas' lemma, that b is no sum of the columns.
///
/// # Source
/// Lawson, Hanson, Solving Least Squares Problems (1974), chapter 23.
pub(crate) fn nonnegative(
    a: &DMatrix<f64>,
    b: &DVector<f64>,
    pushing: usize,
) -> (DVector<f64>, DVector<f64>) {
    let count = a.ncols();
    let mut x = DVector::zeros(count);
    let mut free: Vec<usize> = (0..pushing).collect();
    let mut residual = b.clone();
    if !free.is_empty() {
        place(&mut x, &free, &by_least_squares(a, b, &free));
        residual = b - a * &x;
    }
    for _ in 0..3 * count {
        let gain = |j: usize| a.column(j).dot(&residual);
        let noise = |j: usize| ROUNDING * a.column(j).norm() * b.norm();
        let next = (pushing..count)
            .filter(|j| !free.contains(j) && gain(*j) > noise(*j))
            .max_by(|&i, &j| gain(i).total_cmp(&gain(j)));
        let Some(next) = next else { break };
        let before = residual.norm();
        free.push(next);
        loop {
            let wanted = by_least_squares(a, b, &free);
            // how far x may move before a coefficient becomes negative, and which one
            let share = |k: usize| x[free[k]] / (x[free[k]] - wanted[k]);
            let first = (0..free.len())
                .filter(|&k| free[k] >= pushing && wanted[k] < 0.0)
                .min_by(|&k, &l| share(k).total_cmp(&share(l)));
            let Some(first) = first else {
                place(&mut x, &free, &wanted);
                break;
            };
            let share = share(first);
            for (&j, wanted) in free.iter().zip(wanted.iter()) {
                x[j] += share * (wanted - x[j]);
            }
            x[free[first]] = 0.0;
            free.remove(first);
        }
        residual = b - a * &x;
        if residual.norm() >= before {
            break;
        }
    }
    (x, residual)
}

/// Sets the coefficients of the columns `free`.
fn place(x: &mut DVector<f64>, free: &[usize], values: &DVector<f64>) {
    free.iter()
        .zip(values.iter())
        .for_each(|(&j, value)| x[j] = *value);
}

/// The coefficients of the columns `free` by least squares, with the smallest norm where they are not unique.
fn by_least_squares(a: &DMatrix<f64>, b: &DVector<f64>, free: &[usize]) -> DVector<f64> {
    let own = a.select_columns(free);
    let slack = ROUNDING * own.norm();
    own.svd(true, true)
        .solve(b, slack)
        .unwrap_or_else(|_| DVector::zeros(free.len()))
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::nonnegative;

    /// The residual of every random problem satisfies the conditions of the minimum, and sums of columns with coefficients that
    /// are not negative have none.
    #[test]
    fn residuals_prove_what_they_say() {
        let mut numbers = fastrand::Rng::with_seed(11);
        let mut random = move || numbers.f64() * 2.0 - 1.0;
        let mut impossible = 0;
        for case in 0..400 {
            let (rows, count) = (1 + case % 5, 1 + case % 9);
            let pushing = case % 3 % count;
            let a = DMatrix::from_fn(rows, count, |_, _| random());
            let planted = DVector::from_fn(count, |j, _| {
                let own = random();
                if j < pushing { own } else { own.max(0.0) }
            });
            let (_, residual) = nonnegative(&a, &(&a * &planted), pushing);
            assert!(residual.norm() < 1e-10, "case {case}: {}", residual.norm());
            let b = DVector::from_fn(rows, |_, _| random());
            let (x, residual) = nonnegative(&a, &b, pushing);
            assert!(x.iter().skip(pushing).all(|x| *x >= 0.0));
            for (j, column) in a.column_iter().enumerate() {
                let along = column.dot(&residual);
                let held = if j < pushing { along.abs() } else { along };
                assert!(held < 1e-9, "case {case}: column {j} has {along}");
            }
            let falling = b.dot(&residual) - residual.norm_squared();
            assert!(falling.abs() < 1e-9, "case {case}: {falling}");
            impossible += usize::from(residual.norm() > 1e-6);
        }
        assert!(impossible > 100, "{impossible}");
    }
}
