//! Where everything is and how it moves.

use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;

/// A state of a data set: time, moving parts by identifier, states of differential equations by identifier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// TIME.
    pub time: f64,
    /// Every PART but ground.
    pub parts: BTreeMap<u32, Pose>,
    /// DIF of every DIFF.
    pub differentials: BTreeMap<u32, f64>,
}

/// A part in ground coordinates.
///
/// `rotation` turns part coordinates into ground coordinates. It is taken as it is: the I + theta x of a
/// simulator with small rotations gives that simulator's positions to the last digits, and `rate` then is the
/// theta' x that gives its velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Where the part's own origin is.
    pub origin: Vector3<f64>,
    /// Axes of the part, in columns.
    pub rotation: Matrix3<f64>,
    /// Velocity of the origin.
    pub velocity: Vector3<f64>,
    /// d(rotation)/dt: a point s of the part moves with velocity + rate s.
    pub rate: Matrix3<f64>,
    /// Angular velocity, which WX, WY, WZ read.
    pub spin: Vector3<f64>,
}

impl Pose {
    /// A part at rest.
    #[must_use]
    pub fn at(origin: Vector3<f64>, rotation: Matrix3<f64>) -> Pose {
        Pose::moving(origin, rotation, Vector3::zeros(), Vector3::zeros())
    }

    /// A part that moves as a rigid body: rate = spin x rotation.
    #[must_use]
    pub fn moving(
        origin: Vector3<f64>,
        rotation: Matrix3<f64>,
        velocity: Vector3<f64>,
        spin: Vector3<f64>,
    ) -> Pose {
        Pose { origin, rotation, velocity, rate: spin.cross_matrix() * rotation, spin }
    }
}
