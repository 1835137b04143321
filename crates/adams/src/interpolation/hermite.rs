//! Piecewise cubics by values and slopes.

/// One curve: values and slopes at points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Hermite {
    x: Vec<f64>,
    y: Vec<f64>,
    slopes: Vec<f64>,
    /// Beyond the ends the tangent; otherwise the parabola through the three points at that end.
    linear: bool,
}

impl Hermite {
    /// For at least three points, x increasing.
    pub fn new(x: &[f64], y: &[f64], slopes: Vec<f64>, linear: bool) -> Hermite {
        Hermite { x: x.to_vec(), y: y.to_vec(), slopes, linear }
    }

    /// Whether x lies outside the points.
    pub fn beyond(&self, x: f64) -> bool {
        let (first, last) = (self.x.first(), self.x.last());
        first.is_some_and(|first| x < *first) || last.is_some_and(|last| x > *last)
    }

    /// Value and three derivatives. At a point where pieces meet, of the piece after it.
    pub fn derivatives(&self, x: f64) -> [f64; 4] {
        let n = self.x.len();
        if self.beyond(x) {
            let end = if x < self.x[0] { 0 } else { n - 1 };
            let [_, _, bend] = if self.linear { [0.0; 3] } else { self.parabola(end) };
            let slope = if self.linear { self.slopes[end] } else { self.parabola(end)[1] };
            let d = x - self.x[end];
            return [self.y[end] + d * (slope + d * bend), slope + 2.0 * d * bend, 2.0 * bend, 0.0];
        }
        let k = self.x.partition_point(|point| *point <= x).clamp(1, n - 1) - 1;
        let h = self.x[k + 1] - self.x[k];
        let (a, b) = (self.slopes[k], self.slopes[k + 1]);
        let chord = (self.y[k + 1] - self.y[k]) / h;
        // y = y_k + d (a + d (p + d q))
        let (p, q) = ((3.0 * chord - 2.0 * a - b) / h, (a + b - 2.0 * chord) / (h * h));
        let d = x - self.x[k];
        [
            self.y[k] + d * (a + d * (p + d * q)),
            a + d * (2.0 * p + 3.0 * d * q),
            2.0 * p + 6.0 * d * q,
            6.0 * q,
        ]
    }

    /// Value, slope and half the second derivative, at an end, of the parabola through its three points.
    fn parabola(&self, end: usize) -> [f64; 3] {
        let n = self.x.len();
        let [a, b, c] = if end == 0 { [0, 1, 2] } else { [n - 1, n - 2, n - 3] };
        let chord = |i: usize, j: usize| (self.y[j] - self.y[i]) / (self.x[j] - self.x[i]);
        let bend = (chord(b, c) - chord(a, b)) / (self.x[c] - self.x[a]);
        [self.y[a], chord(a, b) + bend * (self.x[a] - self.x[b]), bend]
    }
}
