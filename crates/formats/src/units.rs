//! Units of length and force, exact factors between them, and dimensions.
//!
//! The unit of time is always the second. The unit of mass is force time^2 / length, such as lbf s^2/ft (the slug).

use schemars::JsonSchema;
use serde::Deserialize;

use crate::text::fault::{Fault, Faults};
use crate::text::place::Place;

crate::text::object::objects!(RawUnits);

/// Standard acceleration of gravity, m/s2.
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Unit of length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    /// Foot, 0.3048 m.
    Foot,
    /// Inch, 0.0254 m.
    Inch,
    /// Metre.
    Metre,
    /// Millimetre.
    Millimetre,
}

/// Unit of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Force {
    /// Pound-force, 4.4482216152605 N.
    Pound,
    /// 1000 pound-force.
    Kip,
    /// Newton.
    Newton,
    /// Kilonewton.
    Kilonewton,
}

impl Length {
    const WORDS: [(&'static str, Length); 4] = [
        ("ft", Length::Foot),
        ("in", Length::Inch),
        ("m", Length::Metre),
        ("mm", Length::Millimetre),
    ];

    /// The unit as a whole multiple of 0.1 mm.
    const fn count(self) -> u128 {
        match self {
            Length::Foot => 3048,
            Length::Inch => 254,
            Length::Metre => 10_000,
            Length::Millimetre => 10,
        }
    }

    /// All units.
    pub const ALL: [Length; 4] = [
        Length::Foot,
        Length::Inch,
        Length::Metre,
        Length::Millimetre,
    ];

    /// The unit as a multiple of `other`: one foot is 12 inches.
    #[must_use]
    pub fn in_units_of(self, other: Length) -> f64 {
        let (over, under) = reduced(self.count(), other.count());
        over as f64 / under as f64
    }

    /// The unit with this keyword in files.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Length> {
        Length::WORDS
            .iter()
            .find(|(known, _)| *known == word)
            .map(|(_, unit)| *unit)
    }

    /// The keyword of the unit in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Length::Foot => "ft",
            Length::Inch => "in",
            Length::Metre => "m",
            Length::Millimetre => "mm",
        }
    }
}

impl Force {
    const WORDS: [(&'static str, Force); 4] = [
        ("lbf", Force::Pound),
        ("kip", Force::Kip),
        ("N", Force::Newton),
        ("kN", Force::Kilonewton),
    ];

    /// The unit as a whole multiple of 1e-13 N.
    const fn count(self) -> u128 {
        match self {
            Force::Pound => 44_482_216_152_605,
            Force::Kip => 44_482_216_152_605_000,
            Force::Newton => 10_000_000_000_000,
            Force::Kilonewton => 10_000_000_000_000_000,
        }
    }

    /// The unit with this keyword in files.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Force> {
        Force::WORDS
            .iter()
            .find(|(known, _)| *known == word)
            .map(|(_, unit)| *unit)
    }

    /// The keyword of the unit in files.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Force::Pound => "lbf",
            Force::Kip => "kip",
            Force::Newton => "N",
            Force::Kilonewton => "kN",
        }
    }
}

/// The units of length and force of a file or of numbers.
///
/// ```
/// use formats::units::{Dimension, Force, Length, Scale, Units};
///
/// let imperial = Units { length: Length::Foot, force: Force::Pound };
/// let to_si = Scale { from: imperial, to: Units::SI };
/// assert_eq!(to_si.factor(Dimension::LENGTH), 0.3048);
/// assert_eq!(to_si.factor(Dimension::FORCE), 4.4482216152605);
/// assert_eq!(imperial.label(Dimension::MASS), "lbf s^2/ft");
/// assert_eq!(Units::parse("ft, lbf, s"), Some(imperial));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Units {
    /// Unit of length.
    pub length: Length,
    /// Unit of force.
    pub force: Force,
}

/// Units of the numbers of a file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(remote = "Self", deny_unknown_fields, expecting = "an object")]
pub struct RawUnits {
    /// Unit of length: "ft", "in", "m" or "mm".
    length: Option<String>,
    /// Unit of force: "lbf", "kip", "N" or "kN".
    force: Option<String>,
    /// Unit of time: "s".
    time: Option<String>,
}

/// Units that are not available, and what to write in their place.
const OTHER_UNITS: [(&str, &str); 22] = [
    (
        "cm",
        "write lengths in m or mm: 1 cm = 0.01 m, 1 cm^4 = 1e-8 m^4",
    ),
    ("dm", "write lengths in m or mm: 1 dm = 0.1 m"),
    ("km", "write lengths in m"),
    ("meter", "write \"m\""),
    ("metre", "write \"m\""),
    ("foot", "write \"ft\""),
    ("feet", "write \"ft\""),
    ("inch", "write \"in\""),
    ("inches", "write \"in\""),
    (
        "t",
        "tonnes are units of mass; write forces in kN: 1 t weighs 9.81 kN",
    ),
    (
        "to",
        "tonnes are units of mass; write forces in kN: 1 t weighs 9.81 kN",
    ),
    ("tf", "write forces in kN: 1 tf = 9.80665 kN"),
    (
        "kg",
        "kilograms are units of mass; write forces in N: 1 kg weighs 9.81 N",
    ),
    ("kgf", "write forces in N: 1 kgf = 9.80665 N"),
    ("daN", "write forces in N: 1 daN = 10 N"),
    ("MN", "write forces in kN: 1 MN = 1000 kN"),
    ("lb", "write \"lbf\""),
    ("lbs", "write \"lbf\""),
    ("kips", "write \"kip\""),
    ("ton", "write forces in kip: 1 short ton = 2 kip"),
    ("ms", "write times in s: 1 ms = 0.001 s"),
    ("min", "write times in s"),
];

/// The value of the keyword of a unit; a fault with what to write instead if it is unknown.
fn unit<T: Copy>(
    word: &str,
    place: &Place<'_>,
    words: &[(&str, T)],
    faults: &mut Faults,
) -> Option<T> {
    let value = faults.one_of(word, place, words);
    let other = OTHER_UNITS.iter().find(|(other, _)| *other == word);
    if let (None, Some((_, hint)), Some(fault)) = (value, other, faults.0.last_mut()) {
        fault.hint = Some((*hint).to_owned());
    }
    value
}

impl Units {
    /// Metre and newton.
    pub const SI: Units = Units {
        length: Length::Metre,
        force: Force::Newton,
    };

    /// Reads the member `units` of the object at `place`; a fault if it is missing or a keyword is unknown.
    pub fn read(raw: &Option<RawUnits>, place: &Place<'_>, faults: &mut Faults) -> Option<Units> {
        let Some(raw) = raw else {
            let hint = "units have no default; specify {\"length\": \"ft\", \"force\": \"lbf\", \"time\": \"s\"}, \
                        or in, m, mm; kip, N, kN";
            faults.add(
                Fault::new(place, "missing key `units`")
                    .hint(hint)
                    .of_value(),
            );
            return None;
        };
        let at = place.key("units");
        let length = faults
            .require(&raw.length, &at, "length")
            .and_then(|word| unit(word, &at.key("length"), &Length::WORDS, faults));
        let force = faults
            .require(&raw.force, &at, "force")
            .and_then(|word| unit(word, &at.key("force"), &Force::WORDS, faults));
        match &raw.time {
            Some(word) => drop(unit(word, &at.key("time"), &[("s", ())], faults)),
            None => faults.add(
                Fault::new(&at, "missing key `time`")
                    .hint("\"time\": \"s\"")
                    .of_value(),
            ),
        }
        Some(Units {
            length: length?,
            force: force?,
        })
    }

    /// The member `units` of a file in these units.
    #[must_use]
    pub fn json(self) -> serde_json::Value {
        serde_json::json!({ "length": self.length.word(), "force": self.force.word(), "time": "s" })
    }

    /// The unit of a quantity as text, such as `lbf s/ft`; empty for a pure number.
    #[must_use]
    pub fn label(self, dimension: Dimension) -> String {
        let powers = [
            (self.force.word(), dimension.force),
            (self.length.word(), dimension.length),
            ("s", dimension.time),
        ];
        let join = |sign: i32| {
            let words: Vec<String> = powers
                .iter()
                .filter(|(_, power)| power * sign > 0)
                .map(|(word, power)| {
                    if power.abs() == 1 {
                        (*word).to_owned()
                    } else {
                        format!("{word}^{}", power.abs())
                    }
                })
                .collect();
            words.join(" ")
        };
        match (join(1), join(-1)) {
            (over, under) if under.is_empty() => over,
            (over, under) => {
                let over = if over.is_empty() {
                    "1".to_owned()
                } else {
                    over
                };
                if under.contains(' ') {
                    format!("{over}/({under})")
                } else {
                    format!("{over}/{under}")
                }
            }
        }
    }

    /// The units of length and force of an ADAMS data set.
    #[must_use]
    pub fn of_adams(units: adams::AdamsUnits) -> Units {
        Units {
            length: match units.length {
                adams::AdamsLengthUnit::Foot => Length::Foot,
                adams::AdamsLengthUnit::Inch => Length::Inch,
                adams::AdamsLengthUnit::Meter => Length::Metre,
                adams::AdamsLengthUnit::Millimeter => Length::Millimetre,
            },
            force: match units.force {
                adams::AdamsForceUnit::Pound => Force::Pound,
                adams::AdamsForceUnit::Kilopound => Force::Kip,
                adams::AdamsForceUnit::Newton => Force::Newton,
                adams::AdamsForceUnit::Kilonewton => Force::Kilonewton,
            },
        }
    }

    /// UNITS of an ADAMS data set. The unit of mass is the one consistent with length and force where ADAMS has it,
    /// else a common one.
    #[must_use]
    pub fn to_adams(self) -> adams::AdamsUnits {
        let (length, mass) = match self.length {
            Length::Foot => (adams::AdamsLengthUnit::Foot, adams::AdamsMassUnit::Slug),
            Length::Inch => (adams::AdamsLengthUnit::Inch, adams::AdamsMassUnit::Pound),
            Length::Metre => (
                adams::AdamsLengthUnit::Meter,
                adams::AdamsMassUnit::Kilogram,
            ),
            Length::Millimetre => (
                adams::AdamsLengthUnit::Millimeter,
                adams::AdamsMassUnit::Kilogram,
            ),
        };
        let force = match self.force {
            Force::Pound => adams::AdamsForceUnit::Pound,
            Force::Kip => adams::AdamsForceUnit::Kilopound,
            Force::Newton => adams::AdamsForceUnit::Newton,
            Force::Kilonewton => adams::AdamsForceUnit::Kilonewton,
        };
        adams::AdamsUnits {
            force,
            mass,
            length,
        }
    }

    /// The units in a text whose first two words are those of length and force, such as `ft, lbf, s` or `ft/lbf`.
    #[must_use]
    pub fn parse(text: &str) -> Option<Units> {
        let mut words = text
            .split(|c: char| !c.is_alphanumeric())
            .filter(|word| !word.is_empty());
        let length = Length::of_word(words.next()?)?;
        let force = Force::of_word(words.next()?)?;
        Some(Units { length, force })
    }
}

/// Powers of length, force and time of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimension {
    /// Power of length.
    pub length: i32,
    /// Power of force.
    pub force: i32,
    /// Power of time.
    pub time: i32,
}

impl Dimension {
    /// The dimension with these powers of length, force and time.
    #[must_use]
    pub const fn of(length: i32, force: i32, time: i32) -> Self {
        Dimension {
            length,
            force,
            time,
        }
    }

    /// A pure number, or radians.
    pub const NUMBER: Dimension = Dimension::of(0, 0, 0);
    /// Length.
    pub const LENGTH: Dimension = Dimension::of(1, 0, 0);
    /// Area.
    pub const AREA: Dimension = Dimension::of(2, 0, 0);
    /// Second moment of area; torsion constant.
    pub const SECOND_MOMENT: Dimension = Dimension::of(4, 0, 0);
    /// Force.
    pub const FORCE: Dimension = Dimension::of(0, 1, 0);
    /// Moment and torque; energy; rotational stiffness per radian.
    pub const MOMENT: Dimension = Dimension::of(1, 1, 0);
    /// Stress; modulus of elasticity.
    pub const STRESS: Dimension = Dimension::of(-2, 1, 0);
    /// Stiffness: force per displacement.
    pub const STIFFNESS: Dimension = Dimension::of(-1, 1, 0);
    /// Flexibility, such as an influence coefficient: displacement per force.
    pub const FLEXIBILITY: Dimension = Dimension::of(1, -1, 0);
    /// Damping: force per speed.
    pub const DAMPING: Dimension = Dimension::of(-1, 1, 1);
    /// Mass.
    pub const MASS: Dimension = Dimension::of(-1, 1, 2);
    /// Mass per length.
    pub const LINE_MASS: Dimension = Dimension::of(-2, 1, 2);
    /// Mass per volume.
    pub const DENSITY: Dimension = Dimension::of(-4, 1, 2);
    /// Mass moment of inertia.
    pub const INERTIA: Dimension = Dimension::of(1, 1, 2);
    /// Speed.
    pub const SPEED: Dimension = Dimension::of(1, 0, -1);
    /// Acceleration.
    pub const ACCELERATION: Dimension = Dimension::of(1, 0, -2);
    /// Time.
    pub const TIME: Dimension = Dimension::of(0, 0, 1);
}

/// Conversion from the units of one file to those of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// Units of the given numbers.
    pub from: Units,
    /// Units of the result.
    pub to: Units,
}

impl Scale {
    /// The factor by which numbers of a dimension are multiplied.
    ///
    /// It is exactly 1 between equal units, otherwise the ratio of two whole numbers (the defining values of the
    /// units), each of which is rounded at most once.
    #[must_use]
    pub fn factor(&self, dimension: Dimension) -> f64 {
        let length = power(
            self.from.length.count(),
            self.to.length.count(),
            dimension.length,
        );
        let force = power(
            self.from.force.count(),
            self.to.force.count(),
            dimension.force,
        );
        let (over, under) = reduced(length.0 * force.0, length.1 * force.1);
        over as f64 / under as f64
    }

    /// The factor of the coefficient of a power law, in force per length^`exponent`.
    #[must_use]
    pub fn power_law(&self, exponent: f64) -> f64 {
        if exponent == 1.0 {
            return self.factor(Dimension::STIFFNESS);
        }
        self.factor(Dimension::FORCE) / self.factor(Dimension::LENGTH).powf(exponent)
    }
}

/// (from / to)^exponent as a fraction in lowest terms.
fn power(from: u128, to: u128, exponent: i32) -> (u128, u128) {
    let (from, to) = reduced(from, to);
    let raised = (
        from.pow(exponent.unsigned_abs()),
        to.pow(exponent.unsigned_abs()),
    );
    if exponent < 0 {
        (raised.1, raised.0)
    } else {
        raised
    }
}

/// a / b in lowest terms, by Euclid's algorithm.
fn reduced(a: u128, b: u128) -> (u128, u128) {
    let (mut x, mut y) = (a, b);
    while y != 0 {
        (x, y) = (y, x % y);
    }
    (a / x, b / x)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FT_LBF: Units = Units {
        length: Length::Foot,
        force: Force::Pound,
    };
    const IN_KIP: Units = Units {
        length: Length::Inch,
        force: Force::Kip,
    };
    const MM_KN: Units = Units {
        length: Length::Millimetre,
        force: Force::Kilonewton,
    };

    const ALL: [Dimension; 6] = [
        Dimension::LENGTH,
        Dimension::SECOND_MOMENT,
        Dimension::STRESS,
        Dimension::DAMPING,
        Dimension::DENSITY,
        Dimension::INERTIA,
    ];

    #[test]
    fn equal_units_have_a_factor_of_exactly_one() {
        for units in [FT_LBF, IN_KIP, Units::SI, MM_KN] {
            for dimension in ALL {
                assert_eq!(
                    Scale {
                        from: units,
                        to: units
                    }
                    .factor(dimension)
                    .to_bits(),
                    1f64.to_bits()
                );
            }
        }
    }

    #[test]
    fn factors_are_the_defining_values() {
        let to_si = Scale {
            from: FT_LBF,
            to: Units::SI,
        };
        assert_eq!(to_si.factor(Dimension::LENGTH), 0.3048);
        assert_eq!(to_si.factor(Dimension::FORCE), 4.4482216152605);
        // pascals in a pound-force per square foot, from the definitions of the foot and the pound
        let psf = 4.448_221_615_260_5 / 0.092_903_04;
        assert!((to_si.factor(Dimension::STRESS) / psf - 1.0).abs() < 4.0 * f64::EPSILON);
        let to_inch = Scale {
            from: FT_LBF,
            to: IN_KIP,
        };
        assert_eq!(to_inch.factor(Dimension::LENGTH), 12.0);
        assert_eq!(to_inch.factor(Dimension::SECOND_MOMENT), 20736.0);
        assert_eq!(to_inch.factor(Dimension::FORCE), 1e-3);
        assert_eq!(to_inch.factor(Dimension::STRESS), 1.0 / 144_000.0);
        // one slug in kilograms: 4.4482216152605 / 0.3048
        assert_eq!(to_si.factor(Dimension::MASS), 14.593_902_937_206_364);
    }

    #[test]
    fn there_and_back_is_one_to_a_rounding() {
        for from in [FT_LBF, IN_KIP, Units::SI, MM_KN] {
            for to in [FT_LBF, IN_KIP, Units::SI, MM_KN] {
                for dimension in ALL {
                    let there = Scale { from, to }.factor(dimension);
                    let back = Scale { from: to, to: from }.factor(dimension);
                    assert!(
                        (there * back - 1.0).abs() < 1e-15,
                        "{from:?} {to:?} {dimension:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn power_law_of_exponent_one_is_a_stiffness() {
        let scale = Scale {
            from: FT_LBF,
            to: Units::SI,
        };
        assert_eq!(scale.power_law(1.0), scale.factor(Dimension::STIFFNESS));
        let cubic = scale.power_law(3.0);
        assert!((cubic / (4.4482216152605 / 0.3048f64.powi(3)) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn labels_read_as_an_engineer_writes_them() {
        assert_eq!(FT_LBF.label(Dimension::DAMPING), "lbf s/ft");
        assert_eq!(Units::SI.label(Dimension::STRESS), "N/m^2");
        assert_eq!(MM_KN.label(Dimension::FLEXIBILITY), "mm/kN");
        assert_eq!(FT_LBF.label(Dimension::NUMBER), "");
    }
}
