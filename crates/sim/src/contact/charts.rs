//! The local coordinates of all hanging bodies during one step.

use nalgebra::DVector;

use crate::contact::chart::Chart;
use crate::contact::switches::Switches;
use crate::contact::system::System;
use crate::mechanics::point::Point;
use crate::mechanics::state::{Known, State};

/// The charts of one step; the chart of a carrier precedes the charts of the bodies that hang on it.
#[derive(Clone, Default)]
pub(crate) struct Charts(Vec<Chart>);

impl Charts {
    /// Creates the charts of the bodies that hang on taut ropes at `from`; `taut` returns whether a rope is taut.
    ///
    /// The ropes are tested in the order of decreasing stiffness. A rope gets a chart if one of its ends is a free
    /// body without a chart, and the other end is fixed or already has a chart. The test is repeated until it adds no
    /// chart.
    pub fn begin(
        &mut self,
        system: &System,
        switches: &Switches,
        taut: impl Fn(usize) -> bool,
        from: &State,
    ) {
        self.0.clear();
        let hangs = |point: &Point| point.free_numbers(&system.mechanics);
        let ropes = &system.scene.actuators.ropes;
        let mut left: Vec<usize> = (0..ropes.len()).filter(|&rope| taut(rope)).collect();
        let stiffness = |rope: usize| ropes[rope].stiffness / ropes[rope].length;
        left.sort_by(|&a, &b| stiffness(b).total_cmp(&stiffness(a)));
        let mut grows = true;
        while grows {
            grows = false;
            left.retain(|&rope| {
                let Some([a, b]) = system.rope(rope).and_then(|(_, rope)| rope.ends()) else {
                    return false;
                };
                if a.is_carried() || b.is_carried() {
                    return false;
                }
                let charted =
                    |numbers: [usize; 3]| self.0.iter().any(|chart| chart.numbers == numbers);
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

    /// The charts, in their order.
    pub fn iter(&self) -> impl Iterator<Item = &Chart> {
        self.0.iter()
    }

    /// Whether no body hangs on a taut rope.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether degree of freedom `number` belongs to a body with a chart.
    pub fn has(&self, number: usize) -> bool {
        self.0.iter().any(|chart| chart.numbers.contains(&number))
    }

    /// Sets the entries of hanging bodies in `q` and `v` to their local coordinates and rates at the start of the
    /// step.
    pub fn set_start(&self, q: &mut DVector<f64>, v: &mut DVector<f64>) {
        for chart in &self.0 {
            for (k, &number) in chart.numbers.iter().enumerate() {
                (q[number], v[number]) = (chart.start[0][k], chart.start[1][k]);
            }
        }
    }

    /// Reads the constant terms of a stage in local coordinates from `known`, and sets `at` to a guess of its end.
    pub fn guess(
        &mut self,
        system: &System,
        switches: &Switches,
        g: f64,
        known: &Known,
        at: &mut State,
    ) {
        for chart in &mut self.0 {
            chart.known = [&known.q, &known.v].map(|of| chart.numbers.map(|number| of[number]));
            let rate: [f64; 3] =
                std::array::from_fn(|k| chart.known[1][k] + g * chart.acceleration[k]);
            let y = std::array::from_fn(|k| chart.known[0][k] + g * rate[k]);
            chart.place(system, switches, y, rate, at);
        }
    }

    /// Sets the constant terms of hanging bodies in X, Y and Z, linearised about the guess `at`.
    pub fn linearise(
        &self,
        system: &System,
        switches: &Switches,
        g: f64,
        known: &mut Known,
        at: &State,
    ) {
        for chart in &self.0 {
            let Some(anchor) = chart.anchor(system, switches, at.t) else {
                continue;
            };
            let Some(local) = chart.local(system, &anchor, at.t, &at.q, &at.v) else {
                continue;
            };
            let apart = std::array::from_fn(|k| chart.known[0][k] - local.y[k]);
            let drift = anchor.given[0] + local.along[0] * anchor.unstretched[1];
            let span = chart.vector(&at.q) - anchor.point.place(&system.mechanics, at.t, &at.q);
            let q =
                anchor.point.place(&system.mechanics, at.t, &known.q) + span + local.apply(apart)
                    - drift * g;
            let v = anchor.point.rate(&known.v) + drift + local.apply(chart.known[1])
                - (anchor.given[1] + local.curve) * g;
            for (k, &number) in chart.numbers.iter().enumerate() {
                (known.q[number], known.v[number]) = (q[k], v[k]);
            }
        }
    }

    /// Sets the entries of hanging bodies in `v` and `a` to the first and second rates of their local coordinates at
    /// the end `at` of a stage.
    pub fn set_rates(
        &mut self,
        system: &System,
        switches: &Switches,
        at: &State,
        [v, a]: [&mut DVector<f64>; 2],
    ) {
        for chart in &mut self.0 {
            let Some(anchor) = chart.anchor(system, switches, at.t) else {
                continue;
            };
            let Some(local) = chart.local(system, &anchor, at.t, &at.q, &at.v) else {
                continue;
            };
            let acceleration =
                chart.vector(&at.a) - anchor.point.rate(&at.a) - anchor.given[1] - local.curve;
            chart.acceleration = local.solve(acceleration);
            for (k, &number) in chart.numbers.iter().enumerate() {
                (v[number], a[number]) = (local.rate[k], chart.acceleration[k]);
            }
        }
    }

    /// Calls `each` with the number and the errors of displacement and speed of every degree of freedom of hanging
    /// bodies. `of` returns the errors of local coordinates and rates by number; they are transformed by the tangent
    /// vectors.
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
            let Some(anchor) = chart.anchor(system, switches, t) else {
                continue;
            };
            let Some(local) = chart.local(system, &anchor, t, &at.q, &at.v) else {
                continue;
            };
            let errors = chart.numbers.map(&of);
            let [dq, dv] = [0, 1].map(|i| local.apply(errors.map(|error| error[i])));
            for (k, &number) in chart.numbers.iter().enumerate() {
                each(number, [dq[k], dv[k]]);
            }
        }
    }

    /// Corrects the hanging bodies of `at`, the interpolant between `from` and `to` at `fraction`: their local
    /// coordinates are interpolated instead of X, Y and Z.
    pub fn interpolate(
        &self,
        system: &System,
        switches: &Switches,
        [from, to]: [&State; 2],
        fraction: f64,
        at: &mut State,
    ) {
        for chart in &self.0 {
            let mut ends = [State::zeros(3, 0, 0), State::zeros(3, 0, 0)];
            // Prescribed motions may jump at the end of a step, so the left-hand limit is used there.
            for ((end, state), t) in ends
                .iter_mut()
                .zip([from, to])
                .zip([from.t, to.t.next_down()])
            {
                let Some(anchor) = chart.anchor(system, switches, t) else {
                    return;
                };
                let Some(local) = chart.local(system, &anchor, t, &state.q, &state.v) else {
                    return;
                };
                let acceleration = chart.vector(&state.a)
                    - anchor.point.rate(&state.a)
                    - anchor.given[1]
                    - local.curve;
                end.t = state.t;
                end.q.copy_from_slice(&local.y);
                end.v.copy_from_slice(&local.rate);
                end.a.copy_from_slice(&local.solve(acceleration));
            }
            let mut middle = State::zeros(3, 0, 0);
            middle.interpolate(&ends[0], &ends[1], fraction);
            let [y, rate] = [&middle.q, &middle.v].map(|of| [of[0], of[1], of[2]]);
            chart.place(system, switches, y, rate, at);
        }
    }
}
