//! Inertia of free degrees of freedom.

use sim::{Damper, Foundation, Method, NormalLaw, Wheel};

use crate::scene::motion::simulation_input;
use crate::scene::raw::RawScene;
use crate::scene::values::body::DOFS;
use crate::scene::values::scene::Scene;
use crate::text::fault::{Fault, Faults, number};
use crate::text::place::Place;

/// Checks that every free degree of freedom of a scene, whose bodies, trucks and structures have no faults, moves a
/// mass. If the wheels have faults, others are put in their place, because inertia does not depend on them.
///
/// The mass matrix of the bodies is assembled as in a run, on rigid structures. The inertia of a structure on a body
/// is not known yet: its carrier, and the bodies to which this is pinned, are taken as having inertia.
pub(super) fn check(raw: &RawScene, scene: &Scene, root: &Place<'_>, faults: &mut Faults) {
    let Ok(mut input) = simulation_input(scene) else {
        return;
    };
    if faults.concern(&["wheels"]) {
        input
            .scene
            .wheels
            .fill(Wheel::new(1.0, NormalLaw::linear(1.0, 0.0, Damper::Rail)));
    }
    for mount in scene
        .structures
        .iter()
        .filter_map(|structure| structure.carrier)
    {
        let mut carrier = Some(mount.body);
        // pins form no cycle: at most as many steps as bodies
        for _ in 0..scene.bodies.len() {
            let Some(body) = carrier else { break };
            input.scene.bodies[body].inertia = [scene.bodies[body].mass; 3];
            carrier = scene.bodies[body].pinned.map(|(to, _)| to);
        }
    }
    let rigid: Vec<Foundation> = scene
        .structures
        .iter()
        .map(|_| Foundation::rigid())
        .collect();
    let Err(sim::Error::NoInertia { body, dof }) = Method::Sdirk4.suits(&input.scene, &rigid)
    else {
        return;
    };
    let (name, given) = &raw.bodies.0[body];
    let (bodies, dof) = (root.key("bodies"), dof as usize);
    let at = bodies.key(name);
    let inertia = at.key("inertia");
    let why = format!("{} is free, but has no inertia", DOFS[dof]);
    let fault = match (given.inertia, dof.checked_sub(3)) {
        (Some(values), Some(k)) => {
            Fault::new(&inertia.index(k), format!("must be positive: {why}")).got(number(values[k]))
        }
        (None, Some(_)) => Fault::new(&at, format!("missing key `inertia`: {why}")),
        (_, None) => Fault::new(&at.key("dof"), format!("must be restrained: {why}")),
    };
    let hint = "`inertia` is [roll, yaw, pitch] about the centre of mass, mass length^2";
    faults.add(fault.hint(format!("{hint}; or remove \"{}\" from `dof`", DOFS[dof])));
}
