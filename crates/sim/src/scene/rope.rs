//! Ropes between bodies, and one-sided stops.

use super::schedule::Schedule;

/// An end of a rope: a point of a body or a fixed point in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RopeEnd {
    /// Which body; `None`: a fixed point in space.
    pub body: Option<usize>,
    /// Position relative to the origin of the body; for a point in space, [X, Y, Z].
    pub at: [f64; 3],
}

/// An elastic rope that can become slack.
///
/// Let l be the distance between its ends and l0(t) = `length` - integral of `speed` its unstretched length. The
/// tension is T = max(0, EA (l - l0)/l0 + c (l' - l0')) for l > l0, and zero for l <= l0.
/// ```
/// use std::ops::ControlFlow;
/// use sim::{Body, Channel, Rope, RopeEnd, Scene, Schedule};
///
/// // 1 t hangs at rest on 10 m of rope below the origin of space.
/// let rope = Rope {
///     from: RopeEnd { body: None, at: [0.0; 3] },
///     to: RopeEnd { body: Some(0), at: [0.0; 3] },
///     stiffness: 1e7,
///     damping: 0.0,
///     length: 10.0,
///     speed: Schedule::new(&[[0.0, 0.0]])?,
/// };
/// let free = [true, true, true, false, false, false];
/// let mut scene = Scene { bodies: vec![Body { free, ..Body::new(1e3, [0.0; 3]) }], ..Scene::default() };
/// scene.actuators.ropes = vec![rope];
/// scene.actuators.hanging = vec![0];
/// let run = sim::run(&scene, &[], &mut |_| ControlFlow::Continue(()))?;
/// assert!(run.history.values(Channel::Tension(0)).all(|tension| (tension / 9810.0 - 1.0).abs() < 1e-6));
/// # Ok::<(), sim::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Rope {
    /// One end.
    pub from: RopeEnd,
    /// The other.
    pub to: RopeEnd,
    /// Axial stiffness EA, a force, > 0.
    pub stiffness: f64,
    /// Damping constant c, force per speed, >= 0.
    pub damping: f64,
    /// Unstretched length at time 0, > 0.
    pub length: f64,
    /// Hoisting speed, positive where the rope is shortened.
    pub speed: Schedule,
}

/// A one-sided contact of a point of a body with a plane: an end stop of a rail, a floor, or another body. For a body
/// that is carried by another body, the plane is fixed to the rail on which the body runs.
///
/// For the penetration p = side (coordinate - place) > 0 the stop exerts the force max(0, k p + c p').
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Body that touches the plane.
    pub body: usize,
    /// Contact point relative to the origin of that body.
    pub at: [f64; 3],
    /// Normal axis of the plane in space, or in the track of a carried body: 0 X, 1 Y, 2 Z.
    pub axis: usize,
    /// Body to which the plane is fixed, touched at the height of `at`; `None`: the plane is fixed in space.
    pub against: Option<usize>,
    /// Coordinate of the plane relative to the origin of the body to which it is fixed.
    pub place: f64,
    /// 1 where the body approaches from below `place`, -1 where it approaches from above.
    pub side: f64,
    /// Stiffness k, > 0.
    pub stiffness: f64,
    /// Damping constant c, >= 0.
    pub damping: f64,
}

impl Rope {
    /// Times at which the slope of the hoisting speed may jump.
    pub(crate) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.speed.breaks()
    }
}
