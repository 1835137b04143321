//! Random states of a scene, with the simulator's contact forces at them.
//!
//! Each state is drawn in three steps. Positions, speeds and spins are random within the [`Scales`] of the scene. The
//! contact forces with all springs and dampers in equilibrium are computed from the simulator. For contacts whose
//! penetration is a state of its own (a damper on a flexible rail), penetrations are then found that belong to the force of
//! the spring and a random rate of the damper, p + G F(p, p') = e, by Newton's method ([`penetrations`]). States whose
//! forces the deck cannot determine are rejected, up to [`TRIES`] times the number asked for.

use nalgebra::{DMatrix, DVector};
use sim::{ContactForces, Foundation, Instant, contact_forces};

use super::random::Random;
use crate::DeckPlan;
use crate::Error;
use formats::scene::BodyMotion;

/// Largest ratio of the force that the simulator finds at a penetration to the force from which the penetration was
/// computed: where wheels are close, forces are ill conditioned by penetrations.
const LARGER: f64 = 3.0;
/// Penetration, relative to the approach, up to which a contact counts as open.
const OFF: f64 = 1e-9;
/// Newton iterations for the penetrations of a state.
const ITERATIONS: usize = 40;
/// Largest force of a damper at full ramp, relative to that of its spring.
const DAMPER: f64 = 0.6;
/// Most states drawn for each state asked for.
const TRIES: usize = 50;
/// Least fraction of the full damping at which the rate of a contact is computed from its force.
const RAMP: f64 = 0.6;
/// Least fraction of the spring's force that must remain beside its damper's.
const CANCELLED: f64 = 1e-2;
/// Largest rotation, radians.
const TURN: f64 = 0.02;
/// Length at each end of a rail without wheels, as a fraction of its length, where the body's position is free.
const MARGIN: f64 = 0.01;
/// Speed where nothing in the scene has a scale of speed, in length units of the scene per second.
const SPEED: f64 = 1.0;

/// A state and its contact forces.
#[derive(Clone, Debug)]
pub struct CheckCase {
    /// The state; penetrations are those of active contacts.
    pub instant: Instant,
    /// The simulator's forces.
    pub forces: ContactForces,
    /// Rate of penetration of each contact; zero where the penetration is no state, or the contact is open.
    pub rate: Vec<f64>,
}

/// `count` random states: positions, speeds, spins, and penetrations that belong to compressive forces; some wheels are off
/// their rails.
///
/// Rejected are states whose forces the deck cannot determine: contacts in tension, dampers that hold a wheel down while it
/// is off its rail, rates at the beginning of a damper's ramp, and springs and dampers whose forces cancel.
///
/// # Errors
/// [`Error::States`] where too few such states were found.
pub fn states(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    count: usize,
) -> Result<Vec<CheckCase>, Error> {
    let mut random = Random::new(1);
    let scales = Scales::of(plan);
    let mut out = Vec::with_capacity(count);
    let mut last = None;
    for _ in 0..TRIES * count {
        if out.len() == count {
            break;
        }
        let Some(instant) = scales.instant(plan, &mut random) else { continue };
        match complete(plan, foundations, instant, &mut random) {
            Ok(Some(case)) => out.push(case),
            Ok(None) => {}
            Err(error) => last = Some(error),
        }
    }
    if out.len() == count {
        return Ok(out);
    }
    Err(Error::States { found: out.len(), count, last })
}

/// The state with penetrations of those contacts that have them as states, and its forces; `None` where it is rejected.
fn complete(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    mut instant: Instant,
    random: &mut Random,
) -> Result<Option<CheckCase>, sim::Error> {
    let scene = &plan.input.scene;
    let one = |instant: &Instant| {
        contact_forces(scene, foundations, std::slice::from_ref(instant)).map(|mut all| all.swap_remove(0))
    };
    let open = one(&instant)?;
    let mut most = vec![f64::INFINITY; plan.contacts.len()];
    for (c, penetration, force) in penetrations(plan, &open, random) {
        instant.penetration[c] = Some(penetration);
        most[c] = LARGER * force;
    }
    let forces = one(&instant)?;
    let fits = (0..plan.contacts.len()).all(|c| {
        let contact = &plan.contacts[c];
        let law = &plan.kind(contact.wheels.start).normal;
        let (force, p) = (forces.vertical[contact.wheels.start], forces.penetration[c]);
        let acts = contact.diff.is_none() || instant.penetration[c].is_some();
        if contact.diff.is_some() && instant.penetration[c].is_some() {
            let point = law.at(p, 0.0);
            if point.by_rate < RAMP * law.damping || force < CANCELLED * point.force || force > most[c] {
                return false;
            }
        }
        law.bilateral || (force >= 0.0 && (force == 0.0 || p > 0.0) && (acts || p <= 0.0))
    });
    let rate = (0..plan.contacts.len()).map(|c| rate(plan, &instant, &forces, c)).collect();
    Ok(fits.then_some(CheckCase { instant, forces, rate }))
}

/// Contact, penetration and force of those contacts that have their penetration as a state and are closed.
///
/// Unknowns: penetrations p of the active contacts. Equation: p + G F(p, p') = e, with the approach e of wheel and rail
/// without forces, the compliance G of the rail and the law F of spring and damper. Newton's method is damped so that p
/// falls by no more than a factor of ten in an iteration. Contacts that open are taken out, and the rest is solved again.
/// First the rates p' are zero; then each is drawn so that the damper has up to [`DAMPER`] of its spring's force.
fn penetrations(plan: &DeckPlan<'_>, open: &ContactForces, random: &mut Random) -> Vec<(usize, f64, f64)> {
    let law = |c: usize| &plan.kind(plan.contacts[c].wheels.start).normal;
    let approach = |c: usize| open.penetration[c];
    let mut active: Vec<usize> =
        (0..plan.contacts.len()).filter(|&c| plan.contacts[c].diff.is_some() && approach(c) > 0.0).collect();
    let mut rate = vec![0.0; plan.contacts.len()];
    let mut found = Vec::new();
    for damped in [false, true] {
        while !active.is_empty() {
            let mut p = DVector::from_iterator(active.len(), active.iter().map(|&c| approach(c)));
            for _ in 0..ITERATIONS {
                let point = |i: usize| law(active[i]).at(p[i], rate[active[i]]);
                let count = |i: usize| plan.contacts[active[i]].wheels.len() as f64;
                let compliance = |r: usize, i: usize| open.compliance[(active[r], active[i])] * count(i);
                let size = active.len();
                let residual = DVector::from_fn(size, |r, _| {
                    p[r] - approach(active[r])
                        + (0..size).map(|i| compliance(r, i) * point(i).force).sum::<f64>()
                });
                let matrix = DMatrix::from_fn(size, size, |r, i| {
                    f64::from(u8::from(r == i)) + compliance(r, i) * point(i).by_penetration
                });
                let Some(step) = matrix.lu().solve(&residual) else { break };
                // a law with an exponent has no force and no slope at p <= 0, where Newton's method would stop
                p = DVector::from_fn(size, |i, _| (p[i] - step[i]).max(0.1 * p[i]));
            }
            found = active.iter().copied().zip(p.iter().copied()).collect();
            // a penetration that was reduced in every iteration is that of an open contact
            let is_closed =
                |(c, p): &(usize, f64)| *p > OFF * approach(*c) && law(*c).at(*p, rate[*c]).force > 0.0;
            let before = active.len();
            found.retain(is_closed);
            active = found.iter().map(|(c, _)| *c).collect();
            if active.len() == before {
                break;
            }
        }
        if !damped {
            for (c, p) in &found {
                rate[*c] = random.around(DAMPER) * law(*c).at(*p, 0.0).force / law(*c).damping;
            }
        }
    }
    found.into_iter().map(|(c, p)| (c, p, law(c).at(p, rate[c]).force)).collect()
}

/// Rate of penetration of contact `c` at its force and penetration.
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
    /// Approach of wheel and rail under the body's weight.
    sink: Vec<f64>,
    /// Half the wheel base and half the gauge.
    reach: Vec<[f64; 2]>,
    /// Lateral displacement.
    side: Vec<f64>,
    /// Vertical and sliding speeds.
    speed: Vec<[f64; 2]>,
    /// Range of x in which every wheel is on its rail.
    range: Vec<[f64; 2]>,
}

impl Scales {
    fn of(plan: &DeckPlan<'_>) -> Scales {
        let mut out = Scales { sink: vec![], reach: vec![], side: vec![], speed: vec![], range: vec![] };
        for (b, body) in plan.input.scene.bodies.iter().enumerate() {
            let own: Vec<usize> = (0..plan.wheels.len()).filter(|&w| plan.wheels[w].body == b).collect();
            let weight = body.mass * plan.input.scene.gravity.max(f64::MIN_POSITIVE);
            let of_wheel = weight / own.len().max(1) as f64;
            let largest = |of: &dyn Fn(usize) -> f64| own.iter().map(|&w| of(w)).fold(0.0, f64::max);
            let sink =
                largest(&|w| plan.kind(w).normal.penetration(of_wheel) + plan.start.deflection[w].abs());
            let damped = |w: usize| {
                let law = &plan.kind(w).normal;
                if law.damping > 0.0 { law.stiffness * sink.powf(law.exponent) / law.damping } else { 0.0 }
            };
            out.sink.push(sink);
            out.reach
                .push([largest(&|w| plan.wheels[w].hub[0].abs()), largest(&|w| plan.wheels[w].hub[2].abs())]);
            out.side
                .push(largest(&|w| plan.kind(w).flange.as_ref().map_or(0.0, |f| 2.0 * f.clearance + sink)));
            let slip = largest(&|w| plan.kind(w).friction.as_ref().map_or(0.0, |f| f.slip));
            let fall = largest(&damped);
            out.speed.push([if fall > 0.0 { fall } else { SPEED }, if slip > 0.0 { slip } else { SPEED }]);
            let range = own.iter().fold([f64::NEG_INFINITY, f64::INFINITY], |range, &w| {
                let rail = plan.scene.rails[plan.datums[plan.wheels[w].datum].rail].range;
                let margin = MARGIN * (rail[1] - rail[0]);
                let x = plan.wheels[w].hub[0];
                [range[0].max(rail[0] + margin - x), range[1].min(rail[1] - margin - x)]
            });
            out.range.push(range);
        }
        out
    }

    /// A random state without penetrations; `None` where a wheel would be beyond its rail.
    fn instant(&self, plan: &DeckPlan<'_>, random: &mut Random) -> Option<Instant> {
        let scene = &plan.input.scene;
        let time = random.between(0.0, scene.end);
        let (mut displacement, mut speed) = (Vec::new(), Vec::new());
        for (b, body) in scene.bodies.iter().enumerate() {
            let [length, width] = self.reach[b];
            let sink = self.sink[b];
            let turn = |reach: f64| if reach > 0.0 { (sink / reach).min(TURN) } else { TURN };
            let [fall, slide] = self.speed[b];
            let size = [0.0, 0.0, self.side[b], turn(width), turn(length), turn(length)];
            let rate = [5.0 * slide, fall, fall, fall, fall, fall];
            let mut own = body.start;
            let mut rates = [0.0; 6];
            for k in 0..6 {
                let (shift, pace) = match k {
                    0 => (random.between(self.range[b][0], self.range[b][1]), random.around(rate[0])),
                    1 => (random.between(-1.5 * sink, 0.3 * sink), random.around(rate[1])),
                    3 | 5 => (random.around(size[k]), random.around(rate[k] / length.max(width).max(1.0))),
                    4 => {
                        let yaw = if length > 0.0 { (self.side[b] / length).min(TURN) } else { TURN };
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
        Some(Instant { time, displacement, speed, spin, penetration })
    }
}
