//! A drive with speed control: D = clip(gain (v_ref - v), limit) along x. The limit is its own or that of traction.

use super::element::{
    At, Coupling, Element, ElementProbe, Guard, GuardKind, Law, Local, Query, Where,
};
use super::energy::{Exchanged, Stored};
use super::grip::Grip;
use super::rows::RowMut;
use crate::mechanics::assembly::Mechanics;
use crate::numerics::dense::dot;
use crate::{Channel, Drive};

/// The force of one drive. Like friction, it is positive if it acts on the body against +x.
pub(crate) struct DriveForce<'a> {
    drive: &'a Drive,
    index: usize,
    grip: Grip,
    /// Whether traction limits the force.
    is_gripped: bool,
}

impl<'a> DriveForce<'a> {
    /// All drives of a scene.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Self> {
        let scene = mechanics.scene;
        let drives = scene.actuators.drives.iter().enumerate();
        drives
            .map(|(index, drive)| {
                let mut kinds = drive
                    .contacts
                    .iter()
                    .map(|&contact| &scene.wheels[scene.contacts[contact].wheel]);
                let is_gripped =
                    !drive.contacts.is_empty() && kinds.all(|kind| kind.friction.is_some());
                DriveForce {
                    drive,
                    index,
                    grip: Grip::new(mechanics, &drive.contacts, is_gripped),
                    is_gripped,
                }
            })
            .collect()
    }

    /// The largest force for the available `traction`, and whether traction is the limit.
    fn limit(&self, traction: f64) -> (f64, bool) {
        let max_force = self.drive.max_force;
        let slips = self.is_gripped && traction < max_force;
        (if slips { traction } else { max_force }, slips)
    }
}

impl Element for DriveForce<'_> {
    fn constant_row(&self, mechanics: &Mechanics, row: &mut RowMut) {
        row.add_rate(&mechanics.kinematics, self.drive.body, self.grip.row);
    }

    fn update_row(&self, at: &Where, row: &mut RowMut, local: &mut Local) {
        let reference = at
            .switches
            .drive_speed(&at.mechanics.scene.actuators, self.index, at.t);
        local.is_on = reference.is_some();
        *row.rate_offset = -reference.unwrap_or(0.0);
    }

    fn probes(&self, _: &Mechanics) -> Vec<ElementProbe> {
        self.grip.probes()
    }

    fn body(&self, _: &Mechanics) -> Option<usize> {
        Some(self.drive.body)
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

    /// Implicit force law: with r the rate at the present force `force`, and `fall` the decrease of the rate per unit
    /// of force, the force solves F = K (r - fall (F - force)), bounded by the limit. With this law a stiff drive
    /// converges in one Newton iteration.
    fn law(&self, query: &Query, couplings: &mut Vec<Coupling>) -> Option<Law> {
        if !query.local.is_on {
            return None;
        }
        let (i, gain) = (query.index, self.drive.gain);
        let force = query.force[i];
        let stiffness = 1.0 + gain * query.fall.max(0.0);
        let wanted = force + (gain * query.rate - force) / stiffness;
        let (limit, slips) = self.limit(self.grip.traction(query.force));
        if wanted.abs() <= limit {
            couplings.push(Coupling {
                element: i,
                by: i,
                slope: 1.0 - 1.0 / stiffness,
            });
            return Some(Law {
                force: wanted,
                by_rate: gain / stiffness,
                ..Law::default()
            });
        }
        let by_traction = if slips { wanted.signum() } else { 0.0 };
        self.grip.couple(i, query.force, by_traction, couplings);
        Some(Law {
            force: limit.copysign(wanted),
            ..Law::default()
        })
    }

    fn guard_kind(&self) -> Option<GuardKind> {
        Some(GuardKind::Corner)
    }

    /// Two guards: the excess of the demanded force over the limit, and, while the force is limited, the excess of
    /// the traction over the drive's own limit.
    fn guards(&self, at: &At, put: &mut dyn FnMut(Guard)) {
        let Drive {
            gain,
            max_force,
            body,
            ..
        } = *self.drive;
        let (state, mechanics) = (at.state, at.mechanics);
        let reference = at
            .switches
            .drive_speed(&mechanics.scene.actuators, self.index, state.t);
        let speed = if mechanics.has_sliding_rails() {
            at.slip() - at.rows.rate_offset[at.index]
        } else {
            dot(
                &self.grip.row,
                &mechanics.body(body, state.t, &state.q, &state.v).1,
            )
        };
        let margins = match reference {
            Some(reference) => {
                let traction = self.grip.traction(&state.force);
                let limit = if self.is_gripped {
                    traction.min(max_force)
                } else {
                    max_force
                };
                let beyond = (gain * (reference - speed)).abs() - limit;
                let spare = if self.is_gripped && beyond > 0.0 {
                    traction - max_force
                } else {
                    0.0
                };
                [beyond, spare].map(|margin| if margin.is_finite() { margin } else { 0.0 })
            }
            None => [0.0; 2],
        };
        for value in margins {
            put(Guard {
                value,
                stiffness: 1.0,
            });
        }
    }

    fn stored(&self, at: &At, energy: &mut Stored) {
        if !at.probes.sliding.is_empty() {
            energy.structure += at.rail_energy();
        }
    }

    fn power(&self, at: &At, power: &mut Exchanged) {
        power.drives -= at.force() * (at.slip() - at.rows.rate_offset[at.index]);
    }

    fn channels(&self, _: &Mechanics) -> Vec<(Channel, f64)> {
        let count = self.grip.wheels.len() as f64;
        let wheels = self
            .grip
            .wheels
            .iter()
            .map(|&w| (Channel::Traction(w), count));
        wheels
            .chain([(Channel::Drive(self.drive.body), -1.0)])
            .collect()
    }
}
