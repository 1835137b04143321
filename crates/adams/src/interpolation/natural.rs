//! Slopes of the natural cubic spline.

/// Slopes at the points, for x increasing and at least two points, such that second derivatives are continuous
/// and zero at both ends.
///
/// With h and m the length and slope of a chord, `-` before and `+` after a point:
/// t_-/h_- + 2 t (1/h_- + 1/h_+) + t_+/h_+ = 3 (m_-/h_- + m_+/h_+), and 2 t + t_+ = 3 m_+ at the first point
/// (mirrored at the last). Solved by elimination without pivots: the rows are diagonally dominant.
///
/// # Source
/// C. de Boor, A Practical Guide to Splines (2001), chapter IV.
pub(super) fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    if n < 2 {
        return vec![0.0; n];
    }
    let inverse: Vec<f64> = x.windows(2).map(|x| 1.0 / (x[1] - x[0])).collect();
    // 3 m / h of each chord.
    let load: Vec<f64> = inverse.iter().zip(y.windows(2)).map(|(v, y)| 3.0 * (y[1] - y[0]) * v * v).collect();
    let side = |k: Option<usize>, list: &[f64]| k.and_then(|k| list.get(k).copied()).unwrap_or(0.0);
    let mut diagonal: Vec<f64> = Vec::with_capacity(n);
    let mut right: Vec<f64> = Vec::with_capacity(n);
    for k in 0..n {
        let (before, after) = (side(k.checked_sub(1), &inverse), side(Some(k), &inverse));
        let mut d = 2.0 * (before + after);
        let mut r = side(k.checked_sub(1), &load) + side(Some(k), &load);
        if k > 0 {
            let factor = before / diagonal[k - 1];
            d -= factor * before;
            r -= factor * right[k - 1];
        }
        diagonal.push(d);
        right.push(r);
    }
    for k in (0..n).rev() {
        if k + 1 < n {
            right[k] -= inverse[k] * right[k + 1];
        }
        right[k] /= diagonal[k];
    }
    right
}
