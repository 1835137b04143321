//! The UNITS statement.

/// Units of a data set; time is in seconds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Units {
    /// FORCE.
    pub force: Force,
    /// MASS. ADAMS itself reconciles it with the others.
    pub mass: Mass,
    /// LENGTH.
    pub length: Length,
}

/// A unit with its keyword in UNITS.
pub(crate) trait Keyword: Copy + 'static {
    const ALL: &'static [(Self, &'static str)];
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
    /// TONNE (the C++ solver alone).
    Tonne,
    /// POUND_MASS.
    Pound,
    /// SLUG.
    Slug,
    /// SLINCH, lbf s^2/in (the C++ solver alone).
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

impl Keyword for Force {
    const ALL: &'static [(Self, &'static str)] = &[
        (Force::Newton, "NEWTON"),
        (Force::Kilonewton, "KNEWTON"),
        (Force::Pound, "POUND_FORCE"),
        (Force::Kilopound, "KPOUND_FORCE"),
    ];
}

impl Keyword for Mass {
    const ALL: &'static [(Self, &'static str)] = &[
        (Mass::Kilogram, "KILOGRAM"),
        (Mass::Tonne, "TONNE"),
        (Mass::Pound, "POUND_MASS"),
        (Mass::Slug, "SLUG"),
        (Mass::Slinch, "SLINCH"),
    ];
}

impl Keyword for Length {
    const ALL: &'static [(Self, &'static str)] = &[
        (Length::Meter, "METER"),
        (Length::Millimeter, "MILLIMETER"),
        (Length::Foot, "FOOT"),
        (Length::Inch, "INCH"),
    ];
}

/// The keyword of a unit.
pub(crate) fn keyword<K: Keyword + PartialEq>(unit: K) -> &'static str {
    K::ALL.iter().find(|(one, _)| *one == unit).map_or("", |(_, word)| word)
}

/// The one of `words` that `text` is or abbreviates, in any case; `None` where there is none, or several.
pub(crate) fn lookup<'a, T: Copy>(words: &'a [(T, &'a str)], text: &str) -> Option<T> {
    if let Some((item, _)) = words.iter().find(|(_, word)| word.eq_ignore_ascii_case(text)) {
        return Some(*item);
    }
    let begins = |word: &str| word.get(..text.len()).is_some_and(|start| start.eq_ignore_ascii_case(text));
    let mut found = words.iter().filter(|(_, word)| !text.is_empty() && begins(word));
    match (found.next(), found.next()) {
        (Some((item, _)), None) => Some(*item),
        _ => None,
    }
}
