//! Cells of the rails of a structure, in which influence lines are cubics.

use super::bounds::Bounds;

/// Distance from an end of a cell, relative to its coordinate plus 1, within which a load is at it: the slack with which the step
/// of a rolling wheel ends there, for accuracies up to 1e-2.
const AT_END: f64 = 4e-6;

/// Distance from the ends of a cell at which loads are held, relative to the length of the longest cell beside: within 1e-9 of the
/// length of a member a load would count on both members.
const INSIDE: f64 = 1.5e-9;

/// Places that are nearer to each other than this part of a rail are one.
const SAME: f64 = 1e-12;

/// Distance from an end within which a load is at it.
fn slack(x: f64) -> f64 {
    AT_END * (1.0 + x.abs())
}

/// The cells of the rails of a structure.
pub(crate) struct RailCells {
    /// By rail: the increasing coordinates between which the cells lie, and the distance from each that is inside.
    ends: Vec<Vec<(f64, f64)>>,
}

/// A cell of a rail: the rail, and the number of ends before it.
pub(crate) type Cell = (usize, usize);

impl RailCells {
    /// The cells of `rails` rails between places by rail and coordinate. Of those of `more` that are within the slack of steps from
    /// one of `ends` this one counts.
    pub fn new(rails: usize, ends: &[(usize, f64)], more: &[(usize, f64)]) -> RailCells {
        let of_rail = |rail: usize| {
            let on = |all: &[(usize, f64)]| -> Vec<f64> {
                all.iter()
                    .filter(|(of, _)| *of == rail)
                    .map(|(_, x)| *x)
                    .collect()
            };
            let mut all = on(ends);
            let is_apart = |x: &f64| all.iter().all(|end| (end - x).abs() > slack(*x));
            let more: Vec<f64> = on(more).into_iter().filter(is_apart).collect();
            all.extend(more);
            all.sort_by(f64::total_cmp);
            let length = all
                .last()
                .zip(all.first())
                .map_or(0.0, |(last, first)| last - first);
            all.dedup_by(|b, a| *b - *a <= SAME * length);
            let length = |k: usize| all.get(k + 1).map_or(0.0, |next| next - all[k]);
            let gap = |k: usize| INSIDE * length(k).max(k.checked_sub(1).map_or(0.0, length));
            (0..all.len()).map(|k| (all[k], gap(k))).collect()
        };
        RailCells {
            ends: (0..rails).map(of_rail).collect(),
        }
    }

    /// The place of a load, held just inside of its cell.
    pub fn hold(&self, cell: Cell, x: f64) -> f64 {
        let [low, high] = self.inside(cell);
        x.max(low).min(high)
    }

    /// The cell of a coordinate.
    pub fn of(&self, rail: usize, x: f64) -> Cell {
        let ends = &self.ends[rail];
        let number = ends.partition_point(|(end, _)| *end <= x);
        // a load that rests at an end of the rail is on it
        (rail, number.clamp(1, ends.len().max(2) - 1))
    }

    /// The coordinates just inside of a cell, between which loads are held.
    pub fn inside(&self, cell: Cell) -> [f64; 2] {
        self.with_gap(cell, 1.0)
    }

    /// The ends of a cell.
    pub fn ends(&self, cell: Cell) -> [f64; 2] {
        self.with_gap(cell, 0.0)
    }

    fn with_gap(&self, (rail, number): Cell, factor: f64) -> [f64; 2] {
        let ends = &self.ends[rail];
        let low = number
            .checked_sub(1)
            .map(|k| ends[k].0 + factor * ends[k].1);
        let high = ends.get(number).map(|(end, gap)| end - factor * gap);
        [
            low.unwrap_or(f64::NEG_INFINITY),
            high.unwrap_or(f64::INFINITY),
        ]
    }

    /// The ends that lie between two coordinates by more than the slack of steps.
    pub fn between(
        &self,
        rail: usize,
        Bounds { low, high }: Bounds,
    ) -> impl Iterator<Item = f64> + '_ {
        let ends = &self.ends[rail];
        let first = ends.partition_point(|(end, _)| *end <= low);
        let inside = ends[first..]
            .iter()
            .map(|(end, _)| *end)
            .take_while(move |end| *end < high);
        inside.filter(move |end| {
            let slack = slack(*end);
            end - low > slack && high - end > slack
        })
    }
}
