//! Results that follow from half an input, and what is missing for the whole: a weight without density, a shape whose
//! properties are stated otherwise.

use super::notes::filled;
use super::raw::{RawGirder, RawSpec};
use crate::text::number::{number, rounded};
use crate::units::{Dimension, Units};
use crate::verdict::OmittedCheck;

/// Difference of a stated property from that of the section beside it, relative, above which one of the two is doubtful.
/// Tables of rolled sections differ by less than 1 % from the formulas; 5 % is the limit of the contract for stated
/// properties beside a named section.
const DIFFERENCE: f64 = 0.05;

/// What is missing in a spec without faults, whose numbers are in `units`.
pub(super) fn of(raw: &RawSpec, units: Units) -> Vec<OmittedCheck> {
    let mut out = Vec::new();
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
