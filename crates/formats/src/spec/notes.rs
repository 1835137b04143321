//! What follows from names of rolled sections and crane rails, in words for the user.

use sections::{RailProfile, crane_rail, rolled};

use super::girder_section::{filled_girder, top_of_section};
use super::raw::{RawGirder, RawRail, RawSection, RawSectionShape, RawSpec};
use super::rolled::{from_si, in_file_units};
use crate::check::Check;
use crate::text::fault::Faults;
use crate::text::number::{number, rounded};
use crate::text::place::Place;
use crate::units::{Dimension, Length, Scale, Units};

/// Number of digits in notes.
const DIGITS: usize = 5;

/// Notes on a spec without faults, whose numbers are in `units`; none if it has neither rolled sections, a girder with a shape
/// nor crane rails.
pub(super) fn of(raw: &RawSpec, units: Units) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(girder) = &raw.girder {
        notes.extend(of_girder(girder, units));
    }
    notes.extend(
        raw.sections
            .iter()
            .flatten()
            .filter_map(|section| of_section(section, units)),
    );
    let rails = raw.rails.iter().flat_map(|rails| &rails.0);
    notes.extend(rails.filter_map(|(name, rail)| of_rail(name, rail, units)));
    notes
}

fn quantity(value: f64, dimension: Dimension, units: Units) -> String {
    format!(
        "{} {}",
        number(rounded(value, DIGITS)),
        units.label(dimension)
    )
}

/// `A = 19778 mm^2, J = ...` for the numbers that the file does not state.
fn listed(numbers: &[(&str, Option<f64>, Option<f64>, Dimension)], units: Units) -> Option<String> {
    let words: Vec<String> = numbers
        .iter()
        .filter(|(_, stated, _, _)| stated.is_none())
        .filter_map(|(key, _, found, dimension)| {
            Some(format!(
                "{key} = {}",
                quantity((*found)?, *dimension, units)
            ))
        })
        .collect();
    (!words.is_empty()).then(|| words.join(", "))
}

/// Notes on the section, the material and the rail of a girder.
fn of_girder(raw: &RawGirder, units: Units) -> Vec<String> {
    let mut notes = Vec::new();
    let section = raw.section.as_deref().and_then(rolled);
    if section.is_some() || raw.shape.is_some() {
        // the girder without its rail: what the section alone gives
        let bare = RawGirder {
            crane_rail: None,
            composite: None,
            ..raw.numbers()
        };
        let found = filled(&bare, units);
        let numbers = [
            ("A", raw.area, found.area, Dimension::AREA),
            (
                "I_vertical",
                raw.i_vertical,
                found.i_vertical,
                Dimension::SECOND_MOMENT,
            ),
            (
                "I_lateral",
                raw.i_lateral,
                found.i_lateral,
                Dimension::SECOND_MOMENT,
            ),
            ("J", raw.j, found.j, Dimension::SECOND_MOMENT),
            (
                "kA_vertical",
                raw.ka_vertical,
                found.ka_vertical,
                Dimension::AREA,
            ),
            (
                "kA_lateral",
                raw.ka_lateral,
                found.ka_lateral,
                Dimension::AREA,
            ),
            (
                "mass_per_length",
                raw.mass_per_length,
                found.mass_per_length,
                Dimension::LINE_MASS,
            ),
        ];
        let name = section.map_or("its shape", |section| section.name);
        notes.extend(listed(&numbers, units).map(|words| format!("girder: {name} has {words}")));
    }
    if section.is_some() {
        let bare = RawGirder {
            crane_rail: None,
            composite: None,
            ..raw.numbers()
        };
        let found = filled(&bare, units);
        let density = found.density.filter(|_| raw.mass_per_length.is_none());
        let steel = [
            ("E", raw.e, found.e, Dimension::STRESS),
            ("G", raw.g, found.g, Dimension::STRESS),
            ("density", raw.density, density, Dimension::DENSITY),
        ];
        notes.extend(
            listed(&steel, units).map(|words| format!("girder: steel by default, {words}")),
        );
    }
    if let Some(rail) = raw.crane_rail.as_deref().and_then(crane_rail) {
        let found = filled(raw, units);
        let height = quantity(
            found.rail_height.unwrap_or_default(),
            Dimension::LENGTH,
            units,
        );
        let unstated = raw
            .rail_height
            .is_none()
            .then(|| flange_height(raw, units))
            .flatten()
            .unwrap_or_default();
        notes.push(format!(
            "girder: {}; rail_height is {height}{unstated}",
            adds(rail, "to rail_height", units)
        ));
        if raw.composite == Some(true) {
            let numbers = [
                ("A", None, found.area, Dimension::AREA),
                (
                    "I_vertical",
                    None,
                    found.i_vertical,
                    Dimension::SECOND_MOMENT,
                ),
                ("I_lateral", None, found.i_lateral, Dimension::SECOND_MOMENT),
            ];
            let words = listed(&numbers, units).unwrap_or_default();
            notes.push(format!(
                "girder: composite with the rail {}, {words}",
                rail.name
            ));
        }
    }
    notes
}

/// Height of the upper edge of the section, which is taken as that of the base of the rail in a file without `rail_height`.
fn flange_height(raw: &RawGirder, units: Units) -> Option<String> {
    let height = quantity(top_of_section(raw, units)?, Dimension::LENGTH, units);
    Some(format!(
        " (not specified in the file: the rail stands on the upper edge of the section, {height} above its centroid)"
    ))
}

/// A girder without faults with the numbers that follow from its names.
pub(super) fn filled(raw: &RawGirder, units: Units) -> RawGirder {
    let mut faults = Faults::default();
    let mut check = Check {
        faults: &mut faults,
        scale: Scale {
            from: units,
            to: units,
        },
    };
    filled_girder(raw, &Place::root(), &mut check)
}

/// Note on a section with the name of a rolled one.
fn of_section(raw: &RawSection, units: Units) -> Option<String> {
    let RawSectionShape::Name(name) = raw.shape.as_ref()? else {
        return None;
    };
    let section = rolled(name)?;
    let [area, iy, iz, j, asy, asz] = in_file_units(section, units).map(Some);
    let numbers = [
        ("A", raw.area, area, Dimension::AREA),
        ("Iy", raw.iy, iy, Dimension::SECOND_MOMENT),
        ("Iz", raw.iz, iz, Dimension::SECOND_MOMENT),
        ("J", raw.j, j, Dimension::SECOND_MOMENT),
        ("Asy", raw.asy, asy, Dimension::AREA),
        ("Asz", raw.asz, asz, Dimension::AREA),
    ];
    let own = raw.name.as_deref().unwrap_or_default();
    listed(&numbers, units).map(|words| format!("section \"{own}\": {} has {words}", section.name))
}

/// Note on a rail of the general form with a crane rail.
fn of_rail(name: &str, raw: &RawRail, units: Units) -> Option<String> {
    let rail = crane_rail(raw.crane_rail.as_deref()?)?;
    let part = if raw.composite == Some(true) {
        "; the members are composite with it"
    } else {
        ""
    };
    Some(format!(
        "rail \"{name}\": {}{part}",
        adds(rail, "to the offsets of its segments", units)
    ))
}

/// What a crane rail adds.
fn adds(rail: &RailProfile, to: &str, units: Units) -> String {
    let mass = quantity(
        from_si(rail.mass, Dimension::LINE_MASS, units),
        Dimension::LINE_MASS,
        units,
    );
    let height = rail.height * Length::Millimetre.in_units_of(units.length);
    let height = quantity(height, Dimension::LENGTH, units);
    format!(
        "the crane rail {} adds {mass} ({} kg/m) to the mass, {height} {to}",
        rail.name,
        number(rail.mass)
    )
}
