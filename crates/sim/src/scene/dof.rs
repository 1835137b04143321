//! The six degrees of freedom of a rigid body, and the lever arms between them.

/// Degree of freedom of a body on its track; rotations are small and right-handed about x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Freedom {
    /// Along the rail.
    X,
    /// Up.
    Y,
    /// To the right when looking along the rail.
    Z,
    /// About x.
    Roll,
    /// About y.
    Yaw,
    /// About z: positive lifts the front.
    Pitch,
}

impl Freedom {
    /// All six, in the order of every array of six in this crate.
    pub const ALL: [Freedom; 6] =
        [Freedom::X, Freedom::Y, Freedom::Z, Freedom::Roll, Freedom::Yaw, Freedom::Pitch];
}

/// Displacement of a point at `r` from a body's origin: row i gives component i per unit of each degree of
/// degree of freedom, u + theta cross r with theta = (roll, yaw, pitch).
#[must_use]
pub(crate) fn arm_rows(r: [f64; 3]) -> [[f64; 6]; 3] {
    let [rx, ry, rz] = r;
    [[1.0, 0.0, 0.0, 0.0, rz, -ry], [0.0, 1.0, 0.0, -rz, 0.0, rx], [0.0, 0.0, 1.0, ry, -rx, 0.0]]
}
