//! The deck with its rails on a moving part: what wheels feel of them must not change.

use adams::{ArgumentValue, DataSet, Pose, Statement};
use nalgebra::{Matrix3, Vector3};

use super::poses::CarrierPose;
use super::random::Random;
use crate::model::plan::GROUND;
use crate::model::start::rotation;

/// Moves every MARKER of the ground to a new PART of unit mass; returns the PART.
pub fn mount(set: &mut DataSet) -> u32 {
    let parts = set.statements.iter().filter(|one| one.keyword == "PART").filter_map(|one| one.id);
    let markers = set.statements.iter().filter(|one| one.keyword == "MARKER").filter_map(|one| one.id);
    let (part, cm) = (parts.max().unwrap_or(GROUND) + 1, markers.max().unwrap_or_default() + 1);
    for statement in set.statements.iter_mut().filter(|one| one.keyword == "MARKER") {
        for argument in statement.arguments.iter_mut().filter(|argument| argument.name == "PART") {
            if argument.value == ArgumentValue::Whole(i64::from(GROUND)) {
                argument.value = ArgumentValue::Whole(i64::from(part));
            }
        }
    }
    let at = set.statements.iter().position(|one| one.keyword == "PART").map_or(0, |first| first + 1);
    let carrier = Statement::new("PART", part)
        .named("carrier_of_the_rails")
        .numbers("MASS", &[1.0])
        .reference("CM", cm)
        .numbers("IP", &[1.0, 1.0, 1.0]);
    let centre = Statement::new("MARKER", cm).named("carrier_cm").reference("PART", part);
    set.statements.splice(at..at, [carrier, centre]);
    part
}

/// A random motion of the carrier: turned by any angle, at up to one radian a second and a length a second.
pub fn carrier(part: u32, random: &mut Random) -> CarrierPose {
    let mut vector = |size: f64| std::array::from_fn::<f64, 3, _>(|_| random.around(size));
    let rows = rotation(vector(2.0));
    let [origin, velocity, spin] = [vector(10.0), vector(1.0), vector(1.0)].map(Vector3::from);
    let turn = Matrix3::from_fn(|i, j| rows[i][j]);
    CarrierPose { part, pose: Pose::moving(origin, turn, velocity, spin) }
}
