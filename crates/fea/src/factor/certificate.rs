//! Bound of the error that rounding in stiffness and factor causes in influence coefficients.

use crate::assembly::{Real, ScaledStiffness};
use crate::factor::cholesky::Factor;

/// Condition of a factored stiffness, and a bound of the error of its influence coefficients.
///
/// # Example
/// ```
/// use fea::{FactoredFrame, Girder};
///
/// let girder = Girder { spans: vec![60.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let certificate = FactoredFrame::new(&model, &[rail])?.certificate();
/// assert!(certificate.extended, "small frames are factored in double-doubles");
/// assert!(certificate.error_bound < 1e-20);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Estimate of the condition number |S K S| |(S K S)^-1| in the 1-norm; S scales the diagonal to about one.
    pub condition: f64,
    /// Bound of |error of G_ij| / sqrt(G_ii G_jj) from rounding in stiffness, factor and solves; that of a
    /// grid also includes the rounding of loads and products.
    pub error_bound: f64,
    /// Whether stiffness and factor are in double-doubles.
    pub extended: bool,
}

/// Roundings in one entry of the stiffness of a member (geometry, section, two congruences).
const FORMING: f64 = 16.0;
/// Factor on the estimate of |K^-1|, which is a lower bound and seldom below a third of the norm.
const ESTIMATE_MARGIN: f64 = 3.0;
/// Most iterations of the estimate of |K^-1|.
const ESTIMATE_STEPS: usize = 5;

impl Certificate {
    /// The certificate of a factor, and the bound of |K^-1| that it uses (K scaled, 1-norm).
    ///
    /// With u = K^-1 p a change dK of the stiffness changes G_ij by u_i^T dK u_j, and
    ///
    /// |u_i^T dK u_j| <= |dK| |K^-1| sqrt(G_ii G_jj).
    ///
    /// |dK| has two parts: what forming the entries can have changed, and what the factor and its two solves
    /// can have changed. |K^-1| is Higham's estimate times a margin.
    ///
    /// # Source
    /// Higham, Accuracy and Stability of Numerical Algorithms (2002), theorem 10.3 and algorithm 15.4.
    pub(crate) fn new<T: Real>(
        stiffness: &ScaledStiffness<T>,
        factor: &Factor<T>,
    ) -> (Certificate, f64) {
        let extended = T::ROUNDING < f64::EPSILON;
        if factor.len() == 0 {
            return (
                Certificate {
                    condition: 1.0,
                    error_bound: 0.0,
                    extended,
                },
                0.0,
            );
        }
        let norm = stiffness.norm();
        let inverse = estimate_inverse_norm(factor);
        let inverse_bound = ESTIMATE_MARGIN * inverse;
        let (growth, longest) = factor.growth();
        let formed = FORMING * stiffness.cancellation * norm;
        // The factor and the two solves each round a sum as long as the longest row, and a quotient by its reciprocal.
        let factored = 3.0 * effective_roundings(longest + 2) * growth;
        let shift = T::ROUNDING * (formed + factored) * inverse_bound;
        let error_bound = if shift < 0.5 {
            shift / (1.0 - shift)
        } else {
            f64::INFINITY
        };
        (
            Certificate {
                condition: norm * inverse,
                error_bound,
                extended,
            },
            inverse_bound,
        )
    }
}

/// Number of roundings in a sum of n products that count: min(n, 8 sqrt(n)).
///
/// The roundings of a long sum do not all have one sign; they exceed 8 sqrt(n) with probability 2 exp(-32).
///
/// # Source
/// Higham and Mary (2019), SIAM J. Sci. Comput. 41, theorem 2.4 with lambda = 8.
fn effective_roundings(n: usize) -> f64 {
    let n = n as f64;
    n.min(8.0 * n.sqrt())
}

/// Estimate of the 1-norm of the inverse: a lower bound, usually sharp.
///
/// Gradient ascent of |K^-1 x|_1 over the vectors with |x|_1 = 1. It starts from the mean of the unit vectors
/// and moves to the unit vector of the largest gradient until the norm grows no more; a vector with
/// alternating signs guards against cancellation.
///
/// # Source
/// Higham (1988), ACM Trans. Math. Softw. 14, algorithm 4.1; Hager (1984), SIAM J. Sci. Stat. Comput. 5.
fn estimate_inverse_norm<T: Real>(factor: &Factor<T>) -> f64 {
    let n = factor.len();
    let solve = |x: &mut Vec<f64>| {
        let mut wide: Vec<T> = x.iter().map(|&value| T::from(value)).collect();
        factor.solve(&mut wide);
        x.iter_mut()
            .zip(wide)
            .for_each(|(x, value)| *x = value.double());
    };
    let one_norm = |x: &[f64]| x.iter().map(|v| v.abs()).sum::<f64>();
    // The mean of the unit vectors, and a vector with alternating signs: one solve for both.
    let step = 1.0 / (n.max(2) - 1) as f64;
    let alternating =
        |k: usize| (1.0 + k as f64 * step) * if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    let mut starts: Vec<[T; 2]> = (0..n)
        .map(|k| [T::from(1.0 / n as f64), T::from(alternating(k))])
        .collect();
    factor.solve_lanes(&mut starts);
    let mut x: Vec<f64> = starts.iter().map(|start| start[0].double()).collect();
    let alternating: f64 = starts.iter().map(|start| start[1].double().abs()).sum();
    let mut best = one_norm(&x);
    let mut last = usize::MAX;
    for _ in 0..ESTIMATE_STEPS {
        let mut gradient: Vec<f64> = x
            .iter()
            .map(|v| if *v < 0.0 { -1.0 } else { 1.0 })
            .collect();
        solve(&mut gradient);
        let largest = (0..n).fold(0, |a, b| {
            if gradient[b].abs() > gradient[a].abs() {
                b
            } else {
                a
            }
        });
        if largest == last {
            break;
        }
        last = largest;
        x.fill(0.0);
        x[largest] = 1.0;
        solve(&mut x);
        let norm = one_norm(&x);
        if norm <= best {
            break;
        }
        best = norm;
    }
    best.max(2.0 * alternating / (3.0 * n as f64))
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use sprs::CsMat;

    use super::*;

    /// Estimate of the 1-norm of a positive definite matrix B, by the factor of its inverse, and the norm itself.
    fn estimated(inverse: &DMatrix<f64>) -> [f64; 2] {
        let n = inverse.nrows();
        let matrix = inverse.clone().try_inverse().expect("positive definite");
        let starts = (0..=n).map(|column| column * (column + 1) / 2).collect();
        let rows = (0..n).flat_map(|column| 0..=column).collect();
        let values = (0..n)
            .flat_map(|j| (0..=j).map(move |i| (i, j)))
            .map(|at| matrix[at])
            .collect();
        let factor =
            Factor::new(&CsMat::new_csc((n, n), starts, rows, values)).expect("positive definite");
        let norm = (0..n)
            .map(|j| inverse.column(j).iter().map(|x| x.abs()).sum())
            .fold(0.0, f64::max);
        [estimate_inverse_norm(&factor), norm]
    }

    /// Identity: an estimate |B x|/|x| is never above the norm. Gradient ascent finds two thirds of the norms exactly.
    #[test]
    fn estimate_of_the_inverse_is_a_lower_bound_and_usually_sharp() {
        let mut random = fastrand::Rng::with_seed(9);
        let mut sharp = 0;
        for case in 0..300 {
            let n = 2 + case % 9;
            let a = DMatrix::from_fn(n, n, |_, _| random.f64() - 0.5);
            let [found, norm] = estimated(&(&a * a.transpose() + DMatrix::identity(n, n) * 0.01));
            assert!(
                found <= norm * (1.0 + 1e-9) && found > norm / ESTIMATE_MARGIN,
                "{found} of {norm}"
            );
            sharp += usize::from(found > norm * (1.0 - 1e-9));
        }
        assert!(sharp >= 200, "{sharp} of 300");
    }

    /// Analytic: B = D + s v v^T with D = diag(3/2, 1, 1, 1, 1) and v = (0, 1, -1, 1, -1). For the mean of the unit vectors
    /// v cancels; the ascent goes on to the first unit vector, on which v does not act, and stops there at |B x| = 3/2. The
    /// norm is 1 + 4 s; the vector with alternating signs finds most of it.
    #[test]
    fn cancellation_does_not_hide_a_large_inverse() {
        let v = DVector::from_vec(vec![0.0, 1.0, -1.0, 1.0, -1.0]);
        for s in [10.0, 1e3, 1e6] {
            let mut matrix = DMatrix::identity(5, 5) + &v * v.transpose() * s;
            matrix[(0, 0)] = 1.5;
            let [found, norm] = estimated(&matrix);
            assert!((norm / (1.0 + 4.0 * s) - 1.0).abs() < 1e-14, "{norm}");
            assert!(found <= norm && found > 0.8 * norm, "{found} of {norm}");
        }
    }
}
