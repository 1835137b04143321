//! The numbers of a girder that follow from the name or the dimensions of its section and from its crane rail, in the units of
//! the file.

use sections::{PlaneSection, RailProfile, STEEL_DENSITY, STEEL_SHEAR, SectionSeries};

use super::outline::girder_shape;
use super::raw::RawGirder;
use super::rolled::{self, from_si};
use super::shape;
use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::place::Place;
use crate::units::{Dimension, Length, Scale, Units};

/// The girder with the numbers that follow from its section and its crane rail, in the units of the file.
pub(super) fn filled_girder(raw: &RawGirder, at: &Place<'_>, check: &mut Check<'_>) -> RawGirder {
    let mut girder = raw.numbers();
    let units = check.scale.from;
    if let (Some(_), Some(_)) = (&raw.section, &raw.shape) {
        let fault = Fault::new(
            &at.key("shape"),
            "`shape` cannot be combined with `section`",
        )
        .at_key()
        .of_value();
        check.faults.add(fault.hint(
            "`section` names a rolled section, `shape` gives the dimensions of a built-up one",
        ));
    }
    match (&raw.section, &raw.shape) {
        (Some(name), _) => {
            let place = at.key("section");
            let found = rolled::section(name, &place, check);
            // the fault of an unknown name has been reported; placeholders prevent reports that properties are missing
            let young = found
                .map_or(SectionSeries::Heb, |section| section.series)
                .young();
            let found = found.map_or([1.0; 6], |section| rolled::in_file_units(section, units));
            check_density(raw, at, check);
            girder
                .e
                .get_or_insert(from_si(young, Dimension::STRESS, units));
            girder
                .g
                .get_or_insert(from_si(STEEL_SHEAR, Dimension::STRESS, units));
            girder
                .density
                .get_or_insert(from_si(STEEL_DENSITY, Dimension::DENSITY, units));
            fill(&mut girder, found);
        }
        (None, Some(given)) => {
            let found = shape::read(given, &at.key("shape"), check);
            check_density(raw, at, check);
            fill(&mut girder, found.unwrap_or([1.0; 6]));
        }
        (None, None) if raw.density.is_some() => {
            let fault = Fault::new(&at.key("density"), "`density` needs `section` or `shape`")
                .at_key()
                .of_value();
            check.faults.add(
                fault.hint("a girder whose properties are given as numbers has `mass_per_length`"),
            );
        }
        (None, None) => {}
    }
    if raw.rail_height.is_none() && raw.crane_rail.is_some() {
        girder.rail_height = top_of_section(raw, units);
    }
    if let Some((rail, composite)) = rolled::carried(&raw.crane_rail, raw.composite, at, check) {
        if composite {
            combine(&mut girder, rail, at, check);
        }
        raise(&mut girder, rail, units);
    }
    girder
}

/// Height of the upper edge of the section of a girder above its centroid, where its name or dimensions give it.
pub(super) fn top_of_section(raw: &RawGirder, units: Units) -> Option<f64> {
    let own = Scale {
        from: units,
        to: units,
    };
    girder_shape(raw, &own).map(|shape| shape.top())
}

fn check_density(raw: &RawGirder, at: &Place<'_>, check: &mut Check<'_>) {
    if let Some(density) = raw.density {
        check.positive(
            density,
            &at.key("density"),
            Dimension::DENSITY,
            "mass per volume",
        );
    }
}

/// Gives a girder the properties of a section that it does not state, and the mass of its density.
fn fill(girder: &mut RawGirder, [area, iy, iz, j, asy, asz]: [f64; 6]) {
    let density = girder.density.unwrap_or_default();
    let area = *girder.area.get_or_insert(area);
    girder.i_lateral.get_or_insert(iy);
    girder.i_vertical.get_or_insert(iz);
    girder.j.get_or_insert(j);
    girder.ka_vertical.get_or_insert(asy);
    girder.ka_lateral.get_or_insert(asz);
    if area > 0.0 && density > 0.0 {
        girder.mass_per_length.get_or_insert(density * area);
    }
}

/// Makes a crane rail a part of the section of a girder, whose `rail_height` is that of the base of the rail.
///
/// Faults of the girder's own numbers are left to their check.
fn combine(girder: &mut RawGirder, rail: &RailProfile, at: &Place<'_>, check: &mut Check<'_>) {
    let Some((part, centroid)) = rolled::plane_section(rail, check.scale.from.length, at, check)
    else {
        return;
    };
    if girder.rail_height.is_none() {
        let fault = Fault::new(at, "missing key `rail_height`").of_value();
        check.faults.add(fault.hint(
            "`composite` needs the height of the rail's base above the elastic axis of the girder",
        ));
    }
    let area = check.faults.require(&girder.area, at, "A").copied();
    let (Some(height), Some(area), Some(i_vertical)) =
        (girder.rail_height, area, girder.i_vertical)
    else {
        return;
    };
    if height < 0.0 || [area, i_vertical].iter().any(|value| *value <= 0.0) {
        return;
    }
    let own = PlaneSection {
        area,
        i_vertical,
        i_lateral: girder.i_lateral.unwrap_or_default(),
    };
    let (whole, _) = own.with_rail(&part, height + centroid);
    girder.area = Some(whole.area);
    girder.i_vertical = Some(whole.i_vertical);
    girder.i_lateral = girder
        .i_lateral
        .map(|own| if own > 0.0 { whole.i_lateral } else { own });
}

/// Adds the height and the mass of a crane rail to a girder. Negative numbers are left to their check.
fn raise(girder: &mut RawGirder, rail: &RailProfile, units: Units) {
    let height = girder.rail_height.get_or_insert_default();
    if *height >= 0.0 {
        *height += rail.height * Length::Millimetre.in_units_of(units.length);
    }
    let mass = girder.mass_per_length.get_or_insert_default();
    if *mass >= 0.0 {
        *mass += from_si(rail.mass, Dimension::LINE_MASS, units);
    }
}
