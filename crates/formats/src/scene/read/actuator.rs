//! Loads and drives of a scene, and checks of the wheels on which drives and brakes act.

use super::schedule::read_schedule;
use crate::check::Check;
use crate::scene::raw::{RawLoad, RawMotion, RawScene};
use crate::scene::values::actuator::Load;
use crate::scene::values::body::{Body, BodyMotion, DOFS, Drive, root_of};
use crate::scene::values::scene::Scene;
use crate::text::fault::{Fault, Faults, alternatives};
use crate::text::names::{names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

/// Reads the loads.
pub(super) fn read_loads(raw: &[RawLoad], bodies: &[Body], check: &mut Check<'_>) -> Vec<Load> {
    let root = Place::root();
    let list = root.key("loads");
    raw.iter()
        .enumerate()
        .filter_map(|(index, load)| read_load(load, bodies, &list.index(index), check))
        .collect()
}

fn read_load(
    raw: &RawLoad,
    bodies: &[Body],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Load> {
    let body = check
        .faults
        .require(&raw.body, at, "body")
        .and_then(|name| {
            let known = names(bodies, |body| &body.name);
            resolve(name, &known, "body", &at.key("body"), check.faults)
        });
    let words: Vec<(&str, usize)> = DOFS
        .iter()
        .enumerate()
        .map(|(index, word)| (*word, index))
        .collect();
    let place = at.key("dof");
    let dof = check.faults.require(&raw.dof, at, "dof");
    let dof = dof.and_then(|word| check.faults.one_of(word, &place, &words));
    let unit = if dof.is_some_and(|dof| dof > 2) {
        Dimension::MOMENT
    } else {
        Dimension::FORCE
    };
    let value = check.faults.require(&raw.value, at, "value");
    let value = value.and_then(|table| read_schedule(table, &at.key("value"), unit, check));
    let (body, dof) = (body?, dof?);
    let owner = &bodies[body];
    let prescribed = matches!(owner.motion, BodyMotion::Prescribed(_));
    let is_free = |i: usize| owner.free[i] && !(i == 0 && prescribed);
    if !is_free(dof) {
        let state = if owner.free[dof] {
            "prescribed"
        } else {
            "fixed"
        };
        let fault = Fault::new(
            &place,
            format!("{} of body {} is {state}", DOFS[dof], owner.name),
        );
        let free: Vec<&str> = (0..6).filter(|&i| is_free(i)).map(|i| DOFS[i]).collect();
        let hint = if free.is_empty() {
            "the body has no free degree of freedom".to_owned()
        } else {
            alternatives(&free) + " can have a load"
        };
        check.faults.add(fault.hint(hint));
    }
    Some(Load {
        body,
        dof,
        value: value?,
    })
}

/// Reads the drive of a motion; none if its table of speeds is missing or invalid.
pub(super) fn read_drive(
    motion: &RawMotion,
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<Drive> {
    let gain = check.required_positive(
        motion.gain,
        at,
        "gain",
        Dimension::DAMPING,
        "drive force per unit of speed difference",
    );
    let max_force = motion.max_force.map(|force| {
        check.not_negative(
            force,
            &at.key("max_force"),
            Dimension::FORCE,
            "leave it out for no limit",
        )
    });
    let speed = check.faults.require(&motion.speed, at, "speed")?;
    let speed = read_schedule(speed, &at.key("speed"), Dimension::SPEED, check)?;
    Some(Drive {
        speed,
        gain,
        max_force,
    })
}

/// Checks that drives and brakes have wheels on which they can act.
pub(super) fn check_wheels(raw: &RawScene, scene: &Scene, faults: &mut Faults) {
    let root = Place::root();
    let kinds = root.key("wheels");
    for truck in &scene.trucks {
        let Some((root, _)) = root_of(&scene.bodies, truck.body) else {
            continue;
        };
        let (body, kind) = (&scene.bodies[root], &scene.wheels[truck.wheel]);
        let drives = matches!(body.motion, BodyMotion::Driven(_)) && kind.driven;
        let brakes = body.brake.is_some() && kind.braked;
        if root != truck.body && (drives || brakes) {
            let what = if drives { "driven" } else { "braked" };
            let expected =
                format!("{what} wheels of a pinned body are not available in this version");
            faults.add(Fault::new(&kinds.key(&kind.name).key(what), expected).at_key());
        }
    }
    for (b, body) in scene.bodies.iter().enumerate() {
        let own = || {
            let trucks = scene.trucks.iter().filter(move |truck| truck.body == b);
            trucks.map(|truck| &scene.wheels[truck.wheel])
        };
        let drives = matches!(body.motion, BodyMotion::Driven(_));
        for kind in
            own().filter(|kind| (drives && kind.driven) || (body.brake.is_some() && kind.braked))
        {
            if kind.spin_inertia.is_some() && kind.friction.is_some() {
                let place = kinds.key(&kind.name);
                let fault = Fault::new(
                    &place.key("spin_inertia"),
                    "a driven or braked wheel with `spin_inertia` is not available in this version",
                );
                faults.add(
                    fault
                        .at_key()
                        .hint("leave `spin_inertia` out: the wheel then rolls without inertia"),
                );
            }
        }
        if body.brake.is_none() {
            continue;
        }
        if !own().any(|kind| kind.braked) {
            let fault = brake_fault(
                raw,
                &body.name,
                format!("no wheel of body {} is braked", body.name),
            );
            faults.add(
                fault
                    .at_key()
                    .hint("set \"braked\": true in the wheel type of one of its trucks"),
            );
        }
        if let Some(kind) = own().find(|kind| kind.braked && kind.friction.is_none()) {
            let fault =
                Fault::new(&kinds.key(&kind.name), "a braked wheel needs `friction`").at_key();
            faults.add(fault.hint("its `mu` limits the brake force"));
        }
    }
}

/// A fault of the brake of body `name`, located at the motion or the first event that applies it.
fn brake_fault(raw: &RawScene, name: &String, expected: String) -> Fault {
    let root = Place::root();
    let (motions, events) = (root.key("motions"), root.key("events"));
    let motion = raw
        .motions
        .iter()
        .position(|m| m.body.as_ref() == Some(name) && m.brake.is_some());
    if let Some(index) = motion {
        return Fault::new(&motions.index(index).key("brake"), expected);
    }
    let event = raw.events.iter().position(|event| event.brakes(name));
    let at = events.index(event.unwrap_or_default());
    Fault::new(&at.key("do").key("brake"), expected)
}
