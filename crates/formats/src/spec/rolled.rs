//! Rolled sections and crane rails by name, in the units of the file.

use sections::{
    PlaneSection, RailProfile, RolledSection, crane_rail, nearest_crane_rails, nearest_rolled,
    rolled,
};

use crate::check::Check;
use crate::text::fault::{Fault, alternatives};
use crate::text::place::Place;
use crate::units::{Dimension, Length, Scale, Units};

/// The rolled section with this name. An unknown name is a fault that suggests the nearest ones.
pub(super) fn section(
    name: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<&'static RolledSection> {
    let found = rolled(name);
    if found.is_none() {
        let near = nearest_rolled(name);
        let such = "examples are \"HEA 300\", \"HEB 400\", \"HEM 300\", \"IPE 300\", \"W24X94\"";
        unknown(
            "must be the name of a rolled section",
            name,
            &near,
            such,
            at,
            check,
        );
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
            "examples are \"A75\", \"CR 135\", \"ASCE 85\"",
            at,
            check,
        );
    }
    found
}

fn unknown(
    expected: &str,
    name: &str,
    near: &[&str],
    such: &str,
    at: &Place<'_>,
    check: &mut Check<'_>,
) {
    let hint = if near.is_empty() {
        such.to_owned()
    } else {
        format!("did you mean {}?", alternatives(near))
    };
    let fault = Fault::new(at, expected)
        .got(format!("\"{name}\""))
        .of_value();
    check
        .faults
        .add(fault.hint(format!("{hint}; \"girderway sections\" lists all names")));
}

/// The crane rail of an object with the keys `crane_rail` and `composite`, and whether it is a part of the section.
pub(super) fn carried(
    name: &Option<String>,
    composite: Option<bool>,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<(&'static RailProfile, bool)> {
    if composite.is_some() && name.is_none() {
        let fault = Fault::new(&at.key("composite"), "`composite` needs `crane_rail`")
            .at_key()
            .of_value();
        check
            .faults
            .add(fault.hint("it specifies whether the rail is part of the section"));
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
            let PlaneSection {
                area,
                i_vertical,
                i_lateral,
            } = section;
            let [two, four] = [one.powi(2), one.powi(4)];
            let section = PlaneSection {
                area: area * two,
                i_vertical: i_vertical * four,
                i_lateral: i_lateral * four,
            };
            Some((section, centroid * one))
        }
        Err(missing) => {
            let fault = Fault::new(
                &at.key("composite"),
                format!("the tables do not contain the {missing} of {}", rail.name),
            );
            check.faults.add(fault.at_key().hint(
                "leave `composite` out and give the properties of the composite section as numbers",
            ));
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
    value
        * Scale {
            from: Units::SI,
            to: units,
        }
        .factor(dimension)
}
