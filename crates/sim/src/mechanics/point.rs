//! A point of a body or of space: its position, its motion, and its row over the degrees of freedom.
//!
//! The space frame has X along the rails (the rail coordinate), Y upwards from the unloaded rail and Z to the right.
//! A body on a track has its origin at Z = z and Y = y + radius - hub height, so that its wheels just touch the rail
//! at y = 0. The origin of a pinned body is at its pin. A body without wheels is a point in space with X = x, Y = y,
//! Z = z. Rotations are small, so the rows are constant except for points of carried bodies.

use nalgebra::{DVector, Vector3};

use super::assembly::Mechanics;
use super::carried_point::{CarriedPoint, Pose};
use super::kinematics::Terms;
use crate::numerics::dense::dot;
use crate::scene::dof::arm_rows;
use crate::{RopeEnd, Travel};

/// A point fixed to a body, or to space where `body` is `None`.
pub(crate) struct Point {
    pub body: Option<usize>,
    /// Position relative to the origin of the body; for a point in space, the position itself.
    pub at: [f64; 3],
    /// Y and Z of the origin of the body (of the carrier, for a carried body) where all displacements are zero.
    origin: [f64; 2],
    /// Its displacement as terms in the degrees of freedom, where the body is not carried.
    rows: [Terms; 3],
    /// Kinematics of the point where the body is carried by another body.
    carried: Option<Box<CarriedPoint>>,
}

impl Point {
    /// A point whose motion is expressed in the space frame.
    pub fn new(mechanics: &Mechanics, end: &RopeEnd) -> Point {
        let carried = end
            .body
            .and_then(|b| mechanics.carried.point(&mechanics.kinematics, b, end.at));
        let origin = rest(
            mechanics,
            carried
                .as_ref()
                .map_or(end.body, |point| Some(point.carrier)),
        );
        Point {
            body: end.body,
            at: end.at,
            origin,
            rows: rows(mechanics, end),
            carried: carried.map(Box::new),
        }
    }

    /// A point whose motion is expressed in the frame of the track of its body, even where that body is carried.
    pub fn on_track(mechanics: &Mechanics, end: &RopeEnd) -> Point {
        let origin = rest(mechanics, end.body);
        Point {
            body: end.body,
            at: end.at,
            origin,
            rows: rows(mechanics, end),
            carried: None,
        }
    }

    fn pose<'s>(
        &'s self,
        mechanics: &Mechanics,
        t: f64,
        q: &DVector<f64>,
    ) -> Option<(&'s CarriedPoint, Pose)> {
        self.carried
            .as_deref()
            .map(|point| (point, point.pose(&mechanics.kinematics, t, q, q)))
    }

    /// Position in space at (t, q).
    pub fn position(&self, mechanics: &Mechanics, t: f64, q: &DVector<f64>) -> [f64; 3] {
        let Some(b) = self.body else { return self.at };
        let moved: [f64; 3] = match self.pose(mechanics, t, q) {
            Some((point, pose)) => (point.origin() + point.shift(&pose)).into(),
            None => {
                let (displacement, _) = mechanics.kinematics.motion(b, t, q, q);
                let moved = arm_rows(self.at).map(|row| dot(&row, &displacement));
                std::array::from_fn(|k| moved[k] + self.at[k])
            }
        };
        [
            moved[0],
            moved[1] + self.origin[0],
            moved[2] + self.origin[1],
        ]
    }

    /// Position in space at (t, q), as a vector.
    pub fn place(&self, mechanics: &Mechanics, t: f64, q: &DVector<f64>) -> Vector3<f64> {
        self.position(mechanics, t, q).into()
    }

    /// Whether the body of the point is carried by another body, so that its rows change with the motion.
    pub fn is_carried(&self) -> bool {
        self.carried.is_some()
    }

    /// Displacement for the degrees of freedom `of`, or velocity for their rates. The body must not be carried.
    pub fn rate(&self, of: &DVector<f64>) -> Vector3<f64> {
        let along = |terms: &Terms| {
            terms
                .iter()
                .map(|&(number, share)| share * of[number])
                .sum()
        };
        Vector3::from(self.rows.each_ref().map(along))
    }

    /// Indices of the degrees of freedom of X, Y and Z, where each is moved by exactly one degree of freedom and no
    /// wheel is on the tree of the body; `None` otherwise.
    pub fn free_numbers(&self, mechanics: &Mechanics) -> Option<[usize; 3]> {
        let own = self.body?;
        let root = |b: usize| mechanics.kinematics.root(b);
        if mechanics
            .wheels
            .iter()
            .any(|wheel| root(wheel.body) == root(own))
        {
            return None;
        }
        let [[(x, a)], [(y, b)], [(z, c)]] = self.rows.each_ref().map(|terms| terms.as_slice())
        else {
            return None;
        };
        ([*a, *b, *c] == [1.0; 3]).then_some([*x, *y, *z])
    }

    /// Velocity due to the prescribed motions alone at (t, q); `travel` are the prescribed motions at t.
    pub fn drift(
        &self,
        mechanics: &Mechanics,
        travel: &[Travel],
        t: f64,
        q: &DVector<f64>,
    ) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (b, body) in mechanics.scene.bodies.iter().enumerate() {
            if body.motion.is_some() && travel[b].v != 0.0 {
                let by = self.by_travel(mechanics, b, t, q);
                sum.iter_mut()
                    .zip(by)
                    .for_each(|(sum, by)| *sum += travel[b].v * by);
            }
        }
        sum
    }

    /// Adds `direction` times the rows of the displacement of the point at (t, q) to `row`.
    pub fn add_row(
        &self,
        mechanics: &Mechanics,
        (t, q): (f64, &DVector<f64>),
        direction: [f64; 3],
        row: &mut [f64],
    ) {
        if let Some((point, pose)) = self.pose(mechanics, t, q) {
            for i in 0..point.count() {
                row[point.number(i)] += scalar(direction, point.shift_by(i, &pose).into());
            }
            return;
        }
        for (terms, along) in self.rows.iter().zip(direction) {
            for &(number, coefficient) in terms {
                row[number] += along * coefficient;
            }
        }
    }

    /// Displacement of the point per unit of the x of root `b` at (t, q).
    pub fn by_travel(&self, mechanics: &Mechanics, b: usize, t: f64, q: &DVector<f64>) -> [f64; 3] {
        let root = |b: usize| mechanics.kinematics.root(b);
        let Some(own) = self.body else {
            return [0.0; 3];
        };
        let mut sum = Vector3::zeros();
        match self.pose(mechanics, t, q) {
            Some((point, pose)) => {
                if root(own) == b {
                    sum += point.along(&pose);
                }
                if root(point.carrier) == b {
                    sum += Vector3::x();
                }
            }
            None if root(own) == b => sum += Vector3::x(),
            None => {}
        }
        sum.into()
    }
}

/// Y and Z of the origin of a body in the frame of its track, where all displacements are zero.
fn rest(mechanics: &Mechanics, body: Option<usize>) -> [f64; 2] {
    let (mut origin, mut next) = ([0.0; 2], body);
    while let Some(b) = next {
        let pin = mechanics.scene.bodies[b].pinned.as_ref();
        match pin {
            Some(pin) => origin = [origin[0] + pin.at[1], origin[1] + pin.at[2]],
            None => {
                let wheel = mechanics
                    .wheels
                    .iter()
                    .find(|wheel| mechanics.kinematics.root(wheel.body) == b);
                origin[0] += wheel.map_or(0.0, |wheel| {
                    let below = height_over(mechanics, wheel.body, b) + wheel.hub[1];
                    mechanics.scene.wheels[wheel.kind].radius - below
                });
            }
        }
        next = pin.map(|pin| pin.body);
    }
    origin
}

fn rows(mechanics: &Mechanics, end: &RopeEnd) -> [Terms; 3] {
    let Some(b) = end.body else {
        return Default::default();
    };
    arm_rows(end.at).map(|component| mechanics.kinematics.combine(b, &component))
}

/// Height of the origin of body `b` above the origin of `root`, the body that it is pinned to directly or through
/// others.
fn height_over(mechanics: &Mechanics, b: usize, root: usize) -> f64 {
    let (mut height, mut at) = (0.0, b);
    while let Some(pin) = mechanics.scene.bodies[at]
        .pinned
        .as_ref()
        .filter(|_| at != root)
    {
        height += pin.at[1];
        at = pin.body;
    }
    height
}

/// Two points that are joined by an element. Without `from`, the element joins `to` and a plane in space.
pub(crate) struct PointPair {
    pub from: Option<Point>,
    pub to: Point,
    /// Whether the direction of the element rotates as the points move transversely.
    pub swings: bool,
}

impl PointPair {
    /// Whether one of the points is on body `b`.
    pub fn is_on(&self, b: usize) -> bool {
        self.to.body == Some(b) || self.from.as_ref().is_some_and(|from| from.body == Some(b))
    }

    /// Adds `direction` times the rows of the vector from `from` to `to` at (t, q) to `row`.
    pub fn add_row(
        &self,
        mechanics: &Mechanics,
        at: (f64, &DVector<f64>),
        direction: [f64; 3],
        row: &mut [f64],
    ) {
        self.to.add_row(mechanics, at, direction, row);
        if let Some(from) = &self.from {
            from.add_row(mechanics, at, direction.map(|d| -d), row);
        }
    }

    /// Rate of the distance along `direction` per unit velocity of the x of root body `b`, at (t, q).
    pub fn by_travel(
        &self,
        mechanics: &Mechanics,
        b: usize,
        (t, q): (f64, &DVector<f64>),
        direction: [f64; 3],
    ) -> f64 {
        let by = |point: &Point| scalar(direction, point.by_travel(mechanics, b, t, q));
        by(&self.to) - self.from.as_ref().map_or(0.0, by)
    }
}

/// Difference `a` - `b`.
pub(crate) fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// Scalar product of two vectors.
pub(crate) fn scalar(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
