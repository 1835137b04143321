//! Frames of parts and markers, and the kinematic functions between them.

use super::state::Pose;
use super::vector::{
    IDENTITY, Matrix, Vector, add, apply, column, cross, dot, matrix, norm, product, resolve,
    subtract, vector,
};
use crate::Scalar;
use crate::expression::functions::atan2;

/// A frame in ground coordinates, with its velocities.
#[derive(Clone, Debug)]
pub(crate) struct Frame<T> {
    pub origin: Vector<T>,
    pub axes: Matrix<T>,
    pub velocity: Vector<T>,
    /// Time derivative of `axes`.
    pub rate: Matrix<T>,
    pub spin: Vector<T>,
}

/// The kinematic functions DX to WM and AX to AZ. Components carry their axis, 0 to 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Measure {
    /// DX, DY, DZ.
    Displacement(usize),
    /// DM.
    Distance,
    /// VX, VY, VZ.
    Velocity(usize),
    /// VM.
    Speed,
    /// VR: the speed along the line of sight.
    RadialSpeed,
    /// WX, WY, WZ.
    AngularVelocity(usize),
    /// WM.
    AngularSpeed,
    /// AX, AY, AZ.
    Angle(usize),
}

impl<T: Scalar> Frame<T> {
    /// The frame of ground.
    pub fn ground() -> Frame<T> {
        Frame::of(&Pose::at_rest(
            nalgebra::Vector3::zeros(),
            nalgebra::Matrix3::identity(),
        ))
    }

    /// The frame of a part in a pose.
    pub fn of(pose: &Pose) -> Frame<T> {
        let rows = |m: &nalgebra::Matrix3<f64>| {
            matrix(std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])))
        };
        let three = |v: &nalgebra::Vector3<f64>| vector([v.x, v.y, v.z]);
        Frame {
            origin: three(&pose.origin),
            axes: rows(&pose.rotation),
            velocity: three(&pose.velocity),
            rate: rows(&pose.rate),
            spin: three(&pose.angular_velocity),
        }
    }

    /// A frame at rest.
    pub fn at_rest(origin: Vector<T>, axes: Matrix<T>) -> Frame<T> {
        let zero = || vector([0.0; 3]);
        Frame {
            origin,
            axes,
            velocity: zero(),
            rate: matrix([[0.0; 3]; 3]),
            spin: zero(),
        }
    }

    /// The frame of a marker, given its position and axes in coordinates of this part.
    pub fn marker(&self, position: Vector<f64>, axes: Matrix<f64>) -> Frame<T> {
        let s = vector(position);
        let rotated = |m: &Matrix<T>| {
            if axes == IDENTITY {
                m.clone()
            } else {
                product(m, &matrix(axes))
            }
        };
        Frame {
            origin: add(&self.origin, &apply(&self.axes, &s)),
            axes: rotated(&self.axes),
            velocity: add(&self.velocity, &apply(&self.rate, &s)),
            rate: rotated(&self.rate),
            spin: self.spin.clone(),
        }
    }

    /// The frame parallel to this part at a point given in ground coordinates, moving with the part.
    pub fn parallel_at(&self, place: &Vector<T>) -> Frame<T> {
        let arm = subtract(place, &self.origin);
        let velocity = add(&self.velocity, &cross(&self.spin, &arm));
        Frame {
            origin: place.clone(),
            velocity,
            ..self.clone()
        }
    }
}

/// The value of a kinematic function of marker `i` relative to `j`, resolved in the axes of `k`, with
/// velocities observed in the frame `l`. `same` says that `k` and `l` are one marker.
///
/// With d = p_i - p_j the displacement is A_k^T d. The velocity is the rate of d as observed in `l`, d' + A_l
/// (A_l')^T d, resolved in `k`. Where `k` and `l` are one marker, it is computed as d/dt (A_k^T d), which is
/// the same for orthogonal axes and exact for axes of small rotations.
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
        Measure::RadialSpeed => {
            let d = distance();
            let length = norm(&d);
            if length.value() > 0.0 {
                dot(&d, &seen()).over(&length)
            } else {
                T::constant(0.0)
            }
        }
        Measure::AngularVelocity(axis) => dot(&column(&k.axes, axis), &subtract(&i.spin, &j.spin)),
        Measure::AngularSpeed => norm(&subtract(&i.spin, &j.spin)),
        Measure::Angle(axis) => angle(axis, i, j),
    }
}

/// The angle of `i` about an axis of `j`, from -pi to pi, by the projection of one axis of `i` on a plane of
/// `j`.
pub(crate) fn angle<T: Scalar>(axis: usize, i: &Frame<T>, j: &Frame<T>) -> T {
    let along = |a: usize, b: usize| dot(&column(&i.axes, a), &column(&j.axes, b));
    match axis {
        0 => atan2(&along(2, 1).negated(), &along(2, 2)),
        1 => atan2(&along(2, 0), &along(2, 2)),
        _ => atan2(&along(1, 0).negated(), &along(1, 1)),
    }
}
