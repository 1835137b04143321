//! Frames of parts and markers, and what is measured between them.

use crate::functions::atan2;
use crate::space::{
    IDENTITY, Matrix, Vector, add, apply, column, cross, dot, matrix, norm, product, resolve, subtract,
    vector,
};
use crate::{Pose, Scalar};

/// A frame in ground coordinates and how it moves.
#[derive(Clone, Debug)]
pub(crate) struct Frame<T> {
    pub origin: Vector<T>,
    pub axes: Matrix<T>,
    pub velocity: Vector<T>,
    /// d(axes)/dt
    pub rate: Matrix<T>,
    pub spin: Vector<T>,
}

/// What DX, VX and the like measure, with the axis where there is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Measure {
    Displacement(usize),
    Distance,
    Velocity(usize),
    Speed,
    /// Speed along the line of sight.
    Recession,
    Spin(usize),
    SpinSpeed,
    /// AX, AY, AZ.
    Angle(usize),
}

impl<T: Scalar> Frame<T> {
    /// Ground at its origin.
    pub fn ground() -> Frame<T> {
        Frame::of(&Pose::at(nalgebra::Vector3::zeros(), nalgebra::Matrix3::identity()))
    }

    pub fn of(pose: &Pose) -> Frame<T> {
        let rows =
            |m: &nalgebra::Matrix3<f64>| matrix(std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])));
        let three = |v: &nalgebra::Vector3<f64>| vector([v.x, v.y, v.z]);
        Frame {
            origin: three(&pose.origin),
            axes: rows(&pose.rotation),
            velocity: three(&pose.velocity),
            rate: rows(&pose.rate),
            spin: three(&pose.spin),
        }
    }

    /// A frame at rest.
    pub fn at_rest(origin: Vector<T>, axes: Matrix<T>) -> Frame<T> {
        let zero = || vector([0.0; 3]);
        Frame { origin, axes, velocity: zero(), rate: matrix([[0.0; 3]; 3]), spin: zero() }
    }

    /// The frame of a marker on this part.
    pub fn marker(&self, position: Vector<f64>, axes: Matrix<f64>) -> Frame<T> {
        let s = vector(position);
        let turned = |m: &Matrix<T>| if axes == IDENTITY { m.clone() } else { product(m, &matrix(axes)) };
        Frame {
            origin: add(&self.origin, &apply(&self.axes, &s)),
            axes: turned(&self.axes),
            velocity: add(&self.velocity, &apply(&self.rate, &s)),
            rate: turned(&self.rate),
            spin: self.spin.clone(),
        }
    }

    /// A frame parallel to this part at a place in ground coordinates, moving with the part.
    pub fn carried(&self, place: &Vector<T>) -> Frame<T> {
        let arm = subtract(place, &self.origin);
        let velocity = add(&self.velocity, &cross(&self.spin, &arm));
        Frame { origin: place.clone(), velocity, ..self.clone() }
    }
}

/// A measure of `i` from `j`, resolved in `k`, with velocities as seen in `l`.
///
/// d = p_i - p_j. In `k`: A_k^T d. Velocities are those of d as it is seen in `l`, d' + A_l (A_l')^T d, resolved
/// in `k`; where `k` is `l`, this is the rate of A_k^T d itself.
pub(crate) fn measure<T: Scalar>(what: Measure, [i, j, k, l]: [&Frame<T>; 4], same: bool) -> T {
    let distance = || subtract(&i.origin, &j.origin);
    let seen = || {
        let relative = subtract(&i.velocity, &j.velocity);
        add(&relative, &apply(&l.axes, &resolve(&l.rate, &distance())))
    };
    match what {
        Measure::Displacement(axis) => dot(&column(&k.axes, axis), &distance()),
        Measure::Distance => norm(&distance()),
        Measure::Velocity(axis) if same => {
            let relative = subtract(&i.velocity, &j.velocity);
            dot(&column(&k.axes, axis), &relative).plus(&dot(&column(&k.rate, axis), &distance()))
        }
        Measure::Velocity(axis) => dot(&column(&k.axes, axis), &seen()),
        Measure::Speed => norm(&seen()),
        Measure::Recession => {
            let d = distance();
            let length = norm(&d);
            if length.value() > 0.0 { dot(&d, &seen()).over(&length) } else { T::constant(0.0) }
        }
        Measure::Spin(axis) => dot(&column(&k.axes, axis), &subtract(&i.spin, &j.spin)),
        Measure::SpinSpeed => norm(&subtract(&i.spin, &j.spin)),
        Measure::Angle(axis) => angle(axis, i, j),
    }
}

/// The angle of `i` about an axis of `j`, by the projection of one of its axes: from -pi to pi.
pub(crate) fn angle<T: Scalar>(axis: usize, i: &Frame<T>, j: &Frame<T>) -> T {
    let along = |a: usize, b: usize| dot(&column(&i.axes, a), &column(&j.axes, b));
    match axis {
        0 => atan2(&along(2, 1).negated(), &along(2, 2)),
        1 => atan2(&along(2, 0), &along(2, 2)),
        _ => atan2(&along(1, 0).negated(), &along(1, 1)),
    }
}
