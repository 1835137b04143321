//! Extremes of sections and points between the rows of a history: peaks of the scan, refined over time.

use trains::{GirderResponse, SectionSide};

use super::distributed::FORCES;
use super::girder::{LoadedGirders, OwnLoad};
use super::instants::LoadState;
use super::peaks::{Peak, SIGNS, SearchEnd, Vertex, largest, largest_between};
use super::scan::Scan;

/// Largest number of evaluations for the peak between two rows.
const EVALUATIONS: usize = 20;
/// Height of a vertex above a value up to which it is not looked for, and difference of values from which a parabola is trusted,
/// relative to the accuracy and the largest value of its kind.
const ENOUGH: f64 = 1e-2;
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
        if value.abs() <= 1e-12 * self.kind_size(quantity) { 0.0 } else { value }
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
    pub fn section(&self, at: usize, quantity: usize, kind: usize, is_near: bool) -> Option<GirderValue> {
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
            let (signed, position) = self.over_time((peak, 1), quantity, &mut |position| value(position));
            offer(&mut found, Some(make(signed, position, None, None, section.side)));
        }
        for passage in self.scan.passages.iter().filter(|passage| passage.section == at) {
            let signed = SIGNS[kind] * passage.values[quantity];
            let side = match section.side {
                SectionSide::At if is_moment(quantity) => SectionSide::At,
                SectionSide::At if passage.is_behind => SectionSide::Behind,
                SectionSide::At => SectionSide::Before,
                side => side,
            };
            let own = Some((passage.load, passage.is_behind));
            offer(&mut found, Some(make(signed, passage.position, own, Some(passage.is_after), side)));
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
        let mut value =
            |position: f64| SIGNS[kind] * self.girders.deflection(point.rail, point.x, plane, position);
        let (signed, position) =
            self.over_time((peak, self.girders.deflection_stride), FORCES + plane, &mut value);
        let side = SectionSide::At;
        Some(GirderValue { signed, position, x: point.x, section: None, own: None, is_after: None, side })
    }

    /// The state in which a value was found.
    pub fn state_of(&self, found: &GirderValue) -> LoadState<'_> {
        let states = self.girders.states;
        let Some(is_after) = found.is_after else { return states.at(found.position) };
        let mut state = states.limit(found.position, is_after);
        if let Some((load, _)) = found.own {
            state.loads.to_mut()[load].x = found.x;
        }
        state
    }

    /// The largest value in the two intervals beside the row of a peak, at whose ends it is not larger; the value at the row
    /// where the values beside it show that no larger one lies between the rows. Where the peak with the highest vertex turns
    /// out lower than the one with the largest value may be, that one is followed as well.
    pub fn over_time(
        &self,
        (peak, stride): (&Peak, usize),
        quantity: usize,
        value: &mut dyn FnMut(f64) -> f64,
    ) -> (f64, f64) {
        let mut near = |vertex: &Vertex| {
            let known = (vertex.value, (vertex.row * stride) as f64);
            let ends = self.rows_beside(known.1, stride);
            let end = self.search_end(self.size(quantity));
            if vertex.height - vertex.value <= end.enough || ends[1] <= ends[0] {
                return known;
            }
            largest_between(ends, known, end, &mut *value)
        };
        let found = near(&peak.highest);
        if peak.largest.row == peak.highest.row || peak.largest.height <= found.0 {
            return found;
        }
        let other = near(&peak.largest);
        if other.0 > found.0 { other } else { found }
    }

    /// The times `stride` rows before a row and behind it, within the run.
    fn rows_beside(&self, position: f64, stride: usize) -> [f64; 2] {
        let last = (self.girders.states.len() - 1) as f64;
        let row = position.round();
        [(row - stride as f64).max(0.0), (row + stride as f64).min(last)]
    }

    /// When a search among values ends of which the largest are as large as `size`.
    pub fn search_end(&self, size: f64) -> SearchEnd {
        SearchEnd { evaluations: EVALUATIONS, enough: ENOUGH * self.accuracy * size }
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
    quantity == GirderResponse::VerticalMoment as usize || quantity == GirderResponse::LateralMoment as usize
}

/// Replaces a value by a larger one; of equal values the first one counts.
pub(super) fn offer(known: &mut Option<GirderValue>, found: Option<GirderValue>) {
    let Some(found) = found else { return };
    let tie = |known: &GirderValue| 1e-12 * known.signed.abs().max(found.signed.abs());
    if known.as_ref().is_none_or(|known| found.signed > known.signed + tie(known)) {
        *known = Some(found);
    }
}
