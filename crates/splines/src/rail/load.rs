//! A unit rail force in the local axes of a member.

use super::element::RailElement;
use crate::vector::{cross, dot, unit};

/// Force and moment that a unit force on the rail exerts on the axis of a member, in local axes.
///
/// A force f at the offset o from the axis acts there as the force f and the moment o cross f. By the same
/// numbers the displacement of the rail along f follows from the displacement and rotation of the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AxisLoad {
    /// Force along local x.
    pub axial: f64,
    /// Moment about local x, length.
    pub twist: f64,
    /// Force and moment of the x-y plane, which act on (v, theta_z).
    pub xy: [f64; 2],
    /// Force and moment of the x-z plane, which act on (w, -theta_y).
    pub xz: [f64; 2],
}

impl AxisLoad {
    /// A unit force along rail direction `axis`, 0, 1 or 2, in the local axes given by the rows of `frame`:
    /// those of the element, or those of its member.
    pub fn new(element: &RailElement, frame: &[[f64; 3]; 3], axis: usize) -> AxisLoad {
        let moment = cross(element.offset, unit(axis));
        let largest = element.offset.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let force = |k: usize| without_rounding(frame[k][axis], 1.0);
        let about = |k: usize| without_rounding(dot(&frame[k], &moment), largest);
        AxisLoad { axial: force(0), twist: about(0), xy: [force(1), about(2)], xz: [force(2), -about(1)] }
    }

    /// Whether the load acts axially, in torsion, in the x-y plane and in the x-z plane.
    pub fn uses(&self) -> [bool; 4] {
        [self.axial != 0.0, self.twist != 0.0, self.xy != [0.0; 2], self.xz != [0.0; 2]]
    }
}

/// `value`, or zero where it is no more than the rounding of a rotation of numbers of size `scale`.
pub(crate) fn without_rounding(value: f64, scale: f64) -> f64 {
    if value.abs() <= 4.0 * f64::EPSILON * scale { 0.0 } else { value }
}
