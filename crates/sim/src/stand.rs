//! What stands on the rails: physical wheels, and the vertical components that they press with.

use std::ops::Range;

use crate::{Error, Foundation, Profile, Scene};

/// One physical wheel.
pub(crate) struct WheelPoint<'a> {
    pub body: usize,
    pub contact: usize,
    pub kind: usize,
    /// Hub from the body's origin.
    pub hub: [f64; 3],
    /// Index of its spin among the freedoms.
    pub spin: Option<usize>,
    /// Its spin over time, where it is prescribed.
    pub turn: Option<&'a Profile>,
}

/// One vertical contact component.
pub(crate) struct Normal {
    pub wheels: Range<usize>,
    pub kind: usize,
    pub contact: usize,
    /// Which rigid part it presses on, where every part has its own force.
    pub part: Option<usize>,
}

impl Normal {
    /// Number of wheels that share the force.
    pub fn count(&self) -> f64 {
        self.wheels.len() as f64
    }
}

/// Wheels and vertical components of all contacts.
pub(crate) struct Stand<'a> {
    pub wheels: Vec<WheelPoint<'a>>,
    pub normals: Vec<Normal>,
    /// Those of each contact.
    pub bearing: Vec<Range<usize>>,
}

impl<'a> Stand<'a> {
    /// Lists them; `next` numbers the spins.
    pub fn new(
        scene: &'a Scene,
        foundations: &[Foundation],
        mut next: impl FnMut() -> usize,
    ) -> Result<Self, Error> {
        let (mut wheels, mut normals, mut bearing) = (Vec::new(), Vec::new(), Vec::new());
        for (index, contact) in scene.contacts.iter().enumerate() {
            let first = wheels.len();
            let kind = &scene.wheels[contact.wheel];
            for (own, offset) in contact.offsets.iter().enumerate() {
                let [x, y, z] = contact.at;
                let mut turns = scene.actuators.turns.iter();
                let turn =
                    turns.find(|turn| (turn.contact, turn.wheel) == (index, own)).map(|turn| &turn.motion);
                let spins = kind.spin_inertia.is_some() && kind.friction.is_some() && turn.is_none();
                let spin = if spins { Some(next()) } else { None };
                wheels.push(WheelPoint {
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
                    let chain = chains
                        .get(contact.rail)
                        .ok_or(Error::NoSuch { what: "rail", index: contact.rail })?;
                    (0..chain.count()).map(Some).collect()
                }
                None => vec![None],
            };
            bearing.push(normals.len()..normals.len() + parts.len());
            for part in parts {
                normals.push(Normal {
                    wheels: first..wheels.len(),
                    kind: contact.wheel,
                    contact: index,
                    part,
                });
            }
        }
        Ok(Stand { wheels, normals, bearing })
    }
}
