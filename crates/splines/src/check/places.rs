//! Where a surface is looked at.

use crate::Table;

/// Most parts of an interval between breaks.
const PARTS: usize = 16;
/// Breaks nearer than this share of the range are one.
const APART: f64 = 1e-9;
/// A row that small beside the table's largest entry is a support's.
const ZERO: f64 = 1e-12;

/// The breaks within `range` and its ends, with equally many places between each two: at most about `most`
/// in all, at most 16 parts an interval. Of more than `most` breaks some are left out.
#[must_use]
pub fn places(breaks: &[f64], range: [f64; 2], most: usize) -> Vec<f64> {
    let mut ends = restricted(breaks, range);
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

/// Breaks strictly within `range`, sorted, between its ends; those that differ by rounding alone once.
#[must_use]
pub fn restricted(breaks: &[f64], [first, last]: [f64; 2]) -> Vec<f64> {
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

/// Stations along z whose rows are zero (below 1e-12 of the table's largest entry): rigid supports.
#[must_use]
pub fn supports(table: &Table) -> Vec<f64> {
    let zero = ZERO * table.values().amax();
    let still = |i: &usize| table.values().row(*i).amax() <= zero;
    (0..table.z().len()).filter(still).map(|i| table.z()[i]).collect()
}
