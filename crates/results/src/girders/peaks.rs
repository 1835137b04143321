//! Peaks of values that are known row by row, and their refinement between the rows.

use std::ops::Index;

/// Signs with which the largest and the smallest values are the largest.
pub(super) const SIGNS: [f64; 2] = [1.0, -1.0];

/// The highest and the lowest peak of a sequence of values at consecutive rows: by index 0 and 1.
///
/// A peak is a row whose neighbours are not higher; for the lowest the values count with the opposite sign. Peaks are
/// compared by the vertex of the parabola through the three values, so that of two peaks between the rows the higher one is
/// found. Where values jump from a row to the next, that vertex is far above them; so the peak with the largest value at its
/// row is known as well.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Peaks {
    last: LastRows,
    values: [f64; 2],
    found: [Peak; 2],
}

/// A row among those that are scanned.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ScannedRow {
    /// Its number: those of consecutive ones follow each other.
    pub number: usize,
    /// The row of the history.
    pub row: usize,
}

/// The last row of a sequence, how many of the last two values are known, and the distance of their rows.
#[derive(Clone, Copy, Debug, Default)]
struct LastRows {
    own: ScannedRow,
    count: usize,
    gap: usize,
}

impl LastRows {
    /// Whether a row follows the last one.
    fn is_followed_by(&self, next: ScannedRow) -> bool {
        self.count > 0 && next.number == self.own.number + 1
    }

    fn add(&mut self, next: ScannedRow) {
        *self = LastRows {
            own: next,
            count: 2.min(self.count + 1),
            gap: next.row.saturating_sub(self.own.row),
        };
    }

    /// A change of the value from the last row but one, if there is one, as a part of a peak.
    fn rise(&self, change: impl FnOnce() -> f64) -> Option<Fall> {
        (self.count > 1).then(|| Fall {
            change: change(),
            gap: self.gap,
        })
    }
}

/// By how much the value of a row is above that of one beside it, so many rows away.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fall {
    pub change: f64,
    pub gap: usize,
}

/// A peak: height of its vertex, the number of its row, and the value there, times the sign for which it is a peak.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub height: f64,
    pub row: usize,
    pub value: f64,
}

/// The peak whose vertex is the highest, the next lower ones, and the one with the largest value at its row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Peak {
    pub highest: Vertex,
    pub lower: [Vertex; 2],
    pub largest: Vertex,
}

impl Peak {
    fn offer(&mut self, vertex: Vertex) {
        if vertex.height > self.lower[1].height {
            self.lower[1] = vertex;
            if vertex.height > self.lower[0].height {
                self.lower.swap(0, 1);
                if vertex.height > self.highest.height {
                    std::mem::swap(&mut self.highest, &mut self.lower[0]);
                }
            }
        }
        if vertex.value > self.largest.value {
            self.largest = vertex;
        }
    }
}

impl Default for Vertex {
    fn default() -> Vertex {
        Vertex {
            height: f64::NEG_INFINITY,
            row: 0,
            value: f64::NEG_INFINITY,
        }
    }
}

impl Index<usize> for Peaks {
    type Output = Peak;

    fn index(&self, kind: usize) -> &Peak {
        &self.found[kind]
    }
}

impl From<[Peak; 2]> for Peaks {
    fn from(found: [Peak; 2]) -> Peaks {
        Peaks {
            found,
            ..Peaks::default()
        }
    }
}

impl Peaks {
    /// Adds the value of a row; rows that are left out separate sequences.
    pub fn add(&mut self, row: ScannedRow, value: f64) {
        if self.last.is_followed_by(row) {
            let [before, own] = self.values;
            // a value between its neighbours is no peak
            if self.last.count < 2 || (own - before) * (value - own) <= 0.0 {
                self.offer(Some(Fall {
                    change: own - value,
                    gap: row.row - self.last.own.row,
                }));
            }
        } else {
            self.finish();
        }
        self.values = [self.values[1], value];
        self.last.add(row);
    }

    /// Ends the sequence.
    pub fn finish(&mut self) {
        if self.last.count > 0 {
            self.offer(None);
        }
        self.last.count = 0;
    }

    /// Considers the last value, now that the next one is known.
    fn offer(&mut self, fall: Option<Fall>) {
        let [before, own] = self.values;
        let rise = self.last.rise(|| own - before);
        offer(&mut self.found, (self.last.own.number, own), rise, fall);
    }
}

/// Considers the value of a row, by how much it is above the value before and above the next one, where there are such.
fn offer(found: &mut [Peak; 2], (row, own): (usize, f64), rise: Option<Fall>, fall: Option<Fall>) {
    for (peak, sign) in found.iter_mut().zip(SIGNS) {
        let is_beyond = |fall: Option<Fall>| fall.is_none_or(|fall| sign * fall.change >= 0.0);
        if is_beyond(rise) && is_beyond(fall) {
            peak.offer(Vertex {
                height: sign * own + bulge(rise, fall),
                row,
                value: sign * own,
            });
        }
    }
}

/// By how much the vertex of the parabola through three values is beyond the middle one; 0 where one of the others is not known.
pub(super) fn bulge(rise: Option<Fall>, fall: Option<Fall>) -> f64 {
    match (rise, fall) {
        (Some(rise), Some(fall)) if rise.change + fall.change != 0.0 => {
            let (up, down) = (rise.change, fall.change);
            if rise.gap == fall.gap {
                return (up - down).powi(2) / (8.0 * (up + down).abs());
            }
            let [before, after] = [rise.gap, fall.gap].map(|gap| gap as f64);
            let (up, down) = (up * after, down * before);
            (up * after - down * before).powi(2)
                / (4.0 * before * after * (before + after) * (up + down).abs())
        }
        _ => 0.0,
    }
}

/// The highest and the lowest peaks of many sequences that have values at the same rows: those of [`Peaks`].
#[derive(Clone, Debug, Default)]
pub(super) struct PeakRows {
    last: LastRows,
    /// The last values but one, and the last ones.
    before: Vec<f64>,
    own: Vec<f64>,
    found: Vec<[Peak; 2]>,
}

impl PeakRows {
    /// Peaks of a number of sequences.
    pub fn new(sequences: usize) -> PeakRows {
        let (before, own) = (vec![0.0; sequences], vec![0.0; sequences]);
        PeakRows {
            last: LastRows::default(),
            before,
            own,
            found: vec![Default::default(); sequences],
        }
    }

    /// Adds the values of a row; rows that are left out separate sequences.
    pub fn add(&mut self, row: ScannedRow, values: &[f64]) {
        if self.last.count > 0 && !self.last.is_followed_by(row) {
            self.finish();
        }
        let (last, gap) = (self.last, row.row.saturating_sub(self.last.own.row));
        if last.count > 1 {
            // a value between its neighbours is no peak
            let is_turn =
                |(before, own, next): (f64, f64, f64)| (own - before) * (next - own) <= 0.0;
            let rows = || {
                self.before
                    .iter()
                    .zip(&self.own)
                    .zip(values)
                    .map(|((a, b), c)| (*a, *b, *c))
            };
            if rows().fold(false, |any, three| any | is_turn(three)) {
                for (found, (before, own, next)) in self.found.iter_mut().zip(rows()) {
                    if is_turn((before, own, next)) {
                        let rise = last.rise(|| own - before);
                        offer(
                            found,
                            (last.own.number, own),
                            rise,
                            Some(Fall {
                                change: own - next,
                                gap,
                            }),
                        );
                    }
                }
            }
        } else if last.count == 1 {
            for ((found, own), next) in self.found.iter_mut().zip(&self.own).zip(values) {
                offer(
                    found,
                    (last.own.number, *own),
                    None,
                    Some(Fall {
                        change: own - next,
                        gap,
                    }),
                );
            }
        }
        std::mem::swap(&mut self.before, &mut self.own);
        self.own.copy_from_slice(values);
        self.last.add(row);
    }

    /// Ends the sequences.
    pub fn finish(&mut self) {
        if self.last.count > 0 {
            for ((found, own), before) in self.found.iter_mut().zip(&self.own).zip(&self.before) {
                offer(
                    found,
                    (self.last.own.number, *own),
                    self.last.rise(|| own - before),
                    None,
                );
            }
        }
        self.last.count = 0;
    }

    /// The highest and the lowest peak of each sequence.
    pub fn found(&self) -> &[[Peak; 2]] {
        &self.found
    }
}

/// The smaller part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// Gain that is still followed, relative to what is enough.
const GAIN: f64 = 1e-7;
/// Gain, relative to the value, that rounding hides.
const ROUNDING: f64 = 1e-13;
/// Distance from an end, relative to the interval, at which a peak beside it would show: one that is nearer is higher than
/// the end by less than this squared, relative to the bow over the interval.
pub(super) const BESIDE: f64 = 1e-3;
/// Distance of two places at which values are compared, relative to the interval: the square of it is the relative error
/// of a value at a smooth peak.
const NEAR: f64 = 1e-6;

/// When the search for a largest value ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct SearchEnd {
    /// Largest number of evaluations between the ends.
    pub evaluations: usize,
    /// Difference of the two best values from which the parabola through them is trusted.
    pub enough: f64,
}

/// The largest value of `function` between two places, with its place. `known` is a place between them with its value, near
/// the largest one as far as known. The ends count as well.
///
/// Each next place is the vertex of the parabola through the three best places so far, at first the known one and the ends;
/// where that would leave the interval, or moves by more than half of the step before the last, it divides the larger part by the golden section. The
/// search ends where the best value is above the second by no more than what is enough, and the vertex above the best one by no
/// more than the fraction [`GAIN`] of that.
///
/// # Source
/// Brent, Algorithms for Minimization without Derivatives (1973), chapter 5, procedure localmin.
pub(super) fn largest(
    ends: [f64; 2],
    known: (f64, f64),
    end: SearchEnd,
    function: &mut dyn FnMut(f64) -> f64,
) -> (f64, f64) {
    let at_ends = ends.map(|place| (function(place), place));
    // of equal values the known one counts
    let outside = at_ends.into_iter().fold(known, larger);
    larger(outside, search(at_ends, known, end, function))
}

fn larger(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    if other.0 > one.0 { other } else { one }
}

/// The same, where the values at the ends do not count.
pub(super) fn largest_between(
    ends: [f64; 2],
    known: (f64, f64),
    end: SearchEnd,
    function: &mut dyn FnMut(f64) -> f64,
) -> (f64, f64) {
    search(
        ends.map(|place| (function(place), place)),
        known,
        end,
        function,
    )
}

/// The search between ends with their values.
fn search(
    at_ends: [(f64, f64); 2],
    known: (f64, f64),
    end: SearchEnd,
    function: &mut dyn FnMut(f64) -> f64,
) -> (f64, f64) {
    let [mut a, mut b] = at_ends.map(|(_, place)| place);
    let near = NEAR * (b - a);
    if near <= 0.0 {
        return known;
    }
    // where the largest value is at an end, and falls from there, none between is larger
    let top = larger(at_ends[0], at_ends[1]);
    if top.0 >= known.0 {
        let inwards = if top.1 == a { BESIDE } else { -BESIDE };
        if function(top.1 + inwards * (b - a)) <= top.0 {
            return known;
        }
    }
    // the best, the second and the third of the places, as (value, place)
    let start = a + GOLDEN * (b - a);
    let is_inside = known.1 > a && known.1 < b;
    let mut best = [if is_inside {
        known
    } else {
        (function(start), start)
    }; 3];
    let (mut step, mut before) = (0.0_f64, 0.0_f64);
    let [first, second] = at_ends;
    if first.0 <= best[0].0 && second.0 <= best[0].0 {
        let [second, third] = if first.0 >= second.0 {
            [first, second]
        } else {
            [second, first]
        };
        best = [best[0], second, third];
        (step, before) = (b - a, b - a);
    }
    for _ in 1..end.evaluations {
        let x = best[0].1;
        let middle = 0.5 * (a + b);
        if (x - middle).abs() <= 2.0 * near - 0.5 * (b - a) {
            break;
        }
        let vertex = vertex(&best)
            .filter(|(to, _)| (to - x).abs() < 0.5 * before.abs() && *to > a && *to < b);
        let is_near = best[0].0 - best[1].0 <= end.enough;
        let gain_that_counts = (GAIN * end.enough).max(ROUNDING * best[0].0.abs());
        if is_near && vertex.is_some_and(|(_, gain)| gain <= gain_that_counts) {
            break;
        }
        before = step;
        step = match vertex.map(|(to, _)| to) {
            Some(to) if to - a < 2.0 * near || b - to < 2.0 * near => near.copysign(middle - x),
            Some(to) => to - x,
            None => {
                before = if x < middle { b - x } else { a - x };
                GOLDEN * before
            }
        };
        let place = x + if step.abs() >= near {
            step
        } else {
            near.copysign(step)
        };
        let found = (function(place), place);
        if found.0 >= best[0].0 {
            *(if place < x { &mut b } else { &mut a }) = x;
            best = [found, best[0], best[1]];
        } else {
            *(if place < x { &mut a } else { &mut b }) = place;
            if found.0 >= best[1].0 || best[1].1 == x {
                best = [best[0], found, best[1]];
            } else if found.0 >= best[2].0 || best[2].1 == x || best[2].1 == best[1].1 {
                best[2] = found;
            }
        }
    }
    larger(known, best[0])
}

/// The vertex of the parabola through three values at places, and by how much it is above the first; `None` if they lie on a
/// line.
fn vertex([x, w, v]: &[(f64, f64); 3]) -> Option<(f64, f64)> {
    let (to_w, to_v) = ((x.1 - w.1) * (x.0 - v.0), (x.1 - v.1) * (x.0 - w.0));
    let denominator = 2.0 * (to_v - to_w);
    if denominator == 0.0 {
        return None;
    }
    let step = ((x.1 - v.1) * to_v - (x.1 - w.1) * to_w) / denominator;
    let curvature = (to_v - to_w) / ((x.1 - v.1) * (x.1 - w.1) * (w.1 - v.1));
    Some((x.1 - step, curvature.abs() * step * step))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row of which none is left out.
    fn at(row: usize) -> ScannedRow {
        ScannedRow { number: row, row }
    }

    /// Analytic: of a parabola the vertex is found from uneven rows, and of four crests the three highest are known.
    #[test]
    fn vertices_between_uneven_rows_are_those_of_the_parabola() {
        for rows in [[0, 4, 12], [0, 8, 9], [3, 4, 5]] {
            let mut peaks = Peaks::default();
            for (number, row) in rows.into_iter().enumerate() {
                peaks.add(
                    ScannedRow { number, row },
                    2.0 - 0.01 * (row as f64 - 4.4).powi(2),
                );
            }
            peaks.finish();
            assert!(
                (peaks[0].highest.height - 2.0).abs() < 1e-12,
                "{rows:?}: {:?}",
                peaks[0]
            );
        }
        let mut peaks = Peaks::default();
        for (row, value) in [0.0, 3.0, 0.0, 5.0, 0.0, 2.0, 0.0, 4.0, 0.0]
            .into_iter()
            .enumerate()
        {
            peaks.add(at(row), value);
        }
        peaks.finish();
        let Peak { highest, lower, .. } = peaks[0];
        assert_eq!(
            [highest, lower[0], lower[1]].map(|vertex| (vertex.row, vertex.value)),
            [(3, 5.0), (7, 4.0), (1, 3.0)]
        );
    }

    /// Analytic: of two equal waves the one whose crest lies between rows has the lower rows.
    #[test]
    fn the_higher_of_two_crests_is_found_between_rows() {
        let mut peaks = Peaks::default();
        let wave = |x: f64, height: f64| height - x * x;
        for (row, x) in [-1.0, 0.0, 1.0].into_iter().enumerate() {
            peaks.add(at(row), wave(x, 1.0));
        }
        for (row, x) in [-1.5, -0.5, 0.5, 1.5].into_iter().enumerate() {
            peaks.add(at(3 + row), wave(x, 1.1));
        }
        peaks.finish();
        let [highest, lowest] = peaks.found;
        assert!(
            (highest.highest.height - 1.1).abs() < 1e-12 && [4, 5].contains(&highest.highest.row),
            "{highest:?}"
        );
        let lowest = lowest.highest;
        assert!(
            (lowest.value + wave(1.5, 1.1)).abs() < 1e-12 && lowest.row == 3,
            "{lowest:?}"
        );
    }

    /// By hand: from 2.0 values fall to -3.0, and the parabola through 1.9, 2.0 and -3.0 is above 2.5; 2.2 is larger than 2.0.
    #[test]
    fn a_peak_beside_a_jump_does_not_hide_a_larger_one() {
        let mut peaks = Peaks::default();
        for (row, value) in [1.0, 2.2, 1.0, 1.9, 2.0, -3.0].into_iter().enumerate() {
            peaks.add(at(row), value);
        }
        peaks.finish();
        let [
            Peak {
                highest, largest, ..
            },
            _,
        ] = peaks.found;
        assert!(
            highest.row == 4 && highest.height > 2.5 && (largest.row, largest.value) == (1, 2.2)
        );
    }

    /// Identity: many sequences have the peaks of each of them alone, also where rows are left out.
    #[test]
    fn sequences_together_have_the_peaks_of_each_alone() {
        let value = |row: usize, k: usize| {
            (0.7 * row as f64 + k as f64).sin() + 0.1 * (row % (k + 2)) as f64
        };
        let (mut together, mut alone) = (PeakRows::new(5), [Peaks::default(); 5]);
        for row in (0..90).filter(|row| row % 31 != 7) {
            let values: [f64; 5] = std::array::from_fn(|k| value(row, k));
            together.add(at(row), &values);
            alone
                .iter_mut()
                .zip(values)
                .for_each(|(one, value)| one.add(at(row), value));
        }
        together.finish();
        for (mut alone, found) in alone.into_iter().zip(together.found()) {
            alone.finish();
            assert_eq!(&alone.found, found);
        }
    }

    /// Ends as far as doubles tell values apart.
    fn rounding(evaluations: usize) -> SearchEnd {
        SearchEnd {
            evaluations,
            enough: 0.0,
        }
    }

    /// Analytic: the vertex of a parabola.
    #[test]
    fn a_vertex_is_found_in_few_evaluations() {
        let mut count = 0;
        let (value, place) = largest([0.0, 2.0], (1.31, 2.0), rounding(30), &mut |x| {
            count += 1;
            3.0 - (x - 0.7).powi(2)
        });
        assert!(
            (place - 0.7).abs() < 1e-5 && (value - 3.0).abs() < 1e-12,
            "{value} at {place}"
        );
        assert!(count <= 10, "{count} evaluations");
    }

    /// Analytic: a quartic that is flat at its top, a corner between the places, and a largest value at an end.
    #[test]
    fn flat_tops_corners_and_ends_are_found() {
        let (flat, at) = largest([-1.0, 2.0], (0.7599, 1.0), rounding(30), &mut |x: f64| {
            1.0 - (x - 0.3).powi(4)
        });
        assert!(
            (flat - 1.0).abs() < 1e-9 && (at - 0.3).abs() < 0.02,
            "{flat} at {at}"
        );
        let (corner, at) = largest([0.0, 1.0], (-0.13, 0.5), rounding(60), &mut |x: f64| {
            -(x - 0.37).abs()
        });
        assert!(
            corner > -1e-5 && (at - 0.37).abs() < 1e-5,
            "{corner} at {at}"
        );
        assert_eq!(
            largest([0.0, 1.0], (0.5, 0.5), rounding(20), &mut |x| x),
            (1.0, 1.0)
        );
    }

    /// Analytic: a cosine, a corner and a peak beside an end, in fewer evaluations the looser the end; smooth peaks far better
    /// than what is enough.
    #[test]
    fn a_search_ends_where_more_would_gain_little() {
        let cosine = |x: f64| (3.0 * (x - 0.4)).cos();
        let corner = |x: f64| 1.0 - (x - 0.6183).abs();
        let beside = |x: f64| 1.0 - (x - 0.02).powi(2) + (x - 0.02).powi(3);
        let (cases, exact): ([&dyn Fn(f64) -> f64; 3], f64) = ([&cosine, &corner, &beside], 1.0);
        for (k, function) in cases.into_iter().enumerate() {
            for enough in [1e-3, 1e-5] {
                let mut count = 0;
                let mut counted = |x: f64| {
                    count += 1;
                    function(x)
                };
                let end = SearchEnd {
                    evaluations: 60,
                    enough,
                };
                let (value, _) =
                    largest_between([0.0, 1.0], (function(0.5), 0.5), end, &mut counted);
                let near = if k == 1 { 1e-5 } else { 1e-4 * enough };
                assert!(
                    value <= exact && value > exact - near,
                    "case {k}, {enough}: {value}"
                );
                assert!(
                    count <= if k == 1 { 40 } else { 13 },
                    "case {k}, {enough}: {count} evaluations"
                );
            }
        }
    }
}
