//! Which arguments a statement has.

use crate::units::lookup;

/// What an argument is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Nothing.
    Flag,
    /// One word.
    Word,
    /// Words or quoted text, separated by commas.
    Words,
    /// An identifier.
    Whole,
    /// Numbers, separated by commas.
    Numbers,
    /// Angles: radians, or degrees with the suffix D.
    Angles,
    /// A function expression.
    Function,
}

use Form::{Angles, Flag, Function, Numbers, Whole, Word, Words};

/// Arguments by full name.
pub(super) type Arguments = &'static [(Form, &'static str)];

const UNITS: Arguments =
    &[(Word, "FORCE"), (Word, "MASS"), (Word, "LENGTH"), (Word, "TIME"), (Word, "SYSTEM"), (Numbers, "UCF")];

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

const DIFF: Arguments =
    &[(Numbers, "IC"), (Function, "FUNCTION"), (Flag, "IMPLICIT"), (Flag, "STATIC_HOLD"), (Word, "ROUTINE")];

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

const ACCGRAV: Arguments = &[(Numbers, "IGRAV"), (Numbers, "JGRAV"), (Numbers, "KGRAV"), (Numbers, "GC")];

/// Keywords with their arguments; without, those whose arguments are kept as they are written.
const KEYWORDS: &[(Option<Arguments>, &str)] = &[
    (Some(ACCGRAV), "ACCGRAV"),
    (None, "ARRAY"),
    (Some(BEAM), "BEAM"),
    (None, "BUSHING"),
    (None, "CONTACT"),
    (None, "COUPLER"),
    (None, "CURVE"),
    (None, "CVCV"),
    (None, "DEBUG"),
    (Some(DIFF), "DIFF"),
    (None, "EQUILIBRIUM"),
    (None, "FIELD"),
    (None, "FLEX_BODY"),
    (None, "FRICTION"),
    (None, "GCON"),
    (None, "GEAR"),
    (Some(GFORCE), "GFORCE"),
    (None, "GRAPHICS"),
    (None, "GSE"),
    (None, "IC"),
    (None, "INTEGRATOR"),
    (Some(JOINT), "JOINT"),
    (Some(JPRIM), "JPRIM"),
    (None, "KINEMATICS"),
    (None, "LIST"),
    (None, "LSE"),
    (None, "LSOLVER"),
    (Some(MARKER), "MARKER"),
    (None, "MATERIAL"),
    (None, "MATRIX"),
    (None, "MFORCE"),
    (Some(MOTION), "MOTION"),
    (None, "NFORCE"),
    (None, "OUTPUT"),
    (Some(PART), "PART"),
    (None, "PINPUT"),
    (None, "POINT_MASS"),
    (None, "POUTPUT"),
    (None, "PREFERENCES"),
    (None, "PTCV"),
    (Some(REQUEST), "REQUEST"),
    (None, "RESULTS"),
    (None, "SENSOR"),
    (Some(SFORCE), "SFORCE"),
    (Some(SPLINE), "SPLINE"),
    (None, "SPRINGDAMPER"),
    (None, "STRING"),
    (None, "SURFACE"),
    (None, "TFSISO"),
    (Some(UNITS), "UNITS"),
    (Some(VARIABLE), "VARIABLE"),
    (Some(VFORCE), "VFORCE"),
    (None, "VTORQUE"),
];

/// Statements that have no identifier.
pub(super) const LONE: &[&str] = &["UNITS", "ACCGRAV"];

/// The full keyword and its arguments, from a word that may be an abbreviation. A word that is none, or that
/// could be several, stands for itself.
pub(super) fn keyword(word: &str) -> (String, Option<Arguments>) {
    let indices: Vec<(usize, &str)> = KEYWORDS.iter().map(|(_, name)| *name).enumerate().collect();
    match lookup(&indices, word).and_then(|k| KEYWORDS.get(k)) {
        Some((arguments, name)) => ((*name).to_owned(), *arguments),
        None => (word.to_ascii_uppercase(), None),
    }
}

/// The argument that a word is or abbreviates.
pub(super) fn argument(all: Arguments, word: &str) -> Option<(Form, &'static str)> {
    let indices: Vec<(usize, &str)> = all.iter().map(|(_, name)| *name).enumerate().collect();
    lookup(&indices, word).and_then(|k| all.get(k)).copied()
}
