//! The largest value of an envelope along a window, enclosed by bisection.
//!
//! On an interval whose ends have the values a and b, no value exceeds max(a, b) plus a margin that depends on the
//! interval alone. Intervals that cannot hold more than the best value are left out, the others are halved.

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

/// By how much an envelope may exceed the larger of its values at the ends of an interval.
pub(crate) type Margin<'a> = Box<dyn Fn([f64; 2]) -> f64 + 'a>;

/// Bounds of what every state of a quantity does between two places: its second derivative between wheels, and the sum
/// of the jumps of its slope at wheels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bend {
    pub curvature: f64,
    pub kinks: f64,
}

impl Bend {
    /// k h^2/8 + s h/4 on an interval of length h.
    pub fn margin(self, [from, to]: [f64; 2]) -> f64 {
        let h = to - from;
        self.curvature * h * h / 8.0 + self.kinks * h / 4.0
    }
}

/// The search for the largest value over a window by bisection.
pub(crate) struct Search<'a, F> {
    sign: f64,
    margin: Margin<'a>,
    window: [f64; 2],
    pub gap: f64,
    /// Values below this size count as zero for the gap.
    pub size: f64,
    /// Sign times a value that is known already; smaller ones are not sought.
    pub known: f64,
    pub most: usize,
    value: F,
    pub best: Option<Governing>,
    /// What sign times the value nowhere exceeds.
    pub bound: f64,
    /// Whether the search ended with the gap that was wanted.
    is_closed: bool,
}

impl<'a, F: FnMut(f64) -> Result<Option<Governing>, Error>> Search<'a, F> {
    pub fn new(sign: f64, margin: Margin<'a>, window: [f64; 2], value: F) -> Search<'a, F> {
        Search {
            sign,
            margin,
            window,
            gap: GAP,
            size: 0.0,
            known: f64::NEG_INFINITY,
            most: MOST_EVALUATIONS,
            value,
            best: None,
            bound: f64::NEG_INFINITY,
            is_closed: false,
        }
    }

    /// Whether the search ended with the gap that was wanted.
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    pub fn offer(&mut self, found: Option<Governing>) {
        offer(&mut self.best, found, self.sign);
    }

    /// Sign times the envelope at x; its state is offered as the best.
    fn at(&mut self, x: f64) -> Result<f64, Error> {
        let found = (self.value)(x)?;
        let signed = found
            .as_ref()
            .map_or(f64::NEG_INFINITY, |g| self.sign * g.value);
        self.offer(found);
        Ok(signed)
    }

    /// Improves the best value by golden sections within a distance of its place.
    pub fn polish(&mut self, distance: f64) -> Result<(), Error> {
        let Some(x) = self.best.as_ref().map(|best| best.x) else {
            return Ok(());
        };
        let (mut a, mut b) = (
            (x - distance).max(self.window[0]),
            (x + distance).min(self.window[1]),
        );
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

    fn interval(&self, x: [f64; 2], values: [f64; 2]) -> Interval {
        Interval {
            x,
            values,
            bound: values[0].max(values[1]) + (self.margin)(x),
        }
    }

    /// Divides the intervals that may hold more than the best, widest bound first.
    pub fn run(&mut self) -> Result<(), Error> {
        let [from, to] = self.window;
        let place = |k: usize| {
            if k == PARTS {
                to
            } else {
                from + (to - from) * k as f64 / PARTS as f64
            }
        };
        let mut values = Vec::with_capacity(PARTS + 1);
        for k in 0..=PARTS {
            values.push(self.at(place(k))?);
        }
        let mut open: Vec<Interval> = (0..PARTS)
            .map(|k| self.interval([place(k), place(k + 1)], [values[k], values[k + 1]]))
            .collect();
        let mut evaluations = PARTS + 1;
        let largest = values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        loop {
            let best = self
                .best
                .as_ref()
                .map_or(self.known, |g| self.known.max(self.sign * g.value));
            let limit = best + self.gap * largest.max(self.size);
            open.retain(|interval| interval.bound > limit);
            let Some(widest) =
                (0..open.len()).max_by(|&a, &b| open[a].bound.total_cmp(&open[b].bound))
            else {
                self.bound = limit;
                self.is_closed = true;
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
            open.push(self.interval([x[0], middle], [values[0], value]));
            open.push(self.interval([middle, x[1]], [value, values[1]]));
        }
    }
}

/// An interval of places with the envelope at its ends and a bound inside.
struct Interval {
    x: [f64; 2],
    values: [f64; 2],
    bound: f64,
}
