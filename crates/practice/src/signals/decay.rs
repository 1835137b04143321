//! The damping of a free oscillation.

use std::f64::consts::PI;

use super::spectrum::NOISE;
use crate::Error;
use crate::error::{Argument, check_samples, positive, within};

/// The properties of a free oscillation that decays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decay {
    /// Damping ratio, negative for an oscillation that grows.
    pub ratio: f64,
    /// Damped frequency, in cycles per unit of time.
    pub frequency: f64,
    /// Number of half cycles from which they are determined.
    pub half_cycles: usize,
}

/// The damping ratio by the logarithmic decrement.
///
/// r_k are the ranges between successive extremes, each found from a parabola through three samples. They are
/// used from the largest range on, as long as they exceed the fraction `floor` of it. With the slope s of the
/// line through (k, ln r_k) by least squares, the logarithmic decrement is delta = -2 s and the damping ratio
///
/// zeta = delta/sqrt(4 pi^2 + delta^2).
///
/// Ranges do not depend on a constant offset, so that the settled mean need not be known. The result is
/// `None` if fewer than two ranges remain. `step` is the interval of samples. A history with several modes
/// has no single damping ratio and must be filtered first.
///
/// # Errors
/// [`Error::Range`] for a step that is not positive or a floor outside 0 to 1; [`Error::Number`] for a sample
/// that is not finite.
///
/// # Source
/// Clough and Penzien, Dynamics of Structures (1993), section 2-6.
///
/// ```
/// let free = |t: f64| (-0.1 * t).exp() * (5.0 * t).cos();
/// let free: Vec<f64> = (0..400).map(|k| free(0.05 * f64::from(k))).collect();
/// let found = practice::decay(&free, 0.05, 0.1)?.expect("an oscillation");
/// assert!((found.ratio - 0.02).abs() < 1e-3);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn decay(values: &[f64], step: f64, floor: f64) -> Result<Option<Decay>, Error> {
    let step = positive(Argument::Time, step)?;
    let floor = within(Argument::Fraction, floor, 0.0, 1.0)?;
    check_samples(0, values)?;
    let noise = NOISE
        * values
            .iter()
            .fold(0.0, |most: f64, value| most.max(value.abs()));
    let tops = extremes(values);
    let ranges: Vec<f64> = tops
        .windows(2)
        .map(|pair| (pair[0].1 - pair[1].1).abs())
        .collect();
    let start = (0..ranges.len()).fold(0, |top, k| if ranges[k] > ranges[top] { k } else { top });
    let kept = ranges[start.min(ranges.len())..].iter();
    let logs: Vec<f64> = kept
        .take_while(|range| **range > noise && **range >= floor * ranges[start])
        .map(|range| range.ln())
        .collect();
    if logs.len() < 2 {
        return Ok(None);
    }
    let middle = (logs.len() - 1) as f64 / 2.0;
    let (mut square, mut product) = (0.0, 0.0);
    for (k, log) in logs.iter().enumerate() {
        square += (k as f64 - middle).powi(2);
        product += (k as f64 - middle) * log;
    }
    let delta = -2.0 * product / square;
    let time = (tops[start + logs.len()].0 - tops[start].0) * step;
    Ok(Some(Decay {
        ratio: delta / (4.0 * PI * PI + delta * delta).sqrt(),
        frequency: logs.len() as f64 / (2.0 * time),
        half_cycles: logs.len(),
    }))
}

/// The positions, in samples, and values of the extremes, by parabolas through three samples.
fn extremes(values: &[f64]) -> Vec<(f64, f64)> {
    let mut tops = Vec::new();
    for k in 1..values.len().saturating_sub(1) {
        let [a, b, c] = [values[k - 1], values[k], values[k + 1]];
        if (b > a && b >= c) || (b < a && b <= c) {
            let curve = a - 2.0 * b + c;
            let shift = if curve == 0.0 {
                0.0
            } else {
                0.5 * (a - c) / curve
            };
            tops.push((k as f64 + shift, b - 0.25 * (a - c) * shift));
        }
    }
    tops
}
