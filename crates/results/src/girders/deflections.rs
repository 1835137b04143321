//! Extremes of the deflections of spans: at listed places, under wheels, and between them.
//!
//! A deflection that depends on the torsion or the shear of its member has a corner under each wheel, and its largest
//! value is often there. As the corner moves with the wheel, refinement along the rail and over time in turn does not
//! reach it: the deflection under the wheel is refined over time, with its place. Extremes elsewhere are refined over
//! time and along the rail in turn, from every listed place whose deflection exceeds those of the places beside it and
//! is nearly as large as the largest.
//!
//! Only places that a member carries count. Between two members the rail moves with the nearer of their ends, which may
//! be that of the girder of the next span.

use trains::SectionSide;

use super::distributed::FORCES;
use super::peaks::{Peak, SIGNS, largest};
use super::refine::{Corners, GirderValue, NEAR, ROUNDS, Refinement, offer};

/// An extreme of a deflection of a span: its plane (0: vertical, 1: lateral) and kind (0: largest, 1: smallest).
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    /// Index in the list of rails.
    pub rail: usize,
    pub span: usize,
    pub plane: usize,
    pub kind: usize,
}

impl Refinement<'_> {
    /// The largest of sign times the deflection over a span.
    pub fn span_deflection(&self, wanted: Wanted) -> Option<GirderValue> {
        let Wanted {
            rail,
            span,
            plane,
            kind,
        } = wanted;
        let spans = self.scan.first_span[self.scan.first_span.len() - 1];
        let tracks = (0..self.scan.under.len() / spans.max(1)).map(|load| {
            (
                load,
                &self.scan.under[self.scan.under(load, rail, span)][plane][kind],
            )
        });
        let points = self.carried_points(wanted);
        let heights: Vec<f64> = points
            .iter()
            .map(|at| self.scan.points[*at][plane][kind].highest.height)
            .collect();
        let under = tracks.clone().map(|(_, peak)| peak.highest.height);
        let best = heights
            .iter()
            .copied()
            .chain(under)
            .fold(f64::NEG_INFINITY, f64::max);
        let least = best - NEAR * self.size(FORCES + plane);
        let mut found: Option<GirderValue> = None;
        for (k, &at) in points.iter().enumerate() {
            // of equal heights the first one counts
            let is_crest = (k == 0 || heights[k] > heights[k - 1])
                && heights.get(k + 1).is_none_or(|after| heights[k] >= *after);
            if is_crest && heights[k] >= least {
                let own = self
                    .point(at, plane, kind)
                    .map(|from| self.along_and_in_time(wanted, from));
                offer(&mut found, own);
            }
        }
        for (load, peak) in tracks.filter(|(_, peak)| peak.highest.height >= least) {
            offer(&mut found, self.under(wanted, load, peak));
        }
        found
    }

    /// The listed places of a span that a member carries, in order.
    fn carried_points(&self, wanted: Wanted) -> Vec<usize> {
        let sections = self.girders.sections;
        let [from, to] = sections.rails[wanted.rail].bounds(wanted.span);
        let is_own = |at: &usize| {
            let point = sections.points[*at];
            point.rail == wanted.rail
                && point.x >= from
                && point.x <= to
                && self.girders.is_carried(wanted.rail, point.x, wanted.span)
        };
        (0..sections.points.len()).filter(is_own).collect()
    }

    /// The largest deflection under a wheel while it is in the span.
    fn under(&self, wanted: Wanted, load: usize, peak: &Peak) -> Option<GirderValue> {
        if peak.highest.height == f64::NEG_INFINITY {
            return None;
        }
        let girders = self.girders;
        let Wanted {
            rail,
            span,
            plane,
            kind,
        } = wanted;
        let [from, to] = girders.sections.rails[rail].bounds(span);
        let mut value = |position: f64| {
            let state = girders.states.at(position);
            let x = state.loads[load].x;
            if x < from || x > to || !girders.is_carried(rail, x, span) {
                return f64::NEG_INFINITY;
            }
            girders
                .deflections(rail, &[x], plane, &state)
                .map_or(f64::NEG_INFINITY, |all| SIGNS[kind] * all[0])
        };
        let (signed, position) = self.over_time(
            (peak, girders.deflection_stride),
            (FORCES + plane, Corners::NONE),
            &mut value,
        );
        let x = girders.states.at(position).loads[load].x;
        let side = SectionSide::At;
        Some(GirderValue {
            signed,
            position,
            x,
            section: None,
            own: None,
            is_after: None,
            side,
        })
    }

    /// Refines a deflection along the rail and over time in turn.
    fn along_and_in_time(&self, wanted: Wanted, from: GirderValue) -> GirderValue {
        let girders = self.girders;
        let Wanted {
            rail, plane, kind, ..
        } = wanted;
        let near = self.carried_beside(wanted, from.x);
        let (mut found, size) = (from, self.size(FORCES + plane));
        for _ in 0..ROUNDS {
            let state = girders.states.at(found.position);
            let (signed, x) = largest(
                near,
                (found.signed, found.x),
                self.search_end(size),
                &mut |x| {
                    girders
                        .deflections(rail, &[x], plane, &state)
                        .map_or(f64::NEG_INFINITY, |all| SIGNS[kind] * all[0])
                },
            );
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
                found = GirderValue {
                    signed,
                    position,
                    ..found
                };
            }
            if gain <= 1e-3 * self.accuracy * size {
                break;
            }
        }
        found
    }

    /// The places beside a coordinate, as far as members carry the rail without a gap. Ends of members are places.
    fn carried_beside(&self, wanted: Wanted, x: f64) -> [f64; 2] {
        let outline = &self.girders.sections.rails[wanted.rail];
        let [from, to] = outline.bounds(wanted.span);
        let [before, after] = outline.neighbours(x);
        [before.max(from), after.min(to)].map(|end| {
            if self
                .girders
                .is_carried(wanted.rail, 0.5 * (end + x), wanted.span)
            {
                end
            } else {
                x
            }
        })
    }
}
