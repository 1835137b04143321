//! JOINT, JPRIM, MOTION as scalar equations.

use crate::code::Code;

/// A joint or motion: equations between two markers.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    pub keyword: &'static str,
    pub id: u32,
    pub i: usize,
    pub j: usize,
    pub equations: Vec<Equation>,
    /// What a motion prescribes.
    pub drive: Option<Drive>,
}

/// One equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Equation {
    /// An axis of J . (p_i - p_j) = 0, or the motion's value.
    Along(usize),
    /// An axis of I . an axis of J = 0.
    Normal(usize, usize),
    /// The angle of I about z of J is the motion's value.
    About,
}

/// The value that a motion prescribes.
#[derive(Clone, Debug)]
pub(crate) struct Drive {
    pub code: Code,
    /// The expression is a velocity: value at the start.
    pub start: Option<f64>,
}

use Equation::{Along, Normal};

const PARALLEL: [Equation; 2] = [Normal(0, 2), Normal(1, 2)];
const ORIENTATION: [Equation; 3] = [Normal(0, 1), Normal(1, 2), Normal(2, 0)];
const INLINE: [Equation; 2] = [Along(0), Along(1)];
const POINT: [Equation; 3] = [Along(0), Along(1), Along(2)];

/// The equations of a type of JOINT or JPRIM; none for types that are not executed.
pub(super) fn equations(kind: &str) -> Vec<Equation> {
    let parts: &[&[Equation]] = match kind {
        "FIXED" => &[&POINT, &ORIENTATION],
        "REVOLUTE" => &[&POINT, &PARALLEL],
        "TRANSLATIONAL" => &[&INLINE, &ORIENTATION],
        "CYLINDRICAL" => &[&INLINE, &PARALLEL],
        "PLANAR" => &[&[Along(2)], &PARALLEL],
        "SPHERICAL" | "ATPOINT" => &[&POINT],
        "HOOKE" | "UNIVERSAL" => &[&POINT, &[Normal(2, 2)]],
        "INLINE" => &[&INLINE],
        "INPLANE" => &[&[Along(2)]],
        "ORIENTATION" => &[&ORIENTATION],
        "PARALLEL_AXES" => &[&PARALLEL],
        "PERPENDICULAR" => &[&[Normal(2, 2)]],
        _ => &[],
    };
    parts.concat()
}
