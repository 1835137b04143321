//! Fidelities at which a structure can be modelled.

use crate::{Channel, History, Scene};

/// Fidelities at which a structure can be modelled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fidelity {
    /// The structure is rigid.
    Rigid,
    /// The structure has compliance but no mass.
    Influence,
    /// The structure has this number of modes, and the static deflection of the others.
    Modal(usize),
}

/// Period of the fastest bounce of a body on its contacts on rigid rails, 2 pi sqrt(m / sum k'), with the stiffnesses k' of
/// the contacts at rest; infinite without contacts.
pub(super) fn fastest_bounce(scene: &Scene) -> f64 {
    let of = |b: usize| {
        let contacts = || scene.contacts.iter().filter(|contact| contact.body == b);
        let wheels: usize = contacts().map(|contact| contact.offsets.len()).sum();
        let body = &scene.bodies[b];
        let share = body.mass * scene.gravity / wheels.max(1) as f64;
        let stiffness: f64 = contacts()
            .map(|contact| {
                let law = &scene.wheels[contact.wheel].normal;
                law.at(law.penetration(share), 0.0).by_penetration * contact.offsets.len() as f64
            })
            .sum();
        (stiffness / body.mass).sqrt()
    };
    2.0 * std::f64::consts::PI / (0..scene.bodies.len()).map(of).fold(0.0, f64::max)
}

/// Period of the slowest bounce of a wheel in a run on flexible rails: 2 pi sqrt(d/g), with d the largest sum of
/// penetration and deflection under a wheel; the duration of the run where there is no gravity or no wheel.
pub(super) fn slowest_bounce(scene: &Scene, history: &History) -> f64 {
    let mut deepest = 0.0_f64;
    let mut w = 0;
    while history.position(Channel::Penetration(w)).is_some() {
        let pairs = history.values(Channel::Penetration(w)).zip(history.values(Channel::Deflection(w)));
        deepest = pairs.fold(deepest, |most, (p, d)| most.max(p + d));
        w += 1;
    }
    let period = 2.0 * std::f64::consts::PI * (deepest / scene.gravity).sqrt();
    if period > 0.0 && period < scene.end { period } else { scene.end }
}
