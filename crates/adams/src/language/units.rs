//! The UNITS statement.

use super::statement::Statement;

/// Units of a data set. The unit of time is the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct AdamsUnits {
    /// FORCE.
    pub force: AdamsForceUnit,
    /// MASS. It need not be consistent with force and length: ADAMS converts mass times acceleration to
    /// force.
    pub mass: AdamsMassUnit,
    /// LENGTH.
    pub length: AdamsLengthUnit,
}

/// A quantity whose units have words in UNITS.
pub(crate) trait UnitWords: Copy + PartialEq + 'static {
    /// Every unit with its word.
    const ALL: &'static [(Self, &'static str)];

    /// The word of a unit.
    fn word(self) -> &'static str {
        Self::ALL
            .iter()
            .find(|(unit, _)| *unit == self)
            .map_or("", |(_, word)| word)
    }
}

/// FORCE of a UNITS statement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AdamsForceUnit {
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
pub enum AdamsMassUnit {
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
pub enum AdamsLengthUnit {
    /// METER.
    Meter,
    /// MILLIMETER.
    Millimeter,
    /// FOOT.
    Foot,
    /// INCH.
    Inch,
}

impl AdamsUnits {
    /// The UNITS statement.
    #[must_use]
    pub fn statement(&self) -> Statement {
        Statement::without_id("UNITS")
            .word("FORCE", self.force.word())
            .word("MASS", self.mass.word())
            .word("LENGTH", self.length.word())
            .word("TIME", "SECOND")
    }
}

impl UnitWords for AdamsForceUnit {
    const ALL: &'static [(Self, &'static str)] = &[
        (AdamsForceUnit::Newton, "NEWTON"),
        (AdamsForceUnit::Kilonewton, "KNEWTON"),
        (AdamsForceUnit::Pound, "POUND_FORCE"),
        (AdamsForceUnit::Kilopound, "KPOUND_FORCE"),
    ];
}

impl UnitWords for AdamsMassUnit {
    const ALL: &'static [(Self, &'static str)] = &[
        (AdamsMassUnit::Kilogram, "KILOGRAM"),
        (AdamsMassUnit::Tonne, "TONNE"),
        (AdamsMassUnit::Pound, "POUND_MASS"),
        (AdamsMassUnit::Slug, "SLUG"),
        (AdamsMassUnit::Slinch, "SLINCH"),
    ];
}

impl UnitWords for AdamsLengthUnit {
    const ALL: &'static [(Self, &'static str)] = &[
        (AdamsLengthUnit::Meter, "METER"),
        (AdamsLengthUnit::Millimeter, "MILLIMETER"),
        (AdamsLengthUnit::Foot, "FOOT"),
        (AdamsLengthUnit::Inch, "INCH"),
    ];
}
