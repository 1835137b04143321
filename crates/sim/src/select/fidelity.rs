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

impl Bounce {
    /// Time within which the dampers reduce it to a hundredth, ln(100) / (ratio omega), `end` at the most.
    fn remembered_time(&self, end: f64) -> f64 {
        // without contacts the ratio is not a number
        (100.0_f64.ln() / (self.ratio * self.omega)).min(end)
    }
}

fn bounces(scene: &Scene) -> impl Iterator<Item = Bounce> + '_ {
    scene.bodies.iter().enumerate().map(|(b, body)| {
        let contacts = || scene.contacts.iter().filter(|contact| contact.body == b);
        let wheels: usize = contacts().map(|contact| contact.offsets.len()).sum();
        let share = body.mass * scene.gravity / wheels.max(1) as f64;
        let [mut stiffness, mut damping] = [0.0; 2];
        for contact in contacts() {
            let law = &scene.wheels[contact.wheel].normal;
            let (at, count) = (
                law.at(law.penetration(share), 0.0),
                contact.offsets.len() as f64,
            );
            stiffness += at.by_penetration * count;
            damping += at.by_rate * count;
        }
        let omega = (stiffness / body.mass).sqrt();
        Bounce {
            omega,
            ratio: damping / (2.0 * body.mass * omega),
        }
    })
}

/// Period of the fastest bounce of a body on its contacts on rigid rails; infinite without contacts.
pub(super) fn fastest_bounce(scene: &Scene) -> f64 {
    2.0 * PI
        / bounces(scene)
            .map(|bounce| bounce.omega)
            .fold(0.0, f64::max)
}

/// Largest number of bounces of a body after which the run still depends on the phase of the first one: those of the
/// run, or those within which the dampers of its contacts reduce a bounce to a hundredth.
pub(super) fn remembered_bounces(scene: &Scene) -> f64 {
    let of = |bounce: Bounce| bounce.remembered_time(scene.end) * bounce.omega / (2.0 * PI);
    bounces(scene).map(of).fold(0.0, f64::max)
}

/// Longest time, up to that of the run, after which the run still depends on the phase of the first bounce of a body.
pub(super) fn remembered_time(scene: &Scene) -> f64 {
    bounces(scene)
        .map(|own| own.remembered_time(scene.end))
        .fold(0.0, f64::max)
}

/// Period of the slowest bounce of a wheel in a run on flexible rails: 2 pi sqrt(d/g), with d the largest sum of
/// penetration and deflection under a wheel; the duration of the run where there is no gravity or no wheel.
pub(super) fn slowest_bounce(scene: &Scene, history: &History) -> f64 {
    let mut deepest = 0.0_f64;
    let mut w = 0;
    while history.position(Channel::Penetration(w)).is_some() {
        let pairs = history
            .values(Channel::Penetration(w))
            .zip(history.values(Channel::Deflection(w)));
        deepest = pairs.fold(deepest, |most, (p, d)| most.max(p + d));
        w += 1;
    }
    let period = 2.0 * PI * (deepest / scene.gravity).sqrt();
    if period > 0.0 && period < scene.end {
        period
    } else {
        scene.end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Body, Contact, Damper, NormalLaw, Wheel};

    /// Analytic: 2 pi sqrt(m/(n k)) of a body on n wheels, and of an exponent e at rest 2 pi sqrt(m/(e W/p)).
    #[test]
    fn the_fastest_bounce_is_that_of_the_stiffest_body() {
        let law = |stiffness: f64| NormalLaw::linear(stiffness, 0.0, Damper::Rail);
        let hertz = NormalLaw {
            exponent: 1.5,
            ..law(4e6)
        };
        let mut scene = Scene {
            bodies: vec![Body::new(500.0, [1.0; 3]), Body::new(2000.0, [1.0; 3])],
            wheels: vec![Wheel::new(0.5, law(2e5)), Wheel::new(0.5, hertz)],
            contacts: vec![
                Contact {
                    offsets: vec![-1.0, 1.0],
                    ..Contact::new(0, [0.0; 3])
                },
                Contact {
                    wheel: 1,
                    ..Contact::new(1, [0.0; 3])
                },
            ],
            ..Scene::default()
        };
        let weight = 2000.0 * scene.gravity;
        let depth = (weight / 4e6).powf(1.0 / 1.5);
        let turn = 2.0 * std::f64::consts::PI;
        let first = turn * (500.0 / 4e5_f64).sqrt();
        let second = turn * (2000.0 / (1.5 * weight / depth)).sqrt();
        assert!((fastest_bounce(&scene) / first.min(second) - 1.0).abs() < 1e-14);
        scene.contacts.remove(1);
        assert!((fastest_bounce(&scene) / first - 1.0).abs() < 1e-14);
        scene.contacts.clear();
        assert_eq!(fastest_bounce(&scene), f64::INFINITY);
    }

    /// Analytic: exp(-ratio omega t) is 1/100 after ln(100) / (ratio omega) with 2 ratio omega = c/m; without a damper the
    /// whole run is remembered.
    #[test]
    fn a_bounce_is_remembered_until_dampers_reduce_it_to_a_hundredth() {
        let scene = |damping: f64| Scene {
            bodies: vec![Body::new(500.0, [1.0; 3])],
            wheels: vec![Wheel::new(
                0.5,
                NormalLaw::linear(2e5, damping, Damper::Rail),
            )],
            contacts: vec![Contact::new(0, [0.0; 3])],
            end: 30.0,
            ..Scene::default()
        };
        let expected = 100.0_f64.ln() * 2.0 * 500.0 / 400.0;
        assert!((remembered_time(&scene(400.0)) / expected - 1.0).abs() < 1e-12);
        assert_eq!(remembered_time(&scene(0.0)), 30.0);
        assert_eq!(remembered_time(&scene(1.0)), 30.0);
    }

    /// Analytic: 2 pi sqrt(d/g) for the largest sum d of penetration and deflection at one time under one wheel; the
    /// duration of the run where that is shorter or there is nothing to bounce.
    #[test]
    fn the_slowest_bounce_is_that_of_the_deepest_wheel() {
        let scene = Scene {
            end: 30.0,
            ..Scene::default()
        };
        let channels = [0, 1]
            .iter()
            .flat_map(|&w| [Channel::Penetration(w), Channel::Deflection(w)]);
        let values = vec![
            0.1, 0.3, 0.05, 0.0, 0.2, 0.25, 0.01, 0.7, 0.25, 0.1, 0.0, 0.0,
        ];
        let history = History::of(channels.collect(), values);
        let expected = 2.0 * std::f64::consts::PI * (0.71 / scene.gravity).sqrt();
        assert!((slowest_bounce(&scene, &history) / expected - 1.0).abs() < 1e-14);
        let short = Scene {
            end: 0.5 * expected,
            ..scene.clone()
        };
        assert_eq!(slowest_bounce(&short, &history), 0.5 * expected);
        assert_eq!(slowest_bounce(&scene, &History::default()), 30.0);
        assert_eq!(
            slowest_bounce(
                &Scene {
                    gravity: 0.0,
                    ..scene
                },
                &history
            ),
            30.0
        );
    }
}
