//! Coordinates in which a stage sees hung bodies: the stretch of the rope and two angles of its direction.
//!
//! A stage solves Q = q + g V, V = v + g A. Over the X, Y and Z of a body on a taut rope it would cut corners: the chord
//! of the arc is off the arc by g^2, the rope is made to pull that much more or less, and a stiff one takes tiny steps.
//! In the coordinates y = (s, alpha, beta) with s the stretch the arc is a straight line. With a the rope's other end, l
//! its unstretched length and u its direction,
//!
//! x = a + (l + s) u,  x' = a' + l' u + J y',  x'' = a'' + J y'' + c,  J = [u, (l + s) u_alpha, (l + s) u_beta],
//!
//! and Y = y + g Y', Y' = y' + g Y'' become a stage of the same form as above,
//! V = (a' + l' u + J y' - g (a_p'' + c)) + g A, linear about the last guess: only q and v of the body change.
//! a_p is the part of a by prescribed motions.
//!
//! # Source
//! Integration in local coordinates: Hairer, Lubich, Wanner, Geometric Numerical Integration (2006), IV.5.3.

use nalgebra::{DVector, Vector3};

use crate::link::Link;
use crate::point::Point;
use crate::rule::Switches;
use crate::solver::{Known, Solver};
use crate::state::State;
use crate::system::System;

/// Shortest rope that is given such coordinates, relative to its unstretched length.
const SHORTEST: f64 = 0.1;

/// The charts of one step, carriers before what hangs on them.
#[derive(Clone, Default)]
pub(crate) struct Charts(Vec<Chart>);

/// Coordinates of one body about the other end of its rope.
#[derive(Clone)]
struct Chart {
    /// Which rope.
    rope: usize,
    /// Whether the body is at the rope's `to`.
    forward: bool,
    /// Numbers of its X, Y and Z.
    numbers: [usize; 3],
    /// Direction of the rope at the start of the step, and two across it.
    frame: [Vector3<f64>; 3],
    /// Coordinates and rates at the start of the step.
    start: [[f64; 3]; 2],
    /// Known parts of the stage's coordinates and rates.
    known: [[f64; 3]; 2],
    /// Second rates of the last stage.
    bend: [f64; 3],
}

/// Where the rope's other end is, how it moves by prescribed motions, and the unstretched length with its rates.
struct Anchor<'s> {
    point: &'s Point,
    /// Velocity and acceleration by prescribed motions.
    given: [Vector3<f64>; 2],
    natural: [f64; 3],
}

/// The tangents of a chart at one state.
struct Local {
    y: [f64; 3],
    rate: [f64; 3],
    reach: f64,
    /// u, u_alpha, u_beta.
    along: [Vector3<f64>; 3],
    /// cos beta squared.
    narrow: f64,
    /// c of the module.
    curve: Vector3<f64>,
}

impl Local {
    /// J w.
    fn push(&self, w: [f64; 3]) -> Vector3<f64> {
        let [u, across, over] = self.along;
        u * w[0] + (across * w[1] + over * w[2]) * self.reach
    }

    /// J^-1 w.
    fn pull(&self, w: Vector3<f64>) -> [f64; 3] {
        let [u, across, over] = self.along;
        [u.dot(&w), across.dot(&w) / (self.reach * self.narrow), over.dot(&w) / self.reach]
    }
}

impl Chart {
    fn ends<'s>(&self, system: &'s System) -> Option<[&'s Point; 2]> {
        match &system.links[self.rope] {
            Link::Rope { from, to, .. } => Some(if self.forward { [from, to] } else { [to, from] }),
            Link::Stop { .. } => None,
        }
    }

    fn anchor<'s>(&self, system: &'s System, switches: &Switches, t: f64) -> Option<Anchor<'s>> {
        let [point, _] = self.ends(system)?;
        let mut given = [Vector3::zeros(); 2];
        for (b, body) in system.scene.bodies.iter().enumerate() {
            let Some(profile) = &body.motion else { continue };
            if point.body.is_some_and(|own| system.kinematics.root(own) == b) {
                let at = profile.at(t);
                given[0].x += at.v;
                given[1].x += at.a;
            }
        }
        let actuators = &system.scene.actuators;
        let [length, rate] = switches.natural(actuators, self.rope, t);
        let natural = [length, rate, switches.natural_bend(actuators, self.rope, t)];
        Some(Anchor { point, given, natural })
    }

    /// Position of the body in space less its X, Y and Z.
    fn offset(&self, system: &System) -> Option<Vector3<f64>> {
        let [_, own] = self.ends(system)?;
        Some(own.place(system, 0.0, &DVector::zeros(system.freedoms)))
    }

    fn vector(&self, of: &DVector<f64>) -> Vector3<f64> {
        Vector3::from(self.numbers.map(|number| of[number]))
    }

    /// Coordinates, rates and tangents at (t, q, v).
    fn local(
        &self,
        system: &System,
        anchor: &Anchor,
        t: f64,
        q: &DVector<f64>,
        v: &DVector<f64>,
    ) -> Option<Local> {
        let [e0, e1, e2] = self.frame;
        let [length, length_rate, length_bend] = anchor.natural;
        let reach = self.vector(q) + self.offset(system)? - anchor.point.place(system, t, q);
        let speed = self.vector(v) - anchor.point.rate(v) - anchor.given[0];
        let r = reach.norm();
        let (alpha, beta) =
            (reach.dot(&e1).atan2(reach.dot(&e0)), (reach.dot(&e2) / r).clamp(-1.0, 1.0).asin());
        let ((sa, ca), (sb, cb)) = (alpha.sin_cos(), beta.sin_cos());
        let (radial, around) = (e0 * ca + e1 * sa, e1 * ca - e0 * sa);
        let u = radial * cb + e2 * sb;
        let along = [u, around * cb, e2 * cb - radial * sb];
        let mut local = Local {
            y: [r - length, alpha, beta],
            rate: [0.0; 3],
            reach: r,
            along,
            narrow: cb * cb,
            curve: u,
        };
        local.rate = local.pull(speed - u * length_rate);
        let [s, a, b] = local.rate;
        let turn = along[1] * a + along[2] * b;
        local.curve = u * length_bend + turn * (2.0 * (length_rate + s))
            - (radial * (cb * a * a) + around * (2.0 * sb * a * b) + u * (b * b)) * r;
        Some(local)
    }
}

impl Charts {
    /// Charts of the bodies that hang on taut ropes at `from`, where `taut` says which do.
    pub fn begin(
        &mut self,
        system: &System,
        switches: &Switches,
        taut: impl Fn(usize) -> bool,
        from: &State,
    ) {
        self.0.clear();
        let hangs = |point: &Point| point.free_numbers(system);
        let mut left: Vec<usize> =
            (0..system.scene.actuators.ropes.len()).filter(|&rope| taut(rope)).collect();
        let mut grows = true;
        while grows {
            grows = false;
            left.retain(|&rope| {
                let Link::Rope { from: a, to: b, .. } = &system.links[rope] else { return false };
                if a.rides() || b.rides() {
                    return false;
                }
                let charted = |numbers: [usize; 3]| self.0.iter().any(|chart| chart.numbers == numbers);
                let (low, high) = (hangs(a), hangs(b));
                let carries = |end: Option<[usize; 3]>| end.is_none_or(charted);
                let (forward, numbers) = match (low, high) {
                    (_, Some(numbers)) if carries(low) && !charted(numbers) => (true, numbers),
                    (Some(numbers), _) if carries(high) && !charted(numbers) => (false, numbers),
                    _ => return true,
                };
                if let Some(chart) = Chart::at(system, switches, rope, (forward, numbers), from) {
                    self.0.push(chart);
                    grows = true;
                }
                false
            });
        }
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether freedom `number` has coordinates of a chart.
    pub fn has(&self, number: usize) -> bool {
        self.0.iter().any(|chart| chart.numbers.contains(&number))
    }

    /// Sets the entries of hung bodies in `q` and `v` to their coordinates and rates at the start of the step.
    pub fn begun(&self, q: &mut DVector<f64>, v: &mut DVector<f64>) {
        for chart in &self.0 {
            for (k, &number) in chart.numbers.iter().enumerate() {
                (q[number], v[number]) = (chart.start[0][k], chart.start[1][k]);
            }
        }
    }

    /// Takes the known parts of a stage from `known`, and guesses where the stage ends.
    pub fn guess(&mut self, system: &System, switches: &Switches, g: f64, known: &Known, at: &mut State) {
        for chart in &mut self.0 {
            chart.known = [&known.q, &known.v].map(|of| chart.numbers.map(|number| of[number]));
            let rate: [f64; 3] = std::array::from_fn(|k| chart.known[1][k] + g * chart.bend[k]);
            let y = std::array::from_fn(|k| chart.known[0][k] + g * rate[k]);
            chart.put(system, switches, y, rate, at);
        }
    }

    /// Sets the known parts of hung bodies for X, Y and Z, about the guess `at`.
    pub fn flatten(&self, system: &System, switches: &Switches, g: f64, known: &mut Known, at: &State) {
        for chart in &self.0 {
            let Some(anchor) = chart.anchor(system, switches, at.t) else { continue };
            let Some(local) = chart.local(system, &anchor, at.t, &at.q, &at.v) else { continue };
            let apart = std::array::from_fn(|k| chart.known[0][k] - local.y[k]);
            let drift = anchor.given[0] + local.along[0] * anchor.natural[1];
            let reach = chart.vector(&at.q) - anchor.point.place(system, at.t, &at.q);
            let q = anchor.point.place(system, at.t, &known.q) + reach + local.push(apart) - drift * g;
            let v = anchor.point.rate(&known.v) + drift + local.push(chart.known[1])
                - (anchor.given[1] + local.curve) * g;
            for (k, &number) in chart.numbers.iter().enumerate() {
                (known.q[number], known.v[number]) = (q[k], v[k]);
            }
        }
    }

    /// Sets the entries of hung bodies in `v` and `a`, those of the stage that ended at `at`, to rates and second rates
    /// of their coordinates.
    pub fn settle(
        &mut self,
        system: &System,
        switches: &Switches,
        at: &State,
        [v, a]: [&mut DVector<f64>; 2],
    ) {
        for chart in &mut self.0 {
            let Some(anchor) = chart.anchor(system, switches, at.t) else { continue };
            let Some(local) = chart.local(system, &anchor, at.t, &at.q, &at.v) else { continue };
            let bend = chart.vector(&at.a) - anchor.point.rate(&at.a) - anchor.given[1] - local.curve;
            chart.bend = local.pull(bend);
            for (k, &number) in chart.numbers.iter().enumerate() {
                (v[number], a[number]) = (local.rate[k], chart.bend[k]);
            }
        }
    }

    /// Calls `each` with the number of every freedom of hung bodies and its share of the errors of coordinates and rates
    /// that `of` gives by number.
    pub fn errors(
        &self,
        system: &System,
        switches: &Switches,
        at: &State,
        of: impl Fn(usize) -> [f64; 2],
        mut each: impl FnMut(usize, [f64; 2]),
    ) {
        for chart in &self.0 {
            let t = at.t.next_down();
            let Some(anchor) = chart.anchor(system, switches, t) else { continue };
            let Some(local) = chart.local(system, &anchor, t, &at.q, &at.v) else { continue };
            let errors = chart.numbers.map(&of);
            let [dq, dv] = [0, 1].map(|i| local.push(errors.map(|error| error[i])));
            for (k, &number) in chart.numbers.iter().enumerate() {
                each(number, [dq[k], dv[k]]);
            }
        }
    }

    /// Moves the hung bodies of `at`, the interpolant between `from` and `to` at `share`, to where that of their
    /// coordinates is.
    pub fn interpolate(
        &self,
        system: &System,
        switches: &Switches,
        [from, to]: [&State; 2],
        share: f64,
        at: &mut State,
    ) {
        for chart in &self.0 {
            let mut ends = [State::zeros(3, 0, 0), State::zeros(3, 0, 0)];
            // motions may jump at the end of a step
            for ((end, state), t) in ends.iter_mut().zip([from, to]).zip([from.t, to.t.next_down()]) {
                let Some(anchor) = chart.anchor(system, switches, t) else { return };
                let Some(local) = chart.local(system, &anchor, t, &state.q, &state.v) else { return };
                let bend =
                    chart.vector(&state.a) - anchor.point.rate(&state.a) - anchor.given[1] - local.curve;
                end.t = state.t;
                end.q.copy_from_slice(&local.y);
                end.v.copy_from_slice(&local.rate);
                end.a.copy_from_slice(&local.pull(bend));
            }
            let mut middle = State::zeros(3, 0, 0);
            middle.interpolate(&ends[0], &ends[1], share);
            let [y, rate] = [&middle.q, &middle.v].map(|of| [of[0], of[1], of[2]]);
            chart.put(system, switches, y, rate, at);
        }
    }
}

impl Solver<'_> {
    /// Chooses the charts of a step from `from`.
    pub fn chart(&mut self, from: &State) {
        if self.system.links.is_empty() {
            return;
        }
        let links = &self.geometry.links;
        self.charts.begin(self.system, &self.geometry.switches, |rope| links[rope].taut, from);
    }
}

impl Chart {
    /// The chart of the body at one end of `rope`, centred where it hangs at `from`.
    fn at(
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
            bend: [0.0; 3],
        };
        let anchor = chart.anchor(system, switches, from.t)?;
        let reach =
            chart.vector(&from.q) + chart.offset(system)? - anchor.point.place(system, from.t, &from.q);
        if reach.norm() <= SHORTEST * anchor.natural[0] {
            return None;
        }
        let along = reach.normalize();
        let speed = chart.vector(&from.v) - anchor.point.rate(&from.v) - anchor.given[0];
        let across = speed - along * along.dot(&speed);
        let least = axes[along.iamin()];
        let across = if across.norm() > 1e-9 * (1.0 + speed.norm()) { across } else { along.cross(&least) };
        let across = across.normalize();
        chart.frame = [along, across, along.cross(&across)];
        let local = chart.local(system, &anchor, from.t, &from.q, &from.v)?;
        let bend = chart.vector(&from.a) - anchor.point.rate(&from.a) - anchor.given[1] - local.curve;
        chart.start = [local.y, local.rate];
        chart.bend = local.pull(bend);
        Some(chart)
    }

    /// Puts the body at the coordinates `y` with their `rate`, about where `at` has the rope's other end.
    fn put(&self, system: &System, switches: &Switches, y: [f64; 3], rate: [f64; 3], at: &mut State) {
        let (Some(anchor), Some(offset)) = (self.anchor(system, switches, at.t), self.offset(system)) else {
            return;
        };
        let [e0, e1, e2] = self.frame;
        let ((sa, ca), (sb, cb)) = (y[1].sin_cos(), y[2].sin_cos());
        let (radial, around) = (e0 * ca + e1 * sa, e1 * ca - e0 * sa);
        let (u, over) = (radial * cb + e2 * sb, e2 * cb - radial * sb);
        let reach = anchor.natural[0] + y[0];
        let q = anchor.point.place(system, at.t, &at.q) + u * reach - offset;
        let v = anchor.point.rate(&at.v)
            + anchor.given[0]
            + u * (anchor.natural[1] + rate[0])
            + (around * (cb * rate[1]) + over * rate[2]) * reach;
        for (k, &number) in self.numbers.iter().enumerate() {
            (at.q[number], at.v[number]) = (q[k], v[k]);
        }
    }
}
