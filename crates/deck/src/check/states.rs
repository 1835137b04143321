//! Random states of a scene with the contact forces of the simulator.
//!
//! Each state is generated in three steps. Positions, speeds and spins are random within the [`Scales`] of the scene;
//! in every other state the positions are those of a static equilibrium, displaced by about a penetration, so that
//! stiff wheels on stiff rails touch them together.
//! The simulator computes the contact forces with all springs and dampers in equilibrium. For contacts whose
//! penetration is a state variable (a damper on a flexible rail), the penetrations are then solved from p + G F(p,
//! p') = e with random rates p' by Newton's method ([`penetrations`]). States whose forces the deck cannot determine
//! are rejected; at most [`TRIES`] times the requested number of states are generated.

use nalgebra::{DMatrix, DVector};
use sim::{ContactForces, Foundation, Instant, contact_forces};

use super::random::Random;
use crate::DeckPlan;
use crate::Error;
use formats::scene::BodyMotion;

/// Largest ratio of the force that the simulator computes from a penetration to the force from which the penetration
/// was computed. Where wheels are close to each other, the forces are ill conditioned functions of the penetrations.
const MAX_FORCE_RATIO: f64 = 3.0;
/// Penetration, relative to the approach, up to which a contact is treated as open.
const OPEN: f64 = 1e-9;
/// Number of Newton iterations for the penetrations of a state.
const ITERATIONS: usize = 40;
/// Largest force of a damper outside its ramp, relative to that of its spring.
const DAMPER_FORCE: f64 = 0.6;
/// Largest number of generated states per requested state.
const TRIES: usize = 50;
/// Smallest fraction of the full damping at which the rate of a contact is computed from its force.
const MIN_RAMP: f64 = 0.6;
/// Smallest accepted sum of the forces of spring and damper, as a fraction of the force of the spring.
const MIN_FORCE: f64 = 1e-2;
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
}

/// Generates `count` random states with positions, speeds, spins, and penetrations that correspond to compressive
/// forces; some wheels are off their rails.
///
/// States whose forces the deck cannot determine are rejected: contacts in tension, dampers that act on a wheel that
/// is off its rail, rates at the beginning of the ramp of a damper, and springs and dampers whose forces cancel.
///
/// # Errors
/// [`Error::States`] where too few such states were found.
pub fn states(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    equilibria: &[CheckCase],
    count: usize,
) -> Result<Vec<CheckCase>, Error> {
    let mut random = Random::new(1);
    let scales = Scales::of(plan);
    let mut out = Vec::with_capacity(count);
    let mut last = None;
    for attempt in 0..TRIES * count {
        if out.len() == count {
            break;
        }
        let Some(mut instant) = scales.instant(plan, &mut random) else {
            continue;
        };
        if attempt % 2 == 1 {
            scales.displace(plan, equilibria, &mut instant, &mut random);
        }
        match complete(plan, foundations, instant, &mut random) {
            Ok(Some(case)) => out.push(case),
            Ok(None) => {}
            Err(error) => last = Some(error),
        }
    }
    if out.len() == count {
        return Ok(out);
    }
    Err(Error::States {
        found: out.len(),
        count,
        last,
    })
}

/// Adds the penetrations that are state variables and the contact forces to a state; `None` if the state is rejected.
fn complete(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    mut instant: Instant,
    random: &mut Random,
) -> Result<Option<CheckCase>, sim::Error> {
    let scene = &plan.input.scene;
    let one = |instant: &Instant| {
        contact_forces(scene, foundations, std::slice::from_ref(instant))
            .map(|mut all| all.swap_remove(0))
    };
    let open = one(&instant)?;
    let mut most = vec![f64::INFINITY; plan.contacts.len()];
    for (c, penetration, force) in penetrations(plan, &open, random) {
        instant.penetration[c] = Some(penetration);
        most[c] = MAX_FORCE_RATIO * force.abs();
    }
    let forces = one(&instant)?;
    let fits = (0..plan.contacts.len()).all(|c| {
        let contact = &plan.contacts[c];
        let law = &plan.kind(contact.wheels.start).normal;
        let (force, p) = (forces.vertical[contact.wheels.start], forces.penetration[c]);
        let acts = contact.diff.is_none() || instant.penetration[c].is_some();
        if contact.diff.is_some() && instant.penetration[c].is_some() {
            let point = law.at(p, 0.0);
            let is_weak = !law.bilateral && force < MIN_FORCE * point.force;
            if point.by_rate < MIN_RAMP * law.damping || is_weak || force.abs() > most[c] {
                return false;
            }
        }
        law.bilateral || (force >= 0.0 && (force == 0.0 || p > 0.0) && (acts || p <= 0.0))
    });
    let rate = (0..plan.contacts.len())
        .map(|c| rate(plan, &instant, &forces, c))
        .collect();
    Ok(fits.then_some(CheckCase {
        instant,
        forces,
        rate,
    }))
}

/// Returns (contact, penetration, force) for each closed contact whose penetration is a state variable.
///
/// Bilateral contacts are always closed.
///
/// Unknowns: penetrations p of the active contacts. Equation: p + G F(p, p') = e, with the approach e of wheel and
/// rail without forces, the compliance G of the rail and the law F of spring and damper. Newton's method is damped so
/// that p decreases by at most a factor of ten in an iteration. Contacts that open are removed, and the remaining
/// system is solved again. The rates p' are zero in the first solution. In the second solution each rate is random,
/// with a damper force of at most the fraction [`DAMPER_FORCE`] of the spring force.
fn penetrations(
    plan: &DeckPlan<'_>,
    open: &ContactForces,
    random: &mut Random,
) -> Vec<(usize, f64, f64)> {
    let law = |c: usize| &plan.kind(plan.contacts[c].wheels.start).normal;
    // a bilateral contact is closed already: its penetration is not its approach
    let approach = |c: usize| {
        if law(c).bilateral {
            open.approach[c]
        } else {
            open.penetration[c]
        }
    };
    let mut active: Vec<usize> = (0..plan.contacts.len())
        .filter(|&c| plan.contacts[c].diff.is_some() && (law(c).bilateral || approach(c) > 0.0))
        .collect();
    let mut rate = vec![0.0; plan.contacts.len()];
    let mut found = Vec::new();
    for damped in [false, true] {
        while !active.is_empty() {
            let mut p = DVector::from_iterator(active.len(), active.iter().map(|&c| approach(c)));
            for _ in 0..ITERATIONS {
                let point = |i: usize| law(active[i]).at(p[i], rate[active[i]]);
                let count = |i: usize| plan.contacts[active[i]].wheels.len() as f64;
                let compliance =
                    |r: usize, i: usize| open.compliance[(active[r], active[i])] * count(i);
                let size = active.len();
                let residual = DVector::from_fn(size, |r, _| {
                    p[r] - approach(active[r])
                        + (0..size)
                            .map(|i| compliance(r, i) * point(i).force)
                            .sum::<f64>()
                });
                let matrix = DMatrix::from_fn(size, size, |r, i| {
                    f64::from(u8::from(r == i)) + compliance(r, i) * point(i).by_penetration
                });
                let Some(step) = matrix.lu().solve(&residual) else {
                    break;
                };
                // the force and the slope of a law with an exponent are zero at p <= 0, where Newton's method would
                // stop
                p = DVector::from_fn(size, |i, _| {
                    let next = p[i] - step[i];
                    if law(active[i]).bilateral {
                        next
                    } else {
                        next.max(0.1 * p[i])
                    }
                });
            }
            found = active.iter().copied().zip(p.iter().copied()).collect();
            // a contact is open if its penetration was reduced in every iteration
            let is_closed = |(c, p): &(usize, f64)| {
                law(*c).bilateral
                    || (*p > OPEN * approach(*c) && law(*c).at(*p, rate[*c]).force > 0.0)
            };
            let before = active.len();
            found.retain(is_closed);
            active = found.iter().map(|(c, _)| *c).collect();
            if active.len() == before {
                break;
            }
        }
        if !damped {
            for (c, p) in &found {
                rate[*c] =
                    random.around(DAMPER_FORCE) * law(*c).at(*p, 0.0).force / law(*c).damping;
            }
        }
    }
    found
        .into_iter()
        .map(|(c, p)| (c, p, law(c).at(p, rate[c]).force))
        .collect()
}

/// Rate of penetration of contact `c` that corresponds to its force and penetration.
fn rate(plan: &DeckPlan<'_>, instant: &Instant, forces: &ContactForces, c: usize) -> f64 {
    let contact = &plan.contacts[c];
    let law = &plan.kind(contact.wheels.start).normal;
    let point = law.at(forces.penetration[c], 0.0);
    if contact.diff.is_none() || instant.penetration[c].is_none() || point.by_rate == 0.0 {
        return 0.0;
    }
    (forces.vertical[contact.wheels.start] - point.force) / point.by_rate
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
            let fall = largest(&damped);
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
