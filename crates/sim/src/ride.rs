//! Bodies on structures that ride on bodies: a trolley on the girders of a bridge.
//!
//! Freedoms of a riding body are relative to its track. With r the place of a body's centre of mass from the carrier's
//! origin, e its rail's axis, R the turn from the rail's frame to the carrier's axes:
//! p' = u_c' + theta_c' cross r(x) + R (u' + theta' cross cg) + x' theta_c cross e = J q' + what is prescribed, and
//! p'' = J q'' + 2 x' theta_c' cross e + X'' (e + theta_c cross e) + X_c''. Forces between the trolley's wheels and their rails
//! act within carrier and trolley: their rows have entries over relative freedoms alone, and the carrier feels them
//! through J^T M J and J^T M g.

use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};

use crate::scene::arm_rows;
use crate::system::System;
use crate::{Axle, Error, Foundation, Scene};

/// Slack allowed between directions of rails of one track.
const SLACK: f64 = 1e-9;

/// All bodies that ride on bodies.
pub(crate) struct Rides {
    riders: Vec<Rider>,
}

struct Rider {
    body: usize,
    carrier: usize,
    /// Columns: the axes of the rail's frame in the carrier's axes.
    turn: Matrix3<f64>,
    /// The body's centre of mass from the carrier's origin, in the carrier's axes, where the body's x is 0.
    origin: Vector3<f64>,
}

/// A rider at one instant.
struct Moved {
    /// Velocity of the centre of mass in the carrier's axes, then of rotation in the rail's, over the freedoms.
    jacobian: DMatrix<f64>,
    /// The same for the speeds of now.
    speed: SVector<f64, 6>,
    /// Acceleration of the centre of mass at q'' = 0.
    bias: Vector3<f64>,
    /// e + theta_c cross e.
    along: Vector3<f64>,
    /// Height of the centre of mass.
    lift: f64,
}

impl Rides {
    /// The riders of `scene`, found by their contacts; `root[b]` is the body at the root of the tree of b.
    ///
    /// # Errors
    /// [`Error::Mounted`]: a tree with contacts on several carriers or rails of different directions, one that carries what it
    /// rides on, loads on riders, and structures with mass or of parts on a body.
    pub fn new(
        scene: &Scene,
        foundations: &[Foundation],
        root: impl Fn(usize) -> usize,
    ) -> Result<Self, Error> {
        let count = scene.bodies.len();
        let mut tracks: Vec<Option<Track>> = vec![None; count];
        let mut grounded = vec![false; count];
        for contact in &scene.contacts {
            let tree = root(contact.body);
            let refused = Error::Mounted { body: tree };
            let Some(mount) = &foundations[contact.structure].on else {
                grounded[tree] = true;
                continue;
            };
            let rail =
                mount.rails.get(contact.rail).ok_or(Error::NoSuch { what: "rail", index: contact.rail })?;
            let turn = frame(rail).ok_or(refused.clone())?;
            let [_, y, z] = hub(scene, contact.body, contact.at);
            let drop = Vector3::new(0.0, y - scene.wheels[contact.wheel].radius, z);
            let track = Track { carrier: mount.body, turn, origin: Vector3::from(rail.origin) - turn * drop };
            match &tracks[tree] {
                None => tracks[tree] = Some(track),
                Some(first) if first.carrier == track.carrier && (first.turn - turn).amax() < SLACK => {}
                Some(_) => return Err(refused),
            }
        }
        for foundation in foundations.iter().filter(|f| f.structure.is_some() || f.parts.is_some()) {
            if let Some(mount) = &foundation.on {
                return Err(Error::Mounted { body: mount.body });
            }
        }
        for mount in foundations.iter().filter_map(|foundation| foundation.on.as_ref()) {
            if tracks[root(mount.body)].is_some() {
                return Err(Error::Mounted { body: mount.body });
            }
        }
        let mut riders = Vec::new();
        for (b, body) in scene.bodies.iter().enumerate() {
            let Some(track) = &tracks[root(b)] else { continue };
            let carrier = root(track.carrier);
            let loaded = scene.actuators.loads.iter().any(|load| load.body == b);
            if grounded[root(b)] || carrier == root(b) || tracks[carrier].is_some() || loaded {
                return Err(Error::Mounted { body: b });
            }
            let [_, y, z] = hub(scene, b, [0.0; 3]);
            let cg = Vector3::from(body.cg) + Vector3::new(0.0, y, z);
            riders.push(Rider {
                body: b,
                carrier: track.carrier,
                turn: track.turn,
                origin: track.origin + track.turn * cg,
            });
        }
        Ok(Rides { riders })
    }

    /// Whether no body rides on another.
    pub fn is_empty(&self) -> bool {
        self.riders.is_empty()
    }

    /// Whether body `b` rides.
    pub fn has(&self, b: usize) -> bool {
        self.riders.iter().any(|rider| rider.body == b)
    }

    /// Adds to `mass` and `load` what the riders do at (t, q, v): J^T M J, and -J^T M (bias + g).
    pub fn add(
        &self,
        system: &System,
        (t, q, v): (f64, &DVector<f64>, &DVector<f64>),
        mass: &mut DMatrix<f64>,
        load: &mut DVector<f64>,
    ) {
        for rider in &self.riders {
            let moved = rider.at(system, t, q, v, mass.nrows());
            let body = &system.scene.bodies[rider.body];
            let force = (moved.bias + Vector3::y() * system.scene.gravity) * body.mass;
            for (column, load) in moved.jacobian.column_iter().zip(load.iter_mut()) {
                *load -= column.fixed_rows::<3>(0).dot(&force);
            }
            let mut weighted = moved.jacobian.clone();
            for (mut row, inertia) in weighted.row_iter_mut().zip(inertias(body)) {
                row *= inertia;
            }
            *mass += moved.jacobian.transpose() * weighted;
        }
    }

    /// Adds to `load` the weights of the riders at (t, q): -J^T M g.
    pub fn weigh(&self, system: &System, (t, q): (f64, &DVector<f64>), load: &mut DVector<f64>) {
        let (count, rest) = (system.body_freedoms(), DVector::zeros(q.len()));
        for rider in &self.riders {
            let moved = rider.at(system, t, q, &rest, count);
            let weight = system.scene.bodies[rider.body].mass * system.scene.gravity;
            for (lift, load) in moved.jacobian.row(1).iter().zip(load.iter_mut()) {
                *load -= weight * lift;
            }
        }
    }

    /// Kinetic energy and energy of weight at (t, q, v).
    pub fn energy(&self, system: &System, t: f64, q: &DVector<f64>, v: &DVector<f64>) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for rider in &self.riders {
            let moved = rider.at(system, t, q, v, 0);
            let body = &system.scene.bodies[rider.body];
            let squares =
                moved.speed.iter().zip(inertias(body)).map(|(speed, inertia)| inertia * speed * speed);
            sum[0] += 0.5 * squares.sum::<f64>();
            sum[1] += body.mass * system.scene.gravity * moved.lift;
        }
        sum
    }

    /// Force along its track that the riders ask of the prescribed x of root `b`, at accelerations `a`.
    pub fn drive(&self, system: &System, [q, v, a]: [&DVector<f64>; 3], t: f64, b: usize) -> f64 {
        let mut sum = 0.0;
        for rider in &self.riders {
            let roots = [rider.body, rider.carrier].map(|body| system.kinematics.root(body));
            if !roots.contains(&b) {
                continue;
            }
            let count = system.body_freedoms();
            let moved = rider.at(system, t, q, v, count);
            let mass = system.scene.bodies[rider.body].mass;
            let shift = moved.jacobian.fixed_rows::<3>(0) * a.rows(0, count);
            let acceleration = shift + moved.bias + Vector3::y() * system.scene.gravity;
            sum += mass * if roots[0] == b { acceleration.dot(&moved.along) } else { acceleration[0] };
        }
        sum
    }
}

#[derive(Clone)]
struct Track {
    carrier: usize,
    turn: Matrix3<f64>,
    origin: Vector3<f64>,
}

impl Rider {
    fn at(&self, system: &System, t: f64, q: &DVector<f64>, v: &DVector<f64>, count: usize) -> Moved {
        let scene = system.scene;
        let (own, own_speed) = system.body(self.body, t, q, v);
        let (base, base_speed) = system.body(self.carrier, t, q, v);
        let e: Vector3<f64> = self.turn.column(0).into();
        let turned = |all: &[f64; 6]| Vector3::new(all[3], all[4], all[5]);
        let tilt = turned(&base).cross(&e);
        let arms = arm_rows((self.origin + e * own[0]).into());
        let cg = arm_rows(scene.bodies[self.body].cg);
        let combine = |rows: &[[f64; 6]; 3], by: &[f64; 6]| {
            Vector3::from_fn(|k, _| rows[k].iter().zip(by).map(|(r, u)| r * u).sum::<f64>())
        };
        // Columns of the velocities by the six of the rider and of the carrier.
        let mut by_own = DMatrix::zeros(6, 6);
        let mut by_base = DMatrix::zeros(6, 6);
        for i in 0..6 {
            let mut one = [0.0; 6];
            one[i] = 1.0;
            let mut shift = self.turn * combine(&cg, &one);
            if i == 0 {
                shift += tilt;
            }
            by_own.fixed_view_mut::<3, 1>(0, i).copy_from(&shift);
            by_own.fixed_view_mut::<3, 1>(3, i).copy_from(&turned(&one));
            by_base.fixed_view_mut::<3, 1>(0, i).copy_from(&combine(&arms, &one));
            by_base.fixed_view_mut::<3, 1>(3, i).copy_from(&(self.turn.transpose() * turned(&one)));
        }
        let mut jacobian = DMatrix::zeros(6, count);
        for (b, columns) in [(self.body, &by_own), (self.carrier, &by_base)] {
            for (i, terms) in system.kinematics.terms(b).iter().enumerate() {
                for &(number, coefficient) in terms.iter().filter(|(number, _)| *number < count) {
                    jacobian.column_mut(number).axpy(coefficient, &columns.column(i), 1.0);
                }
            }
        }
        let prescribed = |b: usize| {
            let motion = scene.bodies[system.kinematics.root(b)].motion.as_ref();
            motion.map_or(0.0, |profile| profile.at(t).a)
        };
        let sum = by_own * SVector::<f64, 6>::from(own_speed) + by_base * SVector::<f64, 6>::from(base_speed);
        let along = e + tilt;
        Moved {
            jacobian,
            speed: SVector::from_fn(|i, _| sum[i]),
            bias: 2.0 * own_speed[0] * turned(&base_speed).cross(&e)
                + prescribed(self.body) * along
                + prescribed(self.carrier) * Vector3::x(),
            along,
            lift: combine(&arms, &base)[1] + combine(&cg, &own)[1],
        }
    }
}

fn inertias(body: &crate::Body) -> [f64; 6] {
    let [roll, yaw, pitch] = body.inertia;
    [body.mass, body.mass, body.mass, roll, yaw, pitch]
}

/// Axes of a rail's frame as columns; `None` where it is not level or not of length 1.
fn frame(rail: &Axle) -> Option<Matrix3<f64>> {
    let x = Vector3::from(rail.along);
    let level = x[1].abs() < SLACK && (x.norm() - 1.0).abs() < SLACK;
    level.then(|| Matrix3::from_columns(&[x, Vector3::y(), x.cross(&Vector3::y())]))
}

/// A point at `at` of body `b` from the origin of the tree's root, at rest; its x is that of the body.
fn hub(scene: &Scene, b: usize, at: [f64; 3]) -> [f64; 3] {
    let ([mut x, mut y, mut z], mut b) = (at, b);
    while let Some(pin) = &scene.bodies[b].pinned {
        (x, y, z, b) = (x + pin.at[0], y + pin.at[1], z + pin.at[2], pin.to);
    }
    [x, y, z]
}
