//! Trucks of one body stand as far apart across the track as the rails of their structure.

use fea::{Model, Rail};

use super::pin::seat_of;
use super::{Origin, Scene};
use crate::fault::{Fault, Faults, number};
use crate::place::Place;
use crate::vector::{cross, dot, unit};

/// Share of the distance of two rails by which trucks may miss it: wheel treads, worn rails, rounded drawings.
const SLACK: f64 = 0.1;

/// Refuses trucks that stand where their rails are not, below bodies that can roll or yaw; whether none did.
pub(super) fn check(scene: &Scene, faults: &mut Faults) -> bool {
    let before = faults.0.len();
    let root = Place::root();
    let list = root.key("trucks");
    let mut first: Vec<Option<usize>> = vec![None; scene.bodies.len()];
    for (index, truck) in scene.trucks.iter().enumerate() {
        let Some((body, arm)) = seat_of(&scene.bodies, truck.body) else { continue };
        let [.., roll, yaw, _] = scene.bodies[body].free;
        let Some(other) = first[body] else {
            first[body] = Some(index);
            continue;
        };
        let fellow = &scene.trucks[other];
        let Some((_, other_arm)) = seat_of(&scene.bodies, fellow.body) else { continue };
        let Some(rails) = apart(scene, fellow.rail, truck.rail).filter(|_| roll || yaw) else { continue };
        let own = truck.at[2] + arm[2];
        let wheels = own - fellow.at[2] - other_arm[2];
        if (wheels - rails).abs() <= SLACK * rails.abs() {
            continue;
        }
        let [here, there] = [truck.rail, fellow.rail].map(|rail| &scene.rails[rail].name);
        let side = if rails > 0.0 { "right" } else { "left" };
        let expected = format!(
            "must stand on its rail: {here} lies {} to the {side} of {there}, looking along them",
            number(rails.abs())
        );
        let found = format!("{} to the right of truck \"{}\"", number(wheels), fellow.name);
        let hint = format!(
            "z of `at` is to the right; of a body in the middle {} here and {} there",
            number(0.5 * rails),
            number(-0.5 * rails)
        );
        let at = list.index(index);
        faults.add(Fault::new(&at.key("at"), expected).got(found).hint(hint));
    }
    faults.0.len() == before
}

/// How far the second rail lies to the right of the first, of one structure whose spec says so.
fn apart(scene: &Scene, one: usize, other: usize) -> Option<f64> {
    let [first, second] = [one, other].map(|rail| &scene.rails[rail]);
    let structure = &scene.structures[first.structure];
    let Origin::Spec { spec, .. } = &structure.origin else { return None };
    if one == other || first.structure != second.structure {
        return None;
    }
    let (model, rails) = spec.model().ok()?;
    let [a, b] = [rails.get(first.rail)?, rails.get(second.rail)?];
    let [u, v] = [unit(a.axis)?, unit(b.axis)?];
    let along = dot(u, v);
    let right = unit(cross(u, model.up))?;
    let distance = line(&model, b, right)? - line(&model, a, right)?;
    // rails that cross have no distance; a rail of both ways has no right
    (along > 1.0 - 1e-6 && distance != 0.0).then_some(distance)
}

/// Where a rail lies along `right`: the middle of its segments' ends.
fn line(model: &Model, rail: &Rail, right: [f64; 3]) -> Option<f64> {
    let ends: Vec<f64> = rail
        .segments
        .iter()
        .filter_map(|segment| Some((model.members.get(segment.member)?, segment.offset)))
        .flat_map(|(member, offset)| {
            [0, 1].map(|end| {
                let place = model.points[member.points[end]];
                dot(place, right) + dot(member.offsets[end], right) + dot(offset, right)
            })
        })
        .collect();
    (!ends.is_empty()).then(|| ends.iter().sum::<f64>() / ends.len() as f64)
}
