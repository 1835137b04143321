//! Sections defined by the dimensions of their plates: the key `shape` of a section.

use fea::CrossSection;

use super::cross_section::{Properties, section_properties};
use super::raw::{RawSection, RawSectionShape, RawShape};
use super::rolled;
use crate::check::Check;
use crate::text::fault::{Fault, number};
use crate::text::place::Place;
use crate::units::{Dimension, Length, Scale};

/// Keys of dimensions, in the order in which [`read`] returns them.
const KEYS: [&str; 8] = [
    "height",
    "width",
    "flange",
    "web",
    "lower_width",
    "lower_flange",
    "diameter",
    "wall",
];

/// Kinds of shapes in specs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I,
    Box,
    Tube,
    Bar,
}

impl Kind {
    const WORDS: [(&'static str, Kind); 4] = [
        ("I", Kind::I),
        ("box", Kind::Box),
        ("tube", Kind::Tube),
        ("bar", Kind::Bar),
    ];

    /// Keys of dimensions that are required, and keys that are optional.
    const fn keys(self) -> (&'static [&'static str], &'static [&'static str]) {
        match self {
            Kind::I => (
                &["height", "width", "flange", "web"],
                &["lower_width", "lower_flange"],
            ),
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
    let place = at.key("shape");
    let found = match &raw.shape {
        None => return section,
        Some(RawSectionShape::Dimensions(shape)) => read(shape, &place, check),
        Some(RawSectionShape::Name(name)) => rolled::section(name, &place, check)
            .map(|found| rolled::in_file_units(found, check.scale.from)),
    };
    let Some(found) = found else {
        // the fault of the shape has been reported; placeholders prevent a second report that the section is
        // incomplete
        for number in [
            &mut section.area,
            &mut section.iy,
            &mut section.iz,
            &mut section.j,
        ] {
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
pub(super) fn read(raw: &RawShape, at: &Place<'_>, check: &mut Check<'_>) -> Option<[f64; 6]> {
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
        let listed: Vec<String> = dimensions
            .iter()
            .filter(|value| **value > 0.0)
            .map(|value| number(*value))
            .collect();
        let fault = Fault::new(at, "its dimensions must leave space between the plates")
            .got(listed.join(", "));
        check
            .faults
            .add(fault.hint("all dimensions have the unit `length`, by default that of the file"));
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
                check.faults.add(
                    fault
                        .at_key()
                        .hint(format!("its dimensions are {}", known.join(", "))),
                );
            }
            None if required.contains(key) => {
                let fault = Fault::new(at, format!("missing key `{key}`"));
                check
                    .faults
                    .add(fault.hint(format!("this kind needs {}", required.join(", "))));
            }
            None => {}
        }
    }
    dimensions
}

/// Dimensions with the defaults of those that were left out, which are still 0.
fn completed(mut dimensions: [f64; 8]) -> [f64; 8] {
    for (optional, default) in [(4, 1), (5, 2)] {
        if dimensions[optional] == 0.0 {
            dimensions[optional] = dimensions[default];
        }
    }
    dimensions
}

/// The properties of a shape in powers of the unit of its dimensions; `None` if no space is left between its plates.
pub(super) fn properties(kind: Kind, dimensions: [f64; 8]) -> Option<Properties> {
    let [
        height,
        width,
        flange,
        web,
        lower_width,
        lower_flange,
        diameter,
        wall,
    ] = completed(dimensions);
    let found = match kind {
        Kind::I => section_properties(
            "I",
            &[height, lower_width, width, web, lower_flange, flange],
        ),
        Kind::Box => section_properties("BOX", &[width, height, flange, web]),
        Kind::Tube => section_properties("TUBE2", &[0.5 * diameter, wall]),
        Kind::Bar => section_properties("BAR", &[width, height]),
    };
    found.ok()
}

/// Number of equal intervals of a part over which its properties are integrated.
const INTERVALS: usize = 8;
/// Positions and weights of Gauss's rule of eight points on -1 to 1: the positive half.
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// A tapered member with shapes of one kind at both ends: its dimensions vary linearly, and its properties are those
/// of its dimensions.
#[derive(Clone, Debug)]
pub(super) struct ShapeTaper {
    kind: Kind,
    /// Dimensions at the ends a and b, in the unit of length of the model.
    ends: [[f64; 8]; 2],
    /// Which of A, Iy, Iz, J, Asy, Asz follow from the dimensions: those that neither section states as a number.
    follows: [bool; 6],
}

impl ShapeTaper {
    /// The taper between two sections that were read without a fault; `None` unless their shapes have dimensions and one kind.
    pub fn between(a: &RawSection, b: &RawSection, scale: &Scale) -> Option<ShapeTaper> {
        let (kind, from) = in_model_units(dimensions(a)?, scale)?;
        let (other, to) = in_model_units(dimensions(b)?, scale)?;
        let stated = |raw: &RawSection| {
            [raw.area, raw.iy, raw.iz, raw.j, raw.asy, raw.asz].map(|q| q.is_some())
        };
        let stated = [stated(a), stated(b)];
        let follows = std::array::from_fn(|k| !stated[0][k] && !stated[1][k]);
        (kind == other).then_some(ShapeTaper {
            kind,
            ends: [from, to],
            follows,
        })
    }

    /// The uniform section that replaces the stretch `from`..`to` (fractions of the length) of a member from section
    /// `a` to section `b`.
    ///
    /// Each stiffness is the reciprocal of its mean reciprocal over the stretch, as for properties that vary linearly:
    /// elongation and twist under end loads are exact, and deflections converge with the square of the number of
    /// parts. The mass is the mean mass. `None` if dimensions in the stretch leave no space between the plates.
    pub fn section(
        &self,
        a: &CrossSection,
        b: &CrossSection,
        [from, to]: [f64; 2],
    ) -> Option<CrossSection> {
        let mut reciprocals = [0.0; 6];
        let mut mass = 0.0;
        let densities = [a.mass / a.area, b.mass / b.area];
        let half = 0.5 / INTERVALS as f64;
        for interval in 0..INTERVALS {
            let middle = (2 * interval + 1) as f64 * half;
            for (place, weight) in GAUSS.iter().flat_map(|&(x, w)| [(-x, w), (x, w)]) {
                let s = from + (to - from) * (middle + half * place);
                let at = |p: f64, q: f64| p + (q - p) * s;
                let found = self.properties(s)?;
                for (sum, value) in reciprocals.iter_mut().zip(found) {
                    *sum += half * weight / value;
                }
                mass += half * weight * found[0] * at(densities[0], densities[1]);
            }
        }
        let linear = a.between(b, from, to);
        let or = |k: usize, stated: f64| {
            if self.follows[k] {
                1.0 / reciprocals[k]
            } else {
                stated
            }
        };
        Some(CrossSection {
            area: or(0, linear.area),
            iy: or(1, linear.iy),
            iz: or(2, linear.iz),
            j: or(3, linear.j),
            shear_y: linear.shear_y.map(|area| or(4, area)),
            shear_z: linear.shear_z.map(|area| or(5, area)),
            mass: if self.follows[0] { mass } else { linear.mass },
            ..linear
        })
    }

    /// A, Iy, Iz, J, Asy, Asz at the fraction `s` of the length.
    fn properties(&self, s: f64) -> Option<[f64; 6]> {
        let [from, to] = self.ends;
        let found = properties(
            self.kind,
            std::array::from_fn(|k| from[k] + (to[k] - from[k]) * s),
        )?;
        Some([
            found.area,
            found.i2,
            found.i1,
            found.j,
            found.k1 * found.area,
            found.k2 * found.area,
        ])
    }
}

/// The shape of a section that is given by dimensions, not by a name.
pub(super) fn dimensions(raw: &RawSection) -> Option<&RawShape> {
    match raw.shape.as_ref()? {
        RawSectionShape::Dimensions(shape) => Some(shape),
        RawSectionShape::Name(_) => None,
    }
}

/// Kind and dimensions of a shape that was read without a fault, in the unit of length of the model.
pub(super) fn in_model_units(raw: &RawShape, scale: &Scale) -> Option<(Kind, [f64; 8])> {
    let word = raw.kind.as_deref()?;
    let kind = Kind::WORDS.iter().find(|(known, _)| *known == word)?.1;
    let unit = match &raw.length {
        Some(word) => Length::of_word(word)?,
        None => scale.from.length,
    };
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
    let factor = unit.in_units_of(scale.to.length);
    Some((
        kind,
        completed(given.map(|value| factor * value.unwrap_or_default())),
    ))
}
