//! Peaks of values that are known row by row, and their refinement between the rows.

/// The highest peak of a sequence of values at consecutive rows.
///
/// A peak is a row whose neighbours are not higher. Peaks are compared by the vertex of the parabola through the three
/// values, so that of two peaks between the rows the higher one is found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Peak {
    /// Row of the last value, and the last two values.
    last: usize,
    values: [f64; 2],
    is_started: bool,
    /// Height of the highest vertex, its row, and the value there.
    pub height: f64,
    pub row: usize,
    pub value: f64,
}

impl Default for Peak {
    fn default() -> Peak {
        Peak {
            last: 0,
            values: [f64::NEG_INFINITY; 2],
            is_started: false,
            height: f64::NEG_INFINITY,
            row: 0,
            value: f64::NEG_INFINITY,
        }
    }
}

impl Peak {
    /// Adds the value of a row; rows that are left out separate sequences.
    pub fn add(&mut self, row: usize, value: f64) {
        if self.is_started && row != self.last + 1 {
            self.finish();
        }
        if self.is_started {
            self.offer(value);
        }
        self.values = [self.values[1], value];
        (self.last, self.is_started) = (row, true);
    }

    /// Ends the sequence.
    pub fn finish(&mut self) {
        if self.is_started {
            self.offer(f64::NEG_INFINITY);
        }
        self.values = [f64::NEG_INFINITY; 2];
        self.is_started = false;
    }

    /// Considers the last value, now that the next one is known.
    fn offer(&mut self, next: f64) {
        let [before, own] = self.values;
        if before > own || next > own {
            return;
        }
        let curvature = 2.0 * own - before - next;
        let bulge = if curvature.is_finite() && curvature > 0.0 {
            (next - before).powi(2) / (8.0 * curvature)
        } else {
            0.0
        };
        if own + bulge > self.height {
            (self.height, self.row, self.value) = (own + bulge, self.last, own);
        }
    }
}

/// Ratio of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The largest value of `function` between two places by golden section, with its place, after `count` evaluations.
/// The ends count.
pub(super) fn largest(ends: [f64; 2], count: usize, function: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
    let [mut a, mut b] = ends;
    let mut best = (function(a), a);
    let offer = |best: &mut (f64, f64), value: f64, place: f64| {
        if value > best.0 {
            *best = (value, place);
        }
    };
    let value = function(b);
    offer(&mut best, value, b);
    if b - a <= 0.0 {
        return best;
    }
    let mut inner = [b - GOLDEN * (b - a), a + GOLDEN * (b - a)];
    let mut values = inner.map(&mut *function);
    for _ in 0..count {
        if values[0] >= values[1] {
            b = inner[1];
            (inner[1], values[1]) = (inner[0], values[0]);
            inner[0] = b - GOLDEN * (b - a);
            values[0] = function(inner[0]);
        } else {
            a = inner[0];
            (inner[0], values[0]) = (inner[1], values[1]);
            inner[1] = a + GOLDEN * (b - a);
            values[1] = function(inner[1]);
        }
    }
    offer(&mut best, values[0], inner[0]);
    offer(&mut best, values[1], inner[1]);
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Analytic: of two equal waves the one whose crest lies between rows has the lower rows.
    #[test]
    fn the_higher_of_two_crests_is_found_between_rows() {
        let mut peak = Peak::default();
        let wave = |x: f64, height: f64| height - x * x;
        for (row, x) in [-1.0, 0.0, 1.0].into_iter().enumerate() {
            peak.add(row, wave(x, 1.0));
        }
        for (row, x) in [-1.5, -0.5, 0.5, 1.5].into_iter().enumerate() {
            peak.add(3 + row, wave(x, 1.1));
        }
        peak.finish();
        assert!((peak.height - 1.1).abs() < 1e-12 && (peak.row == 4 || peak.row == 5), "{peak:?}");
    }

    /// Analytic: the vertex of a parabola.
    #[test]
    fn golden_section_finds_a_vertex() {
        let (value, place) = largest([0.0, 2.0], 30, &mut |x| 3.0 - (x - 0.7).powi(2));
        assert!((place - 0.7).abs() < 1e-5 && (value - 3.0).abs() < 1e-10);
    }
}
