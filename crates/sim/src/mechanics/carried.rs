//! Bodies on structures that are carried by other bodies, for example a trolley on the girders of a bridge.
//!
//! The degrees of freedom of a carried body are relative to its track. Let r be the position of a point of the
//! carried body relative to the origin of the carrier, e the direction of its rail, and R the rotation from the rail
//! frame to the axes of the carrier. Then
//!
//! p' = u_c' + theta_c' cross r(x) + R (u' + theta' cross at) + x' theta_c cross e = J q' + prescribed parts,
//! p'' = J q'' + 2 x' theta_c' cross e + X'' (e + theta_c cross e) + X_c''.
//!
//! The forces between the wheels of the trolley and their rails are internal to carrier and trolley, so their rows
//! have entries for the relative degrees of freedom alone. The carrier is loaded through J^T M J and J^T M g.

use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};

use super::carried_point::{CarriedPoint, Track, hub};
use super::kinematics::Kinematics;
use crate::{CarriedRail, Error, Foundation};

/// Tolerance on the directions and lengths of the rails of one track.
const SLACK: f64 = 1e-9;

/// All bodies that are carried by other bodies.
pub(crate) struct CarriedBodies {
    /// Track of the tree of pinned bodies that each body belongs to; `None` where the body is not carried.
    tracks: Vec<Option<Track>>,
    /// Centres of mass of the carried bodies, with the part of J^T M J by the rotations, which is constant: its lower triangle,
    /// row by row.
    centres: Vec<(CarriedPoint, Vec<f64>)>,
}

impl CarriedBodies {
    /// Finds the carried bodies of a scene from their contacts.
    ///
    /// # Errors
    /// [`Error::Carried`]: a tree with contacts on several carriers or on rails of different directions, a tree that
    /// carries its own carrier, a load on a carried body, or a structure on a carried body.
    pub fn new(foundations: &[Foundation], kinematics: &Kinematics) -> Result<Self, Error> {
        let scene = kinematics.scene;
        let count = scene.bodies.len();
        let root = |b: usize| kinematics.root(b);
        let mut tracks: Vec<Option<Track>> = vec![None; count];
        let mut grounded = vec![false; count];
        for contact in &scene.contacts {
            let tree = root(contact.body);
            let refused = Error::Carried { body: tree };
            let Some(mount) = &foundations[contact.structure].carrier else {
                grounded[tree] = true;
                continue;
            };
            let rail = mount.rails.get(contact.rail).ok_or(Error::NoSuch {
                what: "rail",
                index: contact.rail,
            })?;
            let turn = frame(rail).ok_or(refused.clone())?;
            let [_, y, z] = hub(scene, contact.body, contact.at);
            let drop = Vector3::new(0.0, y - scene.wheels[contact.wheel].radius, z);
            let track = Track {
                carrier: mount.body,
                turn,
                origin: Vector3::from(rail.origin) - turn * drop,
            };
            match &tracks[tree] {
                None => tracks[tree] = Some(track),
                Some(first)
                    if first.carrier == track.carrier && (first.turn - turn).amax() < SLACK => {}
                Some(_) => return Err(refused),
            }
        }
        for mount in foundations
            .iter()
            .filter_map(|foundation| foundation.carrier.as_ref())
        {
            if tracks[root(mount.body)].is_some() {
                return Err(Error::Carried { body: mount.body });
            }
        }
        let mut centres = Vec::new();
        for (b, body) in scene.bodies.iter().enumerate() {
            let Some(track) = &tracks[root(b)] else {
                continue;
            };
            let loaded = scene.actuators.loads.iter().any(|load| load.body == b);
            if grounded[root(b)] || root(track.carrier) == root(b) || loaded {
                return Err(Error::Carried { body: b });
            }
            let point = CarriedPoint::new(kinematics, track, b, body.cg);
            let turns = turning_inertia(&point, body);
            centres.push((point, turns));
        }
        tracks = (0..count).map(|b| tracks[root(b)].clone()).collect();
        Ok(CarriedBodies { tracks, centres })
    }

    /// Whether no body is carried by another.
    pub fn is_empty(&self) -> bool {
        self.centres.is_empty()
    }

    /// Whether body `b` is carried by another body.
    pub fn has(&self, b: usize) -> bool {
        self.tracks[b].is_some()
    }

    /// The point `at` of body `b`; `None` where the body is not carried.
    pub fn point(&self, kinematics: &Kinematics, b: usize, at: [f64; 3]) -> Option<CarriedPoint> {
        self.tracks[b]
            .as_ref()
            .map(|track| CarriedPoint::new(kinematics, track, b, at))
    }

    /// Adds the contribution of the carried bodies at (t, q, v): J^T M J to `mass` and -J^T M (bias + g) to `load`. The part
    /// of J for the translations changes with the motion; that for the rotations is constant. `columns` is scratch memory.
    pub fn add(
        &self,
        kinematics: &Kinematics,
        (t, q, v): (f64, &DVector<f64>, &DVector<f64>),
        (mass, load): (&mut DMatrix<f64>, &mut DVector<f64>),
        columns: &mut Vec<Vector3<f64>>,
    ) {
        let size = mass.nrows();
        let mass = mass.as_mut_slice();
        for (point, turns) in &self.centres {
            let pose = point.pose(kinematics, t, q, v);
            let body = &kinematics.scene.bodies[point.body];
            let force = (point.bias(kinematics, t, &pose)
                + Vector3::y() * kinematics.scene.gravity)
                * body.mass;
            columns.clear();
            columns.extend((0..point.count()).map(|i| point.shift_by(i, &pose)));
            for (i, column) in columns.iter().enumerate() {
                let row = point.number(i);
                load[row] -= column.dot(&force);
                let weighted = column * body.mass;
                let turns = &turns[i * (i + 1) / 2..];
                for ((j, other), turn) in columns[..=i].iter().enumerate().zip(turns) {
                    let sum = other[0] * weighted[0]
                        + other[1] * weighted[1]
                        + other[2] * weighted[2]
                        + turn;
                    let number = point.number(j);
                    mass[number * size + row] += sum;
                    if i != j {
                        mass[row * size + number] += sum;
                    }
                }
            }
        }
    }

    /// Adds to `load` the weights of the carried bodies at (t, q): -J^T M g.
    pub fn weigh(
        &self,
        kinematics: &Kinematics,
        (t, q): (f64, &DVector<f64>),
        load: &mut DVector<f64>,
    ) {
        for (point, _) in &self.centres {
            let pose = point.pose(kinematics, t, q, q);
            let weight = kinematics.scene.bodies[point.body].mass * kinematics.scene.gravity;
            for i in 0..point.count() {
                load[point.number(i)] -= weight * point.shift_by(i, &pose)[1];
            }
        }
    }

    /// Kinetic energy and gravitational potential energy of the carried bodies at (t, q, v).
    pub fn energy(
        &self,
        kinematics: &Kinematics,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (point, _) in &self.centres {
            let pose = point.pose(kinematics, t, q, v);
            let body = &kinematics.scene.bodies[point.body];
            let speed = point.speed(&pose);
            sum[0] += 0.5 * speed.component_mul(&inertias(body)).dot(&speed);
            sum[1] += body.mass * kinematics.scene.gravity * point.shift(&pose)[1];
        }
        sum
    }

    /// Force along its track that the carried bodies require to move root `b` as its x is prescribed, at the
    /// accelerations `a`.
    pub fn drive(
        &self,
        kinematics: &Kinematics,
        [q, v, a]: [&DVector<f64>; 3],
        t: f64,
        b: usize,
    ) -> f64 {
        let mut sum = 0.0;
        for (point, _) in &self.centres {
            let roots = [point.body, point.carrier].map(|body| kinematics.root(body));
            if !roots.contains(&b) {
                continue;
            }
            let pose = point.pose(kinematics, t, q, v);
            let mut acceleration =
                point.bias(kinematics, t, &pose) + Vector3::y() * kinematics.scene.gravity;
            for i in 0..point.count() {
                acceleration += point.shift_by(i, &pose) * a[point.number(i)];
            }
            let along = if roots[0] == b {
                acceleration.dot(&point.along(&pose))
            } else {
                acceleration[0]
            };
            sum += kinematics.scene.bodies[point.body].mass * along;
        }
        sum
    }
}

/// Lower triangle, row by row, of the part of J^T M J of `point`, the centre of mass of `body`, by the rotations.
fn turning_inertia(point: &CarriedPoint, body: &crate::Body) -> Vec<f64> {
    let inertia = Vector3::from(body.inertia);
    let turn = |i: usize| point.turn_by(i);
    (0..point.count())
        .flat_map(|i| (0..=i).map(move |j| turn(i).component_mul(&inertia).dot(&turn(j))))
        .collect()
}

fn inertias(body: &crate::Body) -> SVector<f64, 6> {
    let [roll, yaw, pitch] = body.inertia;
    SVector::from([body.mass, body.mass, body.mass, roll, yaw, pitch])
}

/// Axes of a rail frame as the columns of a matrix; `None` where the rail is not level or its direction is not of
/// unit length.
fn frame(rail: &CarriedRail) -> Option<Matrix3<f64>> {
    let x = Vector3::from(rail.along);
    let level = x[1].abs() < SLACK && (x.norm() - 1.0).abs() < SLACK;
    level.then(|| Matrix3::from_columns(&[x, Vector3::y(), x.cross(&Vector3::y())]))
}
