//! Fidelities at which a structure can be modelled.

use crate::Scene;

/// Numbers of modes that are tried; each one also checks the lower fidelities.
pub(super) const MODES: [usize; 6] = [2, 4, 6, 8, 12, 16];

/// Fidelities at which a structure can be modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fidelity {
    /// The structure is rigid.
    Rigid,
    /// The structure has compliance but no mass.
    Influence,
    /// The structure has this number of modes, and the static deflection of the others.
    Modal(usize),
    /// All modes of a mesh with half as many elements per member as the full mesh, which it checks.
    Half,
    /// All modes of the full mesh.
    Full,
}

/// Highest frequency of a body on its contacts at rest on rigid rails: sqrt(sum k' / m).
pub(super) fn contact_frequency(scene: &Scene, structure: usize) -> f64 {
    let of = |b: usize| {
        let contacts = || scene.contacts.iter().filter(|contact| contact.body == b);
        let wheels: usize = contacts().map(|contact| contact.offsets.len()).sum();
        let body = &scene.bodies[b];
        let share = body.mass * scene.gravity / wheels.max(1) as f64;
        let stiffness: f64 = contacts()
            .filter(|contact| contact.structure == structure)
            .map(|contact| {
                let law = &scene.wheels[contact.wheel].normal;
                law.at(law.penetration(share), 0.0).by_penetration * contact.offsets.len() as f64
            })
            .sum();
        (stiffness / body.mass).sqrt()
    };
    (0..scene.bodies.len()).map(of).fold(0.0, f64::max)
}
