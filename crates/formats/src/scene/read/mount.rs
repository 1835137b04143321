//! Structures carried by bodies.

use crate::check::Check;
use crate::scene::raw::RawStructure;
use crate::scene::values::body::{Body, BodyMotion, root_of};
use crate::scene::values::scene::Scene;
use crate::scene::values::structure::{CarriedBy, Foundation, Origin, Structure};
use crate::scene::values::truck::Truck;
use crate::spec::Spec;
use crate::text::entries::Entries;
use crate::text::fault::{Fault, Faults};
use crate::text::names::{names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

/// Sets the bodies that carry structures.
pub(super) fn read(
    raw: &Entries<RawStructure>,
    structures: &mut [Structure],
    bodies: &[Body],
    check: &mut Check<'_>,
) {
    let root = Place::root();
    let list = root.key("structures");
    for (name, raw) in &raw.0 {
        let at = list.key(name);
        let Some(carrier) = &raw.on else {
            if raw.at.is_some() {
                let fault = Fault::new(
                    &at.key("at"),
                    "`at` is only available for a structure `on` a body",
                );
                check.faults.add(fault.at_key());
            }
            continue;
        };
        let known = names(bodies, |body| &body.name);
        let carrier = resolve(carrier, &known, "body", &at.key("on"), check.faults);
        let position = check.vector(raw.at.unwrap_or_default(), &at.key("at"), Dimension::LENGTH);
        let Some(structure) = structures
            .iter_mut()
            .find(|structure| structure.name == *name)
        else {
            continue;
        };
        if matches!(structure.foundation, Foundation::Ties { .. }) {
            check.faults.unavailable(
                &at.key("foundation"),
                "a foundation on ties for a structure on a body",
            );
        }
        match &structure.origin {
            Origin::Tables { .. } => check.faults.unavailable(
                &at.key("tables"),
                "a foundation from tables for a structure on a body",
            ),
            Origin::Spec { spec, .. } => refuse(spec, &at, check),
        }
        structure.carrier = carrier.map(|body| CarriedBy {
            body,
            at: position,
            may_move: moves(bodies, body),
        });
    }
}

/// The degrees of freedom of a body that can change: all of them if it is pinned.
fn moves(bodies: &[Body], b: usize) -> [bool; 6] {
    let body = &bodies[b];
    let mut moves = body.free;
    moves[0] = body.motion != BodyMotion::Held;
    if body.pinned.is_some() {
        [true; 6]
    } else {
        moves
    }
}

/// Rejects specs whose rails are not horizontal.
fn refuse(spec: &Spec, at: &Place<'_>, check: &mut Check<'_>) {
    // a spec from which no model can be built is rejected where it is solved
    let Ok((model, rails)) = spec.model() else {
        return;
    };
    if rails
        .iter()
        .any(|rail| rail.axis[1] != 0.0 || model.up != [0.0, 1.0, 0.0])
    {
        check.faults.unavailable(
            &at.key("spec"),
            "an inclined rail, or an `up` other than y, of a structure on a body",
        );
    }
}

/// Rejects carried bodies for which there are no equations of motion: a body on two carriers, on a body that is
/// itself carried, or on a structure that it carries. Loads on carried bodies are rejected too.
pub(super) fn check(scene: &Scene, faults: &mut Faults) {
    let root = Place::root();
    let (trucks, loads) = (root.key("trucks"), root.key("loads"));
    let tree = |body: usize| root_of(&scene.bodies, body).map_or(body, |(root, _)| root);
    let carrier = |truck: &Truck| {
        scene.structures[scene.rails[truck.rail].structure]
            .carrier
            .map(|on| on.body)
    };
    let name = |body: usize| &scene.bodies[body].name;
    for (index, truck) in scene.trucks.iter().enumerate() {
        let Some(on) = carrier(truck) else { continue };
        let at = trucks.index(index);
        let (own, below) = (tree(truck.body), tree(on));
        let apart =
            |other: &&Truck| tree(other.body) == own && carrier(other).map(tree) != Some(below);
        if below == own {
            let fault = Fault::new(
                &at,
                format!(
                    "\"{}\" cannot run on a structure that it carries",
                    name(truck.body)
                ),
            );
            faults.add(fault.got(format!("rail {}", scene.rails[truck.rail].name)));
        } else if let Some(other) = scene.trucks.iter().find(apart) {
            let expected = format!(
                "all wheels of \"{}\" must run on structures that are carried by the same body",
                name(own)
            );
            let fault = Fault::new(&at, expected);
            faults.add(fault.got(format!(
                "other wheels on rail {}",
                scene.rails[other.rail].name
            )));
        } else if scene
            .trucks
            .iter()
            .any(|other| tree(other.body) == below && carrier(other).is_some())
        {
            faults.unavailable(
                &at,
                &format!(
                    "a structure on a body that itself runs on a carried structure (\"{}\")",
                    name(below)
                ),
            );
        }
        for (load, _) in scene
            .loads
            .iter()
            .enumerate()
            .filter(|(_, load)| tree(load.body) == own)
        {
            faults.unavailable(
                &loads.index(load),
                "a load on a body that runs on a carried structure",
            );
        }
    }
}
