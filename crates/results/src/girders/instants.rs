//! Loads on a structure and motions of its degrees of freedom between the rows of a history.

use sim::{Channel, History};
use trains::RailLoad;

use crate::response::{WheelLoad, WheelLoadReader};

/// Change of the slope from interval to interval, relative to the slopes beside it, above which values are interpolated
/// linearly: a force jumps there or has a corner.
const CORNER: f64 = 0.25;

/// State of a structure at one time.
#[derive(Clone, Debug, Default)]
pub(super) struct LoadState {
    pub time: f64,
    /// Loads on its rails, always in the same order.
    pub loads: Vec<RailLoad>,
    /// The same loads as the simulation has them.
    pub wheels: Vec<WheelLoad>,
    /// Displacements and accelerations of its degrees of freedom.
    pub dofs: Vec<f64>,
    pub accelerations: Vec<f64>,
}

/// The states of a structure over time: rows of the history `stride` apart, and between them cubic polynomials through
/// four rows, channel by channel. Where a channel jumps or has a corner it is interpolated linearly.
pub(super) struct LoadStates<'a> {
    history: &'a History,
    loads: &'a WheelLoadReader,
    s: usize,
    /// First channels of displacements and accelerations, with their number.
    dofs: Option<(usize, usize, usize)>,
    rows: Vec<usize>,
    /// Channels that are interpolated.
    channels: Vec<usize>,
}

impl<'a> LoadStates<'a> {
    /// The states of structure `s` with `dofs` recorded degrees of freedom.
    pub fn new(
        history: &'a History,
        loads: &'a WheelLoadReader,
        s: usize,
        dofs: usize,
        stride: usize,
    ) -> LoadStates<'a> {
        let channel = |wanted| history.position(wanted);
        let first = channel(Channel::Coordinate(s, 0)).zip(channel(Channel::Acceleration(s, 0)));
        let dofs = first.map(|(q, a)| (q, a, dofs));
        let mut channels = loads.channels();
        channels.extend(dofs.iter().flat_map(|(q, a, n)| (*q..q + n).chain(*a..a + n)));
        let last = history.len().saturating_sub(1);
        let mut rows: Vec<usize> = (0..history.len()).step_by(stride.max(1)).collect();
        if rows.last().is_some_and(|row| *row != last) {
            rows.push(last);
        }
        LoadStates { history, loads, s, dofs, rows, channels }
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    fn sample(&self, row: usize) -> &'a [f64] {
        self.history.sample(self.rows[row])
    }

    /// The state at a row.
    pub fn at_row(&self, row: usize) -> LoadState {
        self.state(self.sample(row))
    }

    /// The state at a time that is counted in rows, between the first and the last.
    pub fn at(&self, position: f64) -> LoadState {
        let last = self.len() - 1;
        let row = (position.max(0.0) as usize).min(last.saturating_sub(1));
        let fraction = position - row as f64;
        if fraction <= 0.0 || last == 0 {
            return self.at_row(row);
        }
        if fraction >= 1.0 {
            return self.at_row(row + 1);
        }
        let (a, b) = (self.sample(row), self.sample(row + 1));
        let before = row.checked_sub(1).map(|row| self.sample(row));
        let after = (row + 2 <= last).then(|| self.sample(row + 2));
        let mut out = a.to_vec();
        out[0] = a[0] + fraction * (b[0] - a[0]);
        let rule = Interpolation::new([before, Some(a), Some(b), after], out[0]);
        for &c in &self.channels {
            out[c] = rule.value(c, fraction);
        }
        self.state(&out)
    }

    fn state(&self, sample: &[f64]) -> LoadState {
        let mut wheels = self.loads.at(sample);
        wheels.retain(|load| load.structure == self.s);
        let loads = wheels.iter().map(|w| RailLoad { rail: w.rail, x: w.x, force: w.force }).collect();
        let part = |from: usize, n: usize| sample[from..from + n].to_vec();
        let (dofs, accelerations) =
            self.dofs.map_or_else(Default::default, |(q, a, n)| (part(q, n), part(a, n)));
        LoadState { time: sample[0], loads, wheels, dofs, accelerations }
    }
}

/// Interpolation between two rows by Lagrange polynomials through them and their neighbours.
struct Interpolation<'a> {
    rows: [Option<&'a [f64]>; 4],
    weights: [f64; 4],
    /// Reciprocals of the three intervals.
    rates: [f64; 3],
}

impl<'a> Interpolation<'a> {
    fn new(rows: [Option<&'a [f64]>; 4], time: f64) -> Interpolation<'a> {
        let mut weights = [0.0; 4];
        for (i, own) in rows.iter().enumerate() {
            let Some(own) = own else { continue };
            weights[i] = 1.0;
            for other in rows.iter().enumerate().filter(|(j, _)| *j != i).filter_map(|(_, other)| *other) {
                weights[i] *= (time - other[0]) / (own[0] - other[0]);
            }
        }
        let rate = |i: usize| match (rows[i], rows[i + 1]) {
            (Some(a), Some(b)) if b[0] > a[0] => 1.0 / (b[0] - a[0]),
            _ => 0.0,
        };
        Interpolation { rows, weights, rates: [rate(0), rate(1), rate(2)] }
    }

    /// The value of channel `c`.
    fn value(&self, c: usize, fraction: f64) -> f64 {
        let slope = |i: usize| match (self.rows[i], self.rows[i + 1]) {
            (Some(a), Some(b)) => (b[c] - a[c]) * self.rates[i],
            _ => f64::NAN,
        };
        let [before, own, after] = [slope(0), slope(1), slope(2)];
        let is_smooth = match (before.is_nan(), after.is_nan()) {
            (false, false) => (after - 2.0 * own + before).abs() <= CORNER * (before.abs() + after.abs()),
            _ => false,
        };
        match (is_smooth, self.rows) {
            (true, rows) => {
                rows.iter().zip(self.weights).filter_map(|(row, w)| Some(w * row.as_ref()?[c])).sum()
            }
            (false, [_, Some(a), Some(b), _]) => a[c] + fraction * (b[c] - a[c]),
            _ => 0.0,
        }
    }
}
