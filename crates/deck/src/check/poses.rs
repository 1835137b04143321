//! Conversion of states of the simulator to states of the parts of the deck, on the ground or on a moving carrier of
//! all rails.

use std::collections::BTreeMap;

use adams::{ArgumentValue, DataSet, ModelState, Pose, Statement};
use nalgebra::{Matrix3, Vector3};

use super::random::Random;
use super::states::CheckCase;
use crate::DeckPlan;
use crate::model::plan::GROUND;
use crate::model::start::rotation;

/// Largest coordinate of the origin of a carrier.
pub const CARRIER: f64 = 10.0;

/// A moving part that carries all rails.
#[derive(Clone, Copy, Debug)]
pub struct CarrierPose {
    /// Its PART.
    pub part: u32,
    /// Its motion.
    pub pose: Pose,
}

/// The state of the parts of the deck at `case`, with the small rotations of the simulator: I + theta x, and the rate
/// theta' x.
#[must_use]
pub fn state(plan: &DeckPlan<'_>, case: &CheckCase, carrier: Option<CarrierPose>) -> ModelState {
    let mut parts = BTreeMap::new();
    let instant = &case.instant;
    let bodies: Vec<Pose> = (0..plan.bodies.len())
        .map(|b| body(plan, case, b))
        .collect();
    for (own, pose) in plan.bodies.iter().zip(&bodies) {
        parts.insert(own.part, *pose);
    }
    for (w, wheel) in plan.wheels.iter().enumerate() {
        let Some((part, _)) = wheel.spin else {
            continue;
        };
        let body = &bodies[wheel.body];
        let hub = Vector3::from(wheel.hub);
        let spin = Vector3::new(
            body.angular_velocity[0],
            body.angular_velocity[1],
            instant.spin[w],
        );
        let (origin, velocity) = (
            body.origin + body.rotation * hub,
            body.velocity + body.rate * hub,
        );
        parts.insert(part, Pose::moving(origin, body.rotation, velocity, spin));
    }
    if let Some(carrier) = carrier {
        for pose in parts.values_mut() {
            *pose = carried(&carrier.pose, pose);
        }
        parts.insert(carrier.part, carrier.pose);
    }
    let mut differentials = BTreeMap::new();
    for (c, contact) in plan.contacts.iter().enumerate() {
        if let Some(id) = contact.diff {
            differentials.insert(id, case.forces.penetration[c]);
        }
    }
    ModelState {
        time: instant.time,
        parts,
        differentials,
    }
}

fn body(plan: &DeckPlan<'_>, case: &CheckCase, b: usize) -> Pose {
    let [x, y, z, roll, yaw, pitch] = case.instant.displacement[b];
    let [vx, vy, vz, by_roll, by_yaw, by_pitch] = case.instant.speed[b];
    let [height, side] = plan.bodies[b].position;
    let origin = Vector3::new(x, height + y, side + z);
    let velocity = Vector3::new(vx, vy, vz);
    let (turn, spin) = (
        Vector3::new(roll, yaw, pitch),
        Vector3::new(by_roll, by_yaw, by_pitch),
    );
    Pose {
        origin,
        rotation: Matrix3::identity() + turn.cross_matrix(),
        velocity,
        rate: spin.cross_matrix(),
        angular_velocity: spin,
    }
}

/// Transforms a pose from the axes of a carrier to those of ground.
fn carried(by: &Pose, pose: &Pose) -> Pose {
    Pose {
        origin: by.origin + by.rotation * pose.origin,
        rotation: by.rotation * pose.rotation,
        velocity: by.velocity + by.rate * pose.origin + by.rotation * pose.velocity,
        rate: by.rate * pose.rotation + by.rotation * pose.rate,
        angular_velocity: by.angular_velocity + by.rotation * pose.angular_velocity,
    }
}

/// Moves every MARKER of the ground to a new PART of unit mass, which carries the rails; returns its identifier.
/// The forces between wheels and rails must not change.
pub fn mount_rails(set: &mut DataSet) -> u32 {
    let parts = set
        .statements
        .iter()
        .filter(|one| one.keyword == "PART")
        .filter_map(|one| one.id);
    let markers = set
        .statements
        .iter()
        .filter(|one| one.keyword == "MARKER")
        .filter_map(|one| one.id);
    let (part, cm) = (
        parts.max().unwrap_or(GROUND) + 1,
        markers.max().unwrap_or_default() + 1,
    );
    for statement in set
        .statements
        .iter_mut()
        .filter(|one| one.keyword == "MARKER")
    {
        for argument in statement
            .arguments
            .iter_mut()
            .filter(|argument| argument.name == "PART")
        {
            if argument.value == ArgumentValue::Whole(i64::from(GROUND)) {
                argument.value = ArgumentValue::Whole(i64::from(part));
            }
        }
    }
    let at = set
        .statements
        .iter()
        .position(|one| one.keyword == "PART")
        .map_or(0, |first| first + 1);
    let carrier = Statement::new("PART", part)
        .named("carrier_of_the_rails")
        .numbers("MASS", &[1.0])
        .reference("CM", cm)
        .numbers("IP", &[1.0, 1.0, 1.0]);
    let centre = Statement::new("MARKER", cm)
        .named("carrier_cm")
        .reference("PART", part);
    set.statements.splice(at..at, [carrier, centre]);
    part
}

/// A random motion of the carrier with any orientation, coordinates up to [`CARRIER`], components of its velocity up to 1 length/s and of its
/// angular velocity up to 1 rad/s.
pub fn random_carrier(part: u32, random: &mut Random) -> CarrierPose {
    let mut vector = |size: f64| std::array::from_fn::<f64, 3, _>(|_| random.around(size));
    let rows = rotation(vector(2.0));
    let [origin, velocity, spin] = [vector(CARRIER), vector(1.0), vector(1.0)].map(Vector3::from);
    let turn = Matrix3::from_fn(|i, j| rows[i][j]);
    CarrierPose {
        part,
        pose: Pose::moving(origin, turn, velocity, spin),
    }
}
