//! A unit rail force in the local axes of a member.

use super::element::RailElement;
use crate::vector::{RealNumber, cross, dot3, unit};

/// Force and moment that a unit force on the rail exerts on the axis of a member, in local axes.
///
/// A force f at the offset o from the axis acts there as the force f and the moment o cross f. By the same
/// numbers the displacement of the rail along f follows from the displacement and rotation of the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct AxisLoad<T = f64> {
    /// Force along local x.
    pub axial: T,
    /// Moment about local x, length.
    pub twist: T,
    /// Force and moment of the x-y plane, which act on (v, theta_z).
    pub xy: [T; 2],
    /// Force and moment of the x-z plane, which act on (w, -theta_y).
    pub xz: [T; 2],
}

impl<T: RealNumber> AxisLoad<T> {
    /// A unit force along rail direction `axis`, 0, 1 or 2, in the local axes given by the rows of `frame`:
    /// those of the element, or those of its member.
    pub fn new(element: &RailElement<T>, frame: &[[T; 3]; 3], axis: usize) -> AxisLoad<T> {
        let moment = cross(element.offset, unit(axis));
        let largest = element
            .offset
            .iter()
            .fold(T::from(0.0), |a, &b| if size(b) > a { size(b) } else { a });
        let force = |k: usize| without_rounding(frame[k][axis], T::from(1.0));
        let about = |k: usize| without_rounding(dot3(&frame[k], &moment), largest);
        AxisLoad {
            axial: force(0),
            twist: about(0),
            xy: [force(1), about(2)],
            xz: [force(2), -about(1)],
        }
    }

    /// Whether the load acts axially, in torsion, in the x-y plane and in the x-z plane.
    pub fn uses(&self) -> [bool; 4] {
        let zero = T::from(0.0);
        [
            self.axial != zero,
            self.twist != zero,
            self.xy != [zero; 2],
            self.xz != [zero; 2],
        ]
    }
}

/// Absolute value.
#[inline]
pub(crate) fn size<T: RealNumber>(value: T) -> T {
    if value < T::from(0.0) { -value } else { value }
}

/// `value`, or zero where it is no more than the rounding of a rotation of numbers of size `scale`. Numbers wider
/// than doubles are left as they are: nothing is recognised by their zeros.
pub(crate) fn without_rounding<T: RealNumber>(value: T, scale: T) -> T {
    let one = T::from(1.0);
    let wide = one + T::from(0.25 * f64::EPSILON) != one;
    if !wide && size(value) <= T::from(4.0 * f64::EPSILON) * scale {
        T::from(0.0)
    } else {
        value
    }
}
