//! The words for units in the command `defaults units`.

use crate::keyword::lookup;
use crate::language::{Force, Length, Mass};

/// Units of length; the first word of each unit is the one that is written.
pub(super) const LENGTHS: &[(Length, &str)] = &[
    (Length::Millimeter, "mm"),
    (Length::Meter, "meter"),
    (Length::Foot, "foot"),
    (Length::Inch, "inch"),
    (Length::Millimeter, "millimeter"),
    (Length::Meter, "m"),
    (Length::Foot, "ft"),
    (Length::Inch, "in"),
];

/// Units of force, likewise.
pub(super) const FORCES: &[(Force, &str)] = &[
    (Force::Newton, "newton"),
    (Force::Kilonewton, "knewton"),
    (Force::Pound, "pound_force"),
    (Force::Kilopound, "kpound_force"),
    (Force::Newton, "n"),
    (Force::Kilonewton, "kn"),
    (Force::Pound, "lbf"),
];

/// Units of mass, likewise.
pub(super) const MASSES: &[(Mass, &str)] = &[
    (Mass::Kilogram, "kg"),
    (Mass::Tonne, "tonne"),
    (Mass::Pound, "pound_mass"),
    (Mass::Slug, "slug"),
    (Mass::Slinch, "slinch"),
    (Mass::Kilogram, "kilogram"),
    (Mass::Tonne, "megagram"),
    (Mass::Pound, "lbm"),
];

/// Words for the second, the only unit of time.
pub(super) const TIMES: &[((), &str)] = &[((), "sec"), ((), "second")];

/// The word that is written for a unit.
pub(super) fn word<U: PartialEq>(words: &[(U, &'static str)], unit: &U) -> &'static str {
    words.iter().find(|(one, _)| one == unit).map_or("", |(_, word)| word)
}

/// The unit of a full word in upper or lower case.
pub(super) fn unit<U: Copy>(words: &[(U, &str)], text: &str) -> Option<U> {
    let same: Vec<(U, &str)> =
        words.iter().filter(|(_, word)| word.eq_ignore_ascii_case(text)).copied().collect();
    lookup(&same, text)
}
