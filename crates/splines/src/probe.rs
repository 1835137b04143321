//! Where on a rail, and in which direction, a force acts or a displacement is measured.

/// Direction in the frame of a rail: x along the rail, y up, z = x cross y (to the right when looking along
/// +x).
///
/// ```
/// use splines::Axis;
///
/// assert_eq!(Axis::ALL.map(Axis::component), [0, 1, 2]);
/// assert!(Axis::Longitudinal < Axis::Lateral);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Axis {
    /// Along the rail, +x.
    Longitudinal,
    /// Up, +y.
    Vertical,
    /// To the right when looking along the rail, +z.
    Lateral,
}

impl Axis {
    /// All three, in the order x, y, z.
    pub const ALL: [Axis; 3] = [Axis::Longitudinal, Axis::Vertical, Axis::Lateral];

    /// Index of the component of a vector in the rail frame: 0, 1 or 2.
    #[must_use]
    pub const fn component(self) -> usize {
        match self {
            Axis::Longitudinal => 0,
            Axis::Vertical => 1,
            Axis::Lateral => 2,
        }
    }
}

/// A place on a rail and a direction: one row and one column of an influence matrix.
///
/// ```
/// use splines::{Axis, Probe};
///
/// // The vertical force of a wheel that stands 12.5 ft along the first rail.
/// let wheel = Probe { rail: 0, x: 12.5, axis: Axis::Vertical };
/// // The lateral force of the same wheel's flange.
/// let flange = Probe { axis: Axis::Lateral, ..wheel };
/// assert_eq!(flange.x, wheel.x);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Index of the rail.
    pub rail: usize,
    /// Coordinate along the rail, length.
    pub x: f64,
    /// Direction of the force and of the displacement.
    pub axis: Axis,
}
