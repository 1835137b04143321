//! Units of tables in the words of ADAMS, and in words on a line.

use crate::units::{Force, Length, Units};

impl Units {
    /// The units of a data set.
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

    /// A data set's UNITS; its mass unit is that of the system, or one that every solver knows.
    #[must_use]
    pub fn to_adams(self) -> adams::AdamsUnits {
        let (length, mass) = match self.length {
            Length::Foot => (adams::AdamsLengthUnit::Foot, adams::AdamsMassUnit::Slug),
            Length::Inch => (adams::AdamsLengthUnit::Inch, adams::AdamsMassUnit::Pound),
            Length::Metre => (adams::AdamsLengthUnit::Meter, adams::AdamsMassUnit::Kilogram),
            Length::Millimetre => (adams::AdamsLengthUnit::Millimeter, adams::AdamsMassUnit::Kilogram),
        };
        let force = match self.force {
            Force::Pound => adams::AdamsForceUnit::Pound,
            Force::Kip => adams::AdamsForceUnit::Kilopound,
            Force::Newton => adams::AdamsForceUnit::Newton,
            Force::Kilonewton => adams::AdamsForceUnit::Kilonewton,
        };
        adams::AdamsUnits { force, mass, length }
    }

    /// The units that a few words name, such as `ft, lbf, s` or `ft/lbf`.
    #[must_use]
    pub fn of_words(text: &str) -> Option<Units> {
        let mut words = text.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
        let length = Length::of_word(words.next()?)?;
        let force = Force::of_word(words.next()?)?;
        Some(Units { length, force })
    }
}
