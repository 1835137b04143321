//! Local coordinates of a hanging body during a step: the stretch of its rope and two angles of the rope's direction.
//!
//! A stage solves Q = q + g V, V = v + g A. In Cartesian coordinates, a body on a taut rope would move along the
//! chord of its arc. The chord deviates from the arc by O(g^2), which changes the stretch of the rope, so a stiff
//! rope would require very small steps. In the coordinates y = (s, alpha, beta), where s is the stretch, the arc is a
//! straight line. With a the other end of the rope, l its unstretched length and u its direction,
//!
//! x = a + (l + s) u,  x' = a' + l' u + J y',  x'' = a'' + J y'' + c,  J = [u, (l + s) u_alpha, (l + s) u_beta],
//!
//! The stage in local coordinates, Y = y + g Y', Y' = y' + g Y'', then has the form of the stage above,
//! V = (a' + l' u + J y' - g (a_p'' + c)) + g A. It is linearised about the last guess, and only the constant terms
//! q and v of the body change. a_p is the part of a that follows prescribed motions.
//!
//! # Source
//! Integration in local coordinates: Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), IV.5.3.

use nalgebra::{DVector, Vector3};

use crate::contact::switches::Switches;
use crate::contact::system::System;
use crate::mechanics::point::Point;
use crate::mechanics::state::State;

/// Shortest distance of the rope ends for which a chart is used, relative to the unstretched length of the rope.
const SHORTEST: f64 = 0.1;

/// Local coordinates of one body about the other end of its rope.
#[derive(Clone)]
pub(crate) struct Chart {
    /// Index of the rope.
    pub rope: usize,
    /// Whether the body is at the end `to` of the rope.
    pub forward: bool,
    /// Numbers of the degrees of freedom X, Y and Z of the body.
    pub numbers: [usize; 3],
    /// Direction of the rope at the start of the step, and two unit vectors perpendicular to it.
    pub frame: [Vector3<f64>; 3],
    /// Coordinates and rates at the start of the step.
    pub start: [[f64; 3]; 2],
    /// Constant terms of the coordinates and rates of the stage.
    pub known: [[f64; 3]; 2],
    /// Second time derivatives of the coordinates in the last stage.
    pub acceleration: [f64; 3],
}

/// The other end of the rope, its prescribed motion, and the unstretched length with its first and second rates.
pub(crate) struct Anchor<'s> {
    pub point: &'s Point,
    /// Velocity and acceleration due to prescribed motions.
    pub given: [Vector3<f64>; 2],
    pub unstretched: [f64; 3],
}

/// Coordinates, rates and tangent vectors of a chart at one state.
pub(crate) struct Local {
    pub y: [f64; 3],
    pub rate: [f64; 3],
    pub span: f64,
    /// u, u_alpha, u_beta.
    pub along: [Vector3<f64>; 3],
    /// cos beta squared.
    pub cos_squared: f64,
    /// Acceleration c in the equation of x'' of the module.
    pub curve: Vector3<f64>,
}

impl Local {
    /// J w.
    pub fn apply(&self, w: [f64; 3]) -> Vector3<f64> {
        let [u, across, over] = self.along;
        u * w[0] + (across * w[1] + over * w[2]) * self.span
    }

    /// J^-1 w.
    pub fn solve(&self, w: Vector3<f64>) -> [f64; 3] {
        let [u, across, over] = self.along;
        [
            u.dot(&w),
            across.dot(&w) / (self.span * self.cos_squared),
            over.dot(&w) / self.span,
        ]
    }
}

impl Chart {
    /// The end of the rope away from the body, then the end at the body.
    fn ends<'s>(&self, system: &'s System) -> Option<[&'s Point; 2]> {
        let [from, to] = system.rope(self.rope)?.1.ends()?;
        Some(if self.forward { [from, to] } else { [to, from] })
    }

    pub fn anchor<'s>(
        &self,
        system: &'s System,
        switches: &Switches,
        t: f64,
    ) -> Option<Anchor<'s>> {
        let [point, _] = self.ends(system)?;
        let mut given = [Vector3::zeros(); 2];
        for (b, body) in system.scene.bodies.iter().enumerate() {
            let Some(profile) = &body.motion else {
                continue;
            };
            if point
                .body
                .is_some_and(|own| system.mechanics.kinematics.root(own) == b)
            {
                let at = profile.at(t);
                given[0].x += at.v;
                given[1].x += at.a;
            }
        }
        let actuators = &system.scene.actuators;
        let [length, rate] = switches.unstretched(actuators, self.rope, t);
        let unstretched = [
            length,
            rate,
            switches.unstretched_acceleration(actuators, self.rope, t),
        ];
        Some(Anchor {
            point,
            given,
            unstretched,
        })
    }

    /// Position of the body in space minus its degrees of freedom X, Y and Z.
    pub fn offset(&self, system: &System) -> Option<Vector3<f64>> {
        let [_, own] = self.ends(system)?;
        Some(own.place(
            &system.mechanics,
            0.0,
            &DVector::zeros(system.mechanics.dofs),
        ))
    }

    pub fn vector(&self, of: &DVector<f64>) -> Vector3<f64> {
        Vector3::from(self.numbers.map(|number| of[number]))
    }

    /// Coordinates, rates and tangent vectors at (t, q, v).
    pub fn local(
        &self,
        system: &System,
        anchor: &Anchor,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> Option<Local> {
        let [e0, e1, e2] = self.frame;
        let [length, length_rate, length_acceleration] = anchor.unstretched;
        let span =
            self.vector(q) + self.offset(system)? - anchor.point.place(&system.mechanics, t, q);
        let speed = self.vector(v) - anchor.point.rate(v) - anchor.given[0];
        let r = span.norm();
        let (alpha, beta) = (
            span.dot(&e1).atan2(span.dot(&e0)),
            (span.dot(&e2) / r).clamp(-1.0, 1.0).asin(),
        );
        let ((sa, ca), (sb, cb)) = (alpha.sin_cos(), beta.sin_cos());
        let (radial, around) = (e0 * ca + e1 * sa, e1 * ca - e0 * sa);
        let u = radial * cb + e2 * sb;
        let along = [u, around * cb, e2 * cb - radial * sb];
        let mut local = Local {
            y: [r - length, alpha, beta],
            rate: [0.0; 3],
            span: r,
            along,
            cos_squared: cb * cb,
            curve: u,
        };
        local.rate = local.solve(speed - u * length_rate);
        let [s, a, b] = local.rate;
        let turn = along[1] * a + along[2] * b;
        local.curve = u * length_acceleration + turn * (2.0 * (length_rate + s))
            - (radial * (cb * a * a) + around * (2.0 * sb * a * b) + u * (b * b)) * r;
        Some(local)
    }
}

impl Chart {
    /// The chart of the body at one end of `rope`, centred on the rope direction at `from`.
    pub fn at(
        system: &System,
        switches: &Switches,
        rope: usize,
        (forward, numbers): (bool, [usize; 3]),
        from: &State,
    ) -> Option<Chart> {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut chart = Chart {
            rope,
            forward,
            numbers,
            frame: axes,
            start: [[0.0; 3]; 2],
            known: [[0.0; 3]; 2],
            acceleration: [0.0; 3],
        };
        let anchor = chart.anchor(system, switches, from.t)?;
        let span = chart.vector(&from.q) + chart.offset(system)?
            - anchor.point.place(&system.mechanics, from.t, &from.q);
        if span.norm() <= SHORTEST * anchor.unstretched[0] {
            return None;
        }
        let along = span.normalize();
        let speed = chart.vector(&from.v) - anchor.point.rate(&from.v) - anchor.given[0];
        let across = speed - along * along.dot(&speed);
        let least = axes[along.iamin()];
        let across = if across.norm() > 1e-9 * (1.0 + speed.norm()) {
            across
        } else {
            along.cross(&least)
        };
        let across = across.normalize();
        chart.frame = [along, across, along.cross(&across)];
        let local = chart.local(system, &anchor, from.t, &from.q, &from.v)?;
        let acceleration =
            chart.vector(&from.a) - anchor.point.rate(&from.a) - anchor.given[1] - local.curve;
        chart.start = [local.y, local.rate];
        chart.acceleration = local.solve(acceleration);
        Some(chart)
    }

    /// Sets the position and the velocity of the body in `at` from the coordinates `y` and their `rate`; the other
    /// end of the rope is at its position in `at`.
    pub fn place(
        &self,
        system: &System,
        switches: &Switches,
        y: [f64; 3],
        rate: [f64; 3],
        at: &mut State,
    ) {
        let (Some(anchor), Some(offset)) =
            (self.anchor(system, switches, at.t), self.offset(system))
        else {
            return;
        };
        let [e0, e1, e2] = self.frame;
        let ((sa, ca), (sb, cb)) = (y[1].sin_cos(), y[2].sin_cos());
        let (radial, around) = (e0 * ca + e1 * sa, e1 * ca - e0 * sa);
        let (u, over) = (radial * cb + e2 * sb, e2 * cb - radial * sb);
        let span = anchor.unstretched[0] + y[0];
        let q = anchor.point.place(&system.mechanics, at.t, &at.q) + u * span - offset;
        let v = anchor.point.rate(&at.v)
            + anchor.given[0]
            + u * (anchor.unstretched[1] + rate[0])
            + (around * (cb * rate[1]) + over * rate[2]) * span;
        for (k, &number) in self.numbers.iter().enumerate() {
            (at.q[number], at.v[number]) = (q[k], v[k]);
        }
    }
}
