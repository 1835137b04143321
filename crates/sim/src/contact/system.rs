//! The numbered scene: the equations of motion without contact, and the contact components F with their probes.
//!
//! M q'' + C q' + K q = f(t) - R^T F. A component is a vertical contact (of one wheel, or of the wheels of
//! equalisers), a flange, a wheel's friction, a drive, a brake, a rope or a stop,
//! in this order.

use std::ops::Range;

use splines::{Axis, Probe};

use super::actuator::Pull;
use super::link::Link;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::state::State;
use crate::scene::dof::arm_rows;
use crate::{Error, Flange, Foundation, NormalLaw, Scene};

/// One probe of a structure: which component it belongs to, and its signed weight there.
pub(crate) struct Entry {
    pub component: usize,
    pub weight: f64,
    pub wheel: usize,
    pub probe: Probe,
    /// Which of [`System::treads`] it belongs to.
    pub tread: Option<usize>,
}

/// Wheels of one contact under a component along a rail that gives: they move alike.
pub(crate) struct Tread {
    pub component: usize,
    /// The first of them.
    pub wheel: usize,
}

/// The numbered scene.
pub(crate) struct System<'a> {
    pub scene: &'a Scene,
    pub foundations: &'a [Foundation],
    pub mechanics: Mechanics<'a>,
    /// Where components along the rails load structures that feel it.
    pub treads: Vec<Tread>,
    /// Wheels with a flange; component `normals.len() + i`.
    pub laterals: Vec<usize>,
    /// Wheels with friction; component `normals.len() + laterals.len() + i`.
    pub tractions: Vec<usize>,
    /// Drives and braked contacts; component `normals.len() + laterals.len() + tractions.len() + i`.
    pub pulls: Vec<Pull>,
    /// Ropes and stops, the last components.
    pub links: Vec<Link<'a>>,
    /// Probes of each structure.
    pub entries: Vec<Vec<Entry>>,
    /// Whether the probes of a structure are the components in their order, with weight -1 each: the compliance
    /// of the components is then the structure's.
    pub is_direct: Vec<bool>,
    /// Largest stiffness of a wheel on its rail.
    pub stiffest: f64,
    /// Whether some structure is loaded along its rails.
    pub is_dragged: bool,
    /// Whether some wheel runs on an uneven rail.
    pub is_uneven: bool,
    /// Whether some wheel's place along the rail depends on the freedoms.
    pub moves_freely: bool,
    /// Whether the rows of contact are the same at every time and place.
    pub constant_rows: bool,
    /// Whether every vertical law is linear.
    pub linear_normals: bool,
    /// Whether the linear contact equations are symmetric: see [`crate::contact::forces`].
    pub symmetric: bool,
}

impl<'a> System<'a> {
    /// Numbers a scene.
    pub fn new(scene: &'a Scene, foundations: &'a [Foundation]) -> Result<Self, Error> {
        let mechanics = Mechanics::new(scene, foundations)?;
        let wheels = &mechanics.wheels;
        let laterals: Vec<usize> =
            (0..wheels.len()).filter(|&w| scene.wheels[wheels[w].kind].flange.is_some()).collect();
        let tractions: Vec<usize> =
            (0..wheels.len()).filter(|&w| wheels[w].spin.is_some() || wheels[w].turn.is_some()).collect();
        let mut system = System {
            scene,
            foundations,
            mechanics,
            treads: Vec::new(),
            laterals,
            tractions,
            pulls: Vec::new(),
            links: Vec::new(),
            entries: Vec::new(),
            is_direct: Vec::new(),
            stiffest: scene.wheels.iter().fold(0.0, |max, wheel| wheel.normal.stiffness.max(max)),
            is_dragged: foundations.iter().any(|foundation| foundation.is_dragged),
            is_uneven: false,
            moves_freely: false,
            constant_rows: false,
            linear_normals: false,
            symmetric: false,
        };
        system.pulls = Pull::all(&system.mechanics);
        system.links = Link::all(&system.mechanics);
        system.treads = system.all_treads();
        system.entries = (0..foundations.len()).map(|s| system.structure_entries(s)).collect();
        system.is_direct = system
            .entries
            .iter()
            .map(|entries| {
                entries.len() == system.components()
                    && entries.iter().enumerate().all(|(i, e)| e.component == i && e.weight == -1.0)
            })
            .collect();
        system.judge();
        Ok(system)
    }

    /// Finds which simplifications hold.
    fn judge(&mut self) {
        self.moves_freely =
            self.mechanics.wheels.iter().any(|wheel| {
                !self.mechanics.kinematics.combine(wheel.body, &arm_rows(wheel.hub)[0]).is_empty()
            });
        self.is_uneven = (0..self.mechanics.wheels.len()).any(|w| self.mechanics.irregularity(w).is_some());
        self.constant_rows = !self.moves_freely
            && !self.is_uneven
            && self.laterals.is_empty()
            && self.tractions.is_empty()
            && self.pulls.is_empty()
            && self.links.is_empty()
            && self.foundations.iter().all(|foundation| foundation.structure.is_none());
        let scene = self.scene;
        let laws = || scene.contacts.iter().map(|contact| &scene.wheels[contact.wheel].normal);
        self.linear_normals = laws().all(NormalLaw::is_linear);
        let ratio = |law: &NormalLaw| law.damping / law.stiffness;
        let grounded = laws().find(|law| !law.has_memory());
        self.symmetric = !self.moves_freely
            && self.foundations.iter().filter_map(|f| f.compliance.as_ref()).all(|c| c.is_symmetric())
            && grounded.is_none_or(|first| {
                laws().all(
                    |law| if law.has_memory() { ratio(first) == 0.0 } else { ratio(law) == ratio(first) },
                )
            });
    }

    /// Number of contact components.
    pub fn components(&self) -> usize {
        self.mechanics.groups.len()
            + self.laterals.len()
            + self.tractions.len()
            + self.pulls.len()
            + self.links.len()
    }

    /// Law of vertical contact `i`, of one wheel.
    pub fn law(&self, i: usize) -> &'a NormalLaw {
        &self.scene.wheels[self.mechanics.groups[i].kind].normal
    }

    /// The state zero.
    pub fn state(&self) -> State {
        let penetrations = self.mechanics.groups.len() + self.drags().len();
        State::zeros(self.mechanics.dofs, penetrations, self.components())
    }

    /// Component of flange `i`.
    pub fn lateral(&self, i: usize) -> usize {
        self.mechanics.groups.len() + i
    }

    /// The law of flange `i`.
    pub fn flange(&self, i: usize) -> Option<&'a Flange> {
        self.scene.wheels[self.mechanics.wheels[self.laterals[i]].kind].flange.as_ref()
    }

    /// Component of friction `i`.
    pub fn traction(&self, i: usize) -> usize {
        self.mechanics.groups.len() + self.laterals.len() + i
    }

    /// Component of drive or brake `i`.
    pub fn pull(&self, i: usize) -> usize {
        self.mechanics.groups.len() + self.laterals.len() + self.tractions.len() + i
    }

    /// Components along the rails whose massless give is a state: frictions, drives and brakes, where some structure is
    /// dragged.
    pub fn drags(&self) -> Range<usize> {
        if self.is_dragged { self.traction(0)..self.link(0) } else { 0..0 }
    }

    fn all_treads(&self) -> Vec<Tread> {
        let mut treads: Vec<Tread> = Vec::new();
        for component in self.drags() {
            for wheel in self.wheels_of(component) {
                let contact = self.mechanics.wheels[wheel].contact;
                let is_dragged = self.foundations[self.scene.contacts[contact].structure].is_dragged;
                if is_dragged && self.tread_of(&treads, component, contact).is_none() {
                    treads.push(Tread { component, wheel });
                }
            }
        }
        treads
    }

    /// Which of `treads` is that of a contact under a component.
    fn tread_of(&self, treads: &[Tread], component: usize, contact: usize) -> Option<usize> {
        let is_own = |tread: &Tread| {
            tread.component == component && self.mechanics.wheels[tread.wheel].contact == contact
        };
        treads.iter().position(is_own)
    }

    /// Wheels of component `i` along a rail: those of a friction, a drive, a brake.
    pub fn wheels_of(&self, i: usize) -> Vec<usize> {
        match i.checked_sub(self.pull(0)) {
            None => i.checked_sub(self.traction(0)).map(|index| self.tractions[index]).into_iter().collect(),
            Some(index) => {
                let contacts = &self.pulls[index].contacts;
                (0..self.mechanics.wheels.len())
                    .filter(|&w| contacts.contains(&self.mechanics.wheels[w].contact))
                    .collect()
            }
        }
    }

    /// Component of rope or stop `i`.
    pub fn link(&self, i: usize) -> usize {
        self.pull(self.pulls.len()) + i
    }

    /// Speed along the rail of the wheels of vertical contact `i`.
    pub fn contact_speed(&self, i: usize, at: &State) -> f64 {
        self.mechanics.speed_along(self.mechanics.groups[i].wheels.start, at)
    }

    /// Probes of structure `s`. A vertical component is positive downwards, hence its weight is negative.
    fn structure_entries(&self, s: usize) -> Vec<Entry> {
        let mut entries = Vec::new();
        let rail_of = |contact: usize, part: Option<usize>| {
            let rail = self.scene.contacts[contact].rail;
            match (&self.foundations[s].parts, part) {
                (Some(chains), Some(part)) => chains[rail].rail(part),
                _ => rail,
            }
        };
        for (component, normal) in self.mechanics.groups.iter().enumerate() {
            if self.scene.contacts[normal.contact].structure != s {
                continue;
            }
            for wheel in normal.wheels.clone() {
                let probe =
                    Probe { rail: rail_of(normal.contact, normal.part), x: 0.0, axis: Axis::Vertical };
                entries.push(Entry { component, weight: -1.0 / normal.count(), wheel, probe, tread: None });
            }
        }
        for (i, &wheel) in self.laterals.iter().enumerate() {
            let contact = self.mechanics.wheels[wheel].contact;
            if self.scene.contacts[contact].structure == s && self.foundations[s].parts.is_none() {
                let probe = Probe { rail: rail_of(contact, None), x: 0.0, axis: Axis::Lateral };
                entries.push(Entry { component: self.lateral(i), weight: 1.0, wheel, probe, tread: None });
            }
        }
        for component in self.drags().filter(|_| self.foundations[s].is_dragged) {
            let wheels = self.wheels_of(component);
            for &wheel in &wheels {
                let contact = self.mechanics.wheels[wheel].contact;
                if self.scene.contacts[contact].structure == s {
                    let probe = Probe { rail: rail_of(contact, None), x: 0.0, axis: Axis::Longitudinal };
                    let tread = self.tread_of(&self.treads, component, contact);
                    entries.push(Entry { component, weight: 1.0 / wheels.len() as f64, wheel, probe, tread });
                }
            }
        }
        entries
    }
}
