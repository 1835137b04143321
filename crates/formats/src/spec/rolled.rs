//! Rolled sections and crane rails by name, in the units of the file.

use sections::{
    PlaneSection, RailProfile, RolledSection, STEEL_DENSITY, STEEL_SHEAR, STEEL_YOUNG, crane_rail,
    nearest_crane_rails, nearest_rolled, rolled,
};

use super::raw::RawGirder;
use crate::check::Check;
use crate::text::fault::{Fault, alternatives};
use crate::text::place::Place;
use crate::units::{Dimension, Length, Scale, Units};

/// The rolled section with this name. An unknown name is a fault that suggests the nearest ones.
pub(super) fn section(name: &str, at: &Place<'_>, check: &mut Check<'_>) -> Option<&'static RolledSection> {
    let found = rolled(name);
    if found.is_none() {
        let near = nearest_rolled(name);
        let such = "names are such as \"HEA 300\", \"HEB 400\", \"HEM 300\", \"IPE 300\", \"W24X94\"";
        unknown("must be the name of a rolled section", name, &near, such, at, check);
    }
    found
}

/// The crane rail with this name. An unknown name is a fault that suggests the nearest ones.
fn rail(name: &str, at: &Place<'_>, check: &mut Check<'_>) -> Option<&'static RailProfile> {
    let found = crane_rail(name);
    if found.is_none() {
        let near = nearest_crane_rails(name);
        unknown(
            "must be the name of a crane rail",
            name,
            &near,
            "names are such as \"A75\", \"CR 135\", \"ASCE 85\"",
            at,
            check,
        );
    }
    found
}

fn unknown(expected: &str, name: &str, near: &[&str], such: &str, at: &Place<'_>, check: &mut Check<'_>) {
    let hint =
        if near.is_empty() { such.to_owned() } else { format!("did you mean {}?", alternatives(near)) };
    let fault = Fault::new(at, expected).got(format!("\"{name}\"")).of_value();
    check.faults.add(fault.hint(format!("{hint}; \"girderway sections\" lists all")));
}

/// The crane rail of an object with the keys `crane_rail` and `composite`, and whether it is a part of the section.
pub(super) fn carried(
    name: &Option<String>,
    composite: Option<bool>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<(&'static RailProfile, bool)> {
    if composite.is_some() && name.is_none() {
        let fault = Fault::new(&at.key("composite"), "`composite` needs `crane_rail`").at_key().of_value();
        check.faults.add(fault.hint("it says whether the rail is a part of the section"));
    }
    let rail = rail(name.as_ref()?, &at.key("crane_rail"), check)?;
    Some((rail, composite.unwrap_or(false)))
}

/// A crane rail as a part of a plane section in a unit of length, and the height of its centroid above its base. What the
/// tables lack is a fault of the key `composite`.
pub(super) fn plane_section(
    rail: &RailProfile,
    unit: Length,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<(PlaneSection, f64)> {
    let one = Length::Millimetre.in_units_of(unit);
    match rail.plane_section() {
        Ok((section, centroid)) => {
            let PlaneSection { area, i_vertical, i_lateral } = section;
            let [two, four] = [one.powi(2), one.powi(4)];
            let section =
                PlaneSection { area: area * two, i_vertical: i_vertical * four, i_lateral: i_lateral * four };
            Some((section, centroid * one))
        }
        Err(missing) => {
            let fault =
                Fault::new(&at.key("composite"), format!("the tables lack the {missing} of {}", rail.name));
            check.faults.add(
                fault
                    .at_key()
                    .hint("leave `composite` out and give the properties of the whole section as numbers"),
            );
            None
        }
    }
}

/// A, Iy, Iz, J, Asy, Asz of a rolled section whose local y axis is along its web, in the units of a file.
pub(super) fn in_file_units(section: &RolledSection, units: Units) -> [f64; 6] {
    let one = Length::Millimetre.in_units_of(units.length);
    let [two, four] = [one.powi(2), one.powi(4)];
    let found = section.dimensions.properties();
    [
        found.area * two,
        found.i_weak * four,
        found.i_strong * four,
        found.j * four,
        found.shear_web * two,
        found.shear_flanges * two,
    ]
}

/// A number in SI units (m, N, s) in the units of a file.
pub(super) fn from_si(value: f64, dimension: Dimension, units: Units) -> f64 {
    value * Scale { from: Units::SI, to: units }.factor(dimension)
}

/// The girder with the numbers that follow from its section and its crane rail, in the units of the file.
pub(super) fn filled_girder(raw: &RawGirder, at: &Place<'_>, check: &mut Check<'_>) -> RawGirder {
    let mut girder = raw.numbers();
    let units = check.scale.from;
    match &raw.section {
        Some(name) => {
            let place = at.key("section");
            let found = section(name, &place, check);
            // the fault of an unknown name has been reported; placeholders prevent reports that properties are missing
            let found = found.map_or([1.0; 6], |section| in_file_units(section, units));
            if let Some(density) = raw.density {
                check.positive(density, &at.key("density"), Dimension::DENSITY, "mass per volume");
            }
            fill(&mut girder, found, units);
        }
        None if raw.density.is_some() => {
            let fault = Fault::new(&at.key("density"), "`density` needs `section`").at_key().of_value();
            check.faults.add(fault.hint("a girder of numbers has `mass_per_length`"));
        }
        None => {}
    }
    if let Some((rail, composite)) = carried(&raw.crane_rail, raw.composite, at, check) {
        if composite {
            combine(&mut girder, rail, at, check);
        }
        raise(&mut girder, rail, units);
    }
    girder
}

/// Gives a girder the properties of a rolled section that it does not state, and the moduli and the mass of steel.
fn fill(girder: &mut RawGirder, [area, iy, iz, j, asy, asz]: [f64; 6], units: Units) {
    girder.e.get_or_insert(from_si(STEEL_YOUNG, Dimension::STRESS, units));
    girder.g.get_or_insert(from_si(STEEL_SHEAR, Dimension::STRESS, units));
    let density = *girder.density.get_or_insert(from_si(STEEL_DENSITY, Dimension::DENSITY, units));
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
    let Some((part, centroid)) = plane_section(rail, check.scale.from.length, at, check) else { return };
    if girder.rail_height.is_none() {
        let fault = Fault::new(at, "missing key `rail_height`").of_value();
        check
            .faults
            .add(fault.hint(
                "`composite` needs the height of the rail's base above the elastic axis of the girder",
            ));
    }
    let area = check.faults.require(&girder.area, at, "A").copied();
    let (Some(height), Some(area), Some(i_vertical)) = (girder.rail_height, area, girder.i_vertical) else {
        return;
    };
    if height < 0.0 || [area, i_vertical].iter().any(|value| *value <= 0.0) {
        return;
    }
    let own = PlaneSection { area, i_vertical, i_lateral: girder.i_lateral.unwrap_or_default() };
    let (whole, _) = own.with_rail(&part, height + centroid);
    girder.area = Some(whole.area);
    girder.i_vertical = Some(whole.i_vertical);
    girder.i_lateral = girder.i_lateral.map(|own| if own > 0.0 { whole.i_lateral } else { own });
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
