//! A low-pass filter without delay.

use std::f64::consts::{PI, SQRT_2};

use crate::Error;
use crate::error::{Argument, positive, usable, within};

/// Butterworth's filter of second order run forwards, then backwards: no delay, and a sine of frequency f keeps
///
/// 1/(1 + (tan(pi f h)/tan(pi c h))^4)
///
/// of its amplitude, half at the cut `c`. `step` h between samples, `cut` in cycles per unit of time. At both ends
/// the history is continued by its image in the end point, 5/c long where it has as much.
///
/// # Errors
/// A step that is not positive; a cut that is not between zero and half the sampling frequency; a sample that is
/// not finite.
///
/// # Source
/// Oppenheim and Schafer, Discrete-Time Signal Processing (2010), chapter 7 (bilinear transform); Gustafsson,
/// Determining the initial states in forward-backward filtering, IEEE Trans. Signal Process. 44, 988-992 (1996),
/// on why ends need care.
pub fn low_pass(values: &[f64], step: f64, cut: f64) -> Result<Vec<f64>, Error> {
    let step = positive(Argument::Time, step)?;
    let half = 0.5 / step;
    let cut = within(Argument::Frequency, cut, half * 1e-9, half * (1.0 - 1e-9))?;
    usable(0, values)?;
    let [first, .., last] = values[..] else {
        return Ok(values.to_vec());
    };
    let section = Section::new((PI * cut * step).tan());
    let pad = ((5.0 / (cut * step)).ceil() as usize).min(values.len() - 1);
    let before = values[1..=pad].iter().rev().map(|value| 2.0 * first - value);
    let after = values[values.len() - 1 - pad..values.len() - 1].iter().rev().map(|value| 2.0 * last - value);
    let mut padded: Vec<f64> = before.chain(values.iter().copied()).chain(after).collect();
    section.run(&mut padded);
    padded.reverse();
    section.run(&mut padded);
    padded.reverse();
    Ok(padded[pad..pad + values.len()].to_vec())
}

/// y_n = b (x_n + 2 x_{n-1} + x_{n-2}) - a_1 y_{n-1} - a_2 y_{n-2}.
struct Section {
    b: f64,
    a: [f64; 2],
}

impl Section {
    /// From K = tan(pi c h).
    fn new(k: f64) -> Section {
        let norm = 1.0 + SQRT_2 * k + k * k;
        Section { b: k * k / norm, a: [2.0 * (k * k - 1.0) / norm, (1.0 - SQRT_2 * k + k * k) / norm] }
    }

    /// In place, as if the first value had stood for ever.
    fn run(&self, values: &mut [f64]) {
        let Some(&first) = values.first() else { return };
        let mut state = [(1.0 - self.b) * first, (self.b - self.a[1]) * first];
        for value in values {
            let input = *value;
            let output = self.b * input + state[0];
            state[0] = 2.0 * self.b * input - self.a[0] * output + state[1];
            state[1] = self.b * input - self.a[1] * output;
            *value = output;
        }
    }
}
