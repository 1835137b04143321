//! What acts on bodies besides weight and rails: loads, drives and brakes.

use crate::rule::Switches;
use crate::scene::arm_rows;
use crate::system::System;
use crate::{Error, Freedom, Rope, Rule, Scene, Schedule, Stop, Turn};

/// A force or a moment on one free freedom of a body, over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Which body.
    pub body: usize,
    /// On which freedom: a force at the origin along x, y or z, or a moment about them; positive as the freedom is.
    pub freedom: Freedom,
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
    pub turns: Vec<Turn>,
    /// Bodies without wheels that start at rest below their ropes or on their floors.
    pub hung: Vec<usize>,
    /// What switches drives, brakes and ropes on the way.
    pub rules: Vec<Rule>,
}

impl Actuators {
    /// Times at which the forces may jump or turn.
    pub(crate) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        let loads = self.loads.iter().flat_map(|load| load.value.breaks());
        let drives = self.drives.iter().flat_map(|drive| drive.speed.breaks().chain([drive.until]));
        let ropes = self.ropes.iter().flat_map(Rope::breaks);
        let rules = self.rules.iter().filter_map(|rule| rule.when.time());
        let turns = self.turns.iter().flat_map(|turn| turn.motion.breaks().iter().copied());
        let loads = loads.chain(turns);
        loads.chain(drives).chain(self.brakes.iter().map(|brake| brake.from)).chain(ropes).chain(rules)
    }

    pub(crate) fn check(&self, scene: &Scene) -> Result<(), Error> {
        for rope in &self.ropes {
            rope.check(scene)?;
        }
        for stop in &self.stops {
            stop.check(scene)?;
        }
        Turn::check_all(&self.turns, scene)?;
        for &index in &self.hung {
            let rides = scene.contacts.iter().any(|contact| contact.body == index);
            if index >= scene.bodies.len() || rides {
                return Err(Error::NoSuch { what: "body without wheels", index });
            }
        }
        for rule in &self.rules {
            rule.check(scene)?;
        }
        for load in &self.loads {
            free(scene, load.body, load.freedom)?;
        }
        for (index, drive) in self.drives.iter().enumerate() {
            free(scene, drive.body, Freedom::X)?;
            if self.drives[..index].iter().any(|earlier| earlier.body == drive.body) {
                return Err(Error::Number { what: "drives of a body", wanted: "one at most", found: 2.0 });
            }
            number("gain of a drive", "positive", drive.gain, drive.gain > 0.0 && drive.gain.is_finite())?;
            number("largest force of a drive", "zero or above", drive.max_force, drive.max_force >= 0.0)?;
            number("end of a drive", "a time", drive.until, !drive.until.is_nan())?;
            for &contact in &drive.contacts {
                rides(scene, drive.body, contact)?;
            }
        }
        for brake in &self.brakes {
            free(scene, brake.body, Freedom::X)?;
            number(
                "speed of a brake",
                "positive",
                brake.speed,
                brake.speed > 0.0 && brake.speed.is_finite(),
            )?;
            number("start of a brake", "a time", brake.from, !brake.from.is_nan())?;
            for &contact in &brake.contacts {
                rides(scene, brake.body, contact)?;
                if scene.wheels[scene.contacts[contact].wheel].friction.is_none() {
                    return Err(Error::NoSuch { what: "friction of braked contact", index: contact });
                }
            }
        }
        Ok(())
    }
}

fn number(what: &'static str, wanted: &'static str, found: f64, holds: bool) -> Result<(), Error> {
    if holds { Ok(()) } else { Err(Error::Number { what, wanted, found }) }
}

fn free(scene: &Scene, body: usize, freedom: Freedom) -> Result<(), Error> {
    let owner = scene.bodies.get(body).ok_or(Error::NoSuch { what: "body", index: body })?;
    let is_free = owner.free[freedom as usize] && (freedom != Freedom::X || owner.motion.is_none());
    if is_free { Ok(()) } else { Err(Error::NotFree { body, freedom }) }
}

fn rides(scene: &Scene, body: usize, index: usize) -> Result<(), Error> {
    let contact = scene.contacts.get(index).ok_or(Error::NoSuch { what: "contact", index })?;
    if contact.body != body {
        return Err(Error::NoSuch { what: "wheel of the body on contact", index });
    }
    let kind =
        scene.wheels.get(contact.wheel).ok_or(Error::NoSuch { what: "wheel", index: contact.wheel })?;
    let turns = scene.actuators.turns.iter().any(|turn| turn.contact == index);
    if turns || kind.spin_inertia.is_some() && kind.friction.is_some() {
        return Err(Error::Spins { contact: index });
    }
    Ok(())
}

/// One vertical component whose force lets a drive pull or a brake rub, with its mu.
#[derive(Clone, Copy)]
pub(crate) struct Grip {
    pub normal: usize,
    pub mu: f64,
}

/// The law of one component along the rail; the component is positive against +x, as friction is.
#[derive(Clone, Copy)]
pub(crate) enum PullLaw {
    /// clip(gain r, limit), r = v - v_ref.
    Drive { drive: usize, gain: f64, max_force: f64, gripped: bool },
    /// mu N tanh(r / speed), r = v.
    Brake { brake: usize, speed: f64 },
}

/// One component along the rail: a drive, or one braked contact.
pub(crate) struct Pull {
    pub body: usize,
    /// Mean row of the places where it acts: their speed along x by the body's freedoms.
    pub row: [f64; 6],
    pub grips: Vec<Grip>,
    /// Contacts under whose wheels it acts.
    pub contacts: Vec<usize>,
    pub law: PullLaw,
}

impl Pull {
    /// All components of a scene, in the order of its drives, then its brakes.
    pub fn all(system: &System) -> Vec<Pull> {
        let scene = system.scene;
        let actuators = &scene.actuators;
        let mut pulls = Vec::new();
        for (index, drive) in actuators.drives.iter().enumerate() {
            let kinds = || drive.contacts.iter().map(|&contact| &scene.wheels[scene.contacts[contact].wheel]);
            let gripped = !drive.contacts.is_empty() && kinds().all(|kind| kind.friction.is_some());
            pulls.push(Pull {
                body: drive.body,
                row: treads(system, &drive.contacts),
                grips: if gripped { grips(system, &drive.contacts) } else { Vec::new() },
                contacts: drive.contacts.clone(),
                law: PullLaw::Drive { drive: index, gain: drive.gain, max_force: drive.max_force, gripped },
            });
        }
        for (index, brake) in actuators.brakes.iter().enumerate() {
            for contact in &brake.contacts {
                let contact = std::slice::from_ref(contact);
                pulls.push(Pull {
                    body: brake.body,
                    row: treads(system, contact),
                    grips: grips(system, contact),
                    contacts: contact.to_vec(),
                    law: PullLaw::Brake { brake: index, speed: brake.speed },
                });
            }
        }
        pulls
    }

    /// Whether it acts at `t`, and the speed that its own is measured against.
    pub fn reference(&self, scene: &Scene, switches: &Switches, t: f64) -> Option<f64> {
        let actuators = &scene.actuators;
        match self.law {
            PullLaw::Drive { drive, .. } => switches.drives(actuators, drive, t),
            PullLaw::Brake { brake, .. } => switches.brakes(actuators, brake, t).then_some(0.0),
        }
    }

    /// Sum of mu N over the grips, N >= 0.
    pub fn traction(&self, force: &[f64]) -> f64 {
        self.grips.iter().map(|grip| grip.mu * force[grip.normal].max(0.0)).sum()
    }

    /// What changes sign where a drive that follows `reference` reaches or leaves its limit, and where the limit changes from
    /// traction to the drive's own, for its `speed` and `traction`; zeros where there are no such corners.
    pub fn margins(&self, reference: Option<f64>, speed: f64, traction: f64) -> [f64; 2] {
        match (self.law, reference) {
            (PullLaw::Drive { gain, max_force, gripped, .. }, Some(reference)) => {
                let limit = if gripped { traction.min(max_force) } else { max_force };
                let reach = (gain * (reference - speed)).abs() - limit;
                let spare = if gripped && reach > 0.0 { traction - max_force } else { 0.0 };
                [reach, spare].map(|margin| if margin.is_finite() { margin } else { 0.0 })
            }
            _ => [0.0; 2],
        }
    }

    /// The most that it can give with the `traction`, and whether that is what limits it.
    fn limit(&self, traction: f64) -> (f64, bool) {
        match self.law {
            PullLaw::Drive { max_force, gripped, .. } => {
                let slips = gripped && traction < max_force;
                (if slips { traction } else { max_force }, slips)
            }
            PullLaw::Brake { .. } => (traction, true),
        }
    }

    /// The force of a drive at the rate that it gives itself, where it gives now `force` at the rate `r`, which every unit
    /// of force lowers by `fall`: F = K (r - fall (F - force)), all that it can beyond its limit. That of a brake at `r`.
    pub fn give(&self, force: f64, r: f64, fall: f64, traction: f64) -> Pulled {
        let PullLaw::Drive { gain, .. } = self.law else {
            let (force, by_rate, by_traction) = self.at(r, traction);
            return Pulled { force, by_rate, by_force: 0.0, by_traction };
        };
        let stiffness = 1.0 + gain * fall.max(0.0);
        let wanted = force + (gain * r - force) / stiffness;
        let (limit, slips) = self.limit(traction);
        if wanted.abs() <= limit {
            Pulled {
                force: wanted,
                by_rate: gain / stiffness,
                by_force: 1.0 - 1.0 / stiffness,
                by_traction: 0.0,
            }
        } else {
            let by_traction = if slips { wanted.signum() } else { 0.0 };
            Pulled { force: limit.copysign(wanted), by_rate: 0.0, by_force: 0.0, by_traction }
        }
    }

    /// Force at the rate `r` with the `traction`, and its derivatives by both.
    pub fn at(&self, r: f64, traction: f64) -> (f64, f64, f64) {
        match self.law {
            PullLaw::Drive { gain, .. } => {
                let (limit, slips) = self.limit(traction);
                if (gain * r).abs() <= limit {
                    (gain * r, gain, 0.0)
                } else {
                    (limit * r.signum(), 0.0, if slips { r.signum() } else { 0.0 })
                }
            }
            PullLaw::Brake { speed, .. } => {
                let share = (r / speed).tanh();
                (traction * share, traction * (1.0 - share * share) / speed, share)
            }
        }
    }
}

/// What a drive or a brake gives, see [`Pull::give`], with its derivatives.
pub(crate) struct Pulled {
    pub force: f64,
    pub by_rate: f64,
    pub by_force: f64,
    pub by_traction: f64,
}

/// Mean over the wheels of `contacts` of the rows of their treads; the origin's where there are none.
fn treads(system: &System, contacts: &[usize]) -> [f64; 6] {
    let wheels: Vec<_> = system.wheels.iter().filter(|wheel| contacts.contains(&wheel.contact)).collect();
    if wheels.is_empty() {
        return arm_rows([0.0; 3])[0];
    }
    let mut mean = [0.0; 6];
    for wheel in &wheels {
        let [x, y, z] = wheel.hub;
        let row = arm_rows([x, y - system.scene.wheels[wheel.kind].radius, z])[0];
        mean.iter_mut().zip(row).for_each(|(mean, entry)| *mean += entry / wheels.len() as f64);
    }
    mean
}

fn grips(system: &System, contacts: &[usize]) -> Vec<Grip> {
    let normals = system.normals.iter().enumerate().filter(|(_, normal)| contacts.contains(&normal.contact));
    normals
        .filter_map(|(index, normal)| {
            let friction = system.scene.wheels[normal.kind].friction.as_ref()?;
            Some(Grip { normal: index, mu: friction.coefficient })
        })
        .collect()
}
