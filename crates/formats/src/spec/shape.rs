//! Sections defined by the dimensions of their plates: the key `shape` of a section.

use super::cross_section::{Properties, section_properties};
use super::raw::{RawSection, RawShape};
use crate::check::Check;
use crate::text::fault::{Fault, number};
use crate::text::place::Place;
use crate::units::{Dimension, Length};

/// Keys of dimensions, in the order in which [`read`] returns them.
const KEYS: [&str; 8] =
    ["height", "width", "flange", "web", "lower_width", "lower_flange", "diameter", "wall"];

/// Kinds of shapes in specs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    I,
    Box,
    Tube,
    Bar,
}

impl Kind {
    const WORDS: [(&'static str, Kind); 4] =
        [("I", Kind::I), ("box", Kind::Box), ("tube", Kind::Tube), ("bar", Kind::Bar)];

    /// Keys of dimensions that are required, and keys that are optional.
    const fn keys(self) -> (&'static [&'static str], &'static [&'static str]) {
        match self {
            Kind::I => (&["height", "width", "flange", "web"], &["lower_width", "lower_flange"]),
            Kind::Box => (&["height", "width", "flange", "web"], &[]),
            Kind::Tube => (&["diameter", "wall"], &[]),
            Kind::Bar => (&["height", "width"], &[]),
        }
    }
}

/// The properties of a section, in the units of the file. Missing properties are computed from its shape.
///
/// y is along the height: Iz = int y^2 dA, Iy = int z^2 dA.
pub(super) fn filled(raw: &RawSection, at: &Place<'_>, check: &mut Check<'_>) -> RawSection {
    let mut section = raw.numbers();
    let Some(shape) = &raw.shape else { return section };
    let place = at.key("shape");
    let Some(found) = read(shape, &place, check) else {
        // the fault of the shape has been reported; placeholders prevent a second report that the section is
        // incomplete
        for number in [&mut section.area, &mut section.iy, &mut section.iz, &mut section.j] {
            number.get_or_insert(1.0);
        }
        return section;
    };
    let [area, iy, iz, j, asy, asz] = found;
    section.area.get_or_insert(area);
    section.iy.get_or_insert(iy);
    section.iz.get_or_insert(iz);
    section.j.get_or_insert(j);
    section.asy.get_or_insert(asy);
    section.asz.get_or_insert(asz);
    section
}

/// A, Iy, Iz, J, Asy, Asz of a shape, in the units of the file; `None` and faults if its dimensions are invalid.
fn read(raw: &RawShape, at: &Place<'_>, check: &mut Check<'_>) -> Option<[f64; 6]> {
    let kind = check.faults.require(&raw.kind, at, "kind")?;
    let kind = check.faults.one_of(kind, &at.key("kind"), &Kind::WORDS)?;
    let before = check.faults.0.len();
    let dimensions = read_dimensions(raw, kind, at, check);
    let own = match &raw.length {
        Some(word) => {
            let words = Length::ALL.map(|unit| (unit.word(), unit));
            check.faults.one_of(word, &at.key("length"), &words)
        }
        None => Some(check.scale.from.length),
    };
    if check.faults.0.len() > before {
        return None;
    }
    let Some(found) = properties(kind, dimensions) else {
        let listed: Vec<String> =
            dimensions.iter().filter(|value| **value > 0.0).map(|value| number(*value)).collect();
        let fault =
            Fault::new(at, "its dimensions must leave space between the plates").got(listed.join(", "));
        check.faults.add(fault.hint("all dimensions have the unit `length`, by default that of the file"));
        return None;
    };
    let unit = own.map_or(1.0, |own| own.in_units_of(check.scale.from.length));
    let [square, fourth] = [unit.powi(2), unit.powi(4)];
    Some([
        found.area * square,
        found.i2 * fourth,
        found.i1 * fourth,
        found.j * fourth,
        found.k1 * found.area * square,
        found.k2 * found.area * square,
    ])
}

/// Reads the dimensions of a shape in the order of [`KEYS`]. Dimensions that are left out are 0.
fn read_dimensions(raw: &RawShape, kind: Kind, at: &Place<'_>, check: &mut Check<'_>) -> [f64; 8] {
    let given = [
        raw.height,
        raw.width,
        raw.flange,
        raw.web,
        raw.lower_width,
        raw.lower_flange,
        raw.diameter,
        raw.wall,
    ];
    let (required, optional) = kind.keys();
    let mut dimensions = [0.0; 8];
    for (index, key) in KEYS.iter().enumerate() {
        let place = at.key(key);
        match given[index] {
            Some(value) if required.contains(key) || optional.contains(key) => {
                dimensions[index] = check.positive(value, &place, Dimension::NUMBER, "a dimension");
            }
            Some(_) => {
                let known: Vec<&str> = required.iter().chain(optional).copied().collect();
                let fault = Fault::new(&place, format!("`{key}` is not a dimension of this kind"));
                check.faults.add(fault.at_key().hint(format!("its dimensions are {}", known.join(", "))));
            }
            None if required.contains(key) => {
                let fault = Fault::new(at, format!("missing key `{key}`"));
                check.faults.add(fault.hint(format!("this kind needs {}", required.join(", "))));
            }
            None => {}
        }
    }
    dimensions
}

/// The properties of a shape in powers of the unit of its dimensions; `None` if no space is left between its plates.
fn properties(kind: Kind, dimensions: [f64; 8]) -> Option<Properties> {
    let [height, width, flange, web, lower_width, lower_flange, diameter, wall] = dimensions;
    // an optional dimension that is missing is still 0
    let or = |own: f64, other: f64| if own > 0.0 { own } else { other };
    let found = match kind {
        Kind::I => {
            let lower = [or(lower_width, width), or(lower_flange, flange)];
            section_properties("I", &[height, lower[0], width, web, lower[1], flange])
        }
        Kind::Box => section_properties("BOX", &[width, height, flange, web]),
        Kind::Tube => section_properties("TUBE2", &[0.5 * diameter, wall]),
        Kind::Bar => section_properties("BAR", &[width, height]),
    };
    found.ok()
}
