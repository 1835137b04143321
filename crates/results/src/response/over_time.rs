//! The largest value over a run of a quantity that follows from the loads on a structure and its motion.
//!
//! A quantity such as the deflection of a span is the largest of many values, one for each place. A cheap value from a few places
//! is computed at all nodes of the solution; in each interval the polynomial through these values bounds it. The intervals are then
//! taken in the order of their bounds. In each of them the quantity itself is evaluated at the nodes of its degree, at least 8, and
//! where the polynomial through these is largest. An interval whose bound, raised by a little and by as much as the quantity
//! exceeded the cheap value in those before it, does not exceed the largest value is left out, and so are all after it.

use piecewise::Lobatto;
use sim::{NodeInterval, Side, Solution, SolutionNodes};
use smallvec::SmallVec;

/// Least degree of the polynomials in an interval that is looked into, and that of polynomials along a span.
const DEGREE: usize = 8;

/// Number of parts of a span at whose ends it is evaluated at all times.
const PARTS: usize = 16;

/// Part of the largest value that an interval has at an end or in its middle which is looked into.
const PROMISING: f64 = 0.7;

/// Part of a bound by which the quantity may exceed it beyond what it has exceeded others: cheap values are those of a few places.
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
    /// those rows of the nodes that count, by increasing rows. `None` where the largest value is not positive.
    pub fn largest(
        &self,
        near: &[(usize, f64)],
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
        let (mut gain, mut largest) = (0.0_f64, 0.0_f64);
        let mut row = Vec::new();
        for (bound, interval) in order {
            if bound * (1.0 + gain + BEYOND) <= largest * (1.0 + EQUAL * self.accuracy) {
                break;
            }
            let ends = [interval.first, interval.first + interval.degree];
            let [from, to] = ends.map(|at| rows.sample(at)[0]);
            let mut at = |share: f64, row: &mut Vec<f64>| -> Option<(f64, [f64; 2])> {
                let t = from + share * (to - from);
                // the values at the ends are those of this interval
                match share {
                    0.0 => Some((from, exact(rows.sample(ends[0]))?)),
                    1.0 => Some((to, exact(rows.sample(ends[1]))?)),
                    _ => {
                        row.clear();
                        self.solution.row(t, Side::Before, row);
                        Some((t, exact(row)?))
                    }
                }
            };
            let nodes = Lobatto::of(interval.degree.max(DEGREE));
            let mut found: SmallVec<[f64; 17]> = SmallVec::new();
            for node in nodes.nodes() {
                let (t, value) = at(*node, &mut row)?;
                found.push(value[0]);
                largest = offer(t, value);
            }
            let most = nodes.polynomial(&found).largest();
            let (t, value) = at(most.share, &mut row)?;
            offer(t, value);
            largest = largest.max(value[0]);
            let own = found.iter().copied().fold(value[0], f64::max);
            gain = gain.max(own / bound - 1.0);
        }
        best
    }
}

/// The places inside a span at which it is evaluated at all times, at equal distances.
pub(crate) fn grid([from, to]: [f64; 2]) -> Vec<f64> {
    let share = |k: usize| k as f64 / PARTS as f64;
    (1..PARTS).map(|k| from + (to - from) * share(k)).collect()
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
