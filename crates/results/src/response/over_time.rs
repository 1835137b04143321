//! The largest value over a run of a quantity that follows from the loads on a structure and its motion.
//!
//! A quantity such as the deflection of a span is the largest of many values, one for each place. A cheap value from a few places
//! is computed at all nodes of the solution; in each interval the polynomial through these values bounds it. The intervals are then
//! taken in the order of their bounds. In each of them the quantity itself is evaluated at the nodes of its degree, at least 8, and
//! where the polynomial through these is largest. An interval whose bound, raised by a little and by as much as the quantity
//! exceeded the cheap value in those before it, does not exceed the largest value is left out, and so are all after it. While the
//! wheels move by little, the ratio of the quantity to the cheap value hardly changes: then it is known from a few values.

use std::collections::HashMap;

use piecewise::Lobatto;
use sim::{Channel, History, NodeInterval, Side, Solution, SolutionNodes};
use smallvec::SmallVec;

/// Least degree of the polynomials in an interval that is looked into, and that of polynomials along a span.
const DEGREE: usize = 8;

/// Number of parts of a span at whose ends it is evaluated at all times.
const PARTS: usize = 16;

/// Part of the largest value that an interval has at an end or in its middle which is looked into.
const PROMISING: f64 = 0.7;

/// Part of a bound by which the quantity may exceed it beyond what it has exceeded others, while the wheels move from one of the
/// places of the cheap values to the next.
const BEYOND: f64 = 0.015;

/// Part of the accuracy of a scene by which values count as equal.
const EQUAL: f64 = 0.1;

/// The largest value of a quantity over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LargestInTime {
    pub value: f64,
    /// Where on a rail it occurs.
    pub x: f64,
    pub time: f64,
}

/// A run in which the largest value of a quantity is looked for.
#[derive(Clone, Copy)]
pub(crate) struct TimeSearch<'a> {
    pub solution: &'a Solution,
    pub nodes: &'a SolutionNodes,
    /// Accuracy of the scene.
    pub accuracy: f64,
}

impl TimeSearch<'_> {
    /// Values at the rows that count: at both ends and the middle node of all intervals, and at all nodes of those that have at
    /// least [`PROMISING`] of the largest there.
    pub fn near(&self, value: &mut dyn FnMut(&[f64]) -> Option<f64>) -> Vec<(usize, f64)> {
        let rows = &self.nodes.rows;
        let mut found = vec![f64::NAN; rows.len()];
        let mut largest = 0.0_f64;
        let mut set = |found: &mut [f64], row: usize| {
            if found[row].is_nan() {
                found[row] = value(rows.sample(row)).unwrap_or(f64::NEG_INFINITY);
            }
            found[row]
        };
        if self.nodes.intervals.is_empty() {
            (0..rows.len()).for_each(|row| {
                set(&mut found, row);
            });
        }
        let three = |own: &NodeInterval| [0, own.degree / 2, own.degree].map(|k| own.first + k);
        for row in self.nodes.intervals.iter().flat_map(three) {
            largest = largest.max(set(&mut found, row));
        }
        for own in &self.nodes.intervals {
            let most = three(own)
                .map(|row| found[row])
                .into_iter()
                .fold(f64::NEG_INFINITY, f64::max);
            if most >= PROMISING * largest {
                (own.first..own.first + own.degree).for_each(|row| {
                    set(&mut found, row);
                });
            }
        }
        let counts = found.into_iter().enumerate();
        counts.filter(|(_, value)| value.is_finite()).collect()
    }

    /// The largest value of `exact`, which returns the value for a row of the solution and its place. `near` are values near to it at
    /// those rows of the nodes that count, by increasing rows, from places at this `distance` from each other. `None` where the
    /// largest value is not positive.
    pub fn largest(
        &self,
        near: &[(usize, f64)],
        distance: f64,
        exact: &mut dyn FnMut(&[f64]) -> Option<[f64; 2]>,
    ) -> Option<LargestInTime> {
        let rows = &self.nodes.rows;
        let mut best: Option<LargestInTime> = None;
        let mut offer = |time: f64, [value, x]: [f64; 2]| {
            if value > 0.0 && best.is_none_or(|known| value > known.value) {
                best = Some(LargestInTime { value, x, time });
            }
            best.map_or(0.0, |best| best.value)
        };
        if self.nodes.intervals.is_empty() {
            for (row, _) in near {
                let sample = rows.sample(*row);
                offer(sample[0], exact(sample)?);
            }
            return best;
        }
        let mut order: Vec<(f64, NodeInterval)> = Vec::new();
        let (mut next, mut own) = (0, Vec::new());
        for interval in &self.nodes.intervals {
            let last = interval.first + interval.degree;
            while near.get(next).is_some_and(|(row, _)| *row < interval.first) {
                next += 1;
            }
            own.clear();
            let inside = near[next..].iter().take_while(|(row, _)| *row <= last);
            own.extend(inside.map(|(_, value)| *value));
            let bound = if own.len() > interval.degree {
                Lobatto::of(interval.degree).polynomial(&own).bounds()[1]
            } else {
                own.iter().copied().fold(0.0, f64::max)
            };
            if bound > 0.0 {
                order.push((bound, *interval));
            }
        }
        order.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut excess = Excess::new((rows, near), distance, exact);
        let mut largest = 0.0_f64;
        let mut row = Vec::new();
        for (bound, interval) in order {
            let most = largest * (1.0 + EQUAL * self.accuracy);
            if bound * (excess.largest + BEYOND) <= most {
                break;
            }
            if bound * excess.within(interval)? <= most {
                continue;
            }
            let ends = [interval.first, interval.first + interval.degree];
            let [from, to] = ends.map(|at| rows.sample(at)[0]);
            let mut at = |share: f64| -> Option<(f64, [f64; 2])> {
                let t = from + share * (to - from);
                // the values at the ends are those of this interval
                match share {
                    0.0 => Some((from, excess.at_row(ends[0])?)),
                    1.0 => Some((to, excess.at_row(ends[1])?)),
                    _ => {
                        row.clear();
                        self.solution.row(t, Side::Before, &mut row);
                        Some((t, (excess.exact)(&row)?))
                    }
                }
            };
            let nodes = Lobatto::of(interval.degree.max(DEGREE));
            let mut found: SmallVec<[f64; 17]> = SmallVec::new();
            for node in nodes.nodes() {
                let (t, value) = at(*node)?;
                found.push(value[0]);
                offer(t, value);
            }
            let most = nodes.polynomial(&found).largest();
            let (t, value) = at(most.share)?;
            largest = offer(t, value);
            let own = found.iter().copied().fold(value[0], f64::max);
            excess.largest = excess.largest.max(own / bound);
        }
        best
    }
}

/// By how much a quantity exceeds the cheap value for it: their ratio.
struct Excess<'a> {
    rows: &'a History,
    /// Cheap values by rows, and the distance between their places.
    near: &'a [(usize, f64)],
    distance: f64,
    /// Channels of the positions of wheels.
    positions: Vec<usize>,
    exact: &'a mut dyn FnMut(&[f64]) -> Option<[f64; 2]>,
    /// Exact values with their places by rows, as far as they are known.
    known: HashMap<usize, [f64; 2]>,
    /// Largest ratio found so far, at least 1.
    largest: f64,
}

impl<'a> Excess<'a> {
    fn new(
        (rows, near): (&'a History, &'a [(usize, f64)]),
        distance: f64,
        exact: &'a mut dyn FnMut(&[f64]) -> Option<[f64; 2]>,
    ) -> Excess<'a> {
        let channels = rows.channels().iter().enumerate();
        let positions = channels.filter(|(_, own)| matches!(own, Channel::Position(_)));
        Excess {
            rows,
            near,
            distance,
            positions: positions.map(|(at, _)| at).collect(),
            exact,
            known: HashMap::new(),
            largest: 1.0,
        }
    }

    /// The quantity at a row, with its place.
    fn at_row(&mut self, row: usize) -> Option<[f64; 2]> {
        if let Some(known) = self.known.get(&row) {
            return Some(*known);
        }
        let found = (self.exact)(self.rows.sample(row))?;
        self.known.insert(row, found);
        Some(found)
    }

    /// The largest ratio in an interval. Where wheels move by much less than the distance between the places of the cheap values,
    /// it is that at both ends and at the largest cheap value, and by as much more as these three differ.
    fn within(&mut self, interval: NodeInterval) -> Option<f64> {
        let (first, last) = (interval.first, interval.first + interval.degree);
        let beyond = BEYOND * self.moved(first, last) / self.distance;
        if beyond > 0.5 * BEYOND {
            return Some(self.largest + BEYOND);
        }
        let near = self.near;
        let from = near.partition_point(|(row, _)| *row < first);
        let to = near.partition_point(|(row, _)| *row <= last);
        let own = &near[from..to];
        let largest = own.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (row, near) in [own.first(), largest, own.last()].into_iter().flatten() {
            if *near <= 0.0 {
                return Some(f64::INFINITY);
            }
            let ratio = self.at_row(*row)?[0] / near;
            (low, high) = (low.min(ratio), high.max(ratio));
        }
        Some(high + (high - low) + beyond)
    }

    /// The largest distance by which a wheel moves between two rows.
    fn moved(&self, first: usize, last: usize) -> f64 {
        let [first, last] = [first, last].map(|row| self.rows.sample(row));
        let each = self
            .positions
            .iter()
            .map(|at| (last[*at] - first[*at]).abs());
        each.fold(0.0, f64::max)
    }
}

/// The places inside a span at which it is evaluated at all times, at equal distances.
pub(crate) fn grid([from, to]: [f64; 2]) -> Vec<f64> {
    let share = |k: usize| k as f64 / PARTS as f64;
    (1..PARTS).map(|k| from + (to - from) * share(k)).collect()
}

/// The distance between the places of a [`grid`].
pub(crate) fn distance([from, to]: [f64; 2]) -> f64 {
    (to - from) / PARTS as f64
}

/// The largest of the values at places of a [`grid`], with 0 at both ends of the span, by the parabola through the largest and the
/// two beside it, and of those under wheels, where a span may have corners.
pub(crate) fn crest(
    grid: impl Iterator<Item = f64>,
    under_wheels: impl Iterator<Item = f64>,
) -> f64 {
    under_wheels.fold(parabola(grid), f64::max)
}

fn parabola(values: impl Iterator<Item = f64>) -> f64 {
    let mut all = vec![0.0];
    all.extend(values);
    all.push(0.0);
    let at = (1..all.len() - 1).max_by(|a, b| all[*a].total_cmp(&all[*b]));
    let Some(at) = at.filter(|at| all[*at] > 0.0) else {
        return 0.0;
    };
    let [before, own, behind] = [all[at - 1], all[at], all[at + 1]];
    let (slope, bend) = (0.5 * (behind - before), before - 2.0 * own + behind);
    if bend < 0.0 {
        own - 0.5 * slope * slope / bend
    } else {
        own
    }
}

/// The largest value along a span of a function that is smooth between `breaks`, with its place: by polynomials of degree 8 between
/// them, of which the values at `x` are those that `values` writes. `is_either` is whether the sign does not count.
pub(crate) fn largest_along(
    [from, to]: [f64; 2],
    breaks: &mut Vec<f64>,
    is_either: bool,
    values: &mut dyn FnMut(&[f64]) -> Option<Vec<f64>>,
) -> Option<[f64; 2]> {
    breaks.extend([from, to]);
    breaks.retain(|x| *x >= from && *x <= to);
    breaks.sort_by(f64::total_cmp);
    let slack = 1e-9 * (to - from);
    breaks.dedup_by(|b, a| *b - *a <= slack);
    let nodes = Lobatto::of(DEGREE);
    let cells = || breaks.windows(2).map(|pair| [pair[0], pair[1]]);
    let places: Vec<f64> = cells()
        .flat_map(|[a, b]| nodes.nodes().iter().map(move |s| a + s * (b - a)))
        .collect();
    let found = values(&places)?;
    let mut best = [0.0, from];
    for (own, [a, b]) in found.chunks_exact(DEGREE + 1).zip(cells()) {
        let polynomial = nodes.polynomial(own);
        let mut offer = |value: f64, share: f64| {
            if value > best[0] {
                best = [value, a + share * (b - a)];
            }
        };
        let most = polynomial.largest();
        offer(most.value, most.share);
        if is_either {
            let least = polynomial.smallest();
            offer(-least.value, least.share);
        }
    }
    Some(best)
}
