//! The energy audit: energy stored, dissipated and supplied.
//!
//! Stored energy and powers are sums over bodies, structures and force elements at one state; each element adds its
//! own ([`Element`](crate::contact::element::Element)). The steppers integrate the powers; this module does not
//! depend on them.

use crate::contact::element::Frame;
use crate::contact::geometry::Geometry;
use crate::contact::system::System;
use crate::mechanics::coupling::kinetic;
use crate::mechanics::state::State;
use crate::numerics::dense::dot;
use crate::scene::dof::arm_rows;
use crate::{Exchanged, Stored};

/// Result of the audit of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Audit {
    /// Largest |stored + lost - supplied - stored at the start| over the run, an energy.
    pub imbalance: f64,
    /// Peak elastic energy over the run or, if there are ropes or stops, the peak kinetic energy if that is larger.
    /// It is the reference of `residual`.
    pub peak_stored: f64,
    /// Energy exchanged over the whole run.
    pub exchanged: Exchanged,
    /// Energy stored at the start.
    pub start: Stored,
    /// Energy stored at the end.
    pub end: Stored,
    /// Where the imbalance arose.
    pub gaps: EnergyGaps,
}

/// What happened in a step whose energy does not balance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GapCause {
    /// Nothing but the motion: the error of the step.
    #[default]
    Step,
    /// The flange of a wheel touched or left its rail inside the step.
    Flange(usize),
    /// A wheel lost or gained contact at the end of the step.
    Contact(usize),
    /// The step ended at a corner of a prescribed motion, a load, a drive or a brake.
    Break,
}

/// Energy that a step left unaccounted for: stored + lost - supplied at its end, less that at its start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyGap {
    /// End of the step, s.
    pub time: f64,
    /// The energy, positive if it was gained.
    pub energy: f64,
    /// What happened in the step.
    pub cause: GapCause,
}

/// The gaps of all steps; their sum is the imbalance at the end. Zero for a run by power series.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyGaps {
    /// The largest gaps, in order of magnitude.
    pub largest: [EnergyGap; 3],
    /// Sums over the steps of each cause.
    pub steps: f64,
    /// See [`GapCause::Flange`].
    pub flanges: f64,
    /// See [`GapCause::Contact`].
    pub contacts: f64,
    /// See [`GapCause::Break`].
    pub breaks: f64,
}

impl EnergyGaps {
    /// Adds the gap of a step.
    pub(crate) fn add(&mut self, gap: EnergyGap) {
        let sum = match gap.cause {
            GapCause::Step => &mut self.steps,
            GapCause::Flange(_) => &mut self.flanges,
            GapCause::Contact(_) => &mut self.contacts,
            GapCause::Break => &mut self.breaks,
        };
        *sum += gap.energy;
        let mut next = gap;
        for kept in &mut self.largest {
            if next.energy.abs() > kept.energy.abs() {
                std::mem::swap(kept, &mut next);
            }
        }
    }
}

impl Audit {
    /// Imbalance relative to the peak stored energy.
    #[must_use]
    pub fn residual(&self) -> f64 {
        if self.peak_stored > 0.0 {
            self.imbalance / self.peak_stored
        } else {
            self.imbalance
        }
    }
}

/// Energy stored at `state`; `geometry` must be current for it.
pub(crate) fn stored(system: &System, geometry: &Geometry, state: &State) -> Stored {
    let mechanics = &system.mechanics;
    let kinetic = kinetic(&mechanics.blocks, &mechanics.couplings, &state.v);
    let mut energy = Stored {
        kinetic,
        ..Stored::default()
    };
    energy.kinetic += mechanics.energy_of_turns(state.t);
    energy.structure = mechanics
        .blocks
        .iter()
        .map(|block| block.elastic(state.q.as_slice()))
        .sum();
    let [motion, lift] =
        mechanics
            .carried
            .energy(&mechanics.kinematics, state.t, &state.q, &state.v);
    energy.kinetic += motion;
    energy.gravity += lift;
    let kinematics = &mechanics.kinematics;
    for (b, body) in system
        .scene
        .bodies
        .iter()
        .enumerate()
        .filter(|(b, _)| !mechanics.carried.has(*b))
    {
        let (displacement, speed) = mechanics.body(b, state.t, &state.q, &state.v);
        let lift = dot(&arm_rows(body.cg)[1], &displacement);
        energy.gravity += body.mass * system.scene.gravity * lift;
        if body.motion.is_some() {
            let (mass, coupling) = (kinematics.mass(b), kinematics.travel_inertia(b));
            energy.kinetic += 0.5 * mass * speed[0] * speed[0];
            energy.kinetic += coupling
                .iter()
                .map(|&(number, inertia)| inertia * speed[0] * state.v[number])
                .sum::<f64>();
        }
    }
    for mount in system
        .foundations
        .iter()
        .filter_map(|foundation| foundation.carrier.as_ref())
    {
        let (displacement, _) = mechanics.body(mount.body, state.t, &state.q, &state.v);
        energy.gravity += system.scene.gravity * dot(&mount.mass[1], &displacement);
    }
    let frame = geometry.frame(system, state);
    for (i, element) in system.elements.iter().enumerate() {
        element.stored(&frame.at(i), &mut energy);
    }
    energy
}

/// Powers of all exchanges at `state`, without the rate of [`boundary`].
pub(crate) fn power(system: &System, geometry: &Geometry, state: &State) -> Exchanged {
    let structure = system
        .mechanics
        .blocks
        .iter()
        .map(|block| block.loss(state.v.as_slice()))
        .sum();
    let mut power = Exchanged {
        structure,
        ..Exchanged::default()
    };
    let frame = geometry.frame(system, state);
    for (b, body) in system.scene.bodies.iter().enumerate() {
        if body.motion.is_some() {
            power.drives += motion_force(system, &frame, b) * frame.places.travel[b].v;
        }
    }
    power.drives += power_of_turns(system, geometry, state);
    for (i, element) in system
        .elements
        .iter()
        .enumerate()
        .filter(|(i, _)| state.force[*i] != 0.0)
    {
        element.power(&frame.at(i), &mut power);
    }
    for load in &system.scene.actuators.loads {
        if let Some(number) = system.mechanics.loaded(load) {
            power.loads += load.value.at(state.t) * state.v[number];
        }
    }
    power
}

/// Boundary terms of the losses in dampers, which are not included in [`power`].
pub(crate) fn boundary(system: &System, geometry: &Geometry, state: &State) -> f64 {
    let (frame, elements) = (
        geometry.frame(system, state),
        system.elements.iter().enumerate(),
    );
    elements.fold(0.0, |sum, (i, element)| {
        sum + element.boundary(&frame.at(i))
    })
}

/// Force along +x required by the prescribed motion of body `b`: its inertia and that of everything pinned to it,
/// plus the resistance of the elements.
pub(crate) fn motion_force(system: &System, frame: &Frame, b: usize) -> f64 {
    let Frame {
        mechanics, state, ..
    } = frame;
    let kinematics = &mechanics.kinematics;
    let mut force = kinematics.mass(b) * frame.places.travel[b].a;
    force += mechanics
        .carried
        .drive(kinematics, [&state.q, &state.v, &state.a], state.t, b);
    for &(number, inertia) in kinematics.travel_inertia(b) {
        force += inertia * state.a[number];
    }
    for (i, element) in system.elements.iter().enumerate() {
        force += element.resistance(&frame.at(i), b);
    }
    force
}

/// Power of the moments that drive prescribed spins.
fn power_of_turns(system: &System, geometry: &Geometry, state: &State) -> f64 {
    let mechanics = &system.mechanics;
    let all = (0..mechanics.wheels.len()).filter_map(|w| Some((w, mechanics.turn(w, state.t)?)));
    all.map(|(w, at)| spin_moment(system, geometry, state, w) * at.v)
        .sum()
}

/// Moment about z required by the prescribed spin of wheel `w`: its spin inertia times the acceleration, plus the
/// moment of the friction below it; zero if the spin is free.
pub(crate) fn spin_moment(system: &System, geometry: &Geometry, state: &State, w: usize) -> f64 {
    let Some(at) = system.mechanics.turn(w, state.t) else {
        return 0.0;
    };
    system.mechanics.spin_inertia(w) * at.a
        + geometry.places().height[w] * system.friction_of(w, state)
}
