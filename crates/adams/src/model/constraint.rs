//! JOINT, JPRIM and MOTION as scalar equations between two markers.

use super::formula::Formula;

/// A joint, joint primitive or motion: scalar equations between the markers I and J.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    pub keyword: &'static str,
    pub id: u32,
    pub i: usize,
    pub j: usize,
    pub equations: Vec<Equation>,
    /// The prescribed displacement of a MOTION.
    pub motion: Option<PrescribedMotion>,
}

/// One scalar equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Equation {
    /// a_j . (p_i - p_j) = 0 for an axis a_j of J, or equal to the prescribed displacement.
    Along(usize),
    /// a_i . b_j = 0: an axis of I is normal to an axis of J.
    Normal(usize, usize),
    /// The angle of I about z of J equals the prescribed rotation.
    About,
}

/// The displacement or rotation that a MOTION prescribes.
#[derive(Clone, Debug)]
pub(crate) struct PrescribedMotion {
    pub formula: Formula,
    /// ICDISP, the value at time zero, if the expression is a velocity.
    pub start: Option<f64>,
}

use Equation::{Along, Normal};

const PARALLEL: [Equation; 2] = [Normal(0, 2), Normal(1, 2)];
const ORIENTATION: [Equation; 3] = [Normal(0, 1), Normal(1, 2), Normal(2, 0)];
const INLINE: [Equation; 2] = [Along(0), Along(1)];
const POINT: [Equation; 3] = [Along(0), Along(1), Along(2)];

/// The equations of a type of JOINT or JPRIM. The list is empty for types that are not executed.
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
