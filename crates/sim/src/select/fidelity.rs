//! Fidelities at which a structure can be modelled.

use std::f64::consts::PI;

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

/// Bounce of a body on its contacts on rigid rails.
struct Bounce {
    /// sqrt(sum k' / m), with the stiffnesses k' of the contacts at rest; 0 without contacts.
    omega: f64,
    /// Damping ratio, sum c' / (2 m omega), with the damping constants c' of the contacts at rest.
    ratio: f64,
}

fn bounces(scene: &Scene) -> impl Iterator<Item = Bounce> + '_ {
    scene.bodies.iter().enumerate().map(|(b, body)| {
        let contacts = || scene.contacts.iter().filter(|contact| contact.body == b);
        let wheels: usize = contacts().map(|contact| contact.offsets.len()).sum();
        let share = body.mass * scene.gravity / wheels.max(1) as f64;
        let [mut stiffness, mut damping] = [0.0; 2];
        for contact in contacts() {
            let law = &scene.wheels[contact.wheel].normal;
            let (at, count) = (law.at(law.penetration(share), 0.0), contact.offsets.len() as f64);
            stiffness += at.by_penetration * count;
            damping += at.by_rate * count;
        }
        let omega = (stiffness / body.mass).sqrt();
        Bounce { omega, ratio: damping / (2.0 * body.mass * omega) }
    })
}

/// Period of the fastest bounce of a body on its contacts on rigid rails; infinite without contacts.
pub(super) fn fastest_bounce(scene: &Scene) -> f64 {
    2.0 * PI / bounces(scene).map(|bounce| bounce.omega).fold(0.0, f64::max)
}

/// Largest number of bounces of a body after which the run still depends on the phase of the first one: those of the
/// run, or those within which the dampers of its contacts reduce a bounce to a hundredth, ln(100) / (2 pi ratio).
pub(super) fn remembered_bounces(scene: &Scene) -> f64 {
    let of = |bounce: Bounce| {
        let all = scene.end * bounce.omega / (2.0 * PI);
        let decay = 100.0_f64.ln() / (2.0 * PI * bounce.ratio);
        // without contacts the ratio is not a number, and there are no bounces
        if decay < all { decay } else { all }
    };
    bounces(scene).map(of).fold(0.0, f64::max)
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
    let period = 2.0 * PI * (deepest / scene.gravity).sqrt();
    if period > 0.0 && period < scene.end { period } else { scene.end }
}
