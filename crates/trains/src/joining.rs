//! Joins cells of influence lines over which all responses are straight up to rounding.
//!
//! Influence lines of a continuous girder die out by a factor of nearly four with each span, and normal forces change
//! linearly: thirty spans away from a section one cell tells as much as all, and a train there need not be looked at span by
//! span. So the work for one section does not grow with the length of the rail.
//!
//! A run of cells is joined while one straight line through its first value stays within a limit of every response at both
//! ends of every cell. Each end narrows the interval of slopes; the run ends where none is left.
//!
//! # Source
//! The swing filter of Elmeleegy, Elmagarmid, Cecchet, Aref, Zwaenepoel, Online piece-wise linear approximation of
//! numerical streams with precision guarantees, VLDB 2009, section 3.

use std::ops::Range;

use crate::line::{LineCell, Lines, value_of_cubic};
use crate::rail_deflection::{CarrierLines, POWERS};
use crate::structure::{Carrier, GirderResponse, QUANTITIES, Structure, Tip};
use crate::train::COMPONENTS;

/// Differences below this fraction of the largest ordinate of a response are its rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
/// Differences below this fraction of the largest ordinate of any response are negligible for all: rounding of large
/// responses appears in small ones where members are inclined.
const NEGLIGIBLE: f64 = 1e-17;
/// Distance from an end of a cell, relative to its length, that is rounding.
const END: f64 = 1e-9;

/// The largest allowed difference by component and response.
type Limits<const N: usize> = [[f64; N]; COMPONENTS];

impl<const N: usize> Lines<N> {
    /// The differences that are rounding. `units` are the sizes in which the responses are compared with each other.
    fn limits(&self, units: [f64; N]) -> Limits<N> {
        let mut limits: Limits<N> = [[0.0; N]; COMPONENTS];
        for (component, limits) in limits.iter_mut().enumerate() {
            for cell in self.rails.iter().flatten() {
                for (size, cubic) in limits.iter_mut().zip(&cell.cubics[component]) {
                    *size = f64::max(*size, size_of_cubic(cubic, cell.x));
                }
            }
            let all = limits
                .iter()
                .zip(units)
                .map(|(size, unit)| size / unit)
                .fold(0.0, f64::max);
            for (limit, unit) in limits.iter_mut().zip(units) {
                *limit = (ROUNDING * *limit).max(NEGLIGIBLE * all * unit);
            }
        }
        limits
    }
}

/// A bound of the size of a cubic over a cell.
fn size_of_cubic(cubic: &[f64; 4], x: [f64; 2]) -> f64 {
    cubic
        .iter()
        .rev()
        .fold(0.0, |sum, c| sum * (x[1] - x[0]) + c.abs())
}

/// Neighbouring cells of N responses that can be joined.
#[derive(Clone, Debug)]
struct Run<const N: usize> {
    /// Coordinate and values at the beginning of the first cell.
    start: f64,
    values: [[f64; N]; COMPONENTS],
    /// Least and largest slopes of lines that stay within the limits.
    slopes: [[[f64; 2]; N]; COMPONENTS],
}

impl<const N: usize> Run<N> {
    /// A run that begins with a cell; `None` where the cell itself is not straight.
    fn from(cell: &LineCell<N>, limits: &Limits<N>) -> Option<Run<N>> {
        let empty = Run {
            start: cell.x[0],
            values: cell.cubics.map(|cubics| cubics.map(|cubic| cubic[0])),
            slopes: [[[f64::NEG_INFINITY, f64::INFINITY]; N]; COMPONENTS],
        };
        empty.with(cell, limits)
    }

    /// The run with the next cell; `None` where no line serves both.
    fn with(&self, cell: &LineCell<N>, limits: &Limits<N>) -> Option<Run<N>> {
        let mut run = self.clone();
        let h = cell.x[1] - cell.x[0];
        let cubics = cell.cubics.iter().flatten().zip(limits.iter().flatten());
        let lines = run
            .values
            .iter()
            .flatten()
            .zip(run.slopes.iter_mut().flatten());
        for ((cubic, limit), (first, [least, most])) in cubics.zip(lines) {
            // The cubic less its chord is t (t - h) (c + d (t + h)).
            let [_, _, c, d] = *cubic;
            let bend = 0.25 * h * h * (c + d * h).abs().max((c + 2.0 * d * h).abs());
            if bend > 0.5 * limit {
                return None;
            }
            for (x, value) in [(cell.x[0], cubic[0]), (cell.x[1], value_of_cubic(cubic, h))] {
                let (d, rise) = (x - run.start, value - first);
                if d > 0.0 {
                    *least = least.max((rise - 0.5 * limit) / d);
                    *most = most.min((rise + 0.5 * limit) / d);
                }
            }
            if *least > *most {
                return None;
            }
        }
        Some(run)
    }

    /// The cell that takes the place of all up to a coordinate.
    fn cell(&self, end: f64) -> LineCell<N> {
        let line = |value: f64, [least, most]: [f64; 2]| [value, 0.5 * (least + most), 0.0, 0.0];
        let cubics = std::array::from_fn(|component| {
            std::array::from_fn(|k| line(self.values[component][k], self.slopes[component][k]))
        });
        LineCell {
            x: [self.start, end],
            stretch: None,
            begins_inside: false,
            cubics,
        }
    }
}

/// Neighbouring cells, and what joins them; without that, a single cell that is kept.
type Joined<R> = (Range<usize>, Option<R>);

/// The runs of `count` cells, in order: `begin` makes a run of one cell, if it can be joined at all, `extend` adds the next.
fn runs<R>(
    count: usize,
    begin: impl Fn(usize) -> Option<R>,
    extend: impl Fn(&R, usize) -> Option<R>,
) -> Vec<Joined<R>> {
    let mut out: Vec<Joined<R>> = Vec::new();
    for cell in 0..count {
        if let Some((range, Some(run))) = out.last_mut()
            && let Some(longer) = extend(run, cell)
        {
            (range.end, *run) = (cell + 1, longer);
            continue;
        }
        out.push((cell..cell + 1, begin(cell)));
    }
    out
}

/// The cells with each run of several replaced by one.
fn replaced<const N: usize, R>(
    cells: &[LineCell<N>],
    runs: &[Joined<R>],
    own: impl Fn(&R) -> &Run<N>,
) -> Vec<LineCell<N>> {
    let of = |(range, run): &Joined<R>| match run {
        Some(run) if range.len() > 1 => own(run).cell(cells[range.end - 1].x[1]),
        _ => cells[range.start].clone(),
    };
    runs.iter().map(of).collect()
}

impl Lines<1> {
    /// The line with its straight runs joined, which end at `tips`.
    pub fn joined(self, tips: &[Tip]) -> Lines<1> {
        let limits = self.limits([1.0]);
        let rails = self.rails.iter().enumerate().map(|(rail, cells)| {
            let begin = |i: usize| Run::from(&cells[i], &limits);
            let extend = |run: &Run<1>, i: usize| {
                let [from, to] = cells[i].x;
                let near = |tip: &Tip| (tip.x - from).abs() <= END * (to - from);
                let ends = tips.iter().any(|tip| tip.rail == rail && near(tip));
                if ends {
                    None
                } else {
                    run.with(&cells[i], &limits)
                }
            };
            let runs = runs(cells.len(), begin, extend);
            replaced(cells, &runs, |run| run)
        });
        Lines {
            rails: rails.collect(),
        }
    }
}

impl CarrierLines {
    /// The lines with their straight runs joined, the same ones of forces and deflections. Cells on the member of the
    /// carrier are kept, because loads that have been passed are added there.
    pub fn joined(mut self, structure: &Structure, carrier: &Carrier) -> CarrierLines {
        let own: Vec<usize> = structure
            .on_member(carrier)
            .map(|on| on.other.stretch)
            .collect();
        let is_moment = |k: usize| {
            k == GirderResponse::Torsion as usize || GirderResponse::ALL[k].slope().is_some()
        };
        let units = std::array::from_fn(|k| if is_moment(k) { carrier.length } else { 1.0 });
        let limits = self.forces.limits(units);
        let of_deflections = self
            .deflections
            .each_ref()
            .map(|lines| lines.as_ref().map(|l| l.limits([1.0; POWERS])));
        for rail in 0..self.forces.rails.len() {
            let forces = &self.forces.rails[rail];
            let deflections: Vec<_> = self
                .deflections
                .iter()
                .flatten()
                .zip(of_deflections.iter().flatten())
                .collect();
            let other = |i: usize| {
                let cell = &forces[i];
                (!cell.stretch.is_some_and(|stretch| own.contains(&stretch))).then_some(cell)
            };
            let begin = |i: usize| {
                let first = Run::from(other(i)?, &limits)?;
                let others = deflections
                    .iter()
                    .map(|(lines, limits)| Run::from(&lines.rails[rail][i], limits));
                Some((first, others.collect::<Option<Vec<_>>>()?))
            };
            let extend = |(first, others): &(Run<QUANTITIES>, Vec<Run<POWERS>>), i: usize| {
                let first = first.with(other(i)?, &limits)?;
                let others = others.iter().zip(&deflections);
                let others =
                    others.map(|(run, (lines, limits))| run.with(&lines.rails[rail][i], limits));
                Some((first, others.collect::<Option<Vec<_>>>()?))
            };
            let runs = runs(forces.len(), begin, extend);
            self.forces.rails[rail] = replaced(forces, &runs, |run| &run.0);
            for (index, lines) in self.deflections.iter_mut().flatten().enumerate() {
                lines.rails[rail] = replaced(&lines.rails[rail], &runs, |run| &run.1[index]);
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One response by pieces, each its ends, its value at the beginning and its slope.
    fn line(pieces: &[([f64; 2], [f64; 4])]) -> Lines<1> {
        let cell = |(index, (x, cubic)): (usize, &([f64; 2], [f64; 4]))| {
            let mut cubics = [[[0.0; 4]; 1]; COMPONENTS];
            cubics[1][0] = *cubic;
            LineCell {
                x: *x,
                stretch: Some(index),
                begins_inside: false,
                cubics,
            }
        };
        Lines {
            rails: vec![pieces.iter().enumerate().map(cell).collect()],
        }
    }

    #[test]
    fn straight_runs_become_one_cell_and_others_stay() {
        let found = line(&[
            ([0.0, 1.0], [1.0, 0.5, 0.0, 0.0]),
            ([1.0, 3.0], [1.5, 0.5, 1e-18, 0.0]),
            ([3.0, 4.0], [2.5, -2.0, 0.7, 0.0]),
            ([4.0, 5.0], [1e-17, -1e-17, 0.0, 0.0]),
            ([5.0, 7.0], [0.0, 2e-18, 0.0, 0.0]),
        ])
        .joined(&[]);
        let cells = &found.rails[0];
        assert_eq!(
            cells.iter().map(|cell| cell.x).collect::<Vec<_>>(),
            [[0.0, 3.0], [3.0, 4.0], [4.0, 7.0]]
        );
        assert_eq!(
            cells.iter().map(|cell| cell.stretch).collect::<Vec<_>>(),
            [None, Some(2), None]
        );
        assert!((value_of_cubic(&cells[0].cubics[1][0], 2.0) - 2.0).abs() < 1e-15);
        assert!(value_of_cubic(&cells[2].cubics[1][0], 2.0).abs() < 1e-15);
    }

    #[test]
    fn a_jump_or_a_kink_ends_a_run() {
        for second in [
            [1.0 + 1e-13, 0.0, 0.0, 0.0],
            [1.0, 1e-13, 0.0, 0.0],
            [1.0, 0.0, 1e-13, 0.0],
        ] {
            let cells =
                line(&[([0.0, 1.0], [1.0, 0.0, 0.0, 0.0]), ([1.0, 2.0], second)]).joined(&[]);
            assert_eq!(cells.rails[0].len(), 2, "{second:?}");
        }
    }
}
