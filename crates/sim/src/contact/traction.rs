//! Friction along the rail below a wheel with spin: T = mu N S(s), where s is the sliding velocity.

use splines::Axis;

use super::element::{At, Coupling, Element, ElementProbe, Law, Local, Query, Where};
use super::energy::{Exchanged, Stored};
use super::rows::RowMut;
use crate::mechanics::assembly::Mechanics;
use crate::scene::dof::arm_rows;
use crate::{Channel, Friction};

/// The friction of one wheel.
pub(crate) struct Traction<'a> {
    friction: &'a Friction,
    wheel: usize,
    /// The vertical contacts of the wheel, each with the number of wheels that share its force.
    verticals: Vec<(usize, f64)>,
}

impl<'a> Traction<'a> {
    /// The friction of all wheels whose spin is a degree of freedom or prescribed.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Self> {
        let wheels = mechanics.wheels.iter().enumerate();
        wheels
            .filter(|(_, wheel)| wheel.spin.is_some() || wheel.turn.is_some())
            .filter_map(|(w, wheel)| {
                let count = |i: usize| (i, mechanics.groups[i].count());
                Some(Traction {
                    friction: mechanics.scene.wheels[wheel.kind].friction.as_ref()?,
                    wheel: w,
                    verticals: mechanics.groups_of(w).map(count).collect(),
                })
            })
            .collect()
    }

    /// Index of the wheel.
    pub fn wheel(&self) -> usize {
        self.wheel
    }
}

impl Element for Traction<'_> {
    fn constant_row(&self, mechanics: &Mechanics, row: &mut RowMut) {
        let wheel = &mechanics.wheels[self.wheel];
        row.add_rate(&mechanics.kinematics, wheel.body, arm_rows(wheel.hub)[0]);
    }

    fn update_row(&self, at: &Where, row: &mut RowMut, _: &mut Local) {
        let (w, mechanics) = (self.wheel, at.mechanics);
        let wheel = &mechanics.wheels[w];
        if let Some(spin) = wheel.spin {
            row.rate[spin] += at.places.height[w];
        }
        let spin = mechanics
            .turn(w, at.t)
            .map_or(0.0, |turn| turn.v * at.places.height[w]);
        let travel = at.places.travel[mechanics.kinematics.root(wheel.body)].v;
        *row.rate_offset = travel + spin;
    }

    fn row_changes(&self) -> [bool; 2] {
        [false, true]
    }

    fn probes(&self, _: &Mechanics) -> Vec<ElementProbe> {
        vec![ElementProbe {
            wheel: self.wheel,
            weight: 1.0,
            axis: Axis::Longitudinal,
            part: None,
        }]
    }

    fn body(&self, mechanics: &Mechanics) -> Option<usize> {
        Some(mechanics.wheels[self.wheel].body)
    }

    fn is_tangential(&self) -> bool {
        true
    }

    fn uses_height(&self) -> bool {
        true
    }

    fn feels_rates(&self) -> bool {
        true
    }

    fn law(&self, query: &Query, couplings: &mut Vec<Coupling>) -> Option<Law> {
        let mu = self.friction.coefficient;
        let load: f64 = self
            .verticals
            .iter()
            .map(|&(n, count)| query.force[n] / count)
            .sum();
        let (share, by_slip) = self.friction.fraction(query.rate);
        for &(n, count) in &self.verticals {
            couplings.push(Coupling {
                element: query.index,
                by: n,
                slope: mu * share / count,
            });
        }
        Some(Law {
            force: mu * load * share,
            by_rate: mu * load * by_slip,
            ..Law::default()
        })
    }

    fn stored(&self, at: &At, energy: &mut Stored) {
        if !at.probes.sliding.is_empty() {
            energy.structure += at.rail_energy();
        }
    }

    fn power(&self, at: &At, power: &mut Exchanged) {
        power.friction += at.force() * at.slip();
    }

    fn resistance(&self, at: &At, b: usize) -> f64 {
        let body = at.mechanics.wheels[self.wheel].body;
        if at.mechanics.kinematics.root(body) == b {
            at.force()
        } else {
            0.0
        }
    }

    fn channels(&self, _: &Mechanics) -> Vec<(Channel, f64)> {
        vec![(Channel::Traction(self.wheel), 1.0)]
    }
}
