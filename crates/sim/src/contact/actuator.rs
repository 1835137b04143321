//! Drives and brakes as components along the rail.

use super::switches::Switches;
use crate::Scene;
use crate::mechanics::assembly::Mechanics;
use crate::scene::dof::arm_rows;

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
    pub fn all(mechanics: &Mechanics) -> Vec<Pull> {
        let scene = mechanics.scene;
        let actuators = &scene.actuators;
        let mut pulls = Vec::new();
        for (index, drive) in actuators.drives.iter().enumerate() {
            let kinds = || drive.contacts.iter().map(|&contact| &scene.wheels[scene.contacts[contact].wheel]);
            let gripped = !drive.contacts.is_empty() && kinds().all(|kind| kind.friction.is_some());
            pulls.push(Pull {
                body: drive.body,
                row: treads(mechanics, &drive.contacts),
                grips: if gripped { grips(mechanics, &drive.contacts) } else { Vec::new() },
                contacts: drive.contacts.clone(),
                law: PullLaw::Drive { drive: index, gain: drive.gain, max_force: drive.max_force, gripped },
            });
        }
        for (index, brake) in actuators.brakes.iter().enumerate() {
            for contact in &brake.contacts {
                let contact = std::slice::from_ref(contact);
                pulls.push(Pull {
                    body: brake.body,
                    row: treads(mechanics, contact),
                    grips: grips(mechanics, contact),
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
fn treads(mechanics: &Mechanics, contacts: &[usize]) -> [f64; 6] {
    let wheels: Vec<_> = mechanics.wheels.iter().filter(|wheel| contacts.contains(&wheel.contact)).collect();
    if wheels.is_empty() {
        return arm_rows([0.0; 3])[0];
    }
    let mut mean = [0.0; 6];
    for wheel in &wheels {
        let [x, y, z] = wheel.hub;
        let row = arm_rows([x, y - mechanics.scene.wheels[wheel.kind].radius, z])[0];
        mean.iter_mut().zip(row).for_each(|(mean, entry)| *mean += entry / wheels.len() as f64);
    }
    mean
}

fn grips(mechanics: &Mechanics, contacts: &[usize]) -> Vec<Grip> {
    let normals =
        mechanics.groups.iter().enumerate().filter(|(_, normal)| contacts.contains(&normal.contact));
    normals
        .filter_map(|(index, normal)| {
            let friction = mechanics.scene.wheels[normal.kind].friction.as_ref()?;
            Some(Grip { normal: index, mu: friction.coefficient })
        })
        .collect()
}
