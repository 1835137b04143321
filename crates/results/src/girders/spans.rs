//! Extremes of spans: the largest values of their sections or places, those beside or under loads, and those between sections.

use trains::SectionSide;

use super::deflections::{DeflectionPeaks, KnownDeflection};
use super::distributed::FORCES;
use super::forces::ForcePeaks;
use super::girder::LoadedGirders;
use super::value::{GirderValue, offer};
use crate::pieces::{LoadState, Peak, SIGNS};

/// Part of the largest value by which that of a section may be lower, and the largest value near to it still be the largest of all.
/// Sections are twentieths of a span, between which the moment of distributed forces rises by little.
const NEAR: f64 = 0.01;

/// The same for deflections of places, which may have corners under loads as well.
const NEAR_DEFLECTION: f64 = 0.05;

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

/// The peaks of a structure.
pub(super) struct GirderPeaks<'a> {
    pub girders: &'a LoadedGirders<'a>,
    pub forces: ForcePeaks,
    pub deflections: DeflectionPeaks,
    /// Largest magnitude of each quantity, and of both deflections.
    pub sizes: [f64; FORCES + 2],
}

impl<'a> GirderPeaks<'a> {
    /// The peaks of all sections and places; those beside and under loads only if `has_loads`.
    pub fn new(girders: &'a LoadedGirders<'a>, has_loads: bool) -> GirderPeaks<'a> {
        let forces = ForcePeaks::new(girders, has_loads);
        let deflections = DeflectionPeaks::new(girders, &forces.first_span, has_loads);
        let mut out = GirderPeaks {
            girders,
            forces,
            deflections,
            sizes: [0.0; FORCES + 2],
        };
        let spans = out.forces.beside.len();
        out.sizes = std::array::from_fn(|quantity| {
            let of_kind = |kind: usize| {
                let sections = (0..out.count(quantity)).map(move |at| (at, kind));
                let sections = sections.filter_map(|(at, kind)| out.value(at, quantity, kind));
                let loads = (0..spans).map(move |span| (span, kind));
                sections.chain(loads.filter_map(|(span, kind)| out.at_loads(span, quantity, kind)))
            };
            let all = (0..2).flat_map(of_kind);
            all.map(|found| found.signed.abs()).fold(0.0, f64::max)
        });
        out
    }

    /// Number of the sections, or of the points for deflections.
    fn count(&self, quantity: usize) -> usize {
        match quantity < FORCES {
            true => self.girders.sections.sections.len(),
            false => self.girders.sections.points.len(),
        }
    }

    /// The largest of sign times a quantity at a section, or at a point for deflections.
    pub fn value(&self, at: usize, quantity: usize, kind: usize) -> Option<GirderValue> {
        match quantity.checked_sub(FORCES) {
            None => self.forces.section(self.girders, at, quantity, kind),
            Some(plane) => self.deflections.point(self.girders, at, plane, kind),
        }
    }

    /// The same beside or under the loads in a span, by its index among all spans.
    fn at_loads(&self, span: usize, quantity: usize, kind: usize) -> Option<GirderValue> {
        match quantity.checked_sub(FORCES) {
            None => self.forces.beside[span][quantity][kind],
            Some(plane) => self.deflections.under[span][plane][kind],
        }
    }

    /// Whether a quantity is zero throughout but for rounding: 1e-9 of the largest force, or of the largest moment, or of
    /// the largest deflection.
    pub fn is_zero(&self, quantity: usize) -> bool {
        self.sizes[quantity] <= 1e-9 * self.kind_size(quantity)
    }

    /// A value of a quantity, and 0 where it is below 1e-12 of the largest value of its kind.
    pub fn without_rounding(&self, quantity: usize, value: f64) -> f64 {
        if value.abs() <= 1e-12 * self.kind_size(quantity) {
            0.0
        } else {
            value
        }
    }

    /// Largest magnitude of the quantities of one dimension.
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
                if to - from <= outline.slack() {
                    continue;
                }
                for quantity in (0..FORCES + 2).filter(|quantity| !self.is_zero(*quantity)) {
                    if (self.girders.is_stopped)() {
                        return out;
                    }
                    for kind in 0..2 {
                        let found = self.span((rail, span), quantity, kind);
                        let value = |found| SpanValue {
                            rail,
                            span,
                            quantity,
                            kind,
                            found,
                        };
                        out.extend(found.map(value));
                    }
                }
            }
        }
        self.raise_deflections(&mut out);
        out
    }

    /// Raises deflections to the largest ones at their places at any time. They were sought from the largest values of places
    /// beside them, which may occur at another time.
    fn raise_deflections(&self, all: &mut [SpanValue]) {
        let deflections = all
            .iter_mut()
            .filter(|own| own.quantity >= FORCES && own.found.signed > 0.0);
        let values: Vec<&mut SpanValue> = deflections.collect();
        let of_value = |own: &&mut SpanValue| KnownDeflection {
            rail: own.rail,
            plane: own.quantity - FORCES,
            kind: own.kind,
            x: own.found.x,
            signed: own.found.signed,
        };
        let known: Vec<KnownDeflection> = values.iter().map(of_value).collect();
        let larger = DeflectionPeaks::larger(self.girders, &known);
        for (own, peak) in values.into_iter().zip(larger) {
            let Some(Peak { signed, at, .. }) = peak else {
                continue;
            };
            let from = GirderValue {
                signed,
                at,
                ..own.found
            };
            own.found = self.near((own.rail, own.span), own.quantity, own.kind, from);
        }
    }

    /// The largest of sign times a quantity over a span: at its sections or places and near to them, then at the loads.
    fn span(
        &self,
        (rail, span): (usize, usize),
        quantity: usize,
        kind: usize,
    ) -> Option<GirderValue> {
        let values = self.sections_of((rail, span), quantity, kind);
        let mut found: Option<GirderValue> = None;
        values.iter().for_each(|value| offer(&mut found, *value));
        let at_loads = self.at_loads(self.forces.first_span[rail] + span, quantity, kind);
        let near = match quantity.checked_sub(FORCES) {
            Some(_) => Some(NEAR_DEFLECTION),
            None => self.girders.distributed.is_along().then_some(NEAR),
        };
        let best = found.iter().chain(&at_loads).map(|found| found.signed);
        let best = best.fold(f64::NEG_INFINITY, f64::max);
        for (k, value) in values.iter().enumerate() {
            let is_crest = (k == 0 || value.signed >= values[k - 1].signed)
                && values
                    .get(k + 1)
                    .is_none_or(|next| value.signed >= next.signed);
            if near.is_some_and(|near| is_crest && value.signed >= best - near * best.abs()) {
                offer(&mut found, self.near((rail, span), quantity, kind, *value));
            }
        }
        at_loads
            .into_iter()
            .for_each(|value| offer(&mut found, value));
        found
    }

    /// The values of the sections of a span in their order, or of its points that a member carries.
    fn sections_of(
        &self,
        (rail, span): (usize, usize),
        quantity: usize,
        kind: usize,
    ) -> Vec<GirderValue> {
        let all = self.girders.sections;
        let [from, to] = all.rails[rail].bounds(span);
        let is_own = |at: &usize| match quantity < FORCES {
            true => {
                let section = &all.sections[*at];
                section.span == span && all.points[section.point].rail == rail
            }
            false => {
                let point = all.points[*at];
                point.rail == rail
                    && (from..=to).contains(&point.x)
                    && self.girders.is_carried(rail, point.x, span)
            }
        };
        let own = (0..self.count(quantity)).filter(is_own);
        own.filter_map(|at| self.value(at, quantity, kind))
            .collect()
    }

    /// The largest value near to that of a section or place.
    fn near(
        &self,
        (rail, span): (usize, usize),
        quantity: usize,
        kind: usize,
        from: GirderValue,
    ) -> GirderValue {
        let girders = self.girders;
        let outline = &girders.sections.rails[rail];
        let bounds = outline.bounds(span);
        let beside = outline.neighbours(from.x);
        let beside = [beside[0].max(bounds[0]), beside[1].min(bounds[1])];
        let Some((member, _)) = from.section else {
            let plane = quantity - FORCES;
            // as far as members carry the rail without a gap; ends of members are places
            let near = beside.map(|end| {
                let is_carried = girders.is_carried(rail, 0.5 * (end + from.x), span);
                if is_carried { end } else { from.x }
            });
            return girders.climb(near, from, &|x, state: &LoadState<'_>| {
                let found = girders.deflections(rail, &[x], plane, state)?;
                Some(SIGNS[kind] * found[0])
            });
        };
        let found = girders.climb_member(member, beside, from, &|place, state| {
            SIGNS[kind] * girders.forces(member, place, state, None)[quantity]
        });
        GirderValue {
            section: Some((member, girders.members.place(member, found.x))),
            ..found
        }
    }
}

impl LoadedGirders<'_> {
    /// The largest value near to one of a member, between two coordinates.
    pub fn climb_member(
        &self,
        member: usize,
        [from, to]: [f64; 2],
        value: GirderValue,
        of: &dyn Fn(f64, &LoadState<'_>) -> f64,
    ) -> GirderValue {
        let Some(ends) = self.members.members().nth(member).map(|own| own.x) else {
            return value;
        };
        let near = [from.max(ends[0]), to.min(ends[1])];
        let found = self.climb(near, value, &|x, state| {
            Some(of(self.members.place(member, x), state))
        });
        // the place itself keeps its side
        let side = if found.x == value.x {
            value.side
        } else {
            SectionSide::At
        };
        GirderValue { side, ..found }
    }
}
