//! Where the slope of a rail under a moving wheel jumps.

use super::{Strip, restricted};
use crate::Error;

/// Places of an interval that give the slope at its end: exact for polynomials up to degree 6.
const NODES: usize = 7;

/// Slopes on both sides of a break.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kink {
    /// Where.
    pub x: f64,
    /// Slope just before.
    pub before: f64,
    /// Slope just beyond.
    pub beyond: f64,
}

impl Kink {
    /// Slope beyond less slope before.
    #[must_use]
    pub fn jump(&self) -> f64 {
        self.beyond - self.before
    }
}

/// Slopes of `f` on both sides of every break strictly within `range`.
///
/// From seven places (Chebyshev's, ends included) of the intervals on either side: exact, but for rounding, where
/// `f` is a polynomial of degree 6 or less between breaks, as every reading and every surface of bending is along a
/// moving wheel.
///
/// # Errors
/// What `f` refuses.
///
/// # Source
/// Berrut, Trefethen, Barycentric Lagrange interpolation, SIAM Review 46, 501-517 (2004).
pub fn kinks(
    f: impl Fn(f64) -> Result<f64, Error>,
    breaks: &[f64],
    range: [f64; 2],
) -> Result<Vec<Kink>, Error> {
    let ends = restricted(breaks, range);
    let mut out = Vec::new();
    for three in ends.windows(3) {
        let before = end_slope(&f, three[1], three[0])?;
        let beyond = end_slope(&f, three[1], three[2])?;
        out.push(Kink { x: three[1], before, beyond });
    }
    Ok(out)
}

/// Slope at `end` of the polynomial through places from there to `other`.
fn end_slope(f: impl Fn(f64) -> Result<f64, Error>, end: f64, other: f64) -> Result<f64, Error> {
    let last = (NODES - 1) as f64;
    let place = |k: usize| 0.5 - 0.5 * (std::f64::consts::PI * k as f64 / last).cos();
    let weight = |k: usize| {
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        if k == 0 || k == NODES - 1 { 0.5 * sign } else { sign }
    };
    let start = f(end)?;
    let mut slope = 0.0;
    for k in 1..NODES {
        slope += weight(k) / weight(0) * (f(end + (other - end) * place(k))? - start) / -place(k);
    }
    Ok(slope / (other - end))
}

/// Kinks of the give under one wheel, g(x) = G(x, x), at the stations of a direct strip; slopes in 1/force.
///
/// # Errors
/// What the compliance refuses.
pub fn diagonal_kinks(strip: &Strip<'_>, range: [f64; 2]) -> Result<Vec<Kink>, Error> {
    kinks(|x| strip.at(x, x), &strip.compliance.breaks(strip.load.0), range)
}

/// Kinks of the give under two wheels with half the load each, `spacing` apart, at their mean:
/// g(x) = 1/4 sum of G over x and x + spacing; `x` is where the first wheel stands. Slopes in 1/force.
///
/// # Errors
/// What the compliance refuses.
pub fn pair_kinks(strip: &Strip<'_>, spacing: f64, range: [f64; 2]) -> Result<Vec<Kink>, Error> {
    if spacing >= range[1] - range[0] {
        return Ok(Vec::new());
    }
    let mut breaks = strip.compliance.breaks(strip.load.0);
    breaks.extend(breaks.clone().iter().map(|x| x - spacing));
    let give = |x: f64| Ok(0.25 * strip.block(&[x, x + spacing], &[x, x + spacing])?.sum());
    // The second wheel must not leave the range by rounding.
    let end = if range[1] - spacing + spacing > range[1] {
        (range[1] - spacing).next_down()
    } else {
        range[1] - spacing
    };
    kinks(give, &breaks, [range[0], end])
}
