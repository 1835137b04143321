//! A point of a body, or of space: where it is, how it moves, and its row over the freedoms.
//!
//! The space frame has X along the rails (the rail coordinate), Y up from the unloaded rail, Z to the right. A body
//! on a track has its origin at Z = z and Y = y + radius - hub height, a pinned one at its pin, so that its wheels just touch at y = 0; a body
//! that rides on nothing is a point in space, X = x, Y = y, Z = z. Rotations are small: the rows are constant, but for
//! points of bodies that ride on bodies.

use nalgebra::{DVector, Vector3};

use crate::dense::dot;
use crate::kinematics::Terms;
use crate::scene::arm_rows;
use crate::spot::{Pose, Spot};
use crate::system::System;
use crate::{Moving, RopeEnd};

/// A point fixed to a body, or to space where there is no body.
pub(crate) struct Point {
    pub body: Option<usize>,
    /// From the body's origin; in space, the place itself.
    pub at: [f64; 3],
    /// Y and Z of the body's origin (of its carrier's, where it rides) where all displacements are zero.
    origin: [f64; 2],
    /// Its displacement over the freedoms, where it does not ride.
    rows: [Terms; 3],
    /// Where it rides.
    spot: Option<Box<Spot>>,
}

impl Point {
    /// A point in space.
    pub fn new(system: &System, end: &RopeEnd) -> Point {
        let spot = end.body.and_then(|b| system.rides.spot(system.scene, &system.kinematics, b, end.at));
        let origin = rest(system, spot.as_ref().map_or(end.body, |spot| Some(spot.carrier)));
        Point { body: end.body, at: end.at, origin, rows: rows(system, end), spot: spot.map(Box::new) }
    }

    /// A point in the frame of its body's track, which may ride.
    pub fn on_track(system: &System, end: &RopeEnd) -> Point {
        let origin = rest(system, end.body);
        Point { body: end.body, at: end.at, origin, rows: rows(system, end), spot: None }
    }

    fn pose<'s>(&'s self, system: &System, t: f64, q: &DVector<f64>) -> Option<(&'s Spot, Pose)> {
        self.spot.as_deref().map(|spot| (spot, spot.pose(system, t, q, q)))
    }

    /// Place in space at (t, q).
    pub fn position(&self, system: &System, t: f64, q: &DVector<f64>) -> [f64; 3] {
        let Some(b) = self.body else { return self.at };
        let moved: [f64; 3] = match self.pose(system, t, q) {
            Some((spot, pose)) => (spot.origin() + spot.shift(&pose)).into(),
            None => {
                let (displacement, _) = system.body(b, t, q, q);
                let moved = arm_rows(self.at).map(|row| dot(&row, &displacement));
                std::array::from_fn(|k| moved[k] + self.at[k])
            }
        };
        [moved[0], moved[1] + self.origin[0], moved[2] + self.origin[1]]
    }

    /// Place in space at (t, q), as a vector.
    pub fn place(&self, system: &System, t: f64, q: &DVector<f64>) -> Vector3<f64> {
        self.position(system, t, q).into()
    }

    /// Whether it rides on a body that moves: its rows change.
    pub fn rides(&self) -> bool {
        self.spot.is_some()
    }

    /// Its displacement by the freedoms, or a rate of it by theirs; it does not ride.
    pub fn rate(&self, of: &DVector<f64>) -> Vector3<f64> {
        let along = |terms: &Terms| terms.iter().map(|&(number, share)| share * of[number]).sum();
        Vector3::from(self.rows.each_ref().map(along))
    }

    /// Numbers of its X, Y and Z where nothing else moves it, and no wheel holds it.
    pub fn free_numbers(&self, system: &System) -> Option<[usize; 3]> {
        let own = self.body?;
        let root = |b: usize| system.kinematics.root(b);
        if system.wheels.iter().any(|wheel| root(wheel.body) == root(own)) {
            return None;
        }
        let [[(x, a)], [(y, b)], [(z, c)]] = self.rows.each_ref().map(|terms| terms.as_slice()) else {
            return None;
        };
        ([*a, *b, *c] == [1.0; 3]).then_some([*x, *y, *z])
    }

    /// Velocity by prescribed motions alone at (t, q), `travel` being those of t.
    pub fn drift(&self, system: &System, travel: &[Moving], t: f64, q: &DVector<f64>) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (b, body) in system.scene.bodies.iter().enumerate() {
            if body.motion.is_some() && travel[b].v != 0.0 {
                let by = self.by_travel(system, b, t, q);
                sum.iter_mut().zip(by).for_each(|(sum, by)| *sum += travel[b].v * by);
            }
        }
        sum
    }

    /// Adds `direction` times the rows of its displacement at (t, q) by the freedoms to `row`.
    pub fn add_row(
        &self,
        system: &System,
        (t, q): (f64, &DVector<f64>),
        direction: [f64; 3],
        row: &mut [f64],
    ) {
        if let Some((spot, pose)) = self.pose(system, t, q) {
            for i in 0..spot.count() {
                let column = spot.column(i, &pose);
                row[spot.number(i)] += dot(&direction, &column.as_slice()[..3]);
            }
            return;
        }
        for (terms, along) in self.rows.iter().zip(direction) {
            for &(number, coefficient) in terms {
                row[number] += along * coefficient;
            }
        }
    }

    /// What it moves per unit of the x of root `b` at (t, q).
    pub fn by_travel(&self, system: &System, b: usize, t: f64, q: &DVector<f64>) -> [f64; 3] {
        let root = |b: usize| system.kinematics.root(b);
        let Some(own) = self.body else { return [0.0; 3] };
        let mut sum = Vector3::zeros();
        match self.pose(system, t, q) {
            Some((spot, pose)) => {
                if root(own) == b {
                    sum += spot.along(&pose);
                }
                if root(spot.carrier) == b {
                    sum += Vector3::x();
                }
            }
            None if root(own) == b => sum += Vector3::x(),
            None => {}
        }
        sum.into()
    }
}

/// Y and Z of the origin of a body, in the frame of its track, where all displacements are zero.
fn rest(system: &System, body: Option<usize>) -> [f64; 2] {
    let (mut origin, mut next) = ([0.0; 2], body);
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
    origin
}

fn rows(system: &System, end: &RopeEnd) -> [Terms; 3] {
    let Some(b) = end.body else { return Default::default() };
    arm_rows(end.at).map(|component| system.kinematics.combine(b, &component))
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
