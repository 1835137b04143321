//! Random states of a scene with the contact forces of the simulator.
//!
//! Each state is generated in three steps. Positions, speeds and spins are random within the [`Scales`] of the scene;
//! in every other state the positions are those of a static equilibrium, displaced by about a penetration, so that
//! stiff wheels on stiff rails touch them together.
//! The simulator computes the contact forces. Where a damper acts between wheel and rail, the penetration p is a state
//! variable, and its rate p' the unknown. Forces that follow from a given penetration are ill conditioned where wheels
//! are close to each other, so that the rate is given instead, as a multiple of the speed at which the wheel falls, and p and F
//! follow together from p + G F(p, p') = e. States are generated until there are as many as requested and each wheel is loaded
//! in [`LOADED`] of them, at most [`TRIES`] times the requested number; the report says how many were found.

use sim::{ContactForces, Damper, Foundation, Instant, Scene, contact_forces};

use super::random::Random;
use crate::DeckPlan;
use crate::Error;
use formats::scene::BodyMotion;

/// Largest number of generated states per requested state. Tables that interpolate may have no forces at most of them.
const TRIES: usize = 3;
/// Least fraction of the requested states that must be found.
const ENOUGH: f64 = 0.02;
/// Number of states in which each wheel is loaded, or a twentieth of the requested states where that is less.
const LOADED: usize = 50;
/// Largest number of states per requested state that are compared so that each wheel is loaded that often.
const MORE: usize = 2;
/// Largest force of a damper outside its ramp in random states, relative to that of a spring under the approach of wheel and
/// rail.
const DAMPED: f64 = 0.2;
/// Largest rotation, radians.
const MAX_ROTATION: f64 = 0.02;
/// Length without wheels at each end of a rail, as a fraction of the length of the rail, for bodies that are free
/// along it.
const MARGIN: f64 = 0.01;
/// Scale of speeds where the scene does not determine one, in length units of the scene per second.
const DEFAULT_SPEED: f64 = 1.0;

/// A state and its contact forces.
#[derive(Clone, Debug)]
pub struct CheckCase {
    /// The state; penetrations are those of active contacts.
    pub instant: Instant,
    /// The contact forces of the simulator.
    pub forces: ContactForces,
    /// Rate of penetration of each contact; zero where the penetration is not a state variable or the contact is
    /// open.
    pub rate: Vec<f64>,
    /// Whether the state is a static equilibrium.
    pub is_at_rest: bool,
}

/// Generates `count` random states with positions, speeds, spins, and penetrations that correspond to compressive
/// forces; some wheels are off their rails.
///
/// States with contacts in tension are rejected.
///
/// # Errors
/// [`Error::States`] where too few such states were found.
pub fn states(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    equilibria: &[CheckCase],
    count: usize,
) -> Result<Vec<CheckCase>, Error> {
    let scene = with_given_rates(plan);
    let mut random = Random::new(1);
    let scales = Scales::of(plan);
    let mut out = Vec::with_capacity(count);
    let mut last = None;
    let (mut often, mut least) = (vec![0; plan.wheels.len()], 0);
    for attempt in 0..TRIES * count {
        if out.len() >= count && (least >= LOADED.min(count / 20) || out.len() >= MORE * count) {
            break;
        }
        let Some(mut instant) = scales.instant(plan, &mut random) else {
            continue;
        };
        if attempt % 2 == 1 {
            scales.displace(plan, equilibria, &mut instant, &mut random);
        }
        match complete(plan, &scene, foundations, instant) {
            Ok(Some(case)) => {
                for (number, force) in often.iter_mut().zip(&case.forces.vertical) {
                    *number += usize::from(*force > 0.0);
                }
                least = often.iter().copied().min().unwrap_or(0);
                out.push(case);
            }
            Ok(None) => {}
            Err(error) => last = Some(error),
        }
    }
    if out.len() as f64 >= ENOUGH * count as f64 {
        return Ok(out);
    }
    Err(Error::States {
        found: out.len(),
        count,
        last,
    })
}

/// Rates of penetrations that are states, relative to the speeds at which their wheels fall: rails move too, and each of them
/// in another way. None is 1, so that a rate is not mistaken for a speed, nor for the rate of the next contact.
const SHARES: [f64; 5] = [0.5, 1.4, 0.7, 1.8, 0.3];

/// The rate of the penetration of contact `c` relative to the speed at which its wheels fall.
fn share(c: usize) -> f64 {
    SHARES[c % SHARES.len()]
}

/// The scene with dampers between hubs and ground in place of those between wheels and flexible rails, so that penetration
/// and force follow together from a given rate. Forces are proportional to damping times rate: dampers are larger or smaller
/// by the ratio of rate and speed.
fn with_given_rates(plan: &DeckPlan<'_>) -> Scene {
    let mut scene = plan.input.scene.clone();
    for (c, contact) in plan.contacts.iter().enumerate() {
        let mut kind = scene.wheels[scene.contacts[c].wheel].clone();
        if contact.diff.is_some() {
            kind.normal.damping *= share(c);
        }
        kind.normal.damper = Damper::Ground;
        scene.contacts[c].wheel = scene.wheels.len();
        scene.wheels.push(kind);
    }
    scene
}

/// Adds the contact forces to a state, and the penetrations that are state variables; `None` if the state is rejected.
fn complete(
    plan: &DeckPlan<'_>,
    scene: &Scene,
    foundations: &[Foundation],
    mut instant: Instant,
) -> Result<Option<CheckCase>, sim::Error> {
    let forces = contact_forces(scene, foundations, std::slice::from_ref(&instant))?.swap_remove(0);
    let mut rate = vec![0.0; plan.contacts.len()];
    for (c, contact) in plan.contacts.iter().enumerate() {
        let law = &plan.kind(contact.wheels.start).normal;
        let (force, p) = (forces.vertical[contact.wheels.start], forces.penetration[c]);
        if !law.bilateral && (force < 0.0 || (force > 0.0 && p <= 0.0)) {
            return Ok(None);
        }
        if contact.diff.is_some() && (law.bilateral || p > 0.0) {
            instant.penetration[c] = Some(p);
            rate[c] = share(c) * fall(plan, &instant, c);
        }
    }
    Ok(Some(CheckCase {
        instant,
        forces,
        rate,
        is_at_rest: false,
    }))
}

/// Number of states in which each wheel has a vertical force.
pub fn loaded(cases: &[CheckCase]) -> Vec<usize> {
    let wheels = cases.first().map_or(0, |case| case.forces.vertical.len());
    let of = |w: usize| {
        let own = cases.iter().filter(|case| case.forces.vertical[w] > 0.0);
        own.count()
    };
    (0..wheels).map(of).collect()
}

/// Mean speed at which the wheels of contact `c` fall.
pub fn fall(plan: &DeckPlan<'_>, instant: &Instant, c: usize) -> f64 {
    let wheels = plan.contacts[c].wheels.clone();
    let count = wheels.len() as f64;
    let of = |w: usize| {
        let [_, y, _, roll, _, pitch] = instant.speed[plan.wheels[w].body];
        let [hx, _, hz] = plan.wheels[w].hub;
        -(y + pitch * hx - roll * hz)
    };
    wheels.map(of).sum::<f64>() / count
}

/// Magnitudes of displacements and speeds of each body in random states.
struct Scales {
    /// Approach of wheel and rail under the weight of the body.
    sink: Vec<f64>,
    /// Largest penetration of a wheel under its share of the weight.
    depth: Vec<f64>,
    /// Half the wheel base and half the gauge.
    arms: Vec<[f64; 2]>,
    /// Lateral displacement.
    side: Vec<f64>,
    /// Vertical and sliding speeds.
    speed: Vec<[f64; 2]>,
    /// Range of x in which every wheel is on its rail.
    range: Vec<[f64; 2]>,
}

impl Scales {
    fn of(plan: &DeckPlan<'_>) -> Scales {
        let mut out = Scales {
            sink: vec![],
            depth: vec![],
            arms: vec![],
            side: vec![],
            speed: vec![],
            range: vec![],
        };
        for (b, body) in plan.input.scene.bodies.iter().enumerate() {
            let own: Vec<usize> = (0..plan.wheels.len())
                .filter(|&w| plan.wheels[w].body == b)
                .collect();
            let weight = body.mass * plan.input.scene.gravity.max(f64::MIN_POSITIVE);
            let of_wheel = weight / own.len().max(1) as f64;
            let largest =
                |of: &dyn Fn(usize) -> f64| own.iter().map(|&w| of(w)).fold(0.0, f64::max);
            let sink = largest(&|w| {
                plan.kind(w).normal.penetration(of_wheel) + plan.start.deflection[w].abs()
            });
            let damped = |w: usize| {
                let law = &plan.kind(w).normal;
                if law.damping > 0.0 {
                    law.stiffness * sink.powf(law.exponent) / law.damping
                } else {
                    0.0
                }
            };
            out.sink.push(sink);
            out.depth
                .push(largest(&|w| plan.kind(w).normal.penetration(of_wheel)));
            out.arms.push([
                largest(&|w| plan.wheels[w].hub[0].abs()),
                largest(&|w| plan.wheels[w].hub[2].abs()),
            ]);
            out.side.push(largest(&|w| {
                plan.kind(w)
                    .flange
                    .as_ref()
                    .map_or(0.0, |f| 2.0 * f.clearance + sink)
            }));
            let slip = largest(&|w| plan.kind(w).friction.as_ref().map_or(0.0, |f| f.slip));
            let fall = DAMPED * largest(&damped);
            out.speed.push([
                if fall > 0.0 { fall } else { DEFAULT_SPEED },
                if slip > 0.0 { slip } else { DEFAULT_SPEED },
            ]);
            let range = own
                .iter()
                .fold([f64::NEG_INFINITY, f64::INFINITY], |range, &w| {
                    let rail = plan.scene.rails[plan.datums[plan.wheels[w].datum].rail].range;
                    let margin = MARGIN * (rail[1] - rail[0]);
                    let x = plan.wheels[w].hub[0];
                    [
                        range[0].max(rail[0] + margin - x),
                        range[1].min(rail[1] - margin - x),
                    ]
                });
            out.range.push(range);
        }
        out
    }

    /// Moves the bodies of a state to a static equilibrium, displaced by about a penetration of their wheels. Bodies
    /// that move along their rails keep their time and place where there is no equilibrium.
    fn displace(
        &self,
        plan: &DeckPlan<'_>,
        equilibria: &[CheckCase],
        instant: &mut Instant,
        random: &mut Random,
    ) {
        let Some(last) = equilibria.len().checked_sub(1) else {
            return;
        };
        let index = (random.between(0.0, 1.0) * (last as f64 + 1.0)) as usize;
        let base = &equilibria[index.min(last)].instant;
        instant.time = base.time;
        for (b, body) in plan.input.scene.bodies.iter().enumerate() {
            let [length, width] = self.arms[b];
            let depth = self.depth[b];
            let turn = depth / length.max(width).max(depth);
            let sizes = [0.0, depth, depth, turn, turn, turn];
            let own = &mut instant.displacement[b];
            *own = base.displacement[b];
            for k in (1..6).filter(|&k| body.free[k]) {
                own[k] += random.around(sizes[k]);
                // dampers and springs have forces of the same size
                instant.speed[b][k] *= depth / self.sink[b].max(f64::MIN_POSITIVE);
            }
            if let BodyMotion::Prescribed(profile) = &plan.scene.bodies[b].motion {
                instant.speed[b][0] = profile.at(base.time).v;
            }
        }
    }

    /// A random state without penetrations; `None` if a wheel would be beyond its rail.
    fn instant(&self, plan: &DeckPlan<'_>, random: &mut Random) -> Option<Instant> {
        let scene = &plan.input.scene;
        let time = random.between(0.0, scene.end);
        let (mut displacement, mut speed) = (Vec::new(), Vec::new());
        for (b, body) in scene.bodies.iter().enumerate() {
            let [length, width] = self.arms[b];
            let sink = self.sink[b];
            let rotation = |arm: f64| {
                if arm > 0.0 {
                    (sink / arm).min(MAX_ROTATION)
                } else {
                    MAX_ROTATION
                }
            };
            let [fall, slide] = self.speed[b];
            let size = [
                0.0,
                0.0,
                self.side[b],
                rotation(width),
                rotation(length),
                rotation(length),
            ];
            let rate = [5.0 * slide, fall, fall, fall, fall, fall];
            let mut own = body.start;
            let mut rates = [0.0; 6];
            for k in 0..6 {
                let (shift, pace) = match k {
                    0 => (
                        random.between(self.range[b][0], self.range[b][1]),
                        random.around(rate[0]),
                    ),
                    1 => (
                        random.between(-1.5 * sink, 0.3 * sink),
                        random.around(rate[1]),
                    ),
                    3 | 5 => (
                        random.around(size[k]),
                        random.around(rate[k] / length.max(width).max(1.0)),
                    ),
                    4 => {
                        let yaw = if length > 0.0 {
                            (self.side[b] / length).min(MAX_ROTATION)
                        } else {
                            MAX_ROTATION
                        };
                        (random.around(yaw), random.around(rate[k] / length.max(1.0)))
                    }
                    _ => (random.around(size[k]), random.around(rate[k])),
                };
                if body.free[k] {
                    (own[k], rates[k]) = (shift, pace);
                }
            }
            if let BodyMotion::Prescribed(profile) = &plan.scene.bodies[b].motion {
                let at = profile.at(time);
                (own[0], rates[0]) = (at.x, at.v);
            }
            displacement.push(own);
            speed.push(rates);
        }
        let mut spin = Vec::new();
        for (w, wheel) in plan.wheels.iter().enumerate() {
            let [x, _, _, _, yaw, pitch] = displacement[wheel.body];
            let [hx, hy, hz] = wheel.hub;
            let place = x + hx + yaw * hz - pitch * hy;
            let [first, last] = plan.scene.rails[plan.datums[wheel.datum].rail].range;
            if !(place >= first && place <= last) {
                return None;
            }
            let radius = plan.kind(w).radius;
            let slide = 2.0 * self.speed[wheel.body][1];
            spin.push(if wheel.spin.is_some() {
                (random.around(slide) - speed[wheel.body][0]) / radius
            } else {
                0.0
            });
        }
        let penetration = vec![None; plan.contacts.len()];
        Some(Instant {
            time,
            displacement,
            speed,
            spin,
            penetration,
        })
    }
}
