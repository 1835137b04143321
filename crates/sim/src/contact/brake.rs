//! Brake force at one contact of a body: B = -mu N tanh(v / speed), where v is the speed at the treads.

use super::element::{At, Coupling, Element, ElementProbe, Law, Local, Query, Where};
use super::energy::{Exchanged, Stored};
use super::grip::Grip;
use super::rows::RowMut;
use crate::mechanics::assembly::Mechanics;
use crate::{Brake, Channel};

/// The force of one braked contact. Like friction, it is positive if it acts on the body against +x.
pub(crate) struct BrakeForce<'a> {
    brake: &'a Brake,
    index: usize,
    grip: Grip,
}

impl<'a> BrakeForce<'a> {
    /// All braked contacts of a scene, ordered by brake.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Self> {
        let brakes = mechanics.scene.actuators.brakes.iter().enumerate();
        brakes
            .flat_map(|(index, brake)| {
                brake
                    .contacts
                    .iter()
                    .map(move |contact| (index, brake, contact))
            })
            .map(|(index, brake, contact)| {
                let grip = Grip::new(mechanics, std::slice::from_ref(contact), true);
                BrakeForce { brake, index, grip }
            })
            .collect()
    }
}

impl Element for BrakeForce<'_> {
    fn constant_row(&self, mechanics: &Mechanics, row: &mut RowMut) {
        row.add_rate(&mechanics.kinematics, self.brake.body, self.grip.row);
    }

    fn update_row(&self, at: &Where, row: &mut RowMut, local: &mut Local) {
        local.is_on = at
            .switches
            .is_braking(&at.mechanics.scene.actuators, self.index, at.t);
        *row.rate_offset = -0.0;
    }

    fn probes(&self, _: &Mechanics) -> Vec<ElementProbe> {
        self.grip.probes()
    }

    fn body(&self, _: &Mechanics) -> Option<usize> {
        Some(self.brake.body)
    }

    fn is_tangential(&self) -> bool {
        true
    }

    fn is_idle(&self, _: bool, local: &Local, _: f64) -> bool {
        !local.is_on
    }

    fn feels_rates(&self) -> bool {
        true
    }

    fn law(&self, query: &Query, couplings: &mut Vec<Coupling>) -> Option<Law> {
        if !query.local.is_on {
            return None;
        }
        let traction = self.grip.traction(query.force);
        let share = (query.rate / self.brake.speed).tanh();
        self.grip.couple(query.index, query.force, share, couplings);
        let by_rate = traction * (1.0 - share * share) / self.brake.speed;
        Some(Law {
            force: traction * share,
            by_rate,
            ..Law::default()
        })
    }

    fn stored(&self, at: &At, energy: &mut Stored) {
        if !at.probes.sliding.is_empty() {
            energy.structure += at.rail_energy();
        }
    }

    fn power(&self, at: &At, power: &mut Exchanged) {
        power.friction += at.force() * at.slip();
    }

    fn channels(&self, _: &Mechanics) -> Vec<(Channel, f64)> {
        let count = self.grip.wheels.len() as f64;
        let wheels = self
            .grip
            .wheels
            .iter()
            .map(|&w| (Channel::Traction(w), count));
        wheels
            .chain([(Channel::Brake(self.brake.body), -1.0)])
            .collect()
    }
}
