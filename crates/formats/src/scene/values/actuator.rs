//! Loads, ropes, stops, prescribed spins and events: the actions on bodies other than wheel forces and gravity.

use sim::{Profile, Rule, Schedule};

/// A force or a moment on one degree of freedom of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Index of its body.
    pub body: usize,
    /// Index of the degree of freedom in the order x, y, z, roll, yaw, pitch.
    pub dof: usize,
    /// Force, or moment (force length), over time.
    pub value: Schedule,
}

/// An elastic rope between two points.
#[derive(Clone, Debug, PartialEq)]
pub struct Rope {
    /// Its name; by default `rope<n>`.
    pub name: String,
    /// Indices of the bodies at both ends; none for an end at a fixed point in space.
    pub bodies: [Option<usize>; 2],
    /// Positions of both ends, relative to the bodies' origins or in space, length.
    pub at: [[f64; 3]; 2],
    /// Axial stiffness EA, force, above 0.
    pub stiffness: f64,
    /// Damping coefficient, force time / length, not negative.
    pub damping: f64,
    /// Unstretched length at time 0, above 0.
    pub length: f64,
    /// Hoisting speed over time, length / time, positive if it shortens the rope.
    pub speed: Schedule,
}

/// A unilateral plane with a spring and a damper.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Its name; by default `stop<n>`.
    pub name: String,
    /// Coordinate in space that it limits: 0 along the rail, 1 upwards.
    pub axis: usize,
    /// Index of the body that carries it; none if it is fixed in space.
    pub against: Option<usize>,
    /// Its position on that coordinate, relative to the origin of the body that carries it, length.
    pub place: f64,
    /// Index of the rail of the scene to which it is attached; none if the ground carries it.
    pub rail: Option<usize>,
    /// Stiffness, force / length, above 0.
    pub stiffness: f64,
    /// Damping coefficient, force time / length, not negative.
    pub damping: f64,
    /// Points of bodies that can make contact with it.
    pub points: Vec<StopPoint>,
}

/// A point of a body that can make contact with a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopPoint {
    /// Index of the body.
    pub body: usize,
    /// Position of the point relative to its origin, length.
    pub at: [f64; 3],
    /// 1 if the point approaches the stop from lower coordinates, -1 if it approaches from higher ones.
    pub side: f64,
}

/// A wheel whose angle about its axle is prescribed.
#[derive(Clone, Debug, PartialEq)]
pub struct Spin {
    /// Index of its truck.
    pub truck: usize,
    /// Index of the wheel within the truck.
    pub wheel: usize,
    /// Angle over time, radians.
    pub motion: Profile,
}

/// Actions that are carried out once, as soon as a condition is met.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Its name; by default `event<n>`.
    pub name: String,
    /// Its condition as written.
    pub when: String,
    /// Description of its actions.
    pub description: String,
    /// Condition and actions.
    pub rule: Rule,
}
