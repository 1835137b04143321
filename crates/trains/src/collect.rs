//! Extremes while they are collected over carriers, and which of two states governs.

use std::collections::HashMap;

use crate::extremes::{Governing, TrainPosition};
use crate::plan::{Arrangement, CasePlan, TIE};
use crate::structure::{Carrier, GirderResponse, Structure};

/// The extremes of one case while they are collected.
#[derive(Debug, Default)]
pub(crate) struct Accumulated {
    pub list: Vec<Entry>,
    /// Where each entry stands in the list, by rail, span, quantity and kind.
    places: HashMap<(usize, usize, usize, bool), usize>,
}

/// An extreme whose value may still be unknown.
#[derive(Debug)]
pub(crate) struct Entry {
    pub rail: usize,
    pub span: usize,
    pub quantity: GirderResponse,
    pub is_max: bool,
    pub governing: Option<Governing>,
    /// What no value exceeds, where that is known to be more than the value: sign times bound.
    pub bound: Option<f64>,
}

/// The entry for a quantity of a span.
pub(crate) fn entry(
    all: &mut Accumulated,
    rail: usize,
    span: usize,
    quantity: GirderResponse,
    is_max: bool,
) -> &mut Entry {
    let list = &mut all.list;
    let at = *all
        .places
        .entry((rail, span, quantity as usize, is_max))
        .or_insert_with(|| {
            list.push(Entry {
                rail,
                span,
                quantity,
                is_max,
                governing: None,
                bound: None,
            });
            list.len() - 1
        });
    &mut list[at]
}

/// +1 for a largest, -1 for a smallest value.
pub(crate) const fn sign_of(is_max: bool) -> f64 {
    if is_max { 1.0 } else { -1.0 }
}

/// Replaces a governing state by a better one.
pub(crate) fn offer(known: &mut Option<Governing>, found: Option<Governing>, sign: f64) {
    let Some(found) = found else { return };
    if known
        .as_ref()
        .is_none_or(|known| is_better(&found, known, sign))
    {
        *known = Some(found);
    }
}

/// Whether a state is larger than a known one or, where they are equal to rounding, before it: unturned, then by
/// position, then by coordinate.
pub(crate) fn is_better(found: &Governing, known: &Governing, sign: f64) -> bool {
    let difference = sign * (found.value - known.value);
    let tie = TIE * found.value.abs().max(known.value.abs());
    if difference.abs() > tie {
        return difference > 0.0;
    }
    let order = |g: &Governing| {
        (
            g.trains.iter().map(|t| t.stance.turned).collect::<Vec<_>>(),
            g.trains.iter().map(|t| t.position).collect::<Vec<_>>(),
            g.x,
        )
    };
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs()).max(1e-300);
    let ((turned, positions, x), (known_turned, known_positions, known_x)) =
        (order(found), order(known));
    if turned != known_turned {
        return turned < known_turned;
    }
    for (a, b) in positions.iter().zip(&known_positions) {
        if !near(*a, *b) {
            return a < b;
        }
    }
    !near(x, known_x) && x < known_x
}

/// The spans over a carrier with the part of each that lies on it; `spans` are coordinates of their ends by rail.
pub(crate) fn spans_of(
    spans: &[Vec<f64>],
    structure: &Structure,
    carrier: &Carrier,
) -> Vec<(usize, [f64; 2])> {
    let slack = structure.slack();
    let ends = spans.get(carrier.rail).map_or(&[][..], Vec::as_slice);
    let mut out = Vec::new();
    for span in 0..=ends.len() {
        let from = if span == 0 {
            f64::NEG_INFINITY
        } else {
            ends[span - 1]
        };
        let to = ends.get(span).copied().unwrap_or(f64::INFINITY);
        let part = [from.max(carrier.x[0]), to.min(carrier.x[1])];
        if part[1] - part[0] > slack {
            out.push((span, part));
        }
    }
    out
}

/// Where the trains of an arrangement stand.
pub(crate) fn standings(plan: &CasePlan, found: &Arrangement) -> Vec<TrainPosition> {
    let each = found.trains.iter().zip(&plan.trains);
    each.map(|(standing, stances)| TrainPosition {
        position: standing.position,
        stance: stances[standing.stance].stance,
    })
    .collect()
}
