//! Ropes and stops as components: approach, rate, and which of them pull or push.
//!
//! The approach of a rope is its stretch l - l0, that of a stop its depth; both grow with the force's own row, so
//! that f = -row^T F. Rows are those of the last state: a stage repeats them until they are at rest.

use nalgebra::DVector;

use crate::mechanics::assembly::Mechanics;
use crate::mechanics::point::Point;
use crate::{Moving, Rope, RopeEnd, Stop};

/// Rounding of a stretch or depth, relative to the places it comes from.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A rope or a stop.
pub(crate) enum Link<'a> {
    Rope { rope: &'a Rope, from: Point, to: Point },
    Stop { stop: &'a Stop, point: Point, bearer: Option<Point> },
}

/// A link at one state.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hold {
    pub stiffness: f64,
    pub damping: f64,
    /// Unit vector along which the approach grows: from `from` to `to` of a rope, into a stop.
    pub direction: [f64; 3],
    /// Distance of the ends of a rope; depth of a stop.
    pub length: f64,
    /// Unstretched length of a rope, and its rate.
    pub natural: [f64; 2],
    /// Force below which rounding of places hides whether it acts.
    pub noise: f64,
    /// Whether it pulls or pushes.
    pub taut: bool,
}

impl<'a> Link<'a> {
    /// All links of a scene: its ropes, then its stops.
    pub fn all(mechanics: &Mechanics<'a>) -> Vec<Link<'a>> {
        let actuators = &mechanics.scene.actuators;
        let ropes = actuators.ropes.iter().map(|rope| Link::Rope {
            rope,
            from: Point::new(mechanics, &rope.from),
            to: Point::new(mechanics, &rope.to),
        });
        let stops = actuators.stops.iter().map(|stop| {
            let end = RopeEnd { body: Some(stop.body), at: stop.at };
            let point = Point::on_track(mechanics, &end);
            let rest = DVector::zeros(mechanics.dofs);
            let bearer = stop.against.map(|b| {
                let origin = Point::on_track(mechanics, &RopeEnd { body: Some(b), at: [0.0; 3] });
                let apart = point.place(mechanics, 0.0, &rest) - origin.place(mechanics, 0.0, &rest);
                Point::on_track(mechanics, &RopeEnd { body: Some(b), at: [0.0, apart.y, apart.z] })
            });
            Link::Stop { stop, point, bearer }
        });
        ropes.chain(stops).collect()
    }

    /// Whether it is fixed to body `b`.
    pub fn is_on(&self, b: usize) -> bool {
        match self {
            Link::Rope { from, to, .. } => from.body == Some(b) || to.body == Some(b),
            Link::Stop { point, bearer, .. } => {
                point.body == Some(b) || bearer.as_ref().is_some_and(|bearer| bearer.body == Some(b))
            }
        }
    }

    /// Adds `direction` times the rows of the vector that its approach measures to `row`, at (t, q).
    pub fn add_row(
        &self,
        mechanics: &Mechanics,
        at: (f64, &DVector<f64>),
        direction: [f64; 3],
        row: &mut [f64],
    ) {
        match self {
            Link::Rope { from, to, .. } => {
                to.add_row(mechanics, at, direction, row);
                from.add_row(mechanics, at, direction.map(|d| -d), row);
            }
            Link::Stop { point, bearer, .. } => {
                point.add_row(mechanics, at, direction, row);
                if let Some(bearer) = bearer {
                    bearer.add_row(mechanics, at, direction.map(|d| -d), row);
                }
            }
        }
    }

    /// Rate of its approach along `direction` by the x of body `b`, at (t, q).
    pub fn by_travel(
        &self,
        mechanics: &Mechanics,
        b: usize,
        (t, q): (f64, &DVector<f64>),
        direction: [f64; 3],
    ) -> f64 {
        let by = |point: &Point| scalar(direction, point.by_travel(mechanics, b, t, q));
        match self {
            Link::Rope { from, to, .. } => by(to) - by(from),
            Link::Stop { point, bearer, .. } => by(point) - bearer.as_ref().map_or(0.0, by),
        }
    }

    /// Approach at (t, q), and its rate by prescribed motions and hoisting; brings `hold` there. A rope has the
    /// unstretched length `natural`, with its rate.
    pub fn read(
        &self,
        mechanics: &Mechanics,
        travel: &[Moving],
        t: f64,
        q: &DVector<f64>,
        natural: [f64; 2],
        hold: &mut Hold,
    ) -> [f64; 2] {
        match self {
            Link::Rope { rope, from, to } => {
                let (a, b) = (from.position(mechanics, t, q), to.position(mechanics, t, q));
                let reach = difference(b, a);
                hold.length = norm(reach);
                if hold.length > 0.0 {
                    hold.direction = reach.map(|r| r / hold.length);
                } else {
                    hold.direction = [0.0, -1.0, 0.0];
                }
                hold.natural = natural;
                hold.stiffness = rope.stiffness / hold.natural[0];
                hold.damping = rope.damping;
                let size = a.iter().chain(&b).fold(hold.length, |max, c| max.max(c.abs()));
                hold.noise = ROUNDING * hold.stiffness * size;
                let drift =
                    difference(to.drift(mechanics, travel, t, q), from.drift(mechanics, travel, t, q));
                [hold.length - hold.natural[0], scalar(hold.direction, drift) - hold.natural[1]]
            }
            Link::Stop { stop, point, bearer } => {
                let place = point.position(mechanics, t, q)[stop.axis];
                let borne = bearer.as_ref().map_or(0.0, |at| at.position(mechanics, t, q)[stop.axis]);
                hold.direction = [0.0; 3];
                hold.direction[stop.axis] = stop.side;
                hold.length = stop.side * (place - borne - stop.place);
                (hold.stiffness, hold.damping) = (stop.stiffness, stop.damping);
                hold.noise = ROUNDING * hold.stiffness * place.abs().max(stop.place.abs()).max(borne.abs());
                let drift = |point: &Point| scalar(hold.direction, point.drift(mechanics, travel, t, q));
                [hold.length, drift(point) - bearer.as_ref().map_or(0.0, drift)]
            }
        }
    }
}

impl Hold {
    /// Force by stretch or depth `p` and its rate, as if it could do both pull and push.
    pub fn law(&self, p: f64, rate: f64) -> f64 {
        self.stiffness * p + self.damping * rate
    }
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn scalar(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: [f64; 3]) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}
