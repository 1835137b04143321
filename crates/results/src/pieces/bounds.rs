//! Intervals in which a value lies, and their sums and products.

use piecewise::{Lobatto, Polynomial};

/// Values below this part of the largest one are not looked for.
const ROUNDING: f64 = 1e-10;

/// Smallest and largest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub low: f64,
    pub high: f64,
}

impl Bounds {
    pub const ZERO: Bounds = Bounds {
        low: 0.0,
        high: 0.0,
    };
    /// Before any value is in it.
    const NONE: Bounds = Bounds {
        low: f64::INFINITY,
        high: f64::NEG_INFINITY,
    };

    /// Those of the polynomial through values at nodes.
    pub fn through(values: impl Iterator<Item = f64>) -> Bounds {
        let all = values.map(Bounds::at);
        all.fold(Bounds::NONE, Bounds::with).beyond_nodes()
    }

    /// Those of a polynomial whose values at the nodes these are.
    fn beyond_nodes(self) -> Bounds {
        let [low, high] = Lobatto::bounds([self.low, self.high]);
        Bounds { low, high }
    }

    /// Those of the polynomials through `count` values at each node, node by node.
    pub fn of_columns(values: &[f64], count: usize) -> Vec<Bounds> {
        let mut out = vec![Bounds::NONE; count];
        for row in values.chunks_exact(count.max(1)) {
            for (own, value) in out.iter_mut().zip(row) {
                own.low = if *value < own.low { *value } else { own.low };
                own.high = if *value > own.high { *value } else { own.high };
            }
        }
        out.iter_mut().for_each(|own| *own = own.beyond_nodes());
        out
    }

    /// Those of a polynomial.
    pub fn of(polynomial: &Polynomial) -> Bounds {
        let [low, high] = polynomial.bounds();
        Bounds { low, high }
    }

    /// Both intervals and what is between.
    pub fn with(self, other: Bounds) -> Bounds {
        Bounds {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    pub fn is_zero(&self) -> bool {
        self.low == 0.0 && self.high == 0.0
    }

    pub fn contains(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Largest magnitude.
    pub fn size(&self) -> f64 {
        self.high.max(-self.low)
    }

    /// Largest difference from a value in it.
    pub fn distance(&self, value: f64) -> f64 {
        (self.high - value).max(value - self.low)
    }

    /// Wider by a radius.
    pub fn widened(self, radius: f64) -> Bounds {
        Bounds {
            low: self.low - radius,
            high: self.high + radius,
        }
    }

    /// Those of one value.
    pub fn at(value: f64) -> Bounds {
        Bounds {
            low: value,
            high: value,
        }
    }

    /// Adds the product of two others.
    pub fn add_product(&mut self, a: Bounds, b: Bounds) {
        let ends = [
            a.low * b.low,
            a.low * b.high,
            a.high * b.low,
            a.high * b.high,
        ];
        let [first, others @ ..] = ends;
        self.low += others.into_iter().fold(first, f64::min);
        self.high += others.into_iter().fold(first, f64::max);
    }

    /// At a share of the way to another one.
    pub fn towards(self, other: Bounds, share: f64) -> Bounds {
        Bounds {
            low: (1.0 - share) * self.low + share * other.low,
            high: (1.0 - share) * self.high + share * other.high,
        }
    }

    /// Whether no value in it is larger than the largest that is known, or smaller than the smallest, of which the largest values
    /// and those of their negatives are `known`. Differences that are rounding of `most` do not count.
    pub fn is_within(&self, [largest, least]: [f64; 2], most: f64) -> bool {
        let rounding = ROUNDING * most;
        self.high <= largest + rounding && -self.low <= least + rounding
    }
}
