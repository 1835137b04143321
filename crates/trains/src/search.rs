//! The largest value of an envelope along a window, enclosed by bisection.
//!
//! On an interval of length h whose ends have the values a and b, no value exceeds max(a, b) + k h^2/8 + s h/4, where k
//! bounds the second derivative of every state between its wheels and s the sum of the jumps of its slope at wheels.

use crate::collect::offer;
use crate::error::Error;
use crate::extremes::Governing;

/// Relative distance between the largest value found and the bound of all others.
const GAP: f64 = 5e-10;
/// Parts of a window from which the bisection starts.
const PARTS: usize = 20;
/// Most evaluations for one extreme; where they do not suffice, the bound that was reached is given.
const MOST_EVALUATIONS: usize = 3000;
/// Golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// Bounds of what a quantity does between two places: its second derivative between wheels, and the sum of the jumps
/// of its slope at wheels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bend {
    pub curvature: f64,
    pub kinks: f64,
}

/// The search for the largest value over a window by bisection.
pub(crate) struct Search<F> {
    sign: f64,
    pub bend: Bend,
    window: [f64; 2],
    pub gap: f64,
    pub most: usize,
    value: F,
    pub best: Option<Governing>,
    /// What sign times the value nowhere exceeds.
    pub bound: f64,
}

impl<F: FnMut(f64) -> Result<Option<Governing>, Error>> Search<F> {
    pub fn new(sign: f64, bend: Bend, window: [f64; 2], value: F) -> Search<F> {
        Search {
            sign,
            bend,
            window,
            gap: GAP,
            most: MOST_EVALUATIONS,
            value,
            best: None,
            bound: f64::NEG_INFINITY,
        }
    }

    pub fn offer(&mut self, found: Option<Governing>) {
        offer(&mut self.best, found, self.sign);
    }

    /// Sign times the envelope at x; its state is offered as the best.
    fn at(&mut self, x: f64) -> Result<f64, Error> {
        let found = (self.value)(x)?;
        let signed = found.as_ref().map_or(f64::NEG_INFINITY, |g| self.sign * g.value);
        self.offer(found);
        Ok(signed)
    }

    /// Improves the best value by golden sections within a distance of its place.
    pub fn polish(&mut self, distance: f64) -> Result<(), Error> {
        let Some(x) = self.best.as_ref().map(|best| best.x) else { return Ok(()) };
        let (mut a, mut b) = ((x - distance).max(self.window[0]), (x + distance).min(self.window[1]));
        let mut inner = [b - GOLDEN * (b - a), a + GOLDEN * (b - a)];
        let mut values = [self.at(inner[0])?, self.at(inner[1])?];
        for _ in 0..45 {
            if values[0] >= values[1] {
                b = inner[1];
                (inner[1], values[1]) = (inner[0], values[0]);
                inner[0] = b - GOLDEN * (b - a);
                values[0] = self.at(inner[0])?;
            } else {
                a = inner[0];
                (inner[0], values[0]) = (inner[1], values[1]);
                inner[1] = a + GOLDEN * (b - a);
                values[1] = self.at(inner[1])?;
            }
        }
        Ok(())
    }

    /// Divides the intervals that may hold more than the best, widest bound first.
    pub fn run(&mut self) -> Result<(), Error> {
        let [from, to] = self.window;
        let place = |k: usize| if k == PARTS { to } else { from + (to - from) * k as f64 / PARTS as f64 };
        let mut values = Vec::with_capacity(PARTS + 1);
        for k in 0..=PARTS {
            values.push(self.at(place(k))?);
        }
        let mut open: Vec<Interval> = (0..PARTS)
            .map(|k| Interval::new([place(k), place(k + 1)], [values[k], values[k + 1]], self.bend))
            .collect();
        let mut evaluations = PARTS + 1;
        let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        loop {
            let best = self.best.as_ref().map_or(f64::NEG_INFINITY, |g| self.sign * g.value);
            let limit = best + self.gap * largest.max(best.abs());
            open.retain(|interval| interval.bound > limit);
            let Some(widest) = (0..open.len()).max_by(|&a, &b| open[a].bound.total_cmp(&open[b].bound))
            else {
                self.bound = limit;
                return Ok(());
            };
            if evaluations >= self.most {
                self.bound = open[widest].bound;
                return Ok(());
            }
            let Interval { x, values, .. } = open.swap_remove(widest);
            let middle = 0.5 * (x[0] + x[1]);
            let value = self.at(middle)?;
            evaluations += 1;
            open.push(Interval::new([x[0], middle], [values[0], value], self.bend));
            open.push(Interval::new([middle, x[1]], [value, values[1]], self.bend));
        }
    }
}

/// An interval of places with the envelope at its ends and a bound inside.
struct Interval {
    x: [f64; 2],
    values: [f64; 2],
    bound: f64,
}

impl Interval {
    fn new(x: [f64; 2], values: [f64; 2], bend: Bend) -> Interval {
        let h = x[1] - x[0];
        let bound = values[0].max(values[1]) + bend.curvature * h * h / 8.0 + bend.kinks * h / 4.0;
        Interval { x, values, bound }
    }
}
