//! Results that follow from half an input, and what is missing for the whole: a weight without density, a shape whose
//! properties are stated otherwise, a taper in too few parts.

use super::notes::filled;
use super::raw::{RawGirder, RawSpec};
use super::structure::{Form, FrameSpec};
use crate::plausible::{DIFFERENCE, TAPER_ERROR};
use crate::text::number::{number, rounded};
use crate::units::{Dimension, Units};
use crate::verdict::OmittedCheck;

/// What is missing in a spec without faults: `raw` are its numbers in `units`, `form` is what was read of them.
pub(super) fn of(raw: &RawSpec, form: &Form, units: Units) -> Vec<OmittedCheck> {
    let mut out = Vec::new();
    if let Form::Frame(frame) = form {
        out.extend(tapers(frame));
    }
    if let Some(girder) = &raw.girder {
        out.extend(weight(girder));
        out.extend(properties(girder, units));
    }
    out
}

/// A girder whose crane rail alone has mass.
fn weight(girder: &RawGirder) -> Option<OmittedCheck> {
    let has_mass =
        girder.mass_per_length.is_some() || girder.density.is_some() || girder.section.is_some();
    (girder.crane_rail.is_some() && !has_mass).then(|| {
        OmittedCheck::new(
            "self-weight and mass of the girder",
            "only its crane rail has mass; specify `density` beside `shape`, or `mass_per_length`",
        )
    })
}

/// Properties that are stated beside a section and differ from it: stresses take the fibres of the section.
fn properties(girder: &RawGirder, units: Units) -> Option<OmittedCheck> {
    if girder.shape.is_none() && girder.section.is_none() {
        return None;
    }
    let bare = RawGirder {
        area: None,
        i_vertical: None,
        i_lateral: None,
        j: None,
        crane_rail: None,
        composite: None,
        ..girder.numbers()
    };
    let own = filled(&bare, units);
    let pairs = [
        ("A", girder.area, own.area, Dimension::AREA),
        (
            "I_vertical",
            girder.i_vertical,
            own.i_vertical,
            Dimension::SECOND_MOMENT,
        ),
        (
            "I_lateral",
            girder.i_lateral,
            own.i_lateral,
            Dimension::SECOND_MOMENT,
        ),
        ("J", girder.j, own.j, Dimension::SECOND_MOMENT),
    ];
    let differing: Vec<String> = pairs
        .into_iter()
        .filter_map(|(key, stated, own, dimension)| {
            let (stated, own) = (stated?, own?);
            let words =
                |value: f64| format!("{} {}", number(rounded(value, 4)), units.label(dimension));
            ((stated / own - 1.0).abs() > DIFFERENCE).then(|| {
                format!(
                    "`{key}` is {}, that of the section {}",
                    words(stated),
                    words(own)
                )
            })
        })
        .collect();
    (!differing.is_empty()).then(|| {
        let reason = format!(
            "{}; the stated numbers are used for deflections, and the edges of the section for stresses",
            differing.join("; ")
        );
        OmittedCheck::new("agreement of the stated properties with the section of the girder", reason)
    })
}

/// Tapered members in so few parts that deflections err visibly.
///
/// The flexibility of a part is the mean over its length, so that the error of n parts comes from the change of the bending
/// moment within a part. For a second moment whose ends have the ratio r, and a moment that vanishes at one end, it is
/// ln r/(4 n^2) while r is below 20, and (ln r)^2/(12 n^2) above; both within a factor of two (quadrature of M^2/EI for
/// second moments that vary linearly, and with the cube of a height).
fn tapers(frame: &FrameSpec) -> Option<OmittedCheck> {
    let mut worst: Option<(f64, String)> = None;
    let mut count = 0;
    for cell in frame.cells.chunk_by(|a, b| a == b).scan(0, |first, cell| {
        let from = *first;
        *first += cell.len();
        Some(from..*first)
    }) {
        let Some(outline) = frame.member_outlines.get(cell.start) else {
            continue;
        };
        let Some((other, _)) = outline.taper else {
            continue;
        };
        let [a, b] = [outline.section, other].map(|index| &frame.model.sections[index]);
        let variation = [(a.iy, b.iy), (a.iz, b.iz)].map(|(a, b)| (a / b).ln().abs());
        let variation = variation
            .into_iter()
            .filter(|v| v.is_finite())
            .fold(0.0, f64::max);
        let whole = variation * variation.max(3.0) / 12.0;
        let parts = cell.len() as f64;
        let error = whole / (parts * parts);
        if error <= TAPER_ERROR {
            continue;
        }
        count += 1;
        if worst.as_ref().is_none_or(|(most, _)| error > *most) {
            let [block, index] = frame.cells[cell.start];
            let needed = (whole / TAPER_ERROR).sqrt().ceil();
            let words = format!(
                "cells[{block}].data[{index}] has {parts} `parts`, while its second moments differ by a factor of {}: \
                 deflections may err by about {:.0} %; specify at least {needed} `parts`",
                number(rounded(variation.exp(), 2)),
                100.0 * error.min(1.0)
            );
            worst = Some((error, words));
        }
    }
    let (_, words) = worst?;
    let more = match count - 1 {
        0 => String::new(),
        1 => "; one more cell has too few".to_owned(),
        more => format!("; {more} more cells have too few"),
    };
    Some(OmittedCheck::new(
        "deflections of tapered members",
        words + &more,
    ))
}
