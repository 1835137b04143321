//! The energy audit: what is stored, what was lost, what was put in.

use crate::contact::actuator::PullLaw;
use crate::contact::drag::slip;
use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::coupling::kinetic;
use crate::mechanics::state::State;
use crate::numerics::dense::{along, dot};
use crate::numerics::step::step_integral;
use crate::scene::dof::arm_rows;
use crate::scene::wheel::Damper;

/// Energy stored in a scene at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stored {
    /// Kinetic energy of bodies, wheels and structures.
    pub kinetic: f64,
    /// Potential energy of weight, zero where every body touches the unloaded rail.
    pub gravity: f64,
    /// Elastic energy between wheel and rail, flanges included.
    pub contact: f64,
    /// Elastic energy of the structures.
    pub structure: f64,
    /// Elastic energy of ropes and stops.
    pub ropes: f64,
}

impl Stored {
    /// Sum of all.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.gravity + self.contact + self.structure + self.ropes
    }
}

/// Energy lost and put in since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exchanged {
    /// Lost in the dampers of contacts, ropes and stops.
    pub dampers: f64,
    /// Lost in sliding, brakes included.
    pub friction: f64,
    /// Lost as flanges let go, and gained as they take hold.
    pub flanges: f64,
    /// Lost as the parts of a structure hand wheels over, one force a part.
    pub handover: f64,
    /// Lost in the structures' damping.
    pub structure: f64,
    /// Lost where a contact opens or closes with a jump of its force.
    pub switches: f64,
    /// Put in by prescribed motions and drives.
    pub drives: f64,
    /// Put in by loads.
    pub loads: f64,
    /// Put in by hoisting.
    pub hoists: f64,
    /// Put in where wheels meet steps of uneven rails; what their slopes do is in `drives`, or the body's own.
    pub steps: f64,
}

impl Exchanged {
    /// What left the scene, less what was put in.
    #[must_use]
    pub fn net_loss(&self) -> f64 {
        self.dampers + self.friction + self.flanges + self.handover + self.structure + self.switches
            - self.put_in()
    }

    /// Work put in by prescribed motions, drives, loads, hoisting and steps of rails.
    #[must_use]
    pub fn put_in(&self) -> f64 {
        self.drives + self.loads + self.hoists + self.steps
    }

    pub(crate) fn add(&mut self, power: &Exchanged, weight: f64) {
        self.dampers += weight * power.dampers;
        self.friction += weight * power.friction;
        self.flanges += weight * power.flanges;
        self.handover += weight * power.handover;
        self.structure += weight * power.structure;
        self.switches += weight * power.switches;
        self.drives += weight * power.drives;
        self.loads += weight * power.loads;
        self.hoists += weight * power.hoists;
        self.steps += weight * power.steps;
    }
}

/// Result of the audit of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Audit {
    /// Largest |stored + lost - put in - stored at the start| over the run, an energy.
    pub imbalance: f64,
    /// Peak elastic energy over the run, or, where there are ropes or stops, the kinetic one if that is larger: the
    /// scale of `residual`.
    pub peak_stored: f64,
    /// Everything exchanged until the end.
    pub exchanged: Exchanged,
    /// Stored at the start.
    pub start: Stored,
    /// Stored at the end.
    pub end: Stored,
}

impl Audit {
    /// Imbalance relative to the peak stored energy.
    #[must_use]
    pub fn residual(&self) -> f64 {
        if self.peak_stored > 0.0 { self.imbalance / self.peak_stored } else { self.imbalance }
    }
}

/// Energy stored at `state`; `geometry` must belong to it.
pub(crate) fn stored(system: &System, geometry: &Geometry, state: &State) -> Stored {
    let mut energy = Stored {
        kinetic: kinetic(&system.mechanics.blocks, &system.mechanics.couplings, &state.v),
        ..Stored::default()
    };
    energy.kinetic += system.mechanics.energy_of_turns(state.t);
    energy.structure = system.mechanics.blocks.iter().map(|block| block.elastic(state.q.as_slice())).sum();
    let [motion, lift] =
        system.mechanics.carried.energy(&system.mechanics.kinematics, state.t, &state.q, &state.v);
    energy.kinetic += motion;
    energy.gravity += lift;
    for (b, body) in system.scene.bodies.iter().enumerate().filter(|(b, _)| !system.mechanics.carried.has(*b))
    {
        let (displacement, speed) = system.mechanics.body(b, state.t, &state.q, &state.v);
        let lift = dot(&arm_rows(body.cg)[1], &displacement);
        energy.gravity += body.mass * system.scene.gravity * lift;
        if body.motion.is_some() {
            let (mass, drag) =
                (system.mechanics.kinematics.mass(b), system.mechanics.kinematics.travel_inertia(b));
            energy.kinetic += 0.5 * mass * speed[0] * speed[0];
            energy.kinetic +=
                drag.iter().map(|&(number, inertia)| inertia * speed[0] * state.v[number]).sum::<f64>();
        }
    }
    for mount in system.foundations.iter().filter_map(|foundation| foundation.on.as_ref()) {
        let (displacement, _) = system.mechanics.body(mount.body, state.t, &state.q, &state.v);
        energy.gravity += system.scene.gravity * dot(&mount.mass[1], &displacement);
    }
    for (i, normal) in system.mechanics.groups.iter().enumerate() {
        if state.force[i] != 0.0 {
            energy.contact += normal.count() * geometry.share[i][0] * system.law(i).energy(state.p[i]);
        }
        energy.structure += 0.5 * state.force[i] * along(&geometry.compliance, i, &state.force);
    }
    for (index, &w) in system.laterals.iter().enumerate() {
        let i = system.lateral(index);
        let give = along(&geometry.compliance, i, &state.force);
        energy.structure += 0.5 * state.force[i] * give;
        if let Some(flange) = &system.scene.wheels[system.mechanics.wheels[w].kind].flange {
            let overlap = flange.overlap(geometry.approach(i, &state.q) - give);
            energy.contact += 0.5 * flange.stiffness * flange.share(geometry.height[w]).0 * overlap * overlap;
        }
    }
    for i in system.drags() {
        energy.structure += 0.5 * state.force[i] * along(&geometry.compliance, i, &state.force);
    }
    for (index, hold) in geometry.links.iter().enumerate() {
        let i = system.link(index);
        if state.force[i] != 0.0 {
            let p = geometry.approach(i, &state.q);
            energy.ropes += 0.5 * hold.stiffness * p * p;
        }
    }
    energy
}

/// Rates of everything exchanged at `state`, less the boundary terms of [`boundary`].
pub(crate) fn power(system: &System, geometry: &Geometry, state: &State) -> Exchanged {
    let rate = |i: usize| geometry.rate(i, &state.v);
    let convective = |i: usize| {
        if system.is_uneven { geometry.rise[i] * system.contact_speed(i, state) } else { 0.0 }
    };
    let structure = system.mechanics.blocks.iter().map(|block| block.loss(state.v.as_slice())).sum();
    let mut power = Exchanged { structure, ..Exchanged::default() };
    for (i, normal) in system.mechanics.groups.iter().enumerate() {
        if state.force[i] == 0.0 {
            continue;
        }
        let law = system.law(i);
        let [share, share_slope] = geometry.share[i];
        let share_rate = if share_slope == 0.0 { 0.0 } else { share_slope * system.contact_speed(i, state) };
        power.handover -= normal.count() * share_rate * law.energy(state.p[i]);
        match law.damper {
            Damper::Rail => {
                power.dampers +=
                    (state.force[i] - normal.count() * share * law.spring(state.p[i])) * state.p_rate[i];
            }
            Damper::Ground => {
                let acceleration = along(&geometry.rate_rows, i, state.a.as_slice());
                power.dampers -= normal.count()
                    * law.damping
                    * (share * acceleration + share_rate * rate(i))
                    * step_integral(law.depth, state.p[i]);
            }
        }
    }
    for (index, &w) in system.laterals.iter().enumerate() {
        let i = system.lateral(index);
        let Some(flange) = &system.scene.wheels[system.mechanics.wheels[w].kind].flange else { continue };
        let (share, slope) = flange.share(geometry.height[w]);
        if share > 0.0 && slope != 0.0 && state.force[i] != 0.0 {
            let overlap = state.force[i] / (flange.stiffness * share);
            let climb =
                system.mechanics.groups_of(w).next().map_or(0.0, |normal| -rate(normal) - convective(normal));
            power.flanges -= 0.5 * flange.stiffness * overlap * overlap * slope * climb;
        }
    }
    for index in 0..system.tractions.len() {
        let i = system.traction(index);
        power.friction += state.force[i] * slip(system, geometry, state, i);
    }
    for (b, body) in system.scene.bodies.iter().enumerate() {
        if body.motion.is_some() {
            power.drives += drive_force(system, geometry, state, b) * geometry.travel[b].v;
        }
    }
    power.drives += power_of_turns(system, geometry, state);
    for (index, pull) in system.pulls.iter().enumerate() {
        let i = system.pull(index);
        match pull.law {
            PullLaw::Drive { .. } => {
                power.drives -= state.force[i] * (slip(system, geometry, state, i) - geometry.rate_held[i]);
            }
            PullLaw::Brake { .. } => power.friction += state.force[i] * slip(system, geometry, state, i),
        }
    }
    for (index, hold) in geometry.links.iter().enumerate() {
        let i = system.link(index);
        if state.force[i] == 0.0 {
            continue;
        }
        let p = geometry.approach(i, &state.q);
        power.dampers += hold.damping * rate(i) * rate(i);
        if hold.natural[1] != 0.0 {
            // EA p^2/(2 l0) also falls and grows with l0 itself.
            let share = 0.5 * hold.stiffness * p * p / hold.natural[0];
            power.hoists -= (state.force[i] + share) * hold.natural[1];
        }
    }
    for load in &system.scene.actuators.loads {
        if let Some(number) = system.mechanics.loaded(load) {
            power.loads += load.value.at(state.t) * state.v[number];
        }
    }
    power
}

/// Boundary term of the losses in dampers to ground: with d the wheel's displacement and S the damper's ramp,
/// integral of c S(p) d' dp = [c d' Q(p)] - integral of c d'' Q(p) dt, Q' = S.
pub(crate) fn boundary(system: &System, geometry: &Geometry, state: &State) -> f64 {
    let mut sum = 0.0;
    for (i, normal) in system.mechanics.groups.iter().enumerate() {
        let law = system.law(i);
        if law.is_grounded() && state.force[i] != 0.0 {
            sum += normal.count()
                * geometry.share[i][0]
                * law.damping
                * geometry.rate(i, &state.v)
                * step_integral(law.depth, state.p[i]);
        }
    }
    sum
}

/// Force along +x of the drive of body `b`, or that of its prescribed motion: its inertia and that of all that is
/// pinned to it, less what their wheels
/// get from the rail's slope and from friction.
pub(crate) fn drive_force(system: &System, geometry: &Geometry, state: &State, b: usize) -> f64 {
    let body = &system.scene.bodies[b];
    if body.motion.is_none() {
        return pull_force(system, state, b, |law| matches!(law, PullLaw::Drive { .. }));
    }
    let kinematics = &system.mechanics.kinematics;
    let mut force = kinematics.mass(b) * geometry.travel[b].a;
    force += system.mechanics.carried.drive(
        &system.mechanics.kinematics,
        [&state.q, &state.v, &state.a],
        state.t,
        b,
    );
    for &(number, inertia) in kinematics.travel_inertia(b) {
        force += inertia * state.a[number];
    }
    for (i, normal) in system.mechanics.groups.iter().enumerate() {
        if kinematics.root(system.scene.contacts[normal.contact].body) == b {
            force -= geometry.rail_slope[i] * state.force[i];
        }
    }
    for (index, &w) in system.laterals.iter().enumerate() {
        if kinematics.root(system.mechanics.wheels[w].body) == b {
            force -= geometry.rail_slope[system.lateral(index)] * state.force[system.lateral(index)];
        }
    }
    for (index, &w) in system.tractions.iter().enumerate() {
        if kinematics.root(system.mechanics.wheels[w].body) == b {
            force += state.force[system.traction(index)];
        }
    }
    for (index, (link, hold)) in system.links.iter().zip(&geometry.links).enumerate() {
        let by_travel = link.by_travel(&system.mechanics, b, (state.t, &state.q), hold.direction);
        force += by_travel * state.force[system.link(index)];
    }
    force
}

/// Force along +x of the brakes of body `b`.
pub(crate) fn brake_force(system: &System, state: &State, b: usize) -> f64 {
    pull_force(system, state, b, |law| matches!(law, PullLaw::Brake { .. }))
}

fn pull_force(system: &System, state: &State, b: usize, is_of: impl Fn(&PullLaw) -> bool) -> f64 {
    let pulls = system.pulls.iter().enumerate().filter(|(_, pull)| pull.body == b && is_of(&pull.law));
    pulls.map(|(index, _)| 0.0 - state.force[system.pull(index)]).sum()
}

/// Power of the moments that prescribe spins.
fn power_of_turns(system: &System, geometry: &Geometry, state: &State) -> f64 {
    let mechanics = &system.mechanics;
    let all = (0..mechanics.wheels.len()).filter_map(|w| Some((w, mechanics.turn(w, state.t)?)));
    all.map(|(w, at)| spin_moment(system, geometry, state, w) * at.v).sum()
}

/// Moment about z that prescribes the spin of wheel `w`: I times its acceleration and the friction below it; zero where
/// the spin is free.
pub(crate) fn spin_moment(system: &System, geometry: &Geometry, state: &State, w: usize) -> f64 {
    let Some(at) = system.mechanics.turn(w, state.t) else { return 0.0 };
    let friction = system.tractions.iter().position(|&traction| traction == w);
    let force = friction.map_or(0.0, |index| state.force[system.traction(index)]);
    system.mechanics.spin_inertia(w) * at.a + geometry.height[w] * force
}
