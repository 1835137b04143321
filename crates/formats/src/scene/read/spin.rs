//! Wheels whose spin is prescribed by a motion.

use super::schedule::{motion_tables, read_profile};
use crate::check::Check;
use crate::scene::raw::RawMotion;
use crate::scene::values::actuator::Spin;
use crate::scene::values::body::BodyMotion;
use crate::scene::values::scene::Scene;
use crate::text::fault::Fault;
use crate::text::names::{names, resolve};
use crate::text::place::Place;
use crate::units::Dimension;

/// Value of `dof` for a spin.
pub(super) const SPIN: &str = "spin";

/// Whether a motion prescribes the spin of a wheel.
pub(super) fn is_spin(motion: &RawMotion) -> bool {
    motion.dof.as_deref() == Some(SPIN)
}

/// Reads the prescribed spins of a scene whose trucks have already been read.
pub(super) fn read_all(raw: &[RawMotion], scene: &Scene, check: &mut Check<'_>) -> Vec<Spin> {
    let root = Place::root();
    let list = root.key("motions");
    let mut spins: Vec<Spin> = Vec::new();
    for (index, motion) in raw.iter().enumerate().filter(|(_, motion)| is_spin(motion)) {
        let at = list.index(index);
        let Some(spin) = read(motion, scene, &at, check) else {
            continue;
        };
        if spins
            .iter()
            .any(|other| (other.truck, other.wheel) == (spin.truck, spin.wheel))
        {
            check.faults.add(Fault::new(
                &at,
                "the spin of this wheel already has a motion",
            ));
        }
        spins.push(spin);
    }
    for (truck, owner) in scene.trucks.iter().enumerate() {
        let kind = &scene.wheels[owner.wheel];
        let body = &scene.bodies[owner.body];
        let acts = (kind.driven && matches!(body.motion, BodyMotion::Driven(_)))
            || (kind.braked && body.brake.is_some());
        if acts && spins.iter().any(|spin| spin.truck == truck) {
            let fault = Fault::new(
                &list,
                format!(
                    "truck {} cannot have both a prescribed spin and a drive or brake",
                    owner.name
                ),
            );
            check
                .faults
                .add(fault.hint("remove either the motion of the spin or the drive and the brake"));
        }
    }
    spins
}

fn read(motion: &RawMotion, scene: &Scene, at: &Place<'_>, check: &mut Check<'_>) -> Option<Spin> {
    if let Some(kind) = check.faults.require(&motion.kind, at, "kind") {
        check
            .faults
            .one_of(kind, &at.key("kind"), &[("prescribed", ())]);
    }
    for (key, given) in [
        ("body", motion.body.is_some()),
        ("gain", motion.gain.is_some()),
        ("max_force", motion.max_force.is_some()),
        ("brake", motion.brake.is_some()),
    ] {
        if given {
            let fault = Fault::new(
                &at.key(key),
                format!("`{key}` is not a key of the motion of a spin"),
            );
            check.faults.add(
                fault
                    .at_key()
                    .hint("its keys are `truck`, `wheel`, `dof`, `kind` and one table"),
            );
        }
    }
    let rate = |power| Dimension::of(0, 0, power);
    let profile = read_profile(
        &motion_tables(motion, [0, -1, -2].map(rate)),
        [0.0; 2],
        at,
        check,
    );
    let known = names(&scene.trucks, |truck| &truck.name);
    let truck = match (&motion.truck, known.len()) {
        (Some(name), _) => resolve(name, &known, "truck", &at.key("truck"), check.faults)?,
        (None, 1) => 0,
        (None, _) => check
            .faults
            .require(&motion.truck, at, "truck")
            .map(|_| 0)?,
    };
    let owner = &scene.trucks[truck];
    let count = owner.wheel_offsets().len();
    let number = motion.wheel.unwrap_or(1);
    if number == 0 || number > count {
        let fault = Fault::new(
            &at.key("wheel"),
            format!("must be a wheel of truck {}", owner.name),
        );
        check.faults.add(
            fault
                .got(number)
                .hint(format!("the truck has {count} wheels, counted from 1")),
        );
        return None;
    }
    let kind = &scene.wheels[owner.wheel];
    if kind.friction.is_none() {
        let place = Place::root();
        let place = place.key("wheels");
        let fault = Fault::new(
            &place.key(&kind.name),
            "a wheel whose spin is prescribed needs `friction`",
        );
        check.faults.add(
            fault
                .at_key()
                .hint("friction transmits the force between wheel and rail"),
        );
    }
    Some(Spin {
        truck,
        wheel: number - 1,
        motion: profile?,
    })
}
