//! The state of a data set: poses and velocities of parts, and differential states.

use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;

/// The state of a data set at one time.
///
/// ```
/// use adams::{Pose, ModelState};
/// use nalgebra::{Matrix3, Vector3};
///
/// let mut state = ModelState { time: 0.5, ..ModelState::default() };
/// state.parts.insert(2, Pose::at_rest(Vector3::new(0.0, 1.25, 30.0), Matrix3::identity()));
/// assert_eq!(state.parts[&2].velocity, Vector3::zeros());
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModelState {
    /// The value of TIME, in s.
    pub time: f64,
    /// The pose of every PART except ground, by identifier.
    pub parts: BTreeMap<u32, Pose>,
    /// The value DIF of every DIFF, by identifier.
    pub differentials: BTreeMap<u32, f64>,
}

/// The position, orientation and velocities of a part in ground coordinates.
///
/// `rotation` transforms part coordinates to ground coordinates and is used as it is given, without being
/// made orthogonal. A simulator with small rotations theta gives I + theta x here and theta' x as `rate`; the
/// positions and velocities of points then agree with that simulator's to the last digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the origin of the part.
    pub origin: Vector3<f64>,
    /// Axes of the part as columns.
    pub rotation: Matrix3<f64>,
    /// Velocity of the origin.
    pub velocity: Vector3<f64>,
    /// Time derivative of `rotation`: a point with part coordinates s has the velocity `velocity + rate s`.
    pub rate: Matrix3<f64>,
    /// Angular velocity, which WX, WY and WZ measure, in rad/s.
    pub angular_velocity: Vector3<f64>,
}

impl Pose {
    /// A part at rest.
    #[must_use]
    pub fn at_rest(origin: Vector3<f64>, rotation: Matrix3<f64>) -> Pose {
        Pose::moving(origin, rotation, Vector3::zeros(), Vector3::zeros())
    }

    /// A part that moves as a rigid body: `rate` is spin x rotation.
    #[must_use]
    pub fn moving(
        origin: Vector3<f64>,
        rotation: Matrix3<f64>,
        velocity: Vector3<f64>,
        angular_velocity: Vector3<f64>,
    ) -> Pose {
        Pose {
            origin,
            rotation,
            velocity,
            rate: angular_velocity.cross_matrix() * rotation,
            angular_velocity,
        }
    }
}
