//! A point of a body, or of space: where it is, how it moves, and its row over the freedoms.
//!
//! The space frame has X along the rails (the rail coordinate), Y up from the unloaded rail, Z to the right. A body
//! on a track has its origin at Z = z and Y = y + radius - hub height, a pinned one at its pin, so that its wheels just touch at y = 0; a body
//! that rides on nothing is a point in space, X = x, Y = y, Z = z. Rotations are small: the rows are constant.

use nalgebra::DVector;

use crate::dense::dot;
use crate::scene::arm_rows;
use crate::system::System;
use crate::{Moving, RopeEnd};

/// A point fixed to a body, or to space where there is no body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub body: Option<usize>,
    /// From the body's origin; in space, the place itself.
    pub at: [f64; 3],
    /// Y and Z of the body's origin where all displacements are zero.
    origin: [f64; 2],
}

impl Point {
    pub fn new(system: &System, end: &RopeEnd) -> Point {
        let (mut origin, mut next) = ([0.0; 2], end.body);
        while let Some(b) = next {
            let pin = system.scene.bodies[b].pinned.as_ref();
            match pin {
                Some(pin) => origin = [origin[0] + pin.at[1], origin[1] + pin.at[2]],
                None => {
                    let wheel = system.wheels.iter().find(|wheel| system.kinematics.root(wheel.body) == b);
                    origin[0] += wheel.map_or(0.0, |wheel| {
                        let below = height_over(system, wheel.body, b) + wheel.hub[1];
                        system.scene.wheels[wheel.kind].radius - below
                    });
                }
            }
            next = pin.map(|pin| pin.to);
        }
        Point { body: end.body, at: end.at, origin }
    }

    /// Place in space at (t, q).
    pub fn position(&self, system: &System, t: f64, q: &DVector<f64>) -> [f64; 3] {
        let Some(b) = self.body else { return self.at };
        let (displacement, _) = system.body(b, t, q, q);
        let moved = arm_rows(self.at).map(|row| dot(&row, &displacement));
        [
            moved[0] + self.at[0],
            moved[1] + self.at[1] + self.origin[0],
            moved[2] + self.at[2] + self.origin[1],
        ]
    }

    /// Velocity by prescribed motions alone.
    pub fn drift(&self, system: &System, travel: &[Moving]) -> [f64; 3] {
        match self
            .body
            .map(|b| system.kinematics.root(b))
            .filter(|&b| system.scene.bodies[b].motion.is_some())
        {
            Some(b) => [travel[b].v, 0.0, 0.0],
            None => [0.0; 3],
        }
    }

    /// Adds `direction` times the rows of its displacement by the freedoms to `row`.
    pub fn add_row(&self, system: &System, direction: [f64; 3], row: &mut [f64]) {
        let Some(b) = self.body else { return };
        for (component, along) in arm_rows(self.at).iter().zip(direction) {
            for (number, coefficient) in system.kinematics.combine(b, component) {
                row[number] += along * coefficient;
            }
        }
    }

    /// What it moves along `direction` per unit of the x of body `b`.
    pub fn by_travel(&self, system: &System, b: usize, direction: [f64; 3]) -> f64 {
        if self.body.map(|own| system.kinematics.root(own)) == Some(b) { direction[0] } else { 0.0 }
    }
}

/// Height of the origin of body `b` over that of the body `root` that it is pinned to.
fn height_over(system: &System, b: usize, root: usize) -> f64 {
    let (mut height, mut at) = (0.0, b);
    while let Some(pin) = system.scene.bodies[at].pinned.as_ref().filter(|_| at != root) {
        height += pin.at[1];
        at = pin.to;
    }
    height
}
