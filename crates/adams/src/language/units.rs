//! The UNITS statement.

use super::statement::Statement;

/// Units of a data set. The unit of time is the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Units {
    /// FORCE.
    pub force: Force,
    /// MASS. It need not be consistent with force and length: ADAMS converts mass times acceleration to
    /// force.
    pub mass: Mass,
    /// LENGTH.
    pub length: Length,
}

/// A quantity whose units have words in UNITS.
pub(crate) trait UnitWords: Copy + PartialEq + 'static {
    /// Every unit with its word.
    const ALL: &'static [(Self, &'static str)];

    /// The word of a unit.
    fn word(self) -> &'static str {
        Self::ALL.iter().find(|(unit, _)| *unit == self).map_or("", |(_, word)| word)
    }
}

/// FORCE of a UNITS statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Force {
    /// NEWTON.
    Newton,
    /// KNEWTON.
    Kilonewton,
    /// POUND_FORCE.
    Pound,
    /// KPOUND_FORCE.
    Kilopound,
}

/// MASS of a UNITS statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Mass {
    /// KILOGRAM.
    Kilogram,
    /// TONNE, known to the C++ solver only.
    Tonne,
    /// POUND_MASS.
    Pound,
    /// SLUG.
    Slug,
    /// SLINCH, lbf s^2/in, known to the C++ solver only.
    Slinch,
}

/// LENGTH of a UNITS statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Length {
    /// METER.
    Meter,
    /// MILLIMETER.
    Millimeter,
    /// FOOT.
    Foot,
    /// INCH.
    Inch,
}

impl Units {
    /// The UNITS statement.
    #[must_use]
    pub fn statement(&self) -> Statement {
        Statement::lone("UNITS")
            .word("FORCE", self.force.word())
            .word("MASS", self.mass.word())
            .word("LENGTH", self.length.word())
            .word("TIME", "SECOND")
    }
}

impl UnitWords for Force {
    const ALL: &'static [(Self, &'static str)] = &[
        (Force::Newton, "NEWTON"),
        (Force::Kilonewton, "KNEWTON"),
        (Force::Pound, "POUND_FORCE"),
        (Force::Kilopound, "KPOUND_FORCE"),
    ];
}

impl UnitWords for Mass {
    const ALL: &'static [(Self, &'static str)] = &[
        (Mass::Kilogram, "KILOGRAM"),
        (Mass::Tonne, "TONNE"),
        (Mass::Pound, "POUND_MASS"),
        (Mass::Slug, "SLUG"),
        (Mass::Slinch, "SLINCH"),
    ];
}

impl UnitWords for Length {
    const ALL: &'static [(Self, &'static str)] = &[
        (Length::Meter, "METER"),
        (Length::Millimeter, "MILLIMETER"),
        (Length::Foot, "FOOT"),
        (Length::Inch, "INCH"),
    ];
}
