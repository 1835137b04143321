//! Extremes of spans: the largest values of their sections, those beside wheels, and those between sections.

use trains::SectionSide;

use super::deflections::Wanted;
use super::distributed::FORCES;
use super::peaks::{Peak, SIGNS, largest};
use super::refine::{Corners, GirderValue, NEAR, ROUNDS, Refinement, is_moment, offer};
use super::scan::Scan;

/// Peaks of sections that are lower than a refined value by more than this fraction of the largest value of their kind are left
/// out: rows are near enough to each other that the parabolas through them err by less.
const BELOW: f64 = 0.01;

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

impl Refinement<'_> {
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
                    if (self.girders.is_stopped)() {
                        return out;
                    }
                    for kind in 0..2 {
                        let found = match quantity.checked_sub(FORCES) {
                            None => self.span_force(rail, span, quantity, kind),
                            Some(plane) => self.span_deflection(Wanted {
                                rail,
                                span,
                                plane,
                                kind,
                            }),
                        };
                        out.extend(found.map(|found| SpanValue {
                            rail,
                            span,
                            quantity,
                            kind,
                            found,
                        }));
                    }
                }
            }
        }
        out
    }

    /// The largest of sign times a force over a span: at its sections, where wheels pass them, and beside wheels.
    fn span_force(
        &self,
        rail: usize,
        span: usize,
        quantity: usize,
        kind: usize,
    ) -> Option<GirderValue> {
        let Scan {
            sections: peaks,
            wheels,
            ..
        } = self.scan;
        let all = &self.girders.sections;
        let own: Vec<usize> = (0..all.sections.len())
            .filter(|at| {
                all.sections[*at].span == span && all.points[all.sections[*at].point].rail == rail
            })
            .collect();
        let loads =
            wheels.len() / (2 * self.scan.first_span[self.scan.first_span.len() - 1]).max(1);
        let tracks: Vec<(usize, bool, &Peak)> = (0..loads)
            .flat_map(|load| [(load, false), (load, true)])
            .map(|(load, behind)| {
                (
                    load,
                    behind,
                    &wheels[self.scan.wheel(load, behind, rail, span)][quantity][kind],
                )
            })
            .collect();
        let values = own
            .iter()
            .map(|at| peaks[*at][quantity][kind].largest.value);
        let values = values.chain(tracks.iter().map(|track| track.2.largest.value));
        let best = values.fold(f64::NEG_INFINITY, f64::max);
        let least = best - NEAR * self.size(quantity);
        // sections with higher peaks first: what is far below a peak that is known is not followed
        let height = |at: usize| peaks[at][quantity][kind].highest.height;
        let mut ranked: Vec<usize> = (0..own.len()).collect();
        ranked.sort_by(|a, b| height(own[*b]).total_cmp(&height(own[*a])));
        let (mut of_sections, mut known) = (vec![None; own.len()], f64::NEG_INFINITY);
        for rank in ranked {
            let near = least.max(known - BELOW * self.size(quantity));
            let value = self.section(own[rank], quantity, kind, height(own[rank]) >= near);
            known = value.map_or(known, |value| known.max(value.signed));
            of_sections[rank] = value;
        }
        // of equal values that of the first section counts
        let mut found: Option<GirderValue> = None;
        of_sections
            .into_iter()
            .for_each(|value| offer(&mut found, value));
        if let Some(own) =
            found.filter(|own| own.own.is_none() && !self.girders.distributed.is_empty())
        {
            offer(&mut found, self.along(rail, span, quantity, kind, own));
        }
        for (load, behind, peak) in tracks
            .into_iter()
            .filter(|track| track.2.highest.height >= least)
        {
            offer(
                &mut found,
                self.beside(rail, span, (load, behind), quantity, kind, peak),
            );
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
        if peak.highest.height == f64::NEG_INFINITY {
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
                girders
                    .member_at(rail, x, span)
                    .is_some()
                    .then_some((index, place, x))
            };
            let found = girders.members.members().enumerate().find_map(on)?;
            Some((state, found))
        };
        let value = |position: f64, is_behind: bool| {
            place(position).map_or(f64::NEG_INFINITY, |(state, (member, place, _))| {
                SIGNS[kind]
                    * girders.forces_in(member, place, &state, Some((own.0, is_behind)))[quantity]
            })
        };
        let (signed, position) =
            self.over_time((peak, 1), (quantity, Corners::NONE), &mut |position| {
                value(position, own.1)
            });
        let (_, (member, place, x)) = place(position)?;
        let side = match own.1 {
            _ if is_moment(quantity) => SectionSide::At,
            true => SectionSide::Behind,
            false => SectionSide::Before,
        };
        let section = Some((member, place));
        Some(GirderValue {
            signed,
            position,
            x,
            section,
            own: Some(own),
            is_after: None,
            side,
        })
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
        let neighbours = outline.neighbours(from.x);
        let near = [
            neighbours[0].max(ends[0]).max(bounds[0]),
            neighbours[1].min(ends[1]).min(bounds[1]),
        ];
        let value = |x: f64, position: f64| {
            let place = girders.members.place(member, x);
            SIGNS[kind]
                * girders.forces_in(member, place, &girders.states.at(position), None)[quantity]
        };
        let (mut found, size) = (from, self.size(quantity));
        for _ in 0..ROUNDS {
            let known = (found.signed, found.x);
            let (signed, x) = largest(near, known, self.search_end(size), &mut |x| {
                value(x, found.position)
            });
            if signed <= found.signed + 1e-3 * self.accuracy * size {
                break;
            }
            found = GirderValue {
                signed,
                x,
                section: Some((member, girders.members.place(member, x))),
                side: SectionSide::At,
                ..found
            };
            let (signed, position) =
                self.near_in_time(found.position, 1, &mut |position| value(x, position));
            if signed > found.signed {
                found = GirderValue {
                    signed,
                    position,
                    ..found
                };
            }
        }
        Some(found)
    }
}
