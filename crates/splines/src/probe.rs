//! Where on a rail, and in which direction, one contact force acts.

/// Direction of a rail frame: x along the rail, y up, z = x cross y (to the right when looking along x).
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

    /// Component of a vector in the rail frame: 0, 1 or 2.
    #[must_use]
    pub const fn component(self) -> usize {
        match self {
            Axis::Longitudinal => 0,
            Axis::Vertical => 1,
            Axis::Lateral => 2,
        }
    }
}

/// A place on a rail and a direction: one row or column of an influence matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Which rail.
    pub rail: usize,
    /// Coordinate along the rail.
    pub x: f64,
    /// Direction of the force and of the displacement.
    pub axis: Axis,
}
