//! A point of a body that is carried by another body: where it is, how it moves, and its columns over the degrees of
//! degree of freedom.

use nalgebra::{DVector, Matrix3, SVector, Vector3};

use super::kinematics::Kinematics;
use crate::Scene;
use crate::scene::dof::arm_rows;

type Rows = SVector<f64, 6>;

/// Where the rails of a tree are on its carrier.
#[derive(Clone)]
pub(crate) struct Track {
    pub carrier: usize,
    /// Columns: the axes of the rail's frame in the carrier's axes.
    pub turn: Matrix3<f64>,
    /// Origin of the tree's root from the carrier's, in the carrier's axes, where its x is 0.
    pub origin: Vector3<f64>,
}

/// A point of a carried body.
pub(crate) struct CarriedPoint {
    pub body: usize,
    pub carrier: usize,
    turn: Matrix3<f64>,
    at: [f64; 3],
    /// From the carrier's origin, in the carrier's axes, where the body's x is 0 and nothing has moved.
    origin: Vector3<f64>,
    columns: Vec<Column>,
}

/// What a degree of freedom does to a point: velocity in the carrier's axes, then rotation in the rail's.
struct Column {
    number: usize,
    /// At x = 0 on a carrier that is not turned.
    still: Rows,
    /// More of the velocity by x: the carrier's rotation cross e.
    by_x: Vector3<f64>,
    /// Its coefficient in the body's x.
    x: f64,
}

/// Carried body and carrier at one instant.
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

    /// Velocity and rotation by the six of the body and of the carrier, with the body at `x`.
    fn motion(&self, x: f64, tilt: &Vector3<f64>, own: &[f64; 6], base: &[f64; 6]) -> Rows {
        let arm = self.origin + self.axis() * x;
        let shift = self.turn * combine(self.at, own) + tilt * own[0] + combine(arm.into(), base);
        let spin = turned(own) + self.turn.transpose() * turned(base);
        Rows::new(shift[0], shift[1], shift[2], spin[0], spin[1], spin[2])
    }

    pub fn pose(&self, kinematics: &Kinematics, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> Pose {
        let (own, own_speed) = kinematics.motion(self.body, t, q, v);
        let (base, base_speed) = kinematics.motion(self.carrier, t, q, v);
        Pose { own, own_speed, base, base_speed, tilt: turned(&base).cross(&self.axis()) }
    }

    /// Number of degrees of freedom it moves with.
    pub fn count(&self) -> usize {
        self.columns.len()
    }

    /// Number of degree of freedom `i` of those.
    pub fn number(&self, i: usize) -> usize {
        self.columns[i].number
    }

    /// Velocity in the carrier's axes, then rotation in the rail's, per unit of degree of freedom `i`.
    pub fn column(&self, i: usize, pose: &Pose) -> Rows {
        let Column { still, by_x, x, .. } = &self.columns[i];
        let more = by_x * pose.own[0] + pose.tilt * *x;
        still + Rows::new(more[0], more[1], more[2], 0.0, 0.0, 0.0)
    }

    /// The same for the speeds of now.
    pub fn speed(&self, pose: &Pose) -> Rows {
        self.motion(pose.own[0], &pose.tilt, &pose.own_speed, &pose.base_speed)
    }

    /// e + theta_c cross e: its velocity per unit of the body's x.
    pub fn along(&self, pose: &Pose) -> Vector3<f64> {
        self.axis() + pose.tilt
    }

    /// Acceleration at q'' = 0.
    pub fn bias(&self, kinematics: &Kinematics, t: f64, pose: &Pose) -> Vector3<f64> {
        let prescribed = |b: usize| {
            let motion = kinematics.scene.bodies[kinematics.root(b)].motion.as_ref();
            motion.map_or(0.0, |profile| profile.at(t).a)
        };
        2.0 * pose.own_speed[0] * turned(&pose.base_speed).cross(&self.axis())
            + prescribed(self.body) * self.along(pose)
            + prescribed(self.carrier) * Vector3::x()
    }

    /// Displacement in the carrier's axes from where all displacements are zero.
    pub fn shift(&self, pose: &Pose) -> Vector3<f64> {
        let x = pose.own[0];
        let mut rest = pose.own;
        rest[0] = 0.0;
        self.motion(x, &Vector3::zeros(), &rest, &pose.base).fixed_rows::<3>(0) + self.axis() * x
    }

    /// Place where all displacements are zero, from the carrier's origin.
    pub fn origin(&self) -> Vector3<f64> {
        self.origin
    }
}

fn turned(all: &[f64; 6]) -> Vector3<f64> {
    Vector3::new(all[3], all[4], all[5])
}

/// Displacement of a point at `at` of a body by its six.
fn combine(at: [f64; 3], by: &[f64; 6]) -> Vector3<f64> {
    let rows = arm_rows(at);
    Vector3::from_fn(|k, _| rows[k].iter().zip(by).map(|(r, u)| r * u).sum::<f64>())
}

/// A point at `at` of body `b` from the origin of the tree's root, at rest; its x is that of the body.
pub(crate) fn hub(scene: &Scene, b: usize, at: [f64; 3]) -> [f64; 3] {
    let ([mut x, mut y, mut z], mut b) = (at, b);
    while let Some(pin) = &scene.bodies[b].pinned {
        (x, y, z, b) = (x + pin.at[0], y + pin.at[1], z + pin.at[2], pin.body);
    }
    [x, y, z]
}
