//! Piecewise cubic curves by values and slopes, with the slopes of Akima's rule and of the natural spline.

/// A curve given by values and slopes at points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct HermiteCurve {
    x: Vec<f64>,
    y: Vec<f64>,
    slopes: Vec<f64>,
    /// Whether the tangent continues the curve beyond its ends, instead of the parabola through the three
    /// points at that end.
    linear: bool,
}

impl HermiteCurve {
    /// A curve through at least three points with increasing x.
    pub fn new(x: &[f64], y: &[f64], slopes: Vec<f64>, linear: bool) -> HermiteCurve {
        HermiteCurve {
            x: x.to_vec(),
            y: y.to_vec(),
            slopes,
            linear,
        }
    }

    /// Whether x lies outside the points.
    pub fn beyond(&self, x: f64) -> bool {
        let (first, last) = (self.x.first(), self.x.last());
        first.is_some_and(|first| x < *first) || last.is_some_and(|last| x > *last)
    }

    /// The value and the first three derivatives at x; at a point between two pieces, those of the piece
    /// after it.
    pub fn derivatives(&self, x: f64) -> [f64; 4] {
        let n = self.x.len();
        if self.beyond(x) {
            let end = if x < self.x[0] { 0 } else { n - 1 };
            let [_, _, bend] = if self.linear {
                [0.0; 3]
            } else {
                self.parabola(end)
            };
            let slope = if self.linear {
                self.slopes[end]
            } else {
                self.parabola(end)[1]
            };
            let d = x - self.x[end];
            return [
                self.y[end] + d * (slope + d * bend),
                slope + 2.0 * d * bend,
                2.0 * bend,
                0.0,
            ];
        }
        let k = self.x.partition_point(|point| *point <= x).clamp(1, n - 1) - 1;
        let h = self.x[k + 1] - self.x[k];
        let (a, b) = (self.slopes[k], self.slopes[k + 1]);
        let chord = (self.y[k + 1] - self.y[k]) / h;
        // y = y_k + d (a + d (p + d q))
        let (p, q) = (
            (3.0 * chord - 2.0 * a - b) / h,
            (a + b - 2.0 * chord) / (h * h),
        );
        let d = x - self.x[k];
        [
            self.y[k] + d * (a + d * (p + d * q)),
            a + d * (2.0 * p + 3.0 * d * q),
            2.0 * p + 6.0 * d * q,
            6.0 * q,
        ]
    }

    /// The value, slope and half the second derivative, at an end, of the parabola through the three points
    /// there.
    fn parabola(&self, end: usize) -> [f64; 3] {
        let n = self.x.len();
        let [a, b, c] = if end == 0 {
            [0, 1, 2]
        } else {
            [n - 1, n - 2, n - 3]
        };
        let chord = |i: usize, j: usize| (self.y[j] - self.y[i]) / (self.x[j] - self.x[i]);
        let bend = (chord(b, c) - chord(a, b)) / (self.x[c] - self.x[a]);
        [
            self.y[a],
            chord(a, b) + bend * (self.x[a] - self.x[b]),
            bend,
        ]
    }
}

/// Slopes t at the points by Akima's rule, for increasing x and at least two points.
///
/// t_i = (|m_(i+1) - m_i| m_(i-1) + |m_(i-1) - m_(i-2)| m_i) / (|m_(i+1) - m_i| + |m_(i-1) - m_(i-2)|), where
/// m_i is the slope of the chord after point i. Beyond the ends the chord slopes are continued in arithmetic
/// progression. Where both weights are exactly zero, t_i = (m_(i-1) + m_i) / 2.
///
/// # Source
/// H. Akima, A new method of interpolation and smooth curve fitting based on local procedures, Journal of the
/// ACM 17(4), 1970, pages 589-602.
pub(super) fn akima_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let chords: Vec<f64> = x
        .windows(2)
        .zip(y.windows(2))
        .map(|(x, y)| (y[1] - y[0]) / (x[1] - x[0]))
        .collect();
    let (Some(&first), Some(&last)) = (chords.first(), chords.last()) else {
        return vec![0.0; x.len()];
    };
    let second = chords.get(1).copied().unwrap_or(first);
    let before = if chords.len() > 1 {
        chords[chords.len() - 2]
    } else {
        last
    };
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

/// Slopes t at the points of the natural cubic spline, for increasing x and at least two points: second
/// derivatives are continuous, and zero at both ends.
///
/// h and m are the length and slope of the chord before (`-`) and after (`+`) a point: t_-/h_- + 2 t (1/h_- +
/// 1/h_+) + t_+/h_+ = 3 (m_-/h_- + m_+/h_+), and 2 t + t_+ = 3 m_+ at the first point (likewise at the last).
/// The tridiagonal equations are diagonally dominant and are solved by elimination without pivoting.
///
/// # Source
/// C. de Boor, A Practical Guide to Splines (2001), chapter IV.
pub(super) fn natural_slopes(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    if n < 2 {
        return vec![0.0; n];
    }
    let inverse: Vec<f64> = x.windows(2).map(|x| 1.0 / (x[1] - x[0])).collect();
    // 3 m / h of each chord: the right-hand side is the sum over the chords at a point.
    let load: Vec<f64> = inverse
        .iter()
        .zip(y.windows(2))
        .map(|(v, y)| 3.0 * (y[1] - y[0]) * v * v)
        .collect();
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
