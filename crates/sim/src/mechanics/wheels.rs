//! The wheels of all contacts, and the groups of wheels that share one vertical force.

use std::ops::Range;

use super::kinematics::{Kinematics, Terms};
use crate::scene::dof::arm_rows;
use crate::{Error, Foundation, Profile, Scene};

/// One physical wheel.
pub(crate) struct WheelPoint<'a> {
    pub body: usize,
    pub contact: usize,
    pub kind: usize,
    /// Position of the hub relative to the origin of the body.
    pub hub: [f64; 3],
    /// Index of the spin among the degrees of freedom; `None` where the wheel has no spin of its own.
    pub spin: Option<usize>,
    /// Prescribed spin; `None` where the spin is not prescribed.
    pub turn: Option<&'a Profile>,
}

/// Rail coordinate of a wheel as a linear function of the degrees of freedom, x = constant + travel of its root + terms q.
pub(crate) struct RailCoordinate {
    pub constant: f64,
    /// The root of the body, where its travel is prescribed.
    pub driven: Option<usize>,
    pub terms: Terms,
}

impl RailCoordinate {
    pub fn new(kinematics: &Kinematics, wheel: &WheelPoint) -> Self {
        let (line, root) = (arm_rows(wheel.hub)[0], kinematics.root(wheel.body));
        let constant: f64 = line
            .iter()
            .zip(kinematics.constant(wheel.body))
            .map(|(l, c)| l * c)
            .sum();
        RailCoordinate {
            constant: wheel.hub[0] + constant,
            driven: kinematics.scene.bodies[root]
                .motion
                .is_some()
                .then_some(root),
            terms: kinematics.combine(wheel.body, &line),
        }
    }
}

/// Wheels that share one vertical force: the wheels of a contact, with one group for each rigid part that they may
/// load.
pub(crate) struct WheelGroup {
    pub wheels: Range<usize>,
    pub kind: usize,
    pub contact: usize,
    /// Rigid part that the group loads, where every part has a force of its own.
    pub part: Option<usize>,
}

impl WheelGroup {
    /// Number of wheels that share the force.
    pub fn count(&self) -> f64 {
        self.wheels.len() as f64
    }
}

/// Wheels and wheel groups of all contacts.
pub(crate) struct Wheels<'a> {
    pub points: Vec<WheelPoint<'a>>,
    pub groups: Vec<WheelGroup>,
    /// Range of wheel groups of each contact.
    pub of_contact: Vec<Range<usize>>,
}

impl<'a> Wheels<'a> {
    /// Lists the wheels and groups; `next` returns the index of the next degree of freedom for a spin.
    pub fn new(
        scene: &'a Scene,
        foundations: &[Foundation],
        mut next: impl FnMut() -> usize,
    ) -> Result<Self, Error> {
        let (mut points, mut groups, mut of_contact) = (Vec::new(), Vec::new(), Vec::new());
        for (index, contact) in scene.contacts.iter().enumerate() {
            let first = points.len();
            let kind = &scene.wheels[contact.wheel];
            for (own, offset) in contact.offsets.iter().enumerate() {
                let [x, y, z] = contact.at;
                let mut turns = scene.actuators.spins.iter();
                let turn = turns
                    .find(|turn| (turn.contact, turn.wheel) == (index, own))
                    .map(|turn| &turn.motion);
                let spins =
                    kind.spin_inertia.is_some() && kind.friction.is_some() && turn.is_none();
                let spin = if spins { Some(next()) } else { None };
                points.push(WheelPoint {
                    body: contact.body,
                    contact: index,
                    kind: contact.wheel,
                    hub: [x + offset, y, z],
                    spin,
                    turn,
                });
            }
            let parts: Vec<Option<usize>> = match &foundations[contact.structure].parts {
                Some(chains) => {
                    let chain = chains.get(contact.rail).ok_or(Error::NoSuch {
                        what: "rail",
                        index: contact.rail,
                    })?;
                    (0..chain.count()).map(Some).collect()
                }
                None => vec![None],
            };
            of_contact.push(groups.len()..groups.len() + parts.len());
            for part in parts {
                groups.push(WheelGroup {
                    wheels: first..points.len(),
                    kind: contact.wheel,
                    contact: index,
                    part,
                });
            }
        }
        Ok(Wheels {
            points,
            groups,
            of_contact,
        })
    }
}
