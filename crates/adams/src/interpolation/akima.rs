//! Slopes by Akima's rule.

/// Slopes t at the points, for x increasing and at least two points.
///
/// t_i = (|m_(i+1) - m_i| m_(i-1) + |m_(i-1) - m_(i-2)| m_i) / (|m_(i+1) - m_i| + |m_(i-1) - m_(i-2)|), where
/// m_i is the slope of the chord after point i; beyond the ends chords go on in arithmetic progression. Where
/// both weights are exactly zero, t_i = (m_(i-1) + m_i) / 2.
///
/// # Source
/// H. Akima, A new method of interpolation and smooth curve fitting based on local procedures, Journal of the
/// ACM 17(4), 1970, pages 589-602.
pub(super) fn slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let chords: Vec<f64> =
        x.windows(2).zip(y.windows(2)).map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0])).collect();
    let (Some(&first), Some(&last)) = (chords.first(), chords.last()) else {
        return vec![0.0; x.len()];
    };
    let second = chords.get(1).copied().unwrap_or(first);
    let before = if chords.len() > 1 { chords[chords.len() - 2] } else { last };
    let mut all = vec![3.0 * first - 2.0 * second, 2.0 * first - second];
    all.extend(&chords);
    all.extend([2.0 * last - before, 3.0 * last - 2.0 * before]);
    all.windows(4)
        .map(|m| {
            let (right, left) = ((m[3] - m[2]).abs(), (m[1] - m[0]).abs());
            if right + left == 0.0 {
                0.5 * (m[1] + m[2])
            } else {
                (right * m[1] + left * m[2]) / (right + left)
            }
        })
        .collect()
}
