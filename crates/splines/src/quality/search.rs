//! Where a block is examined, and how an extreme is refined from the best of these places.

use crate::error::Error;

/// Largest number of parts into which an interval between breaks is divided.
const PARTS: usize = 16;
/// Breaks nearer to each other than this fraction of the range count as one.
const APART: f64 = 1e-9;
/// Halvings of the step before the search ends.
const HALVINGS: usize = 26;
/// Largest number of steps taken in all.
const STEPS: usize = 2000;

/// Places at which a block is examined: the `breaks` within `range`, its two ends, and equally many places in
/// each interval between them. Their number is at most about `most`; an interval has at most 16 parts. Where
/// there are more than `most` breaks, some are left out.
///
/// ```
/// use splines::quality::sample_places;
///
/// assert_eq!(sample_places(&[1.0, 5.0], [0.0, 2.0], 4), [0.0, 0.5, 1.0, 1.5, 2.0]);
/// ```
#[must_use]
pub fn sample_places(breaks: &[f64], range: [f64; 2], most: usize) -> Vec<f64> {
    let mut ends = breaks_within(breaks, range);
    if ends.len() > most.max(2) {
        let (last, keep) = (ends.len() - 1, most.max(2) - 1);
        ends = (0..=keep).map(|k| ends[k * last / keep]).collect();
    }
    let parts = (most / (ends.len() - 1).max(1)).clamp(1, PARTS);
    let mut out = Vec::with_capacity(parts * ends.len());
    for pair in ends.windows(2) {
        out.extend((0..parts).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / parts as f64));
    }
    out.extend(ends.last());
    out
}

/// The ends of `range` and the breaks strictly within it, increasing. Breaks that differ by rounding alone
/// occur once.
pub(super) fn breaks_within(breaks: &[f64], [first, last]: [f64; 2]) -> Vec<f64> {
    let apart = APART * (last - first);
    let mut sorted: Vec<f64> = breaks.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut out = vec![first];
    for x in sorted {
        if x - out[out.len() - 1] > apart && last - x > apart {
            out.push(x);
        }
    }
    out.push(last);
    out
}

/// Moves `at` to a local maximum of `f` near it, and returns the value there.
///
/// Compass search: from the best place so far, try a step in both senses along each coordinate and along the
/// diagonal on which all coordinates move alike, kept within `bounds`; take each step that increases `f`;
/// halve the step when none does, 26 times, to 3e-8 of its first length. It needs no derivative and follows
/// ridges along the coordinates and along that diagonal, where table readings have theirs.
///
/// # Errors
/// Those of `f`.
///
/// # Source
/// Kolda, Lewis, Torczon, Optimization by direct search, SIAM Review 45, 385-482 (2003).
pub(super) fn refine_maximum(
    f: impl Fn(&[f64]) -> Result<f64, Error>,
    at: &mut [f64],
    step: f64,
    bounds: [f64; 2],
) -> Result<f64, Error> {
    let n = at.len();
    let mut best = f(at)?;
    let (mut step, mut taken) = (step, 0);
    let mut trial = vec![0.0; n];
    for _ in 0..HALVINGS {
        let mut moved = true;
        while moved && taken < STEPS {
            moved = false;
            for direction in 0..2 * (n + 1) {
                let signed = if direction % 2 == 0 { step } else { -step };
                let axis = direction / 2;
                for (k, (t, a)) in trial.iter_mut().zip(at.iter()).enumerate() {
                    let moves = axis == n || axis == k;
                    *t = if moves {
                        (a + signed).clamp(bounds[0], bounds[1])
                    } else {
                        *a
                    };
                }
                let value = f(&trial)?;
                if value > best {
                    best = value;
                    at.copy_from_slice(&trial);
                    moved = true;
                    taken += 1;
                }
            }
        }
        step *= 0.5;
    }
    Ok(best)
}
