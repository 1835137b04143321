//! Check that the lateral distance between two trucks of a body equals the distance between the rails on which they
//! run.

use fea::{Model, Rail};

use crate::scene::values::body::seat_of;
use crate::scene::values::scene::Scene;
use crate::scene::values::structure::Origin;
use crate::text::fault::{Fault, Faults, number};
use crate::text::place::Place;
use crate::vector::{cross, dot, unit};

/// Tolerance of the distance between trucks, as a fraction of the distance between their rails. It allows for the
/// width of wheel treads, worn rails and rounded dimensions.
const DEFAULT_TOLERANCE: f64 = 0.1;

/// Rejects trucks that are not positioned on their rails, for bodies that can roll or yaw. Returns whether there are
/// none.
///
/// For each body the first of its trucks is the reference. The lateral distance from it to every other truck,
/// computed from the positions `at` and the pins between bodies, is compared with the distance between the two rails
/// in the model of their spec.
pub(super) fn check(scene: &Scene, faults: &mut Faults) -> bool {
    let before = faults.0.len();
    let root = Place::root();
    let list = root.key("trucks");
    let mut first: Vec<Option<usize>> = vec![None; scene.bodies.len()];
    for (index, truck) in scene.trucks.iter().enumerate() {
        let Some((body, arm)) = seat_of(&scene.bodies, truck.body) else {
            continue;
        };
        let [.., roll, yaw, _] = scene.bodies[body].free;
        let Some(other) = first[body] else {
            first[body] = Some(index);
            continue;
        };
        let reference = &scene.trucks[other];
        let Some((_, reference_arm)) = seat_of(&scene.bodies, reference.body) else {
            continue;
        };
        let Some(rails) = rail_distance(scene, reference.rail, truck.rail).filter(|_| roll || yaw)
        else {
            continue;
        };
        let own = truck.at[2] + arm[2];
        let wheels = own - reference.at[2] - reference_arm[2];
        if (wheels - rails).abs() <= DEFAULT_TOLERANCE * rails.abs() {
            continue;
        }
        let [here, there] = [truck.rail, reference.rail].map(|rail| &scene.rails[rail].name);
        let side = if rails > 0.0 { "right" } else { "left" };
        let expected = format!(
            "must be above its rail: {here} is {} to the {side} of {there}, seen along the rails",
            number(rails.abs())
        );
        let found = format!(
            "{} to the right of truck \"{}\"",
            number(wheels),
            reference.name
        );
        let hint = format!(
            "z of `at` points to the right; for a body midway between the rails it is {} here and {} there",
            number(0.5 * rails),
            number(-0.5 * rails)
        );
        let at = list.index(index);
        faults.add(Fault::new(&at.key("at"), expected).got(found).hint(hint));
    }
    faults.0.len() == before
}

/// Distance from the first rail to the second, positive to the right, length; none if they belong to different
/// structures or to a structure without a spec.
fn rail_distance(scene: &Scene, one: usize, other: usize) -> Option<f64> {
    let [first, second] = [one, other].map(|rail| &scene.rails[rail]);
    let structure = &scene.structures[first.structure];
    let Origin::Spec { spec, .. } = &structure.origin else {
        return None;
    };
    if one == other || first.structure != second.structure {
        return None;
    }
    let (model, rails) = spec.model().ok()?;
    let [a, b] = [rails.get(first.rail)?, rails.get(second.rail)?];
    let [u, v] = [unit(a.axis)?, unit(b.axis)?];
    let along = dot(u, v);
    let right = unit(cross(u, model.up))?;
    let distance = position_along(&model, b, right)? - position_along(&model, a, right)?;
    // the distance is undefined for rails that are not parallel
    (along > 1.0 - 1e-6 && distance != 0.0).then_some(distance)
}

/// Position of a rail along the unit vector `right`: the mean over the ends of its segments.
fn position_along(model: &Model, rail: &Rail, right: [f64; 3]) -> Option<f64> {
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
