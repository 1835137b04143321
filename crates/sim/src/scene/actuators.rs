//! Actions on bodies other than weight and rail forces: loads, drives, brakes and prescribed spins.

use super::dof::BodyDof;
use super::profile::Profile;
use super::rope::{Rope, Stop};
use super::rule::Rule;
use super::schedule::Schedule;

/// A force or a moment on one free degree of freedom of a body, as a function of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Which body.
    pub body: usize,
    /// Degree of freedom that is loaded: a force at the origin along x, y or z, or a moment about these axes, with
    /// the sign of the degree of freedom.
    pub dof: BodyDof,
    /// Value of the force or moment over time.
    pub value: Schedule,
}

/// A speed-controlled drive: D = clip(gain (v_ref(t) - v), -limit, limit) along x.
///
/// v is the mean velocity along x of the driven wheels at their contact points. D acts at these points in equal
/// parts, so it also causes a pitching moment on the body. The limit is the smaller of `max_force` and the available
/// traction, which is the sum of mu N over the driven wheels with the present vertical forces N. Without driven
/// contacts, D acts at the origin of the body, v is the velocity of the origin, and traction is not limited. Traction
/// is not limited either where a driven wheel has no [`friction`](crate::Wheel::friction).
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Driven body, whose x must be free.
    pub body: usize,
    /// Reference speed v_ref(t).
    pub speed: Schedule,
    /// Gain, force per unit of speed error, > 0.
    pub gain: f64,
    /// Largest force, >= 0; infinite for no limit.
    pub max_force: f64,
    /// Driven contacts of the body. Their wheels must not have a spin degree of freedom.
    pub contacts: Vec<usize>,
    /// Time at which the drive is switched off; infinite for never.
    pub until: f64,
}

/// Brakes of a body that are applied at a given time. Each braked contact exerts the friction force B = -mu N tanh(s
/// / speed), where s is the velocity along x of the body at the contact points and mu is the friction coefficient of
/// the wheel.
///
/// The law is regularised: a braked body under a horizontal force H creeps at s = speed artanh(H / mu N).
#[derive(Clone, Debug, PartialEq)]
pub struct Brake {
    /// Driven body, whose x must be free.
    pub body: usize,
    /// Time at which the brakes are applied.
    pub from: f64,
    /// Speed at which the brake force is 76 % of mu N, > 0.
    pub speed: f64,
    /// Braked contacts of the body. Their wheels must have friction and no spin degree of freedom.
    pub contacts: Vec<usize>,
}

/// Prescribed spin of a wheel: its angle about z is a given function of time, and the moment is a result. Rolling
/// towards +x is a negative rotation.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribedSpin {
    /// Contact, whose wheels must have friction.
    pub contact: usize,
    /// Index of the wheel in the contact.
    pub wheel: usize,
    /// Angle, angular velocity and angular acceleration over time.
    pub motion: Profile,
}

/// All loads, drives, brakes, ropes, stops, prescribed spins and rules of a scene.
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
    /// Bodies without wheels that start in static equilibrium on their ropes or floors.
    pub hanging: Vec<usize>,
    /// Rules that switch drives, brakes and ropes during the run.
    pub rules: Vec<Rule>,
}

impl Actuators {
    /// Times at which the forces or their slopes may jump.
    pub(crate) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        let loads = self.loads.iter().flat_map(|load| load.value.breaks());
        let drives = self
            .drives
            .iter()
            .flat_map(|drive| drive.speed.breaks().chain([drive.until]));
        let ropes = self.ropes.iter().flat_map(Rope::breaks);
        let rules = self.rules.iter().filter_map(|rule| rule.when.time());
        let turns = self
            .spins
            .iter()
            .flat_map(|turn| turn.motion.breaks().iter().copied());
        let loads = loads.chain(turns);
        loads
            .chain(drives)
            .chain(self.brakes.iter().map(|brake| brake.from))
            .chain(ropes)
            .chain(rules)
    }
}
