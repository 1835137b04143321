//! Extremes of sections and points between the rows of a history: peaks of the scan, refined over time.

use trains::{GirderResponse, SectionSide};

use super::distributed::FORCES;
use super::girder::{LoadedGirders, OwnLoad};
use super::instants::LoadState;
use super::peaks::{BESIDE, Fall, Peak, SIGNS, SearchEnd, Vertex, bulge, largest, largest_between};
use super::scan::{Passage, Scan};

/// Largest number of evaluations for the peak between two rows.
const EVALUATIONS: usize = 20;
/// Height of a vertex above a value up to which it is not looked for, and difference of values from which a parabola is trusted,
/// relative to the accuracy and the largest value of its kind.
const ENOUGH: f64 = 1e-2;
/// How much lower a peak may seem than another one at rows between which others are left out, relative to the largest value of its
/// kind, and still be followed.
pub(super) const RANKED: f64 = 1e-4;
/// Time from a row, in rows, within which a corner is at the row.
const AT_ROW: f64 = 1e-6;
/// Distance from a corner, relative to the interval, at which the force is the limit there.
const INSIDE: f64 = 1e-9;
/// Rounds of refinement over time and along the girder in turn.
pub(super) const ROUNDS: usize = 3;
/// Peaks that are lower than the highest one by more than this fraction of the largest value of their kind are left out.
pub(super) const NEAR: f64 = 0.05;

/// A value at a section and a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct GirderValue {
    /// Sign times value.
    pub signed: f64,
    /// Time, counted in rows.
    pub position: f64,
    pub x: f64,
    /// Member and place on it; `None` for deflections.
    pub section: Option<(usize, f64)>,
    pub own: OwnLoad,
    /// Whether it is the state just after a passage; `None` for the state at the time itself.
    pub is_after: Option<bool>,
    pub side: SectionSide,
}

/// Corners of a force at a section over time, where loads pass it; the limits of the force there are known.
#[derive(Clone, Copy)]
pub(super) struct Corners<'a> {
    /// By increasing time.
    pub passages: &'a [Passage],
    pub quantity: usize,
    pub kind: usize,
}

impl Corners<'_> {
    /// No corners.
    pub const NONE: Corners<'static> = Corners {
        passages: &[],
        quantity: 0,
        kind: 0,
    };

    /// The part of an interval without corners in which a peak may lie beside a known value, with its ends; `None` where
    /// the force rises as far as a corner, or falls from one on both sides of it.
    ///
    /// A peak in a part whose largest value seems to be at its end shows by a larger value just beside the end.
    fn divide(
        &self,
        ends: [f64; 2],
        known: (f64, f64),
        value: &mut dyn FnMut(f64) -> f64,
    ) -> Option<[f64; 2]> {
        let signed = |passage: &Passage| SIGNS[self.kind] * passage.values[self.quantity];
        let at_row = self
            .passages
            .iter()
            .filter(|passage| (passage.position - known.1).abs() <= AT_ROW);
        if let Some(limit) = at_row.map(signed).reduce(f64::max) {
            // the known value is at a corner: whether the force falls from it on both sides
            let falls =
                |sense: f64| -> bool { value(known.1 + sense * BESIDE) <= limit.max(known.0) };
            return if [-1.0, 1.0].into_iter().all(falls) {
                None
            } else {
                Some(ends)
            };
        }
        let mut part = ends;
        for (side, sense) in [-1.0, 1.0].into_iter().enumerate() {
            let distance = |passage: &Passage| sense * (passage.position - known.1);
            let reach = sense * (ends[side] - known.1);
            let ahead = self
                .passages
                .iter()
                .map(distance)
                .filter(|ahead| *ahead > 0.0 && *ahead < reach);
            let Some(ahead) = ahead.min_by(f64::total_cmp) else {
                continue;
            };
            let corner = known.1 + sense * ahead;
            // of the limits on this side of the corner the larger one
            let limits = self
                .passages
                .iter()
                .filter(|passage| distance(passage) == ahead);
            let limit = limits
                .filter(|passage| passage.is_after == (side == 0))
                .map(signed)
                .fold(known.0, f64::max);
            if limit > known.0 && value(corner - sense * BESIDE * ahead) <= limit {
                return None;
            }
            part[side] = corner - sense * INSIDE * ahead;
        }
        Some(part)
    }
}

/// The refinement of the peaks of one scan.
pub(super) struct Refinement<'a> {
    pub girders: &'a LoadedGirders<'a>,
    pub scan: &'a Scan,
    /// Largest magnitude of each quantity, and of both deflections.
    pub sizes: [f64; FORCES + 2],
    /// Relative accuracy that is wanted.
    pub accuracy: f64,
}

impl Refinement<'_> {
    /// Whether a quantity is zero throughout but for rounding: 1e-9 of the largest force, or of the largest moment, or of
    /// the largest deflection.
    pub fn is_zero(&self, quantity: usize) -> bool {
        let own = self.size(quantity);
        own <= 1e-9 * self.kind_size(quantity)
    }

    /// A value of a quantity, and 0 where it is below 1e-12 of the largest value of its kind.
    pub fn without_rounding(&self, quantity: usize, value: f64) -> f64 {
        if value.abs() <= 1e-12 * self.kind_size(quantity) {
            0.0
        } else {
            value
        }
    }

    /// Largest magnitude of a quantity.
    pub fn size(&self, quantity: usize) -> f64 {
        self.sizes[quantity]
    }

    /// Largest magnitude of the quantities of one dimension; of forces, where a structure has no moments to speak of.
    fn kind_size(&self, quantity: usize) -> f64 {
        let kinds: &[usize] = match quantity {
            0 | 2 | 3 => &[0, 2, 3],
            1 | 4 | 5 => &[1, 4, 5],
            _ => &[6, 7],
        };
        kinds.iter().fold(0.0, |most, k| most.max(self.sizes[*k]))
    }

    /// The largest of sign times a force at a section over time, wheels that pass it included. The peak between the rows
    /// is refined if `is_near`.
    pub fn section(
        &self,
        at: usize,
        quantity: usize,
        kind: usize,
        is_near: bool,
    ) -> Option<GirderValue> {
        let section = &self.girders.sections.sections[at];
        let x = self.girders.sections.points[section.point].x;
        let peak = &self.scan.sections[at][quantity][kind];
        if peak.highest.height == f64::NEG_INFINITY {
            return None;
        }
        let value = |position: f64| SIGNS[kind] * self.girders.forces(section, position)[quantity];
        let make = |signed, position, own, is_after, side| GirderValue {
            signed,
            position,
            x,
            section: Some((section.member, section.place)),
            own,
            is_after,
            side,
        };
        let mut found = None;
        if is_near {
            let corners = Corners {
                passages: &self.scan.passages[at],
                quantity,
                kind,
            };
            let (signed, position) =
                self.over_time((peak, 1), (quantity, corners), &mut |position| {
                    value(position)
                });
            offer(
                &mut found,
                Some(make(signed, position, None, None, section.side)),
            );
        }
        for passage in &self.scan.passages[at] {
            let signed = SIGNS[kind] * passage.values[quantity];
            let side = match section.side {
                SectionSide::At if is_moment(quantity) => SectionSide::At,
                SectionSide::At if passage.is_behind => SectionSide::Behind,
                SectionSide::At => SectionSide::Before,
                side => side,
            };
            let own = Some((passage.load, passage.is_behind));
            offer(
                &mut found,
                Some(make(
                    signed,
                    passage.position,
                    own,
                    Some(passage.is_after),
                    side,
                )),
            );
        }
        found
    }

    /// The largest of sign times the deflection of a point over time.
    pub fn point(&self, at: usize, plane: usize, kind: usize) -> Option<GirderValue> {
        let point = self.girders.sections.points[at];
        let peak = &self.scan.points[at][plane][kind];
        if peak.highest.height == f64::NEG_INFINITY {
            return None;
        }
        let mut value = |position: f64| {
            SIGNS[kind]
                * self
                    .girders
                    .deflection(point.rail, point.x, plane, position)
        };
        let (signed, position) = self.over_time(
            (peak, self.girders.deflection_stride),
            (FORCES + plane, Corners::NONE),
            &mut value,
        );
        let side = SectionSide::At;
        Some(GirderValue {
            signed,
            position,
            x: point.x,
            section: None,
            own: None,
            is_after: None,
            side,
        })
    }

    /// The state in which a value was found.
    pub fn state_of(&self, found: &GirderValue) -> LoadState<'_> {
        let states = self.girders.states;
        let Some(is_after) = found.is_after else {
            return states.at(found.position);
        };
        let mut state = states.limit(found.position, is_after);
        if let Some((load, _)) = found.own {
            state.loads.to_mut()[load].x = found.x;
        }
        state
    }

    /// The largest value in the two intervals beside the row of a peak, at whose ends it is not larger; the value at the row
    /// where the values beside it show that no larger one lies between the rows. Where the peak with the highest vertex turns
    /// out lower than the one with the largest value may be, that one is followed as well. Corners divide the intervals; the
    /// values at them are not looked for.
    pub fn over_time(
        &self,
        (peak, stride): (&Peak, usize),
        (quantity, corners): (usize, Corners<'_>),
        value: &mut dyn FnMut(f64) -> f64,
    ) -> (f64, f64) {
        let end = self.search_end(self.size(quantity));
        let mut near = |vertex: &Vertex, least: f64| {
            let vertex = self.among_rows(vertex, stride, &mut *value);
            let known = (vertex.value, vertex.row as f64);
            let ends = self.rows_beside(known.1, stride);
            if vertex.height - vertex.value <= end.enough
                || ends[1] <= ends[0]
                || vertex.height <= least
            {
                return known;
            }
            match corners.divide(ends, known, &mut *value) {
                Some(ends) => largest_between(ends, known, end, &mut *value),
                None => known,
            }
        };
        let mut found = near(&peak.highest, f64::NEG_INFINITY);
        for vertex in self.lower_peaks(peak, (stride, self.size(quantity))) {
            if vertex.height + RANKED * self.size(quantity) > found.0 {
                let other = near(vertex, found.0);
                found = if other.0 > found.0 { other } else { found };
            }
        }
        if peak.largest.row == peak.highest.row || peak.largest.height <= found.0 {
            return found;
        }
        let other = near(&peak.largest, f64::NEG_INFINITY);
        if other.0 > found.0 { other } else { found }
    }

    /// The peaks below the highest one that may be as high: those not much lower, between whose rows others have been left out.
    pub fn lower_peaks<'p>(
        &self,
        peak: &'p Peak,
        (stride, size): (usize, f64),
    ) -> impl Iterator<Item = &'p Vertex> + use<'p, '_> {
        let least = peak.highest.value - RANKED * size;
        peak.lower.iter().filter(move |vertex| {
            vertex.height > least && self.rows_between(vertex.row, stride).is_some()
        })
    }

    /// The rows at which forces, or for a stride of more than 1 deflections, are evaluated.
    fn evaluated(&self, stride: usize) -> &[usize] {
        if stride == 1 {
            self.girders.scanned
        } else {
            &self.girders.deflected
        }
    }

    /// The vertex at the evaluated row of a number: at the row itself, or where others have been left out beside it at the one
    /// with the largest value as far as the evaluated rows beside it, which is found by halves.
    fn among_rows(
        &self,
        vertex: &Vertex,
        stride: usize,
        value: &mut dyn FnMut(f64) -> f64,
    ) -> Vertex {
        let own = self.evaluated(stride)[vertex.row];
        let Some([before, after]) = self.rows_between(vertex.row, stride) else {
            return Vertex {
                row: own,
                ..*vertex
            };
        };
        let mut best = (vertex.value, own);
        let mut beside = [None; 2];
        let mut step = (own - before).max(after - own).next_power_of_two();
        while step > stride {
            step /= 2;
            let rows = [best.1.checked_sub(step), Some(best.1 + step)];
            beside = rows.map(|row| {
                let row = row.filter(|row| *row >= before && *row <= after)?;
                Some((value(row as f64), row))
            });
            let higher = beside
                .into_iter()
                .flatten()
                .fold(best, |a, b| if b.0 > a.0 { b } else { a });
            if higher.1 != best.1 {
                // beside the new one the values at this distance are that of the old one, and one beyond
                beside = [None; 2];
                best = higher;
            }
        }
        let known = |row: Option<usize>| {
            let row = row.filter(|row| *row >= before && *row <= after)?;
            let known = beside
                .into_iter()
                .flatten()
                .find(|known: &(f64, usize)| known.1 == row);
            Some(known.map_or_else(|| value(row as f64), |known| known.0))
        };
        let fall = |beside: Option<f64>| {
            let change = best.0 - beside?;
            change.is_finite().then_some(Fall { change, gap: 1 })
        };
        let [rise, fall] = [best.1.checked_sub(stride), Some(best.1 + stride)]
            .map(known)
            .map(fall);
        Vertex {
            height: best.0 + bulge(rise, fall),
            row: best.1,
            value: best.0,
        }
    }

    /// The evaluated rows beside that of a number; `None` where none have been left out between.
    fn rows_between(&self, number: usize, stride: usize) -> Option<[usize; 2]> {
        let rows = self.evaluated(stride);
        let own = rows[number];
        let [before, after] =
            [number.saturating_sub(1), (number + 1).min(rows.len() - 1)].map(|k| rows[k]);
        (own - before > stride || after - own > stride).then_some([before, after])
    }

    /// The largest value in the intervals beside the scanned row of a number, as [`Refinement::near_in_time`].
    pub fn near_scanned(&self, number: usize, value: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
        let mut row = self.girders.scanned[number];
        if self.rows_between(number, 1).is_some() {
            let own = value(row as f64);
            row = self
                .among_rows(
                    &Vertex {
                        height: own,
                        row: number,
                        value: own,
                    },
                    1,
                    value,
                )
                .row;
        }
        self.near_in_time(row as f64, 1, value)
    }

    /// The times `stride` rows before a row and behind it, within the run.
    fn rows_beside(&self, position: f64, stride: usize) -> [f64; 2] {
        let last = (self.girders.states.len() - 1) as f64;
        let row = position.round();
        [
            (row - stride as f64).max(0.0),
            (row + stride as f64).min(last),
        ]
    }

    /// When a search among values ends of which the largest are as large as `size`.
    pub fn search_end(&self, size: f64) -> SearchEnd {
        SearchEnd {
            evaluations: EVALUATIONS,
            enough: ENOUGH * self.accuracy * size,
        }
    }

    /// The largest value from `stride` rows before a time to as many behind it.
    pub fn near_in_time(
        &self,
        position: f64,
        stride: usize,
        value: &mut dyn FnMut(f64) -> f64,
    ) -> (f64, f64) {
        let own = (value(position), position);
        let ends = self.rows_beside(position, stride);
        if ends[1] <= ends[0] {
            return own;
        }
        largest(ends, own, self.search_end(own.0.abs()), value)
    }
}

/// Whether a quantity is a bending moment, which is the same on both sides of a wheel.
pub(super) fn is_moment(quantity: usize) -> bool {
    quantity == GirderResponse::VerticalMoment as usize
        || quantity == GirderResponse::LateralMoment as usize
}

/// Replaces a value by a larger one; of equal values the first one counts.
pub(super) fn offer(known: &mut Option<GirderValue>, found: Option<GirderValue>) {
    let Some(found) = found else { return };
    let tie = |known: &GirderValue| 1e-12 * known.signed.abs().max(found.signed.abs());
    if known
        .as_ref()
        .is_none_or(|known| found.signed > known.signed + tie(known))
    {
        *known = Some(found);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A passage at a position, with the limit of the first quantity just before or just after it.
    fn passage(position: f64, is_after: bool, limit: f64) -> Passage {
        let mut values = [0.0; FORCES];
        values[0] = limit;
        Passage {
            load: 0,
            position,
            is_after,
            is_behind: is_after,
            values,
        }
    }

    /// Analytic: a force rises to a corner behind the row, or has a peak before it; it falls from a corner at the row, or from one
    /// before it; without corners the interval is whole.
    #[test]
    fn intervals_of_peaks_end_at_corners() {
        let part = |passages: &[Passage], value: &dyn Fn(f64) -> f64| {
            let corners = Corners {
                passages,
                quantity: 0,
                kind: 0,
            };
            corners.divide([3.0, 5.0], (value(4.0), 4.0), &mut |position| {
                value(position)
            })
        };
        assert_eq!(part(&[], &|x| -(x - 4.1).powi(2)), Some([3.0, 5.0]));

        // 1 just before the corner at 4.5, far below behind it
        let rising = |x: f64| if x < 4.5 { 1.0 + (x - 4.5) } else { -9.0 };
        let at_corner = [passage(4.5, false, 1.0), passage(4.5, true, -9.0)];
        assert_eq!(part(&at_corner, &rising), None);
        // the same limit, but a higher peak at 4.4
        let peaked = |x: f64| {
            if x < 4.5 {
                1.01 - (x - 4.4).powi(2)
            } else {
                -9.0
            }
        };
        let [from, to] = part(&at_corner, &peaked).expect("a peak before the corner");
        assert!(from == 3.0 && to < 4.5 && to > 4.5 - 1e-8);

        // a corner at the row: a force that falls on both sides, and one with a peak behind it
        let at_row = [passage(4.0, false, 0.0), passage(4.0, true, 0.0)];
        assert_eq!(part(&at_row, &|x| -(x - 4.0).abs()), None);
        assert_eq!(
            part(&at_row, &|x| if x > 4.0 { x - 4.0 } else { 4.0 - x }),
            Some([3.0, 5.0])
        );

        // lower limits at a corner before the row bound the interval
        let before = [passage(3.25, false, -7.0), passage(3.25, true, -2.0)];
        let [from, to] = part(&before, &|x| {
            if x > 3.25 { -(x - 4.2).powi(2) } else { -7.0 }
        })
        .expect("smooth");
        assert!(to == 5.0 && from > 3.25 && from < 3.25 + 1e-8);
    }
}
