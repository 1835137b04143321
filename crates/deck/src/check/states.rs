//! Random states of a scene, with the simulator's contact forces there.

use nalgebra::{DMatrix, DVector};
use sim::{ContactForces, Foundation, Instant, contact_forces};

use super::random::Random;
use crate::DeckPlan;
use crate::Error;
use formats::scene::Along;

/// Largest force that the simulator may find at a penetration, of the force that it was made from: where wheels are
/// close, penetrations hardly fix forces.
const LARGER: f64 = 3.0;
/// Penetration of a contact that has come off, of its approach.
const OFF: f64 = 1e-9;
/// Newton iterations for the penetrations of a state.
const ITERATIONS: usize = 40;
/// Largest force of a damper at full ramp, of its spring's.
const DAMPER: f64 = 0.6;
/// Tries for each state asked for, before the scene counts as one that has none.
const TRIES: usize = 50;
/// Least share of the damping of a contact whose rate is found from its force.
const RAMP: f64 = 0.6;
/// Least share of the spring's force that its damper leaves.
const CANCELLED: f64 = 1e-2;
/// Largest rotation, radians.
const TURN: f64 = 0.02;
/// Share of a rail's length at its ends where no wheel is put, where the body's place can be chosen.
const MARGIN: f64 = 0.01;
/// Speeds where nothing else says how fast, in lengths of the scene a second.
const SPEED: f64 = 1.0;

/// A state and what acts there.
#[derive(Clone, Debug)]
pub struct CheckCase {
    /// The state; penetrations are those of contacts that act.
    pub instant: Instant,
    /// The simulator's forces.
    pub forces: ContactForces,
    /// Rate of penetration, a contact; zero where it is no state or open.
    pub rate: Vec<f64>,
}

/// `count` random states: places, displacements, speeds, spins, and penetrations that belong to pressing forces;
/// some wheels are off their rails.
///
/// Left out are states whose forces are not the deck's to find: contacts that pull, dampers that hold a wheel down
/// while it is off the rail, rates that a damper at the foot of its ramp would need, and springs and dampers that cancel.
///
/// # Errors
/// A scene the simulator refuses, or without such states.
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
        match settle(plan, foundations, instant, &mut random) {
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

/// Gives penetrations to the contacts that keep them, and finds the forces.
fn settle(
    plan: &DeckPlan<'_>,
    foundations: &[Foundation],
    mut instant: Instant,
    random: &mut Random,
) -> Result<Option<CheckCase>, sim::Error> {
    let scene = &plan.cast.scene;
    let one = |instant: &Instant| {
        contact_forces(scene, foundations, std::slice::from_ref(instant)).map(|mut all| all.swap_remove(0))
    };
    let open = one(&instant)?;
    let mut most = vec![f64::INFINITY; plan.contacts.len()];
    for (c, penetration, force) in plant(plan, &open, random) {
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

/// Penetrations and forces of the contacts that keep them and press: those of springs, with dampers of random rates beside them,
/// in balance with the rail's give; Newton's method on p + G F(p, p') = e.
fn plant(plan: &DeckPlan<'_>, open: &ContactForces, random: &mut Random) -> Vec<(usize, f64, f64)> {
    let law = |c: usize| &plan.kind(plan.contacts[c].wheels.start).normal;
    let reach = |c: usize| open.penetration[c];
    let mut active: Vec<usize> =
        (0..plan.contacts.len()).filter(|&c| plan.contacts[c].diff.is_some() && reach(c) > 0.0).collect();
    let mut rate = vec![0.0; plan.contacts.len()];
    let mut found = Vec::new();
    for damped in [false, true] {
        while !active.is_empty() {
            let mut p = DVector::from_iterator(active.len(), active.iter().map(|&c| reach(c)));
            for _ in 0..ITERATIONS {
                let point = |i: usize| law(active[i]).at(p[i], rate[active[i]]);
                let count = |i: usize| plan.contacts[active[i]].wheels.len() as f64;
                let give = |r: usize, i: usize| open.compliance[(active[r], active[i])] * count(i);
                let size = active.len();
                let left = DVector::from_fn(size, |r, _| {
                    p[r] - reach(active[r]) + (0..size).map(|i| give(r, i) * point(i).force).sum::<f64>()
                });
                let matrix = DMatrix::from_fn(size, size, |r, i| {
                    f64::from(u8::from(r == i)) + give(r, i) * point(i).by_penetration
                });
                let Some(step) = matrix.lu().solve(&left) else { break };
                // a curved law must not be left on the side where it ends
                p = DVector::from_fn(size, |i, _| (p[i] - step[i]).max(0.1 * p[i]));
            }
            found = active.iter().copied().zip(p.iter().copied()).collect();
            // one that shrank in every iteration has come off
            let presses =
                |(c, p): &(usize, f64)| *p > OFF * reach(*c) && law(*c).at(*p, rate[*c]).force > 0.0;
            let before = active.len();
            found.retain(presses);
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

/// The rate that goes with the force and penetration of contact `c`.
fn rate(plan: &DeckPlan<'_>, instant: &Instant, forces: &ContactForces, c: usize) -> f64 {
    let contact = &plan.contacts[c];
    let law = &plan.kind(contact.wheels.start).normal;
    let point = law.at(forces.penetration[c], 0.0);
    if contact.diff.is_none() || instant.penetration[c].is_none() || point.by_rate == 0.0 {
        return 0.0;
    }
    (forces.vertical[contact.wheels.start] - point.force) / point.by_rate
}

/// How far and fast bodies move in random states.
struct Scales {
    /// Approach of wheels, a body.
    sink: Vec<f64>,
    /// Half the wheel base and half the gauge, a body.
    reach: Vec<[f64; 2]>,
    /// Lateral displacement, a body.
    side: Vec<f64>,
    /// Vertical and sliding speeds, a body.
    speed: Vec<[f64; 2]>,
    /// Range of x in which every wheel is on its rail, a body.
    range: Vec<[f64; 2]>,
}

impl Scales {
    fn of(plan: &DeckPlan<'_>) -> Scales {
        let mut out = Scales { sink: vec![], reach: vec![], side: vec![], speed: vec![], range: vec![] };
        for (b, body) in plan.cast.scene.bodies.iter().enumerate() {
            let own: Vec<usize> = (0..plan.wheels.len()).filter(|&w| plan.wheels[w].body == b).collect();
            let weight = body.mass * plan.cast.scene.gravity.max(f64::MIN_POSITIVE);
            let share = weight / own.len().max(1) as f64;
            let largest = |of: &dyn Fn(usize) -> f64| own.iter().map(|&w| of(w)).fold(0.0, f64::max);
            let sink = largest(&|w| plan.kind(w).normal.penetration(share) + plan.start.give[w].abs());
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

    /// A state; `None` where a wheel would be off its rail.
    fn instant(&self, plan: &DeckPlan<'_>, random: &mut Random) -> Option<Instant> {
        let scene = &plan.cast.scene;
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
            if let Along::Prescribed(profile) = &plan.scene.bodies[b].motion {
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
