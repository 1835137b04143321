//! What acts on bodies besides weight and rails: loads, drives, brakes and prescribed spins.

use super::dof::BodyDof;
use super::profile::Profile;
use super::rope::{Rope, Stop};
use super::rule::Rule;
use super::schedule::Schedule;

/// A force or a moment on one free degree of freedom of a body, over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Which body.
    pub body: usize,
    /// On which freedom: a force at the origin along x, y or z, or a moment about them; positive as the degree of
    /// freedom is.
    pub dof: BodyDof,
    /// Its size.
    pub value: Schedule,
}

/// A drive that follows a speed: D = clip(gain (v_ref(t) - v), -limit, limit) along x.
///
/// v is the mean speed along x of the driven wheels at their treads, and D acts there, evenly: it tips the body. The
/// limit is the lesser of `max_force` and the traction sum of mu N of the driven wheels, N the vertical force of
/// now. Without driven contacts D acts at the body's origin, v is the origin's speed, and traction is no limit; nor
/// is it where a driven wheel has no [`friction`](crate::Wheel::friction).
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Which body; its x is free.
    pub body: usize,
    /// v_ref(t).
    pub speed: Schedule,
    /// Force per speed, > 0.
    pub gain: f64,
    /// Largest force, >= 0; infinite for none.
    pub max_force: f64,
    /// Driven contacts of the body; their wheels have no spin of their own.
    pub contacts: Vec<usize>,
    /// Time from which it is off; infinite for never.
    pub until: f64,
}

/// Brakes of a body, on from a time: each braked contact rubs with B = -mu N tanh(s / speed), s the speed along x of
/// the body at its treads, mu of the wheel's friction.
///
/// Regularised: a braked body creeps where something pushes it, at s = speed artanh(H / mu N).
#[derive(Clone, Debug, PartialEq)]
pub struct Brake {
    /// Which body; its x is free.
    pub body: usize,
    /// Time from which the brakes are on.
    pub from: f64,
    /// Speed at which the brake has 76 % of its friction, > 0.
    pub speed: f64,
    /// Braked contacts of the body; their wheels have friction and no spin of their own.
    pub contacts: Vec<usize>,
}

/// A wheel's spin over time: its angle about z is prescribed and its moment follows. Rolling towards +x turns it
/// negative.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedSpin {
    /// Which contact; its wheels have friction.
    pub contact: usize,
    /// Which of the contact's wheels.
    pub wheel: usize,
    /// Angle, angular speed and acceleration over time.
    pub motion: Profile,
}

/// All loads, drives and brakes, ropes and stops of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Actuators {
    /// Loads.
    pub loads: Vec<Load>,
    /// Drives, at most one a body.
    pub drives: Vec<Drive>,
    /// Brakes.
    pub brakes: Vec<Brake>,
    /// Ropes.
    pub ropes: Vec<Rope>,
    /// End stops and floors.
    pub stops: Vec<Stop>,
    /// Wheels whose spin is prescribed.
    pub spins: Vec<PrescribedSpin>,
    /// Bodies without wheels that start at rest below their ropes or on their floors.
    pub hanging: Vec<usize>,
    /// What switches drives, brakes and ropes during the run.
    pub rules: Vec<Rule>,
}

impl Actuators {
    /// Times at which the forces may jump or turn.
    pub(crate) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        let loads = self.loads.iter().flat_map(|load| load.value.breaks());
        let drives = self.drives.iter().flat_map(|drive| drive.speed.breaks().chain([drive.until]));
        let ropes = self.ropes.iter().flat_map(Rope::breaks);
        let rules = self.rules.iter().filter_map(|rule| rule.when.time());
        let turns = self.spins.iter().flat_map(|turn| turn.motion.breaks().iter().copied());
        let loads = loads.chain(turns);
        loads.chain(drives).chain(self.brakes.iter().map(|brake| brake.from)).chain(ropes).chain(rules)
    }
}
