//! A point of a body that is carried by another body: its position, its motion, and its columns over the degrees of
//! freedom.

use nalgebra::{DVector, Matrix3, SVector, Vector3};

use super::kinematics::Kinematics;
use crate::Scene;
use crate::scene::dof::arm_rows;

type Rows = SVector<f64, 6>;

/// The track of a tree of pinned bodies on its carrier.
#[derive(Clone)]
pub(crate) struct Track {
    pub carrier: usize,
    /// Rotation whose columns are the axes of the rail frame in the axes of the carrier.
    pub turn: Matrix3<f64>,
    /// Origin of the root of the tree at x = 0, relative to the origin of the carrier and in its axes.
    pub origin: Vector3<f64>,
}

/// A point of a carried body.
pub(crate) struct CarriedPoint {
    pub body: usize,
    pub carrier: usize,
    turn: Matrix3<f64>,
    at: [f64; 3],
    /// Position relative to the origin of the carrier, in its axes, where the x of the body and all displacements are
    /// zero.
    origin: Vector3<f64>,
    columns: Vec<Column>,
}

/// Motion of a point per unit of one degree of freedom: the velocity in the axes of the carrier, then the rotation in
/// the rail frame.
struct Column {
    number: usize,
    /// Motion at x = 0 on a carrier without rotation.
    still: Rows,
    /// Change of the velocity per unit of x: the rotation of the carrier cross e.
    by_x: Vector3<f64>,
    /// Coefficient of the degree of freedom in the x of the body.
    x: f64,
}

/// Displacements and velocities of the carried body and its carrier at one instant.
pub(crate) struct Pose {
    own: [f64; 6],
    own_speed: [f64; 6],
    base: [f64; 6],
    base_speed: [f64; 6],
    /// theta_c cross e.
    tilt: Vector3<f64>,
}

impl CarriedPoint {
    pub fn new(kinematics: &Kinematics, track: &Track, body: usize, at: [f64; 3]) -> CarriedPoint {
        let [_, y, z] = hub(kinematics.scene, body, [0.0; 3]);
        let mut point = CarriedPoint {
            body,
            carrier: track.carrier,
            turn: track.turn,
            at,
            origin: track.origin + track.turn * (Vector3::from(at) + Vector3::new(0.0, y, z)),
            columns: Vec::new(),
        };
        let mut shares: Vec<(usize, [[f64; 6]; 2])> = Vec::new();
        for (which, b) in [body, track.carrier].into_iter().enumerate() {
            for (i, terms) in kinematics.terms(b).iter().enumerate() {
                for &(number, coefficient) in terms {
                    let known = shares.iter().position(|(known, _)| *known == number);
                    let at = known.unwrap_or_else(|| {
                        shares.push((number, [[0.0; 6]; 2]));
                        shares.len() - 1
                    });
                    shares[at].1[which][i] += coefficient;
                }
            }
        }
        let column = |&(number, [own, base]): &(usize, [[f64; 6]; 2])| Column {
            number,
            still: point.motion(0.0, &Vector3::zeros(), &own, &base),
            by_x: turned(&base).cross(&point.axis()),
            x: own[0],
        };
        point.columns = shares.iter().map(column).collect();
        point
    }

    fn axis(&self) -> Vector3<f64> {
        self.turn.column(0).into()
    }

    /// Velocity and rotation for the six velocities `own` of the body and `base` of the carrier, with the body at
    /// `x`.
    fn motion(&self, x: f64, tilt: &Vector3<f64>, own: &[f64; 6], base: &[f64; 6]) -> Rows {
        let arm = self.origin + self.axis() * x;
        let shift = self.turn * combine(self.at, own) + tilt * own[0] + combine(arm.into(), base);
        let spin = turned(own) + self.turn.transpose() * turned(base);
        Rows::new(shift[0], shift[1], shift[2], spin[0], spin[1], spin[2])
    }

    pub fn pose(
        &self,
        kinematics: &Kinematics,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> Pose {
        let (own, own_speed) = kinematics.motion(self.body, t, q, v);
        let (base, base_speed) = kinematics.motion(self.carrier, t, q, v);
        Pose {
            own,
            own_speed,
            base,
            base_speed,
            tilt: turned(&base).cross(&self.axis()),
        }
    }

    /// Number of degrees of freedom that move the point.
    pub fn count(&self) -> usize {
        self.columns.len()
    }

    /// Index in the scene of degree of freedom `i` of the point.
    pub fn number(&self, i: usize) -> usize {
        self.columns[i].number
    }

    /// Velocity in the axes of the carrier per unit of degree of freedom `i`.
    #[inline]
    pub fn shift_by(&self, i: usize, pose: &Pose) -> Vector3<f64> {
        let Column { still, by_x, x, .. } = &self.columns[i];
        still.fixed_rows::<3>(0) + by_x * pose.own[0] + pose.tilt * *x
    }

    /// Rotation in the rail frame per unit of degree of freedom `i`.
    pub fn turn_by(&self, i: usize) -> Vector3<f64> {
        self.columns[i].still.fixed_rows::<3>(3).into()
    }

    /// Velocity and rotation at the velocities of `pose`.
    pub fn speed(&self, pose: &Pose) -> Rows {
        self.motion(pose.own[0], &pose.tilt, &pose.own_speed, &pose.base_speed)
    }

    /// e + theta_c cross e: velocity of the point per unit velocity of the x of the body.
    pub fn along(&self, pose: &Pose) -> Vector3<f64> {
        self.axis() + pose.tilt
    }

    /// Acceleration of the point at q'' = 0.
    pub fn bias(&self, kinematics: &Kinematics, t: f64, pose: &Pose) -> Vector3<f64> {
        let prescribed = |b: usize| {
            let motion = kinematics.scene.bodies[kinematics.root(b)].motion.as_ref();
            motion.map_or(0.0, |profile| profile.at(t).a)
        };
        2.0 * pose.own_speed[0] * turned(&pose.base_speed).cross(&self.axis())
            + prescribed(self.body) * self.along(pose)
            + prescribed(self.carrier) * Vector3::x()
    }

    /// Displacement in the axes of the carrier from the position at which all displacements are zero.
    pub fn shift(&self, pose: &Pose) -> Vector3<f64> {
        let x = pose.own[0];
        let mut rest = pose.own;
        rest[0] = 0.0;
        self.motion(x, &Vector3::zeros(), &rest, &pose.base)
            .fixed_rows::<3>(0)
            + self.axis() * x
    }

    /// Position relative to the origin of the carrier where all displacements are zero.
    pub fn origin(&self) -> Vector3<f64> {
        self.origin
    }
}

fn turned(all: &[f64; 6]) -> Vector3<f64> {
    Vector3::new(all[3], all[4], all[5])
}

/// Displacement of a point at `at` of a body for the six displacements `by` of the body.
fn combine(at: [f64; 3], by: &[f64; 6]) -> Vector3<f64> {
    let rows = arm_rows(at);
    Vector3::from_fn(|k, _| rows[k].iter().zip(by).map(|(r, u)| r * u).sum::<f64>())
}

/// Position of the point `at` of body `b` at rest, relative to the origin of the root of its tree. The x component is
/// relative to the origin of the body.
pub(crate) fn hub(scene: &Scene, b: usize, at: [f64; 3]) -> [f64; 3] {
    let ([mut x, mut y, mut z], mut b) = (at, b);
    while let Some(pin) = &scene.bodies[b].pinned {
        (x, y, z, b) = (x + pin.at[0], y + pin.at[1], z + pin.at[2], pin.body);
    }
    [x, y, z]
}
