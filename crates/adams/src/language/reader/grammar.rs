//! The arguments of every kind of statement.

use crate::keyword::{Keyword, lookup};

/// The form of the value that an argument takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// No value.
    Flag,
    /// One word.
    Word,
    /// Words or quoted texts, separated by commas.
    Words,
    /// An identifier.
    Whole,
    /// One or more numbers, separated by commas.
    Numbers,
    /// Angles in radians, or in degrees with the suffix D.
    Angles,
    /// A function expression.
    Function,
}

use Form::{Angles, Flag, Function, Numbers, Whole, Word, Words};

/// The arguments of one kind of statement: their forms and full names.
pub(super) type Arguments = &'static [(Form, &'static str)];

const UNITS: Arguments = &[
    (Word, "FORCE"),
    (Word, "MASS"),
    (Word, "LENGTH"),
    (Word, "TIME"),
    (Word, "SYSTEM"),
    (Numbers, "UCF"),
];

const PART: Arguments = &[
    (Flag, "GROUND"),
    (Numbers, "QG"),
    (Numbers, "ZG"),
    (Numbers, "XG"),
    (Angles, "REULER"),
    (Numbers, "MASS"),
    (Whole, "CM"),
    (Whole, "IM"),
    (Numbers, "IP"),
    (Numbers, "VX"),
    (Numbers, "VY"),
    (Numbers, "VZ"),
    (Angles, "WX"),
    (Angles, "WY"),
    (Angles, "WZ"),
    (Whole, "VM"),
    (Whole, "WM"),
    (Words, "EXACT"),
];

const MARKER: Arguments = &[
    (Whole, "PART"),
    (Whole, "POINT_MASS"),
    (Whole, "FLEX_BODY"),
    (Whole, "NODE_ID"),
    (Flag, "FLOATING"),
    (Numbers, "QP"),
    (Angles, "REULER"),
    (Numbers, "ZP"),
    (Numbers, "XP"),
    (Flag, "USEXP"),
];

const JOINT: Arguments = &[
    (Whole, "I"),
    (Whole, "J"),
    (Flag, "REVOLUTE"),
    (Flag, "TRANSLATIONAL"),
    (Flag, "FIXED"),
    (Flag, "PLANAR"),
    (Flag, "CYLINDRICAL"),
    (Flag, "SPHERICAL"),
    (Flag, "HOOKE"),
    (Flag, "UNIVERSAL"),
    (Flag, "CONVEL"),
    (Flag, "SCREW"),
    (Flag, "RACKPIN"),
    (Numbers, "IC"),
    (Numbers, "ICTRAN"),
    (Angles, "ICROT"),
    (Numbers, "PD"),
    (Numbers, "PITCH"),
];

const JPRIM: Arguments = &[
    (Whole, "I"),
    (Whole, "J"),
    (Flag, "ATPOINT"),
    (Flag, "INLINE"),
    (Flag, "INPLANE"),
    (Flag, "ORIENTATION"),
    (Flag, "PARALLEL_AXES"),
    (Flag, "PERPENDICULAR"),
];

const MOTION: Arguments = &[
    (Flag, "ROTATIONAL"),
    (Flag, "TRANSLATIONAL"),
    (Whole, "JOINT"),
    (Whole, "I"),
    (Whole, "J"),
    (Flag, "X"),
    (Flag, "Y"),
    (Flag, "Z"),
    (Flag, "B1"),
    (Flag, "B2"),
    (Flag, "B3"),
    (Flag, "DISPLACEMENT"),
    (Flag, "VELOCITY"),
    (Flag, "ACCELERATION"),
    (Numbers, "ICDISP"),
    (Numbers, "ICVEL"),
    (Function, "FUNCTION"),
    (Word, "ROUTINE"),
];

const SPLINE: Arguments = &[
    (Numbers, "X"),
    (Numbers, "Y"),
    (Flag, "LINEAR_EXTRAPOLATE"),
    (Word, "FILE"),
    (Word, "BLOCK"),
    (Word, "CHANNEL"),
];

const VARIABLE: Arguments = &[(Numbers, "IC"), (Function, "FUNCTION"), (Word, "ROUTINE")];

const DIFF: Arguments = &[
    (Numbers, "IC"),
    (Function, "FUNCTION"),
    (Flag, "IMPLICIT"),
    (Flag, "STATIC_HOLD"),
    (Word, "ROUTINE"),
];

const SFORCE: Arguments = &[
    (Flag, "TRANSLATIONAL"),
    (Flag, "ROTATIONAL"),
    (Flag, "ACTIONONLY"),
    (Whole, "I"),
    (Whole, "J"),
    (Function, "FUNCTION"),
    (Word, "ROUTINE"),
];

const GFORCE: Arguments = &[
    (Whole, "I"),
    (Whole, "JFLOAT"),
    (Whole, "RM"),
    (Function, "FX"),
    (Function, "FY"),
    (Function, "FZ"),
    (Function, "TX"),
    (Function, "TY"),
    (Function, "TZ"),
    (Function, "FUNCTION"),
    (Word, "ROUTINE"),
];

const VFORCE: Arguments = &[
    (Whole, "I"),
    (Whole, "JFLOAT"),
    (Whole, "RM"),
    (Function, "FX"),
    (Function, "FY"),
    (Function, "FZ"),
    (Function, "FUNCTION"),
    (Word, "ROUTINE"),
];

const BEAM: Arguments = &[
    (Whole, "I"),
    (Whole, "J"),
    (Numbers, "LENGTH"),
    (Numbers, "IXX"),
    (Numbers, "IYY"),
    (Numbers, "IZZ"),
    (Numbers, "AREA"),
    (Numbers, "EMODULUS"),
    (Numbers, "GMODULUS"),
    (Numbers, "ASY"),
    (Numbers, "ASZ"),
    (Numbers, "CRATIO"),
    (Numbers, "CMATRIX"),
    (Word, "FORMULATION"),
];

const REQUEST: Arguments = &[
    (Flag, "DISPLACEMENT"),
    (Flag, "VELOCITY"),
    (Flag, "ACCELERATION"),
    (Flag, "FORCE"),
    (Whole, "I"),
    (Whole, "J"),
    (Whole, "RM"),
    (Words, "CNAMES"),
    (Words, "CLABELS"),
    (Words, "CUNITS"),
    (Words, "CTYPES"),
    (Words, "RESULTS_NAME"),
    (Words, "COMMENT"),
    (Words, "TITLE"),
    (Numbers, "VARIABLES"),
    (Function, "F1"),
    (Function, "F2"),
    (Function, "F3"),
    (Function, "F4"),
    (Function, "F5"),
    (Function, "F6"),
    (Function, "F7"),
    (Function, "F8"),
    (Function, "FUNCTION"),
    (Word, "ROUTINE"),
];

const ACCGRAV: Arguments = &[
    (Numbers, "IGRAV"),
    (Numbers, "JGRAV"),
    (Numbers, "KGRAV"),
    (Numbers, "GC"),
];

/// The arguments of a kind of statement; `None` for kinds whose arguments are kept as they are written.
fn arguments(keyword: &Keyword) -> Option<Arguments> {
    Some(match keyword {
        Keyword::Accgrav => ACCGRAV,
        Keyword::Beam => BEAM,
        Keyword::Diff => DIFF,
        Keyword::Gforce => GFORCE,
        Keyword::Joint => JOINT,
        Keyword::Jprim => JPRIM,
        Keyword::Marker => MARKER,
        Keyword::Motion => MOTION,
        Keyword::Part => PART,
        Keyword::Request => REQUEST,
        Keyword::Sforce => SFORCE,
        Keyword::Spline => SPLINE,
        Keyword::Units => UNITS,
        Keyword::Variable => VARIABLE,
        Keyword::Vforce => VFORCE,
        _ => return None,
    })
}

/// Whether a kind of statement has no identifier.
pub(super) fn has_no_id(keyword: &Keyword) -> bool {
    matches!(keyword, Keyword::Units | Keyword::Accgrav)
}

/// The keyword that a word names or abbreviates, and its arguments. A word that is unknown or ambiguous
/// is a keyword of its own.
pub(super) fn keyword(word: &str) -> (Keyword, Option<Arguments>) {
    let keyword =
        lookup(Keyword::ALL, word).unwrap_or_else(|| Keyword::Other(word.to_ascii_uppercase()));
    let arguments = arguments(&keyword);
    (keyword, arguments)
}

/// The form and full name of the argument that a word names or abbreviates.
pub(super) fn argument(all: Arguments, word: &str) -> Option<(Form, &'static str)> {
    let indices: Vec<(usize, &str)> = all.iter().map(|(_, name)| *name).enumerate().collect();
    lookup(&indices, word).and_then(|k| all.get(k)).copied()
}
