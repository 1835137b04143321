//! Words of the command `defaults units`.

use crate::units::{Force, Length, Mass, lookup};

/// The first word of each unit is the one that is written.
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

pub(super) const FORCES: &[(Force, &str)] = &[
    (Force::Newton, "newton"),
    (Force::Kilonewton, "knewton"),
    (Force::Pound, "pound_force"),
    (Force::Kilopound, "kpound_force"),
    (Force::Newton, "n"),
    (Force::Kilonewton, "kn"),
    (Force::Pound, "lbf"),
];

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

pub(super) const TIMES: &[((), &str)] = &[((), "sec"), ((), "second")];

/// The word of a unit.
pub(super) fn word<U: PartialEq>(words: &[(U, &'static str)], unit: &U) -> &'static str {
    words.iter().find(|(one, _)| one == unit).map_or("", |(_, word)| word)
}

/// The unit of a word, in any case, in full.
pub(super) fn unit<U: Copy>(words: &[(U, &str)], text: &str) -> Option<U> {
    let same: Vec<(U, &str)> =
        words.iter().filter(|(_, word)| word.eq_ignore_ascii_case(text)).copied().collect();
    lookup(&same, text)
}
