//! Extremes between the rows of a history: peaks of the scan, refined over time, and along the girder where no wheel
//! stands at the section.

use trains::{GirderResponse, SectionSide};

use super::distributed::FORCES;
use super::girder::{LoadedGirders, OwnLoad};
use super::peaks::{Peak, largest};
use super::scan::{SIGNS, Scan};

/// Number of evaluations of a golden section.
const EVALUATIONS: usize = 20;
/// Rounds of refinement over time and along the girder in turn.
const ROUNDS: usize = 3;
/// Peaks that are lower than the highest one by more than this fraction of the largest value of their kind are left out.
const NEAR: f64 = 0.05;

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

/// The largest or smallest value of one quantity over a span.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpanValue {
    /// Index in the list of rails.
    pub rail: usize,
    pub span: usize,
    /// Index of the quantity in [`trains::GirderResponse::ALL`].
    pub quantity: usize,
    /// 0: largest, 1: smallest.
    pub kind: usize,
    pub found: GirderValue,
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

    /// The extremes of every span that has sections.
    pub fn spans(&self) -> Vec<SpanValue> {
        let mut out = Vec::new();
        for (rail, outline) in self.girders.sections.rails.iter().enumerate() {
            for span in 0..=outline.ends.len() {
                let [from, to] = outline.bounds(span);
                if to - from <= 1e-9 * (outline.range[1] - outline.range[0]) {
                    continue;
                }
                for quantity in (0..FORCES + 2).filter(|quantity| !self.is_zero(*quantity)) {
                    for kind in 0..2 {
                        let found = match quantity.checked_sub(FORCES) {
                            None => self.span_force(rail, span, quantity, kind),
                            Some(plane) => self.span_deflection(rail, span, plane, kind),
                        };
                        out.extend(found.map(|found| SpanValue { rail, span, quantity, kind, found }));
                    }
                }
            }
        }
        out
    }

    /// The largest of sign times a force over a span: at its sections, where wheels pass them, and beside wheels.
    fn span_force(&self, rail: usize, span: usize, quantity: usize, kind: usize) -> Option<GirderValue> {
        let Scan { sections: peaks, wheels, .. } = self.scan;
        let all = &self.girders.sections;
        let own: Vec<usize> = (0..all.sections.len())
            .filter(|at| all.sections[*at].span == span && all.points[all.sections[*at].point].rail == rail)
            .collect();
        let loads = wheels.len() / (2 * self.scan.first_span[self.scan.first_span.len() - 1]).max(1);
        let tracks: Vec<(usize, bool, &Peak)> = (0..loads)
            .flat_map(|load| [(load, false), (load, true)])
            .map(|(load, behind)| {
                (load, behind, &wheels[self.scan.wheel(load, behind, rail, span)][quantity][kind])
            })
            .collect();
        let heights = own.iter().map(|at| peaks[*at][quantity][kind].height);
        let best = heights.chain(tracks.iter().map(|track| track.2.height)).fold(f64::NEG_INFINITY, f64::max);
        let least = best - NEAR * self.size(quantity);
        let mut found: Option<GirderValue> = None;
        for &at in &own {
            let is_near = peaks[at][quantity][kind].height >= least;
            offer(&mut found, self.section(at, quantity, kind, is_near));
        }
        if let Some(own) = found.filter(|own| own.own.is_none() && !self.girders.distributed.is_empty()) {
            offer(&mut found, self.along(rail, span, quantity, kind, own));
        }
        for (load, behind, peak) in tracks.into_iter().filter(|track| track.2.height >= least) {
            offer(&mut found, self.beside(rail, span, (load, behind), quantity, kind, peak));
        }
        found
    }

    /// The largest of sign times a force at a section over time, wheels that pass it included. The peak between the rows
    /// is refined if `is_near`.
    pub fn section(&self, at: usize, quantity: usize, kind: usize, is_near: bool) -> Option<GirderValue> {
        let section = &self.girders.sections.sections[at];
        let x = self.girders.sections.points[section.point].x;
        let peak = &self.scan.sections[at][quantity][kind];
        if peak.height == f64::NEG_INFINITY {
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

    /// The largest value just before or just behind a wheel in a span.
    fn beside(
        &self,
        rail: usize,
        span: usize,
        own: (usize, bool),
        quantity: usize,
        kind: usize,
        peak: &Peak,
    ) -> Option<GirderValue> {
        if peak.height == f64::NEG_INFINITY {
            return None;
        }
        let girders = self.girders;
        // a load on another rail of the same member stands opposite to a section of this one
        let place = |position: f64| {
            let state = girders.states.at(position);
            let mut passed = trains::PassedLoads::default();
            let on = |(index, member): (usize, trains::RailMember)| {
                if member.rail != girders.sections.rails[rail].rail {
                    return None;
                }
                girders.members.load(index, &state.loads, &mut passed);
                let (_, place) = passed.places().find(|(load, _)| *load == own.0)?;
                let x = girders.members.coordinate(index, place);
                girders.member_at(rail, x, span).is_some().then_some((index, place, x))
            };
            let found = girders.members.members().enumerate().find_map(on)?;
            Some((state, found))
        };
        let value = |position: f64, is_behind: bool| {
            place(position).map_or(f64::NEG_INFINITY, |(state, (member, place, _))| {
                SIGNS[kind] * girders.forces_in(member, place, &state, Some((own.0, is_behind)))[quantity]
            })
        };
        let (signed, position) = self.over_time((peak, 1), quantity, &mut |position| value(position, own.1));
        let (_, (member, place, x)) = place(position)?;
        let side = match own.1 {
            _ if is_moment(quantity) => SectionSide::At,
            true => SectionSide::Behind,
            false => SectionSide::Before,
        };
        let section = Some((member, place));
        Some(GirderValue { signed, position, x, section, own: Some(own), is_after: None, side })
    }

    /// Refines a value at a section along its member and over time in turn.
    fn along(
        &self,
        rail: usize,
        span: usize,
        quantity: usize,
        kind: usize,
        from: GirderValue,
    ) -> Option<GirderValue> {
        let girders = self.girders;
        let (member, _) = from.section?;
        let outline = &girders.sections.rails[rail];
        let ends = girders.members.members().nth(member)?.x;
        let bounds = outline.bounds(span);
        let neighbours = neighbours(&outline.places, from.x);
        let near = [neighbours[0].max(ends[0]).max(bounds[0]), neighbours[1].min(ends[1]).min(bounds[1])];
        let value = |x: f64, position: f64| {
            let place = girders.members.place(member, x);
            SIGNS[kind] * girders.forces_in(member, place, &girders.states.at(position), None)[quantity]
        };
        let mut found = from;
        for _ in 0..ROUNDS {
            let (signed, x) = largest(near, EVALUATIONS, &mut |x| value(x, found.position));
            if signed <= found.signed + 1e-3 * self.accuracy * self.size(quantity) {
                break;
            }
            found = GirderValue {
                signed,
                x,
                section: Some((member, girders.members.place(member, x))),
                side: SectionSide::At,
                ..found
            };
            let (signed, position) = self.near_in_time(found.position, 1, &mut |position| value(x, position));
            if signed > found.signed {
                found = GirderValue { signed, position, ..found };
            }
        }
        Some(found)
    }

    /// The largest of sign times the deflection over a span.
    fn span_deflection(&self, rail: usize, span: usize, plane: usize, kind: usize) -> Option<GirderValue> {
        let (girders, sections) = (self.girders, self.girders.sections);
        let outline = &sections.rails[rail];
        let [from, to] = outline.bounds(span);
        let own = (0..sections.points.len()).filter(|at| {
            let point = sections.points[*at];
            point.rail == rail && point.x >= from && point.x <= to
        });
        let at = own.max_by(|a, b| {
            let height = |at: &usize| self.scan.points[*at][plane][kind].height;
            // of equal heights the first one counts
            height(a).total_cmp(&height(b)).then(b.cmp(a))
        })?;
        let mut found = self.point(at, plane, kind)?;
        let near = neighbours(&outline.places, found.x);
        let near = [near[0].max(from), near[1].min(to)];
        for _ in 0..ROUNDS {
            let state = girders.states.at(found.position);
            let (signed, x) = largest(near, EVALUATIONS, &mut |x| {
                girders.deflections(rail, &[x], plane, &state).map_or(0.0, |all| SIGNS[kind] * all[0])
            });
            if signed <= found.signed {
                break;
            }
            let gain = signed - found.signed;
            found = GirderValue { signed, x, ..found };
            let (signed, position) =
                self.near_in_time(found.position, girders.deflection_stride, &mut |position| {
                    SIGNS[kind] * girders.deflection(rail, x, plane, position)
                });
            if signed > found.signed {
                found = GirderValue { signed, position, ..found };
            }
            if gain <= 1e-3 * self.accuracy * self.size(FORCES + plane) {
                break;
            }
        }
        Some(found)
    }

    /// The largest of sign times the deflection of a point over time.
    pub fn point(&self, at: usize, plane: usize, kind: usize) -> Option<GirderValue> {
        let point = self.girders.sections.points[at];
        let peak = &self.scan.points[at][plane][kind];
        if peak.height == f64::NEG_INFINITY {
            return None;
        }
        let mut value =
            |position: f64| SIGNS[kind] * self.girders.deflection(point.rail, point.x, plane, position);
        let (signed, position) =
            self.over_time((peak, self.girders.deflection_stride), FORCES + plane, &mut value);
        let side = SectionSide::At;
        Some(GirderValue { signed, position, x: point.x, section: None, own: None, is_after: None, side })
    }

    /// The largest value in the two intervals beside the row of a peak; the value at the row where the values beside it
    /// show that no larger one lies between the rows.
    fn over_time(
        &self,
        (peak, stride): (&Peak, usize),
        quantity: usize,
        value: &mut dyn FnMut(f64) -> f64,
    ) -> (f64, f64) {
        if peak.height - peak.value <= 1e-2 * self.accuracy * self.size(quantity) {
            return (peak.value, (peak.row * stride) as f64);
        }
        self.near_in_time((peak.row * stride) as f64, stride, value)
    }

    /// The largest value from `stride` rows before a time to as many behind it.
    fn near_in_time(&self, position: f64, stride: usize, value: &mut dyn FnMut(f64) -> f64) -> (f64, f64) {
        let last = (self.girders.states.len() - 1) as f64;
        let own = (value(position), position);
        let row = position.round();
        let ends = [(row - stride as f64).max(0.0), (row + stride as f64).min(last)];
        if ends[1] <= ends[0] {
            return own;
        }
        let found = largest(ends, EVALUATIONS, value);
        // of equal values the row itself counts
        if found.0 > own.0 { found } else { own }
    }
}

/// Whether a quantity is a bending moment, which is the same on both sides of a wheel.
fn is_moment(quantity: usize) -> bool {
    quantity == GirderResponse::VerticalMoment as usize || quantity == GirderResponse::LateralMoment as usize
}

/// Replaces a value by a larger one; of equal values the first one counts.
fn offer(known: &mut Option<GirderValue>, found: Option<GirderValue>) {
    let Some(found) = found else { return };
    let tie = |known: &GirderValue| 1e-12 * known.signed.abs().max(found.signed.abs());
    if known.as_ref().is_none_or(|known| found.signed > known.signed + tie(known)) {
        *known = Some(found);
    }
}

/// The places beside a coordinate.
fn neighbours(places: &[f64], x: f64) -> [f64; 2] {
    let before = places.iter().rev().find(|place| **place < x);
    let after = places.iter().find(|place| **place > x);
    [before.map_or(x, |place| *place), after.map_or(x, |place| *place)]
}
