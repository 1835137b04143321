//! Units of tables in the words of ADAMS, and in words on a line.

use crate::units::{Force, Length, Units};

impl Units {
    /// The units of a data set.
    #[must_use]
    pub fn of_adams(units: adams::Units) -> Units {
        Units {
            length: match units.length {
                adams::Length::Foot => Length::Foot,
                adams::Length::Inch => Length::Inch,
                adams::Length::Meter => Length::Metre,
                adams::Length::Millimeter => Length::Millimetre,
            },
            force: match units.force {
                adams::Force::Pound => Force::Pound,
                adams::Force::Kilopound => Force::Kip,
                adams::Force::Newton => Force::Newton,
                adams::Force::Kilonewton => Force::Kilonewton,
            },
        }
    }

    /// A data set's UNITS; its mass unit is that of the system, or one that every solver knows.
    #[must_use]
    pub fn to_adams(self) -> adams::Units {
        let (length, mass) = match self.length {
            Length::Foot => (adams::Length::Foot, adams::Mass::Slug),
            Length::Inch => (adams::Length::Inch, adams::Mass::Pound),
            Length::Metre => (adams::Length::Meter, adams::Mass::Kilogram),
            Length::Millimetre => (adams::Length::Millimeter, adams::Mass::Kilogram),
        };
        let force = match self.force {
            Force::Pound => adams::Force::Pound,
            Force::Kip => adams::Force::Kilopound,
            Force::Newton => adams::Force::Newton,
            Force::Kilonewton => adams::Force::Kilonewton,
        };
        adams::Units { force, mass, length }
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
