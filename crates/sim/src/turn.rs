//! Wheels whose spin is prescribed: friction then drives the body.

use crate::geometry::Geometry;
use crate::state::State;
use crate::system::System;
use crate::{Error, Moving, Profile, Scene};

/// A wheel's spin over time: its angle about z is prescribed and its moment follows. Rolling towards +x turns it
/// negative.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// Which contact; its wheels have friction.
    pub contact: usize,
    /// Which of the contact's wheels.
    pub wheel: usize,
    /// Angle, angular speed and acceleration over time.
    pub motion: Profile,
}

impl Turn {
    pub(crate) fn check_all(turns: &[Turn], scene: &Scene) -> Result<(), Error> {
        for (index, turn) in turns.iter().enumerate() {
            let none = Error::NoSuch { what: "contact of a prescribed spin", index: turn.contact };
            let contact = scene.contacts.get(turn.contact).ok_or(none)?;
            if turn.wheel >= contact.offsets.len() {
                return Err(Error::NoSuch { what: "wheel of a prescribed spin", index: turn.wheel });
            }
            if scene.wheels.get(contact.wheel).is_none_or(|kind| kind.friction.is_none()) {
                return Err(Error::NoSuch {
                    what: "friction of the contact that turns",
                    index: turn.contact,
                });
            }
            let same = |other: &Turn| (other.contact, other.wheel) == (turn.contact, turn.wheel);
            if turns[..index].iter().any(same) {
                return Err(Error::Number {
                    what: "prescribed spins of a wheel",
                    wanted: "one at most",
                    found: 2.0,
                });
            }
        }
        Ok(())
    }
}

impl System<'_> {
    /// Angle, speed and acceleration of the spin of wheel `w` at `t`, where it is prescribed.
    pub fn turn(&self, w: usize, t: f64) -> Option<Moving> {
        self.wheels[w].turn.map(|motion| motion.at(t))
    }

    /// Inertia of the spin of wheel `w`.
    fn spin_inertia(&self, w: usize) -> f64 {
        self.scene.wheels[self.wheels[w].kind].spin_inertia.unwrap_or_default()
    }

    /// Kinetic energy of the wheels whose spin is prescribed, those of their bodies left out.
    pub fn energy_of_turns(&self, t: f64) -> f64 {
        let all = (0..self.wheels.len()).filter_map(|w| Some((w, self.turn(w, t)?)));
        all.map(|(w, at)| 0.5 * self.spin_inertia(w) * at.v * at.v).sum()
    }

    /// Power of the moments that prescribe spins.
    pub fn power_of_turns(&self, geometry: &Geometry, state: &State) -> f64 {
        let all = (0..self.wheels.len()).filter_map(|w| Some((w, self.turn(w, state.t)?)));
        all.map(|(w, at)| self.moment(geometry, state, w) * at.v).sum()
    }

    /// Moment about z that prescribes the spin of wheel `w`: I times its acceleration and the friction below it; zero where
    /// the spin is free.
    pub fn moment(&self, geometry: &Geometry, state: &State, w: usize) -> f64 {
        let Some(at) = self.turn(w, state.t) else { return 0.0 };
        let friction = self.tractions.iter().position(|&traction| traction == w);
        let force = friction.map_or(0.0, |index| state.force[self.traction(index)]);
        self.spin_inertia(w) * at.a + geometry.height[w] * force
    }
}
