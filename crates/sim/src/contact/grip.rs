//! The wheels through which a drive or a brake acts: their contact points and the limit of traction.

use splines::Axis;

use super::element::{Coupling, ElementProbe};
use crate::mechanics::assembly::Mechanics;
use crate::scene::dof::arm_rows;

/// Wheels of some contacts of a body that transmit the force in equal parts at their treads.
pub(crate) struct Grip {
    /// Mean of the rows of the treads, which yield their speeds along x from the degrees of freedom of the body.
    /// Without wheels it is the row of the body's origin.
    pub row: [f64; 6],
    pub wheels: Vec<usize>,
    /// Vertical contacts whose forces determine the traction, each with its friction coefficient mu.
    pressed: Vec<(usize, f64)>,
}

impl Grip {
    /// The grip of `contacts`. If `is_limited` is true, the traction (the sum of mu N) limits the force.
    pub fn new(mechanics: &Mechanics, contacts: &[usize], is_limited: bool) -> Grip {
        let all = mechanics.wheels.iter().enumerate();
        let wheels = all
            .filter(|(_, wheel)| contacts.contains(&wheel.contact))
            .map(|(w, _)| w)
            .collect();
        let pressed = if is_limited {
            pressed(mechanics, contacts)
        } else {
            Vec::new()
        };
        Grip {
            row: tread_row(mechanics, contacts),
            wheels,
            pressed,
        }
    }

    /// Traction: the sum of mu N over contacts with N > 0.
    pub fn traction(&self, force: &[f64]) -> f64 {
        self.pressed
            .iter()
            .map(|&(vertical, mu)| mu * force[vertical].max(0.0))
            .sum()
    }

    /// Adds the couplings of a law whose derivative with respect to the traction is `slope`.
    pub fn couple(&self, element: usize, force: &[f64], slope: f64, couplings: &mut Vec<Coupling>) {
        for &(vertical, mu) in self
            .pressed
            .iter()
            .filter(|(vertical, _)| force[*vertical] > 0.0)
        {
            couplings.push(Coupling {
                element,
                by: vertical,
                slope: slope * mu,
            });
        }
    }

    /// One longitudinal probe on the rail below every wheel.
    pub fn probes(&self) -> Vec<ElementProbe> {
        let weight = 1.0 / self.wheels.len() as f64;
        let wheels = self.wheels.iter();
        wheels
            .map(|&wheel| ElementProbe {
                wheel,
                weight,
                axis: Axis::Longitudinal,
                part: None,
            })
            .collect()
    }
}

/// Mean of the tread rows of the wheels of `contacts`; the row of the body's origin if there are none.
fn tread_row(mechanics: &Mechanics, contacts: &[usize]) -> [f64; 6] {
    let wheels: Vec<_> = mechanics
        .wheels
        .iter()
        .filter(|wheel| contacts.contains(&wheel.contact))
        .collect();
    if wheels.is_empty() {
        return arm_rows([0.0; 3])[0];
    }
    let mut mean = [0.0; 6];
    for wheel in &wheels {
        let [x, y, z] = wheel.hub;
        let row = arm_rows([x, y - mechanics.scene.wheels[wheel.kind].radius, z])[0];
        mean.iter_mut()
            .zip(row)
            .for_each(|(mean, entry)| *mean += entry / wheels.len() as f64);
    }
    mean
}

fn pressed(mechanics: &Mechanics, contacts: &[usize]) -> Vec<(usize, f64)> {
    let groups = mechanics
        .groups
        .iter()
        .enumerate()
        .filter(|(_, group)| contacts.contains(&group.contact));
    groups
        .filter_map(|(i, group)| {
            Some((
                i,
                mechanics.scene.wheels[group.kind]
                    .friction
                    .as_ref()?
                    .coefficient,
            ))
        })
        .collect()
}
