//! Ropes between bodies, and one-sided stops.

use crate::{Error, Scene, Schedule};

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

/// A one-sided contact of a point of a body with a plane: an end stop of a rail, a floor, or another body. The plane of a body
/// that rides on another is fixed to the rail it runs on.
///
/// With p = side (coordinate - place) > 0 it pushes back with max(0, k p + c p').
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// The body that meets it.
    pub body: usize,
    /// Point of the body that meets it, from its origin.
    pub at: [f64; 3],
    /// Which coordinate of space, or of the track of a body that rides: 0 X, 1 Y, 2 Z.
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

    pub(crate) fn check(&self, scene: &Scene) -> Result<(), Error> {
        for body in [self.from.body, self.to.body].into_iter().flatten() {
            exists(scene, body)?;
        }
        number("EA of a rope", "positive", self.stiffness, self.stiffness > 0.0)?;
        number("damping of a rope", "zero or above", self.damping, self.damping >= 0.0)?;
        number("length of a rope", "positive", self.length, self.length > 0.0)?;
        let turns = self.speed.turns().chain(self.breaks()).chain([scene.end]);
        let shortest = turns
            .filter(|t| (0.0..=scene.end).contains(t))
            .map(|t| self.length - self.speed.integral(t))
            .fold(self.length, f64::min);
        number("length of a rope that is hoisted", "positive until the end", shortest, shortest > 0.0)
    }
}

impl Stop {
    pub(crate) fn check(&self, scene: &Scene) -> Result<(), Error> {
        exists(scene, self.body)?;
        self.against.map_or(Ok(()), |bearer| exists(scene, bearer))?;
        number("stiffness of a stop", "positive", self.stiffness, self.stiffness > 0.0)?;
        number("damping of a stop", "zero or above", self.damping, self.damping >= 0.0)?;
        number("side of a stop", "1 or -1", self.side, self.side.abs() == 1.0)?;
        number("axis of a stop", "0, 1 or 2", self.axis as f64, self.axis < 3)
    }
}

fn exists(scene: &Scene, index: usize) -> Result<(), Error> {
    if index < scene.bodies.len() { Ok(()) } else { Err(Error::NoSuch { what: "body", index }) }
}

fn number(what: &'static str, wanted: &'static str, found: f64, holds: bool) -> Result<(), Error> {
    if holds && found.is_finite() { Ok(()) } else { Err(Error::Number { what, wanted, found }) }
}
