//! What codes ask of a crane girder beyond the limits and loads of this crate.

/// A check of a code, with its clause where a public source names it.
pub type ScopeEntry = (&'static str, Option<&'static str>);

/// Checks of EN 1993-6 and of the parts of EN 1993-1 that it refers to.
const EN_1993_6: [ScopeEntry; 11] = [
    (
        "cross-section class and resistance",
        Some("EN 1993-1-1, 5.5, 6.2"),
    ),
    ("lateral-torsional buckling", Some("6.3.2")),
    ("warping stresses from torsion", Some("6.2, annex A")),
    (
        "resistance of the web to wheel loads, and buckling of plates",
        Some("6.5, EN 1993-1-5"),
    ),
    (
        "local stresses in the web with those of bending",
        Some("5.7"),
    ),
    (
        "local bending of the bottom flange under wheels",
        Some("5.8, 6.7"),
    ),
    ("web breathing", Some("7.4")),
    ("elastic behaviour in service", Some("7.5")),
    ("vibration of the bottom flange", Some("7.6")),
    ("fatigue of details", Some("9")),
    (
        "welds, connections, stiffeners and rail fixings",
        Some("6.8, 8"),
    ),
];

/// Checks that American practice asks of a runway girder (AISC 360, Design Guide 7).
const AISC: [ScopeEntry; 6] = [
    (
        "flexure with lateral-torsional buckling",
        Some("AISC 360 F2 to F6"),
    ),
    ("biaxial bending and torsion", Some("AISC 360 H1, H3")),
    (
        "web yielding, crippling and sidesway buckling under wheels",
        Some("AISC 360 J10"),
    ),
    ("fatigue of details", Some("AISC 360 appendix 3")),
    (
        "bending of the bottom flange under wheels of underhung cranes",
        None,
    ),
    ("welds, connections, stiffeners and rail fixings", None),
];

/// Checks that IS 800 asks of a gantry girder.
const IS_800: [ScopeEntry; 5] = [
    (
        "bending strength with lateral-torsional buckling",
        Some("8.2"),
    ),
    ("combined bending and axial force", Some("9.3")),
    ("web buckling and bearing under wheels", Some("8.7")),
    ("fatigue of details", Some("13")),
    ("welds, connections, stiffeners and rail fixings", None),
];

/// The checks of a code that this program does not do; `code` is a name without edition
/// ([`code_name`](super::limit_choice::code_name)).
///
/// ```
/// let left = practice::scope::checks_beyond("EN 1993-6");
/// assert!(left.iter().any(|(check, _)| check.contains("lateral-torsional")));
/// ```
#[must_use]
pub fn checks_beyond(code: &str) -> &'static [ScopeEntry] {
    match code {
        "EN 1991-3" | "EN 1993-6" => &EN_1993_6,
        "IS 800" => &IS_800,
        _ => &AISC,
    }
}
