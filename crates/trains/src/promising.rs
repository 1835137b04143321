//! Pieces of the positions of several trains in which a value can be reached: the others are left out of a search.
//!
//! Let b be a bound of the response to a train in one of its pieces. For trains that stand one behind another, the most that
//! all trains up to this one reach, and the most that this one and all behind it reach, are
//!
//! before(j) = b(j) + max before(i),    behind(i) = b(i) + max behind(j)
//!
//! over the pieces i and j of neighbours in which there is room for both: i begins at least the least distance before j
//! ends. No arrangement with a train in a piece reaches more than before + behind - b.

use crate::plan::{CasePlan, Order};

/// Distances that count as rounding, relative to positions.
const ROUNDING: f64 = 1e-9;

/// A piece of the positions of a train in one stance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoundedPiece {
    pub position: [f64; 2],
    /// What the response to the train does not exceed in it.
    pub bound: f64,
    /// Its number in the list from which it was taken.
    pub index: usize,
}

/// The pieces of a train, increasing, by stance.
pub(crate) type BoundedPieces = Vec<(usize, Vec<BoundedPiece>)>;

impl CasePlan {
    /// Keeps the pieces that are part of an arrangement whose bound reaches `floor`; `all` has the pieces of each train.
    pub fn keep_promising(&self, all: &mut [BoundedPieces], floor: f64) {
        if floor == f64::NEG_INFINITY {
            return;
        }
        let most: Vec<f64> = all.iter().map(most_of).collect();
        let sum: f64 = most.iter().sum();
        for group in &self.groups {
            if group.orders[0].trains.len() < 2 || !group.orders.iter().all(Order::is_queue) {
                continue;
            }
            let own: f64 = group.orders[0]
                .trains
                .iter()
                .map(|&train| most[train])
                .sum();
            let least = floor - (sum - own);
            let mut kept: Vec<Vec<Vec<bool>>> = all
                .iter()
                .map(|own| {
                    own.iter()
                        .map(|(_, pieces)| vec![false; pieces.len()])
                        .collect()
                })
                .collect();
            for order in &group.orders {
                self.mark(order, all, least, &mut kept);
            }
            for &train in &group.orders[0].trains {
                for ((_, pieces), kept) in all[train].iter_mut().zip(&kept[train]) {
                    let mut kept = kept.iter();
                    pieces.retain(|_| *kept.next().expect("there is a mark for each piece"));
                }
            }
        }
    }

    /// Marks the pieces that are part of an arrangement of one order that reaches `least`.
    fn mark(&self, order: &Order, all: &[BoundedPieces], least: f64, kept: &mut [Vec<Vec<bool>>]) {
        let mut before: Vec<Vec<Vec<f64>>> = Vec::with_capacity(order.trains.len());
        for (k, &train) in order.trains.iter().enumerate() {
            let values = all[train].iter().map(|(stance, pieces)| {
                let mut sums = bounds(pieces);
                if k > 0 {
                    let last = order.trains[k - 1];
                    let mut most = vec![f64::NEG_INFINITY; pieces.len()];
                    for ((other, others), values) in all[last].iter().zip(&before[k - 1]) {
                        let distance = self.distance((last, *other), (train, *stance));
                        best_ahead(pieces, others, values, distance, &mut most);
                    }
                    sums.iter_mut()
                        .zip(most)
                        .for_each(|(sum, more)| *sum += more);
                }
                sums
            });
            before.push(values.collect());
        }
        let mut behind: Vec<Vec<f64>> = Vec::new();
        for (k, &train) in order.trains.iter().enumerate().rev() {
            let values = all[train].iter().map(|(stance, pieces)| {
                let mut sums = bounds(pieces);
                if let Some(&next) = order.trains.get(k + 1) {
                    let mut most = vec![f64::NEG_INFINITY; pieces.len()];
                    for ((other, others), values) in all[next].iter().zip(&behind) {
                        let distance = self.distance((train, *stance), (next, *other));
                        best_behind(pieces, others, values, distance, &mut most);
                    }
                    sums.iter_mut()
                        .zip(most)
                        .for_each(|(sum, more)| *sum += more);
                }
                sums
            });
            let values: Vec<Vec<f64>> = values.collect();
            let lists = all[train]
                .iter()
                .zip(kept[train].iter_mut())
                .zip(before[k].iter().zip(&values));
            for (((_, pieces), kept), (before, behind)) in lists {
                for (k, piece) in pieces.iter().enumerate() {
                    kept[k] |= before[k] + behind[k] - piece.bound >= least;
                }
            }
            behind = values;
        }
    }
}

/// The largest bound of the pieces of a train.
fn most_of(own: &BoundedPieces) -> f64 {
    own.iter()
        .flat_map(|(_, pieces)| pieces)
        .map(|piece| piece.bound)
        .fold(f64::NEG_INFINITY, f64::max)
}

fn bounds(pieces: &[BoundedPiece]) -> Vec<f64> {
    pieces.iter().map(|piece| piece.bound).collect()
}

/// Raises `most` to the largest of the values of `others` that begin at least `distance` before the end of each piece.
fn best_ahead(
    pieces: &[BoundedPiece],
    others: &[BoundedPiece],
    values: &[f64],
    distance: f64,
    most: &mut [f64],
) {
    let mut other = 0;
    let mut so_far = f64::NEG_INFINITY;
    for (piece, most) in pieces.iter().zip(most) {
        let end = piece.position[1] - distance;
        let end = end + ROUNDING * (end.abs() + distance.abs());
        while other < others.len() && others[other].position[0] <= end {
            so_far = so_far.max(values[other]);
            other += 1;
        }
        *most = most.max(so_far);
    }
}

/// Raises `most` to the largest of the values of `others` that end at least `distance` behind the start of each piece.
fn best_behind(
    pieces: &[BoundedPiece],
    others: &[BoundedPiece],
    values: &[f64],
    distance: f64,
    most: &mut [f64],
) {
    let mut other = others.len();
    let mut so_far = f64::NEG_INFINITY;
    for (piece, most) in pieces.iter().zip(most).rev() {
        let start = piece.position[0] + distance;
        let start = start - ROUNDING * (start.abs() + distance.abs());
        while other > 0 && others[other - 1].position[1] >= start {
            other -= 1;
            so_far = so_far.max(values[other]);
        }
        *most = most.max(so_far);
    }
}
