//! A low-pass filter without phase delay.

use std::f64::consts::{PI, SQRT_2};

use crate::Error;
use crate::error::{Argument, check_samples, positive, within};

/// A second-order Butterworth filter that is applied forwards and then backwards, so that it has no phase
/// delay.
///
/// The gain of a sine of frequency f is 1/(1 + (tan(pi f h)/tan(pi c h))^4), one half at the cut-off
/// frequency c. `step` is the interval h of samples, `cut` is c in cycles per unit of time. Beyond both ends
/// the history is extended by its point reflection in the end point, over a length of 5/c or as far as it has
/// samples.
///
/// # Errors
/// [`Error::Range`] for a step that is not positive, or a cut-off frequency that is not between zero and half
/// the sampling frequency; [`Error::Number`] for a sample that is not finite.
///
/// # Source
/// Oppenheim and Schafer, Discrete-Time Signal Processing (2010), chapter 7 (bilinear transform); Gustafsson,
/// Determining the initial states in forward-backward filtering, IEEE Trans. Signal Process. 44, 988-992
/// (1996), on the treatment of the ends.
///
/// ```
/// let straight: Vec<f64> = (0..100).map(|k| 0.5 * f64::from(k)).collect();
/// let filtered = practice::low_pass(&straight, 0.01, 5.0)?;
/// assert!(straight.iter().zip(&filtered).all(|(a, b)| (a - b).abs() < 1e-9));
/// # Ok::<(), practice::Error>(())
/// ```
pub fn low_pass(values: &[f64], step: f64, cut: f64) -> Result<Vec<f64>, Error> {
    let step = positive(Argument::Time, step)?;
    let half = 0.5 / step;
    let cut = within(Argument::Frequency, cut, half * 1e-9, half * (1.0 - 1e-9))?;
    check_samples(0, values)?;
    let [first, .., last] = values[..] else {
        return Ok(values.to_vec());
    };
    let section = Biquad::new((PI * cut * step).tan());
    let pad = ((5.0 / (cut * step)).ceil() as usize).min(values.len() - 1);
    let before = values[1..=pad]
        .iter()
        .rev()
        .map(|value| 2.0 * first - value);
    let after = values[values.len() - 1 - pad..values.len() - 1]
        .iter()
        .rev()
        .map(|value| 2.0 * last - value);
    let mut padded: Vec<f64> = before.chain(values.iter().copied()).chain(after).collect();
    section.run(&mut padded);
    padded.reverse();
    section.run(&mut padded);
    padded.reverse();
    Ok(padded[pad..pad + values.len()].to_vec())
}

/// A second-order section of a filter: y_n = b (x_n + 2 x_{n-1} + x_{n-2}) - a_1 y_{n-1} - a_2 y_{n-2}.
struct Biquad {
    b: f64,
    a: [f64; 2],
}

impl Biquad {
    /// The Butterworth low-pass with K = tan(pi c h).
    fn new(k: f64) -> Biquad {
        let norm = 1.0 + SQRT_2 * k + k * k;
        Biquad {
            b: k * k / norm,
            a: [
                2.0 * (k * k - 1.0) / norm,
                (1.0 - SQRT_2 * k + k * k) / norm,
            ],
        }
    }

    /// Filters in place. The initial state is that of a constant history equal to the first value.
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
