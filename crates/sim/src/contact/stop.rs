//! A one-sided stop: a point of a body meets a plane in space or on another body, with the reaction k p + c p'.

use nalgebra::DVector;

use super::active::ActiveSet;
use super::element::{At, Coupling, Element, Law, Local, Query, Role, Where};
use super::energy::{Exchanged, Stored};
use super::rows::RowMut;
use super::spring;
use crate::mechanics::assembly::Mechanics;
use crate::mechanics::point::{Point, PointPair, scalar};
use crate::{Channel, RopeEnd, Stop};

/// The force of one stop.
pub(crate) struct StopForce<'a> {
    stop: &'a Stop,
    index: usize,
    /// The pair from the body with the plane, if there is one, to the point that meets the plane.
    points: Box<PointPair>,
}

impl<'a> StopForce<'a> {
    /// Index of the stop in the scene.
    pub fn index(&self) -> usize {
        self.index
    }

    /// All stops of a scene.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Self> {
        let stops = mechanics.scene.actuators.stops.iter().enumerate();
        stops
            .map(|(index, stop)| {
                let to = Point::on_track(
                    mechanics,
                    &RopeEnd {
                        body: Some(stop.body),
                        at: stop.at,
                    },
                );
                let rest = DVector::zeros(mechanics.dofs);
                let from = stop.against.map(|b| {
                    let origin = Point::on_track(
                        mechanics,
                        &RopeEnd {
                            body: Some(b),
                            at: [0.0; 3],
                        },
                    );
                    let apart =
                        to.place(mechanics, 0.0, &rest) - origin.place(mechanics, 0.0, &rest);
                    Point::on_track(
                        mechanics,
                        &RopeEnd {
                            body: Some(b),
                            at: [0.0, apart.y, apart.z],
                        },
                    )
                });
                StopForce {
                    stop,
                    index,
                    points: Box::new(PointPair {
                        from,
                        to,
                        swings: false,
                    }),
                }
            })
            .collect()
    }
}

impl Element for StopForce<'_> {
    fn update_row(&self, at: &Where, row: &mut RowMut, local: &mut Local) {
        let (stop, mechanics, hold) = (self.stop, at.mechanics, &mut local.spring);
        let PointPair {
            from: bearer,
            to: point,
            ..
        } = &*self.points;
        let place = point.position(mechanics, at.t, at.q)[stop.axis];
        let borne = bearer.as_ref().map_or(0.0, |bearer| {
            bearer.position(mechanics, at.t, at.q)[stop.axis]
        });
        hold.direction = [0.0; 3];
        hold.direction[stop.axis] = stop.side;
        hold.length = stop.side * (place - borne - stop.place);
        (hold.stiffness, hold.damping) = (stop.stiffness, stop.damping);
        hold.noise =
            spring::ROUNDING * hold.stiffness * place.abs().max(stop.place.abs()).max(borne.abs());
        let drift = |point: &Point| {
            scalar(
                hold.direction,
                point.drift(mechanics, &at.places.travel, at.t, at.q),
            )
        };
        let moved = [
            hold.length,
            drift(point) - bearer.as_ref().map_or(0.0, drift),
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
        Some(spring::switch(at, active))
    }

    fn stored(&self, at: &At, energy: &mut Stored) {
        spring::stored(at, energy);
    }

    fn power(&self, at: &At, power: &mut Exchanged) {
        spring::dissipate(at, power);
    }

    fn resistance(&self, at: &At, b: usize) -> f64 {
        spring::resistance(&self.points, at, b)
    }

    fn channels(&self, _: &Mechanics) -> Vec<(Channel, f64)> {
        vec![(Channel::Stop(self.index), 1.0)]
    }

    fn own_channels(&self) -> Vec<Channel> {
        vec![Channel::Stop(self.index)]
    }
}
