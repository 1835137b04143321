//! The words for units in the command `defaults units`.

use crate::keyword::lookup;
use crate::language::{AdamsForceUnit, AdamsLengthUnit, AdamsMassUnit};

/// Units of length; the first word of each unit is the one that is written.
pub(super) const LENGTHS: &[(AdamsLengthUnit, &str)] = &[
    (AdamsLengthUnit::Millimeter, "mm"),
    (AdamsLengthUnit::Meter, "meter"),
    (AdamsLengthUnit::Foot, "foot"),
    (AdamsLengthUnit::Inch, "inch"),
    (AdamsLengthUnit::Millimeter, "millimeter"),
    (AdamsLengthUnit::Meter, "m"),
    (AdamsLengthUnit::Foot, "ft"),
    (AdamsLengthUnit::Inch, "in"),
];

/// Units of force, likewise.
pub(super) const FORCES: &[(AdamsForceUnit, &str)] = &[
    (AdamsForceUnit::Newton, "newton"),
    (AdamsForceUnit::Kilonewton, "knewton"),
    (AdamsForceUnit::Pound, "pound_force"),
    (AdamsForceUnit::Kilopound, "kpound_force"),
    (AdamsForceUnit::Newton, "n"),
    (AdamsForceUnit::Kilonewton, "kn"),
    (AdamsForceUnit::Pound, "lbf"),
];

/// Units of mass, likewise.
pub(super) const MASSES: &[(AdamsMassUnit, &str)] = &[
    (AdamsMassUnit::Kilogram, "kg"),
    (AdamsMassUnit::Tonne, "tonne"),
    (AdamsMassUnit::Pound, "pound_mass"),
    (AdamsMassUnit::Slug, "slug"),
    (AdamsMassUnit::Slinch, "slinch"),
    (AdamsMassUnit::Kilogram, "kilogram"),
    (AdamsMassUnit::Tonne, "megagram"),
    (AdamsMassUnit::Pound, "lbm"),
];

/// Words for the second, the only unit of time.
pub(super) const TIMES: &[((), &str)] = &[((), "sec"), ((), "second")];

/// The word that is written for a unit.
pub(super) fn word<U: PartialEq>(words: &[(U, &'static str)], unit: &U) -> &'static str {
    words
        .iter()
        .find(|(one, _)| one == unit)
        .map_or("", |(_, word)| word)
}

/// The unit of a full word in upper or lower case.
pub(super) fn unit<U: Copy>(words: &[(U, &str)], text: &str) -> Option<U> {
    let same: Vec<(U, &str)> = words
        .iter()
        .filter(|(_, word)| word.eq_ignore_ascii_case(text))
        .copied()
        .collect();
    lookup(&same, text)
}
