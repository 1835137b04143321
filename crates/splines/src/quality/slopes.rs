//! Jumps of the slope of the rail's deflection under moving wheels.

use super::block::CouplingBlock;
use super::search::breaks_within;
use crate::error::Error;

/// Number of places of an interval from which the slope at its end is found: exact for polynomials up to
/// degree 6.
const NODES: usize = 7;

/// Slopes on both sides of a break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeJump {
    /// Coordinate of the break.
    pub x: f64,
    /// Slope just before it.
    pub before: f64,
    /// Slope just beyond it.
    pub beyond: f64,
}

impl SlopeJump {
    /// Slope beyond the break less slope before it.
    #[must_use]
    pub fn jump(&self) -> f64 {
        self.beyond - self.before
    }
}

/// Slopes of `f` on both sides of every break strictly within `range`.
///
/// Each slope is that of the polynomial through seven Chebyshev points (ends included) of the interval on
/// that side. It is exact but for rounding where `f` is a polynomial of degree 6 or less between breaks, as
/// is the deflection under a moving wheel for every table reading and every exact surface in bending.
///
/// # Errors
/// Those of `f`.
///
/// # Source
/// Berrut, Trefethen, Barycentric Lagrange interpolation, SIAM Review 46, 501-517 (2004).
pub fn slope_jumps(
    f: impl Fn(f64) -> Result<f64, Error>,
    breaks: &[f64],
    range: [f64; 2],
) -> Result<Vec<SlopeJump>, Error> {
    let ends = breaks_within(breaks, range);
    let mut out = Vec::new();
    for three in ends.windows(3) {
        let before = end_slope(&f, three[1], three[0])?;
        let beyond = end_slope(&f, three[1], three[2])?;
        out.push(SlopeJump {
            x: three[1],
            before,
            beyond,
        });
    }
    Ok(out)
}

/// Slope at `end` of the polynomial through the Chebyshev points from there to `other`, by the barycentric
/// formula.
fn end_slope(f: impl Fn(f64) -> Result<f64, Error>, end: f64, other: f64) -> Result<f64, Error> {
    let last = (NODES - 1) as f64;
    let place = |k: usize| 0.5 - 0.5 * (std::f64::consts::PI * k as f64 / last).cos();
    let weight = |k: usize| {
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        if k == 0 || k == NODES - 1 {
            0.5 * sign
        } else {
            sign
        }
    };
    let start = f(end)?;
    let mut slope = 0.0;
    for k in 1..NODES {
        slope += weight(k) / weight(0) * (f(end + (other - end) * place(k))? - start) / -place(k);
    }
    Ok(slope / (other - end))
}

/// Slopes of the deflection under one wheel with unit load, g(x) = G(x, x), on both sides of every break of a
/// direct block, 1/force.
///
/// # Errors
/// Those of the compliance.
pub fn diagonal_slope_jumps(
    block: &CouplingBlock<'_>,
    range: [f64; 2],
) -> Result<Vec<SlopeJump>, Error> {
    slope_jumps(
        |x| block.at(x, x),
        &block.compliance.breaks(block.load.0),
        range,
    )
}

/// The same for the mean deflection under two wheels at the distance `spacing` with half the unit load each:
/// g(x) = 1/4 sum of G over x and x + spacing, x being the coordinate of the first wheel.
///
/// # Errors
/// Those of the compliance.
pub fn pair_slope_jumps(
    block: &CouplingBlock<'_>,
    spacing: f64,
    range: [f64; 2],
) -> Result<Vec<SlopeJump>, Error> {
    if spacing >= range[1] - range[0] {
        return Ok(Vec::new());
    }
    let mut breaks = block.compliance.breaks(block.load.0);
    breaks.extend(breaks.clone().iter().map(|x| x - spacing));
    let deflection = |x: f64| Ok(0.25 * block.matrix(&[x, x + spacing], &[x, x + spacing])?.sum());
    // Rounding must not put the second wheel beyond the range.
    let end = if range[1] - spacing + spacing > range[1] {
        (range[1] - spacing).next_down()
    } else {
        range[1] - spacing
    };
    slope_jumps(deflection, &breaks, [range[0], end])
}
