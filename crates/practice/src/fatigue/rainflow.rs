//! Rainflow counting.

use crate::Error;
use crate::error::check_samples;

/// A cycle or half cycle of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// The values of its two turning points, the earlier first.
    pub ends: [f64; 2],
    /// The indices of their samples.
    pub samples: [usize; 2],
    /// One, or 0.5 for a half cycle.
    pub count: f64,
}

impl Cycle {
    /// The difference between its largest and smallest value.
    #[must_use]
    pub fn range(&self) -> f64 {
        (self.ends[0] - self.ends[1]).abs()
    }

    /// The mean of its turning points.
    #[must_use]
    pub fn mean(&self) -> f64 {
        0.5 * self.ends[0] + 0.5 * self.ends[1]
    }
}

/// How the residue is counted: the ranges that no larger range closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Repetition {
    /// The history occurs once; the ranges of the residue are half cycles.
    Once,
    /// The history is repeated. It is counted from its highest point through its end and beginning back to
    /// that point, so that every range closes. The largest range is reported as two half cycles.
    Repeated,
}

/// The value of a turning point and the index of its sample.
type Turn = (f64, usize);

/// The rainflow cycles of a history in the order in which they close; half cycles come last.
///
/// Of four successive turning points a, b, c, d the two in the middle form a cycle if |b - c| is at most |a -
/// b| and at most |c - d|. They are removed, and the test is repeated with the points that remain. Guarantee:
/// ranges and their counts are those of the three-point rule of E1049, 5.4.4.
///
/// # Errors
/// [`Error::Number`] for a sample that is not finite.
///
/// # Source
/// ASTM E1049-85, 5.4.4 (once) and 5.4.5 (repeated); the four-point rule: Amzallag, Gerey, Robert and
/// Bahuaud, Standardization of the rainflow counting method for fatigue analysis, Int. J. Fatigue 16, 287-293
/// (1994).
///
/// ```
/// use practice::{Repetition, rainflow};
///
/// // The small range of 2 is a whole cycle; the ranges of 5 and 6 around it are half cycles.
/// let cycles = rainflow(&[0.0, 5.0, 2.0, 4.0, -1.0], Repetition::Once)?;
/// let found: Vec<[f64; 2]> = cycles.iter().map(|cycle| [cycle.range(), cycle.count]).collect();
/// assert_eq!(found, [[2.0, 1.0], [5.0, 0.5], [6.0, 0.5]]);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn rainflow(values: &[f64], history: Repetition) -> Result<Vec<Cycle>, Error> {
    check_samples(0, values)?;
    let samples = values.iter().copied().zip(0..);
    let turns = match history {
        Repetition::Once => turning_points(samples),
        Repetition::Repeated => {
            let top =
                (0..values.len()).fold(0, |top, k| if values[k] > values[top] { k } else { top });
            let round = (top..values.len()).chain(0..values.len().min(top + 1));
            turning_points(round.map(|k| (values[k], k)))
        }
    };
    let mut cycles = Vec::new();
    let mut open: Vec<Turn> = Vec::new();
    for turn in turns {
        open.push(turn);
        while let [.., a, b, c, d] = open[..] {
            let inner = (b.0 - c.0).abs();
            if inner > (a.0 - b.0).abs() || inner > (c.0 - d.0).abs() {
                break;
            }
            cycles.push(cycle(b, c, 1.0));
            open.drain(open.len() - 3..open.len() - 1);
        }
    }
    cycles.extend(open.windows(2).map(|pair| cycle(pair[0], pair[1], 0.5)));
    Ok(cycles)
}

/// The ranges in increasing order as pairs of range and count; equal ranges are combined.
#[must_use]
pub fn ranges(cycles: &[Cycle]) -> Vec<[f64; 2]> {
    let mut pairs: Vec<[f64; 2]> = cycles
        .iter()
        .map(|cycle| [cycle.range(), cycle.count])
        .collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    pairs.dedup_by(|next, kept| {
        let same = next[0] == kept[0];
        kept[1] += if same { next[1] } else { 0.0 };
        same
    });
    pairs
}

/// The cycle between two turning points.
fn cycle(from: Turn, to: Turn, count: f64) -> Cycle {
    Cycle {
        ends: [from.0, to.0],
        samples: [from.1, to.1],
        count,
    }
}

/// The first and last sample and every turning point; of successive equal samples the first is taken.
fn turning_points(samples: impl Iterator<Item = Turn>) -> Vec<Turn> {
    let mut turns: Vec<Turn> = Vec::new();
    for sample in samples {
        match turns[..] {
            [.., last] if sample.0 == last.0 => continue,
            [.., before, last] if (last.0 > before.0) == (sample.0 > last.0) => {
                turns.pop();
            }
            _ => {}
        }
        turns.push(sample);
    }
    turns
}
