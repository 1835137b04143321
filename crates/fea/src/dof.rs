//! The six degrees of freedom of a point.

use std::fmt;

/// One of the six degrees of freedom of a point or of an end of a member.
///
/// As an index: `Freedom::Uy as usize` is 1. Displays as `ux`, `uy`, ..., `rz`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Dof {
    /// Displacement along x, length.
    Ux,
    /// Displacement along y, length.
    Uy,
    /// Displacement along z, length.
    Uz,
    /// Rotation about x, radian.
    Rx,
    /// Rotation about y, radian.
    Ry,
    /// Rotation about z, radian.
    Rz,
}

impl Dof {
    /// All six, in order.
    pub const ALL: [Dof; 6] = [Dof::Ux, Dof::Uy, Dof::Uz, Dof::Rx, Dof::Ry, Dof::Rz];
}

impl fmt::Display for Dof {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(["ux", "uy", "uz", "rx", "ry", "rz"][*self as usize])
    }
}

/// A set of degrees of freedom: entry `Freedom as usize` is true if the set contains it.
pub type DofSet = [bool; 6];
