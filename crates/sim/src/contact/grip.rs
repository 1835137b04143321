//! The wheels through which a drive or a brake acts: where they touch their rails, and how hard they are pressed.

use splines::Axis;

use super::element::{Coupling, ElementProbe};
use crate::mechanics::assembly::Mechanics;
use crate::scene::dof::arm_rows;

/// Wheels of some contacts of a body, acted on evenly at their treads.
pub(crate) struct Grip {
    /// Mean row of the treads: their speed along x by the body's degrees of freedom; that of the origin without wheels.
    pub row: [f64; 6],
    pub wheels: Vec<usize>,
    /// Vertical contacts whose force lets the element act, each with its mu.
    pressed: Vec<(usize, f64)>,
}

impl Grip {
    /// The grip of `contacts`; with `is_limited` its traction, the sum of mu N, limits the force.
    pub fn new(mechanics: &Mechanics, contacts: &[usize], is_limited: bool) -> Grip {
        let all = mechanics.wheels.iter().enumerate();
        let wheels = all.filter(|(_, wheel)| contacts.contains(&wheel.contact)).map(|(w, _)| w).collect();
        let pressed = if is_limited { pressed(mechanics, contacts) } else { Vec::new() };
        Grip { row: tread_row(mechanics, contacts), wheels, pressed }
    }

    /// Sum of mu N, N >= 0.
    pub fn traction(&self, force: &[f64]) -> f64 {
        self.pressed.iter().map(|&(vertical, mu)| mu * force[vertical].max(0.0)).sum()
    }

    /// Adds the slopes of a law that grows with the traction by `slope`.
    pub fn couple(&self, element: usize, force: &[f64], slope: f64, couplings: &mut Vec<Coupling>) {
        for &(vertical, mu) in self.pressed.iter().filter(|(vertical, _)| force[*vertical] > 0.0) {
            couplings.push(Coupling { element, by: vertical, slope: slope * mu });
        }
    }

    /// A probe along the rail below every wheel.
    pub fn probes(&self) -> Vec<ElementProbe> {
        let weight = 1.0 / self.wheels.len() as f64;
        let wheels = self.wheels.iter();
        wheels.map(|&wheel| ElementProbe { wheel, weight, axis: Axis::Longitudinal, part: None }).collect()
    }
}

/// Mean over the wheels of `contacts` of the rows of their treads; the origin's where there are none.
fn tread_row(mechanics: &Mechanics, contacts: &[usize]) -> [f64; 6] {
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

fn pressed(mechanics: &Mechanics, contacts: &[usize]) -> Vec<(usize, f64)> {
    let groups = mechanics.groups.iter().enumerate().filter(|(_, group)| contacts.contains(&group.contact));
    groups
        .filter_map(|(i, group)| Some((i, mechanics.scene.wheels[group.kind].friction.as_ref()?.coefficient)))
        .collect()
}
