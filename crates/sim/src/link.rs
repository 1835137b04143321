//! Ropes and stops as components: approach, rate, and which of them pull or push.
//!
//! The approach of a rope is its stretch l - l0, that of a stop its depth; both grow with the force's own row, so
//! that f = -row^T F. Rows are those of the last state: a stage repeats them until they are at rest.

use nalgebra::DVector;

use crate::dense::along;
use crate::geometry::Geometry;
use crate::point::Point;
use crate::state::State;
use crate::system::System;
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
    pub fn all(system: &System<'a>) -> Vec<Link<'a>> {
        let actuators = &system.scene.actuators;
        let ropes = actuators.ropes.iter().map(|rope| Link::Rope {
            rope,
            from: Point::new(system, &rope.from),
            to: Point::new(system, &rope.to),
        });
        let stops = actuators.stops.iter().map(|stop| {
            let end = RopeEnd { body: Some(stop.body), at: stop.at };
            let point = Point::on_track(system, &end);
            let rest = DVector::zeros(system.freedoms);
            let bearer = stop.against.map(|b| {
                let origin = Point::on_track(system, &RopeEnd { body: Some(b), at: [0.0; 3] });
                let apart = point.place(system, 0.0, &rest) - origin.place(system, 0.0, &rest);
                Point::on_track(system, &RopeEnd { body: Some(b), at: [0.0, apart.y, apart.z] })
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
    pub fn add_row(&self, system: &System, at: (f64, &DVector<f64>), direction: [f64; 3], row: &mut [f64]) {
        match self {
            Link::Rope { from, to, .. } => {
                to.add_row(system, at, direction, row);
                from.add_row(system, at, direction.map(|d| -d), row);
            }
            Link::Stop { point, bearer, .. } => {
                point.add_row(system, at, direction, row);
                if let Some(bearer) = bearer {
                    bearer.add_row(system, at, direction.map(|d| -d), row);
                }
            }
        }
    }

    /// Rate of its approach along `direction` by the x of body `b`, at (t, q).
    pub fn by_travel(
        &self,
        system: &System,
        b: usize,
        (t, q): (f64, &DVector<f64>),
        direction: [f64; 3],
    ) -> f64 {
        let by = |point: &Point| scalar(direction, point.by_travel(system, b, t, q));
        match self {
            Link::Rope { from, to, .. } => by(to) - by(from),
            Link::Stop { point, bearer, .. } => by(point) - bearer.as_ref().map_or(0.0, by),
        }
    }

    /// Approach at (t, q), and its rate by prescribed motions and hoisting; brings `hold` there. A rope has the
    /// unstretched length `natural`, with its rate.
    fn read(
        &self,
        system: &System,
        travel: &[Moving],
        t: f64,
        q: &DVector<f64>,
        natural: [f64; 2],
        hold: &mut Hold,
    ) -> [f64; 2] {
        match self {
            Link::Rope { rope, from, to } => {
                let (a, b) = (from.position(system, t, q), to.position(system, t, q));
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
                let drift = difference(to.drift(system, travel, t, q), from.drift(system, travel, t, q));
                [hold.length - hold.natural[0], scalar(hold.direction, drift) - hold.natural[1]]
            }
            Link::Stop { stop, point, bearer } => {
                let place = point.position(system, t, q)[stop.axis];
                let borne = bearer.as_ref().map_or(0.0, |at| at.position(system, t, q)[stop.axis]);
                hold.direction = [0.0; 3];
                hold.direction[stop.axis] = stop.side;
                hold.length = stop.side * (place - borne - stop.place);
                (hold.stiffness, hold.damping) = (stop.stiffness, stop.damping);
                hold.noise = ROUNDING * hold.stiffness * place.abs().max(stop.place.abs()).max(borne.abs());
                let drift = |point: &Point| scalar(hold.direction, point.drift(system, travel, t, q));
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

impl Geometry {
    /// Rows, approaches and rates of the links at (t, q); prescribed motions are where they are at t.
    pub fn update_links(&mut self, system: &System, t: f64, q: &DVector<f64>) {
        let n = system.freedoms;
        for (index, link) in system.links.iter().enumerate() {
            let component = system.link(index);
            let natural = match link {
                Link::Rope { .. } => self.switches.natural(&system.scene.actuators, index, t),
                Link::Stop { .. } => [0.0; 2],
            };
            let [approach, rate] = link.read(system, &self.travel, t, q, natural, &mut self.links[index]);
            let span = component * n..(component + 1) * n;
            let row = &mut self.rows[span.clone()];
            row.fill(0.0);
            link.add_row(system, (t, q), self.links[index].direction, row);
            self.rate_rows[span].copy_from_slice(&self.rows[component * n..(component + 1) * n]);
            self.held[component] = approach - along(&self.rows, component, q.as_slice());
            self.rate_held[component] = rate;
        }
    }

    /// The force by which link `index` pulls or pushes at `at`; negative where it must not act: the lesser of its law
    /// and its spring, since the damper's force may jump where it begins.
    pub fn margin(&self, system: &System, index: usize, at: &State) -> f64 {
        let (component, hold) = (system.link(index), &self.links[index]);
        let p = self.approach(component, &at.q);
        hold.law(p, self.rate(component, &at.v)).min(hold.stiffness * p)
    }

    /// Finds which links act at `at`.
    pub fn settle_links(&mut self, system: &System, at: &State) {
        for index in 0..system.links.len() {
            let holds = !self.switches.is_released(index);
            self.links[index].taut = holds && self.margin(system, index, at) > 0.0;
        }
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
