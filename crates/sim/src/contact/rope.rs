//! An elastic rope between two points: T = EA (l - l0)/l0 + c (l' - l0') if it is taut.

use super::active::ActiveSet;
use super::element::{At, Coupling, Element, Law, Local, Query, Role, Where};
use super::energy::{Exchanged, Stored};
use super::rows::RowMut;
use super::spring;
use super::switches::Switches;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::point::{Point, PointPair, difference, scalar};
use crate::{Channel, Rope};

/// The tension of one rope.
pub(crate) struct RopeForce<'a> {
    pub rope: &'a Rope,
    index: usize,
    /// The pair from the end `from` to the end `to`; boxed, because the other kinds of elements are much smaller.
    points: Box<PointPair>,
}

impl<'a> RopeForce<'a> {
    /// All ropes of a scene.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Self> {
        let ropes = mechanics.scene.actuators.ropes.iter().enumerate();
        ropes
            .map(|(index, rope)| {
                let from = Some(Point::new(mechanics, &rope.from));
                let points = PointPair {
                    from,
                    to: Point::new(mechanics, &rope.to),
                    swings: true,
                };
                RopeForce {
                    rope,
                    index,
                    points: Box::new(points),
                }
            })
            .collect()
    }

    /// Both ends; `None` if there is no first end.
    pub fn ends(&self) -> Option<[&Point; 2]> {
        Some([self.points.from.as_ref()?, &self.points.to])
    }
}

impl Element for RopeForce<'_> {
    fn update_row(&self, at: &Where, row: &mut RowMut, local: &mut Local) {
        let Some([from, to]) = self.ends() else {
            return;
        };
        let (mechanics, hold) = (at.mechanics, &mut local.spring);
        let (a, b) = (
            from.position(mechanics, at.t, at.q),
            to.position(mechanics, at.t, at.q),
        );
        let reach = difference(b, a);
        hold.length = reach[0].hypot(reach[1]).hypot(reach[2]);
        if hold.length > 0.0 {
            hold.direction = reach.map(|r| r / hold.length);
        } else {
            hold.direction = [0.0, -1.0, 0.0];
        }
        hold.unstretched = at
            .switches
            .unstretched(&mechanics.scene.actuators, self.index, at.t);
        hold.stiffness = self.rope.stiffness / hold.unstretched[0];
        hold.damping = self.rope.damping;
        let size = a
            .iter()
            .chain(&b)
            .fold(hold.length, |max, c| max.max(c.abs()));
        hold.noise = spring::ROUNDING * hold.stiffness * size;
        let travel = &at.places.travel;
        let drift = difference(
            to.drift(mechanics, travel, at.t, at.q),
            from.drift(mechanics, travel, at.t, at.q),
        );
        let moved = [
            hold.length - hold.unstretched[0],
            scalar(hold.direction, drift) - hold.unstretched[1],
        ];
        spring::write_row(&self.points, at, hold.direction, moved, row);
    }

    fn follows_motion(&self) -> bool {
        true
    }

    fn points(&self) -> Option<&PointPair> {
        Some(&self.points)
    }

    fn role(&self) -> Role {
        Role::Spring
    }

    fn is_released(&self, switches: &Switches) -> bool {
        switches.is_released(self.index)
    }

    fn begins_active(&self) -> bool {
        false
    }

    fn feels_rates(&self) -> bool {
        true
    }

    fn law(&self, query: &Query, _: &mut Vec<Coupling>) -> Option<Law> {
        spring::law(query)
    }

    fn switch(&self, at: &At, active: &ActiveSet) -> Option<f64> {
        Some(if self.is_released(at.switches) {
            -1.0
        } else {
            spring::switch(at, active)
        })
    }

    fn stored(&self, at: &At, energy: &mut Stored) {
        spring::stored(at, energy);
    }

    fn power(&self, at: &At, power: &mut Exchanged) {
        let spring = &at.local().spring;
        let p = at.approach();
        spring::dissipate(at, power);
        if spring.unstretched[1] != 0.0 {
            // The elastic energy EA p^2/(2 l0) also depends on l0 explicitly.
            let share = 0.5 * spring.stiffness * p * p / spring.unstretched[0];
            power.hoists -= (at.force() + share) * spring.unstretched[1];
        }
    }

    fn resistance(&self, at: &At, b: usize) -> f64 {
        spring::resistance(&self.points, at, b)
    }

    fn channels(&self, _: &Mechanics) -> Vec<(Channel, f64)> {
        vec![(Channel::Tension(self.index), 1.0)]
    }

    fn own_channels(&self) -> Vec<Channel> {
        vec![Channel::Tension(self.index), Channel::Length(self.index)]
    }

    fn length_channel(&self) -> Option<Channel> {
        Some(Channel::Length(self.index))
    }
}
