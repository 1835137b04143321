//! The rows of a long history that are needed for extremes: where loads change evenly a few of them tell as much as all.

/// Factor by which the tolerance is raised.
const RAISED: f64 = 2.0;

/// Channels of one kind, compared with the largest magnitude of any of them.
struct Kind {
    channels: Vec<usize>,
    size: f64,
}

/// Indices of samples, the first and the last included, between which all channels of `kinds` differ from straight lines
/// over time, channel 0, by no more than `tolerance` times the largest magnitude of their kind. The tolerance is raised
/// until there are no more than `most`.
///
/// From each sample that is kept the cone of straight lines that pass near all samples behind it is narrowed one by one;
/// the last one whose values lie in the cone is kept next.
///
/// # Source
/// Williams, Bounded straight-line approximation of digitized planar curves and lines, Computer Graphics and Image
/// Processing 16 (1981), 370.
pub(super) fn kept_rows(
    samples: &[&[f64]],
    kinds: Vec<Vec<usize>>,
    mut tolerance: f64,
    most: usize,
) -> Vec<usize> {
    let kind = |channels: Vec<usize>| {
        let size = |row: &&[f64]| {
            channels
                .iter()
                .fold(0.0, |most: f64, c| most.max(row[*c].abs()))
        };
        let size = samples.iter().map(size).fold(0.0, f64::max);
        Kind { channels, size }
    };
    let kinds: Vec<Kind> = kinds.into_iter().map(kind).collect();
    loop {
        let kept = within(samples, &kinds, tolerance);
        if kept.len() <= most || tolerance >= 1.0 {
            return kept;
        }
        tolerance *= RAISED;
    }
}

/// The rows that a tolerance keeps.
fn within(samples: &[&[f64]], kinds: &[Kind], tolerance: f64) -> Vec<usize> {
    let mut kept = vec![0];
    let mut cone = Cone::new(kinds);
    let mut row = 1;
    while row < samples.len() {
        let first = kept[kept.len() - 1];
        if row == first + 1 || cone.contains(kinds, samples[first], samples[row]) {
            cone.narrow(kinds, tolerance, samples[first], samples[row]);
            row += 1;
        } else {
            kept.push(row - 1);
            cone = Cone::new(kinds);
        }
    }
    if samples.len() > 1 {
        kept.push(samples.len() - 1);
    }
    kept
}

/// Least and largest slope by channel of the lines from a row that pass near all rows behind it.
struct Cone {
    slopes: Vec<[f64; 2]>,
}

impl Cone {
    fn new(kinds: &[Kind]) -> Cone {
        let count = kinds.iter().map(|kind| kind.channels.len()).sum();
        Cone {
            slopes: vec![[f64::NEG_INFINITY, f64::INFINITY]; count],
        }
    }

    /// Whether the line from row `a` to row `b` is in the cone.
    fn contains(&self, kinds: &[Kind], a: &[f64], b: &[f64]) -> bool {
        let channels = kinds.iter().flat_map(|kind| &kind.channels);
        channels.zip(&self.slopes).all(|(&c, [least, most])| {
            let slope = (b[c] - a[c]) / (b[0] - a[0]);
            *least <= slope && slope <= *most
        })
    }

    /// Leaves out the lines from row `a` that pass too far from row `b`.
    fn narrow(&mut self, kinds: &[Kind], tolerance: f64, a: &[f64], b: &[f64]) {
        let channels = kinds
            .iter()
            .flat_map(|kind| kind.channels.iter().map(|c| (*c, tolerance * kind.size)));
        for ((c, allowed), [least, most]) in channels.zip(&mut self.slopes) {
            let duration = b[0] - a[0];
            *least = least.max((b[c] - a[c] - allowed) / duration);
            *most = most.min((b[c] - a[c] + allowed) / duration);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(samples: &[[f64; 3]], tolerance: f64, most: usize) -> Vec<usize> {
        let samples: Vec<&[f64]> = samples.iter().map(|sample| &sample[..]).collect();
        kept_rows(&samples, vec![vec![1], vec![2]], tolerance, most)
    }

    /// Analytic: a chord of length L differs from t^2 by L^2/4 at most, so that of samples h apart every k-th is kept, k the
    /// largest even number up to 2 sqrt(tolerance)/h where k + 1 is too many. Of a straight line only the ends are kept.
    #[test]
    fn of_a_parabola_as_many_rows_are_kept_as_its_chords_need() {
        let parabola = |k: i32| {
            let t = f64::from(k) * 1e-3;
            [t, t * t, 3.0 - 2.0 * t]
        };
        let samples: Vec<[f64; 3]> = (0..=1000).map(parabola).collect();
        let expected: Vec<usize> = (0..=1000).step_by(20).collect();
        // 10 * 10 is within the tolerance, 10 * 11 is not
        assert_eq!(rows(&samples, 1.02e-4, 1000), expected);
        // the second doubling of the tolerance allows 20 * 20
        assert_eq!(
            rows(&samples, 1.02e-4, 30),
            (0..=1000).step_by(40).collect::<Vec<_>>()
        );
        let line: Vec<[f64; 3]> = samples
            .iter()
            .map(|[t, _, line]| [*t, 0.0, *line])
            .collect();
        assert_eq!(rows(&line, 1e-9, 1000), [0, 1000]);
    }

    /// The claim itself, of uneven samples of two waves of different size: between the rows that are kept, straight lines
    /// differ from every sample by no more than the tolerance times the size of the wave.
    #[test]
    fn rows_that_are_left_out_lie_near_straight_lines() {
        let wave = |k: i32| {
            let t = 0.01 * f64::from(k) + 0.004 * f64::from(k * k % 7);
            [
                t,
                (5.0 * t).sin(),
                40.0 * (3.0 * t).cos() + if t > 2.0 { 30.0 } else { 0.0 },
            ]
        };
        let samples: Vec<[f64; 3]> = (0..500).map(wave).collect();
        for tolerance in [1e-3, 1e-2, 0.1] {
            let kept = rows(&samples, tolerance, usize::MAX);
            assert!(kept.len() < 450, "{} rows for {tolerance}", kept.len());
            for pair in kept.windows(2) {
                let [from, to] = [samples[pair[0]], samples[pair[1]]];
                for sample in &samples[pair[0]..=pair[1]] {
                    for (c, size) in [(1, 1.0), (2, 70.0)] {
                        let line =
                            from[c] + (to[c] - from[c]) * (sample[0] - from[0]) / (to[0] - from[0]);
                        let error = (line - sample[c]).abs();
                        assert!(
                            error <= 1.0001 * tolerance * size,
                            "{error} in {c} at {}",
                            sample[0]
                        );
                    }
                }
            }
        }
    }
}
