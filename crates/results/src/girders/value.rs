//! Values of girders at a place and a time.

use piecewise::Lobatto;
use trains::{GirderResponse, SectionSide};

use crate::pieces::{Instant, OwnLoad, Peak, offer_piece};

/// Differences of values of different places, relative to them, up to which the first one counts.
const TIE: f64 = 1e-12;

/// A value at a section, or a deflection of a place, and a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct GirderValue {
    /// Sign times value.
    pub signed: f64,
    pub at: Instant,
    pub x: f64,
    /// Member and place on it; `None` for deflections.
    pub section: Option<(usize, f64)>,
    pub own: OwnLoad,
    pub side: SectionSide,
}

/// Replaces a value by a larger one; of equal values the first one counts.
pub(super) fn offer(known: &mut Option<GirderValue>, found: GirderValue) {
    let tie = |known: &GirderValue| TIE * known.signed.abs().max(found.signed.abs());
    if known
        .as_ref()
        .is_none_or(|known| found.signed > known.signed + tie(known))
    {
        *known = Some(found);
    }
}

/// Whether a quantity is a bending moment, which is the same on both sides of a wheel.
pub(super) fn is_moment(quantity: usize) -> bool {
    quantity == GirderResponse::VerticalMoment as usize
        || quantity == GirderResponse::LateralMoment as usize
}

/// Side of a section at which a load stands.
pub(super) fn side_of(section: SectionSide, quantity: usize, own: OwnLoad) -> SectionSide {
    match (section, own) {
        (SectionSide::At, Some((_, is_behind))) if !is_moment(quantity) => {
            if is_behind {
                SectionSide::Behind
            } else {
                SectionSide::Before
            }
        }
        _ => section,
    }
}

/// What a larger value must exceed.
pub(super) fn floor(known: &Option<GirderValue>) -> Peak {
    Peak::above(known.map_or(f64::NEG_INFINITY, |known| known.signed))
}

/// The same of the largest and the smallest value.
pub(super) fn floors(known: &[Option<GirderValue>; 2]) -> [Peak; 2] {
    [floor(&known[0]), floor(&known[1])]
}

/// Offers the polynomial through values at the nodes of a piece to the largest and the smallest value; `found` makes a value of a
/// peak.
pub(super) fn offer_values(
    known: &mut [Option<GirderValue>; 2],
    piece: (usize, &Lobatto),
    values: &[f64],
    found: &dyn Fn(&Peak) -> GirderValue,
) {
    let mut best = floors(known);
    offer_piece(&mut best, piece, values);
    for (known, best) in known.iter_mut().zip(&best).filter(|(_, best)| best.is_new) {
        offer(known, found(best));
    }
}
