//! Rainflow counting.

use crate::Error;
use crate::error::usable;

/// A cycle, or half of one, of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Its two turning points, the earlier first.
    pub ends: [f64; 2],
    /// Which samples they are.
    pub samples: [usize; 2],
    /// 1, or 0.5 for a half.
    pub count: f64,
}

impl Cycle {
    /// Largest less smallest value.
    #[must_use]
    pub fn range(&self) -> f64 {
        (self.ends[0] - self.ends[1]).abs()
    }

    /// Halfway between them.
    #[must_use]
    pub fn mean(&self) -> f64 {
        0.5 * self.ends[0] + 0.5 * self.ends[1]
    }
}

/// What becomes of the ranges that no larger one closes, the residue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum History {
    /// The history happens once: they are halves of cycles.
    Once,
    /// The history follows itself again and again: it is counted from its highest point round to that point
    /// again, and every range closes. The largest range comes as two halves.
    Repeated,
}

/// A turning point and its sample.
type Turn = (f64, usize);

/// Every cycle of a history, in the order in which they close; halves last.
///
/// Of four successive turning points a, b, c, d the two in the middle make a cycle if |b - c| is neither more
/// than |a - b| nor more than |c - d|; they are taken out and the search goes on. Guarantee: ranges and their
/// counts are those of the three-point rule of E1049, 5.4.4.
///
/// # Errors
/// A sample that is not finite.
///
/// # Source
/// ASTM E1049-85, 5.4.4 (once) and 5.4.5 (repeated); the four-point rule: Amzallag, Gerey, Robert and Bahuaud,
/// Standardization of the rainflow counting method for fatigue analysis, Int. J. Fatigue 16, 287-293 (1994).
pub fn rainflow(values: &[f64], history: History) -> Result<Vec<Cycle>, Error> {
    usable(0, values)?;
    let samples = values.iter().copied().zip(0..);
    let turns = match history {
        History::Once => turning_points(samples),
        History::Repeated => {
            let top = (0..values.len()).fold(0, |top, k| if values[k] > values[top] { k } else { top });
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

/// Ranges in rising order, equal ones together: pairs of range and count.
#[must_use]
pub fn ranges(cycles: &[Cycle]) -> Vec<[f64; 2]> {
    let mut pairs: Vec<[f64; 2]> = cycles.iter().map(|cycle| [cycle.range(), cycle.count]).collect();
    pairs.sort_by(|a, b| a[0].total_cmp(&b[0]));
    pairs.dedup_by(|next, kept| {
        let same = next[0] == kept[0];
        kept[1] += if same { next[1] } else { 0.0 };
        same
    });
    pairs
}

fn cycle(from: Turn, to: Turn, count: f64) -> Cycle {
    Cycle { ends: [from.0, to.0], samples: [from.1, to.1], count }
}

/// First and last sample and every one where the history turns; of equal ones in a row the first.
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
