//! Ropes between bodies, and one-sided stops.

use super::schedule::Schedule;

/// An end of a rope: a point of a body, or of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RopeEnd {
    /// Which body; `None`: a fixed point in space.
    pub body: Option<usize>,
    /// Point from the body's origin; in space, [X, Y, Z].
    pub at: [f64; 3],
}

/// An elastic rope that may fall slack.
///
/// With the distance l of its ends and its unstretched length l0(t) = `length` - integral of `speed`, it pulls with
/// T = max(0, EA (l - l0)/l0 + c (l' - l0')) where l > l0, and not at all where l <= l0.
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
    /// EA, a force, > 0.
    pub stiffness: f64,
    /// c, force per speed, >= 0.
    pub damping: f64,
    /// Unstretched length at time 0, > 0.
    pub length: f64,
    /// Hoisting speed, positive where it shortens the rope.
    pub speed: Schedule,
}

/// A one-sided contact of a point of a body with a plane: an end stop of a rail, a floor, or another body. The plane
/// of a body that is carried by another is fixed to the rail it runs on.
///
/// With p = side (coordinate - place) > 0 it pushes back with max(0, k p + c p').
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// The body that meets it.
    pub body: usize,
    /// Point of the body that meets it, from its origin.
    pub at: [f64; 3],
    /// Which coordinate of space, or of the track of a carried body: 0 X, 1 Y, 2 Z.
    pub axis: usize,
    /// Body that bears the plane, met at the height of `at`; `None`: it stands in space.
    pub against: Option<usize>,
    /// Coordinate of the plane, from the origin of the body that bears it.
    pub place: f64,
    /// 1 where the body comes from below `place`, -1 where from above.
    pub side: f64,
    /// k, > 0.
    pub stiffness: f64,
    /// c, >= 0.
    pub damping: f64,
}

impl Rope {
    /// Times at which the speed may turn.
    pub(crate) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.speed.breaks()
    }
}
