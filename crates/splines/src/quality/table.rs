//! What a table shows by itself: its digits, its supports, and how far the rules of extrapolation differ
//! beyond it.

use crate::curve::akima;
use crate::error::Error;
use crate::table::SplineTable;

/// A row that is below this fraction of the table's largest entry belongs to a support.
const ZERO: f64 = 1e-12;

/// One row of a table extrapolated beyond its end by four rules, length/force.
///
/// ADAMS documents all of them: with LINEAR_EXTRAPOLATE the tangent or the line through the last two points,
/// without it the parabola through the last three points or a cubic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExtrapolatedRow {
    /// The row: coordinate at which the deflection is taken.
    pub z: f64,
    /// Coordinate of the load, beyond the table.
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

impl ExtrapolatedRow {
    /// Largest less smallest of the four.
    #[must_use]
    pub fn spread(&self) -> f64 {
        let all = [self.parabola, self.cubic, self.tangent, self.line];
        all.iter().fold(f64::MIN, |a, b| a.max(*b)) - all.iter().fold(f64::MAX, |a, b| a.min(*b))
    }
}

/// Every row of a table extrapolated to `x`; empty where `x` is within the stations.
///
/// # Errors
/// Those of Akima's curve, which do not occur for a table.
pub fn extrapolated_rows(table: &SplineTable, x: f64) -> Result<Vec<ExtrapolatedRow>, Error> {
    let points = table.x();
    let n = points.len();
    if x >= points[0] && x <= points[n - 1] {
        return Ok(Vec::new());
    }
    // The last point, its neighbour and the next.
    let k = if x > points[n - 1] {
        [n - 1, n - 2, n - 3]
    } else {
        [0, 1, 2]
    };
    let [a, b, c] = k.map(|k| points[k]);
    let mut out = Vec::new();
    for row in 0..table.values().nrows() {
        let y: Vec<f64> = table.values().row(row).iter().copied().collect();
        let slopes = akima(points, &y)?.slopes().to_vec();
        let [ya, yb, yc] = k.map(|k| y[k]);
        let (ta, tb) = (slopes[k[0]], slopes[k[1]]);
        let secant = (yb - ya) / (b - a);
        let curvature = ((yc - ya) / (c - a) - secant) / (c - b);
        let r = x - a;
        // Newton's form of the cubic with the values ya, yb and slopes ta, tb at a and b.
        let (first, second) = ((secant - ta) / (b - a), (tb - secant) / (b - a));
        let third = (second - first) / (b - a);
        out.push(ExtrapolatedRow {
            z: table.z().get(row).copied().unwrap_or(0.0),
            x,
            parabola: ya + r * (secant + (x - b) * curvature),
            cubic: ya + r * (ta + r * (first + (x - b) * third)),
            tangent: ya + r * ta,
            line: ya + r * secant,
        });
    }
    Ok(out)
}

/// Precision with which a table is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TablePrecision {
    /// Fewest significant digits, 1 to 17, that reproduce every entry to the last bit.
    pub digits: usize,
    /// Frobenius norm of a change of every entry by one unit of its last digit, length/force. By rounding to
    /// these digits no entry and no eigenvalue changes by more.
    pub slack: f64,
}

/// Precision with which the entries of a table are written.
///
/// # Source
/// Weyl's theorem: the eigenvalues of a symmetric matrix change by no more than the norm of the change.
#[must_use]
pub fn table_precision(table: &SplineTable) -> TablePrecision {
    let all = table.values();
    let reproduced = |count: usize| {
        all.iter()
            .all(|value| format!("{:.*e}", count - 1, value).parse() == Ok(*value))
    };
    let count = (1..17).find(|&count| reproduced(count)).unwrap_or(17);
    let unit = |value: f64| {
        let power = || value.abs().log10().floor() as i32 + 1 - count as i32;
        if value == 0.0 {
            0.0
        } else {
            10_f64.powi(power())
        }
    };
    TablePrecision {
        digits: count,
        slack: all.iter().map(|v| unit(*v).powi(2)).sum::<f64>().sqrt(),
    }
}

/// Stations along z whose rows are zero (below 1e-12 of the table's largest entry), which are rigid supports.
#[must_use]
pub fn support_stations(table: &SplineTable) -> Vec<f64> {
    let zero = ZERO * table.values().amax();
    let is_zero = |i: &usize| table.values().row(*i).amax() <= zero;
    (0..table.z().len())
        .filter(is_zero)
        .map(|i| table.z()[i])
        .collect()
}
