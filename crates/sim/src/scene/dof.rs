//! The six degrees of freedom of a rigid body, and the lever arms of its points.

/// Degree of freedom of a body on its track. Rotations are small and right-handed about x, y and z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BodyDof {
    /// Along the rail.
    X,
    /// Up.
    Y,
    /// To the right, looking along the rail.
    Z,
    /// About x.
    Roll,
    /// About y.
    Yaw,
    /// About z; a positive value raises the front.
    Pitch,
}

impl BodyDof {
    /// All six, in the order of every array of six in this crate.
    pub const ALL: [BodyDof; 6] = [
        BodyDof::X,
        BodyDof::Y,
        BodyDof::Z,
        BodyDof::Roll,
        BodyDof::Yaw,
        BodyDof::Pitch,
    ];
}

/// Matrix of the displacement u + theta cross r of a point at `r` relative to the origin of a body, with theta =
/// (roll, yaw, pitch). Row i contains component i per unit of each degree of freedom.
#[must_use]
pub(crate) fn arm_rows(r: [f64; 3]) -> [[f64; 6]; 3] {
    let [rx, ry, rz] = r;
    [
        [1.0, 0.0, 0.0, 0.0, rz, -ry],
        [0.0, 1.0, 0.0, -rz, 0.0, rx],
        [0.0, 0.0, 1.0, ry, -rx, 0.0],
    ]
}
