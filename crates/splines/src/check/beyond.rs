//! What a curve gives beyond its last point, by the rule that goes on with it.

use super::Extreme;
use crate::{Error, Table, akima};

/// One row of a table continued beyond its end in four ways, length/force.
///
/// ADAMS documents them all: with LINEAR_EXTRAPOLATE a tangent or the line through the last two points, without it
/// the parabola through the last three points or a cubic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beyond {
    /// The row: where the deflection is taken.
    pub z: f64,
    /// Where the load stands, beyond the table.
    pub x: f64,
    /// Parabola through the last three points.
    pub parabola: f64,
    /// The last cubic of Akima's curve.
    pub cubic: f64,
    /// Tangent of Akima's curve at the last point.
    pub tangent: f64,
    /// Line through the last two points.
    pub line: f64,
}

impl Beyond {
    /// Largest less smallest.
    #[must_use]
    pub fn spread(&self) -> f64 {
        let all = [self.parabola, self.cubic, self.tangent, self.line];
        all.iter().fold(f64::MIN, |a, b| a.max(*b)) - all.iter().fold(f64::MAX, |a, b| a.min(*b))
    }

    /// The spread, and where it was found.
    #[must_use]
    pub fn extreme(&self) -> Extreme {
        Extreme { value: self.spread(), x: self.x, z: self.z }
    }
}

/// Every row of a table at `x`, outside of its first and last station; within them nothing.
///
/// # Errors
/// What Akima's curve refuses: none of a table's rows.
pub fn beyond(table: &Table, x: f64) -> Result<Vec<Beyond>, Error> {
    let points = table.x();
    let n = points.len();
    if x >= points[0] && x <= points[n - 1] {
        return Ok(Vec::new());
    }
    // End, its neighbour and the next.
    let k = if x > points[n - 1] { [n - 1, n - 2, n - 3] } else { [0, 1, 2] };
    let [a, b, c] = k.map(|k| points[k]);
    let mut out = Vec::new();
    for row in 0..table.values().nrows() {
        let y: Vec<f64> = table.values().row(row).iter().copied().collect();
        let slopes = akima(points, &y)?.slopes().to_vec();
        let [ya, yb, yc] = k.map(|k| y[k]);
        let (ta, tb) = (slopes[k[0]], slopes[k[1]]);
        let secant = (yb - ya) / (b - a);
        let bend = ((yc - ya) / (c - a) - secant) / (c - b);
        let r = x - a;
        // Newton's form of the cubic through (a, ya), (a, slope ta), (b, yb), (b, slope tb).
        let (first, second) = ((secant - ta) / (b - a), (tb - secant) / (b - a));
        let third = (second - first) / (b - a);
        out.push(Beyond {
            z: table.z().get(row).copied().unwrap_or(0.0),
            x,
            parabola: ya + r * (secant + (x - b) * bend),
            cubic: ya + r * (ta + r * (first + (x - b) * third)),
            tangent: ya + r * ta,
            line: ya + r * secant,
        });
    }
    Ok(out)
}
