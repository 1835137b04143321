//! How far the numbers can be trusted.

use crate::assembly::Assembly;
use crate::factor::Factor;
use crate::real::Real;

/// Condition of a factored stiffness, and what rounding can have done to compliances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Certificate {
    /// Estimate of |S K S| |(S K S)^-1| in the 1-norm, S the scale that makes the diagonal about one.
    pub condition: f64,
    /// Bound on |error of G_ij| / sqrt(G_ii G_jj), from rounding in stiffness, factor and solves; of a grid also
    /// from that of loads and products.
    pub error_bound: f64,
    /// Whether stiffness and factor are double-doubles.
    pub extended: bool,
}

/// Roundings that form one entry of a member's stiffness (geometry, section, two congruences).
const FORMING: f64 = 16.0;

impl Certificate {
    /// With u = K^-1 p, |u_i' dK u_j| <= |dK| |K^-1| sqrt(G_ii G_jj), K scaled: |dK| is what forming
    /// the entries and factoring them can have changed, |K^-1| is Higham's estimate.
    ///
    /// Also gives the bound of |K^-1|.
    ///
    /// # Source
    /// Higham, Accuracy and Stability of Numerical Algorithms (2002), theorem 10.3 and algorithm 15.4.
    pub(crate) fn new<T: Real>(assembly: &Assembly<T>, factor: &Factor<T>) -> (Certificate, f64) {
        let extended = T::ROUNDING < f64::EPSILON;
        if factor.len() == 0 {
            return (Certificate { condition: 1.0, error_bound: 0.0, extended }, 0.0);
        }
        let norm = assembly.norm();
        let inverse = inverse_norm(factor);
        // The estimate is a lower bound, seldom below a third of the norm.
        let room = 3.0 * inverse;
        let (growth, longest) = factor.growth();
        let formed = FORMING * assembly.cancellation * norm;
        // Roundings of the longest sum, in the factor and in the two solves.
        let factored = 3.0 * roundings(longest + 1) * growth;
        let shift = T::ROUNDING * (formed + factored) * room;
        let error_bound = if shift < 0.5 { shift / (1.0 - shift) } else { f64::INFINITY };
        (Certificate { condition: norm * inverse, error_bound, extended }, room)
    }
}

/// Roundings of a sum of n products that count: all of a short one; of a long one sqrt(n) times a factor that they
/// exceed with probability 2 exp(-32), since they do not all have one sign.
///
/// # Source
/// Higham and Mary (2019), SIAM J. Sci. Comput. 41, theorem 2.4 with lambda = 8.
fn roundings(n: usize) -> f64 {
    let n = n as f64;
    n.min(8.0 * n.sqrt())
}

/// Lower bound, usually sharp, of the 1-norm of the inverse.
///
/// # Source
/// Higham (1988), ACM Trans. Math. Softw. 14, algorithm 4.1; Hager (1984), SIAM J. Sci. Stat. Comput. 5.
fn inverse_norm<T: Real>(factor: &Factor<T>) -> f64 {
    let n = factor.len();
    let solve = |x: &mut Vec<f64>| {
        let mut wide: Vec<T> = x.iter().map(|&value| T::from(value)).collect();
        factor.solve(&mut wide);
        x.iter_mut().zip(wide).for_each(|(x, value)| *x = value.double());
    };
    let one_norm = |x: &[f64]| x.iter().map(|v| v.abs()).sum::<f64>();
    let mut x = vec![1.0 / n as f64; n];
    solve(&mut x);
    let mut best = one_norm(&x);
    let mut last = usize::MAX;
    for _ in 0..5 {
        let mut z: Vec<f64> = x.iter().map(|v| if *v < 0.0 { -1.0 } else { 1.0 }).collect();
        solve(&mut z);
        let largest = (0..n).fold(0, |a, b| if z[b].abs() > z[a].abs() { b } else { a });
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
    let step = 1.0 / (n.max(2) - 1) as f64;
    let mut x: Vec<f64> =
        (0..n).map(|k| (1.0 + k as f64 * step) * if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
    solve(&mut x);
    best.max(2.0 * one_norm(&x) / (3.0 * n as f64))
}
