//! The dominant frequency of a history.

use std::f64::consts::PI;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use crate::Error;
use crate::error::{Argument, least_zero, positive, usable, within};

/// Fewest samples of a spectrum.
const LEAST: usize = 8;

/// Amplitudes over the largest value that rounding makes.
pub(crate) const NOISE: f64 = 64.0 * f64::EPSILON;

/// A sine within a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// Cycles per unit of time.
    pub frequency: f64,
    /// From its middle to its top.
    pub amplitude: f64,
}

/// The strongest sine of a frequency in `band`, the least and the most in cycles per unit of time; `step` between
/// samples. None where the spectrum has no peak inside.
///
/// The history less its mean, under Hann's window, is transformed; at the highest peak, bin k with the larger
/// neighbour k +- 1 and the ratio a of their magnitudes, the frequency is that of k +- d, d = (2 a - 1)/(a + 1),
/// and the amplitude 4 |X_k| (1 - d^2) pi d/(n sin(pi d)). Exact for a sine alone, but for what reaches over from
/// its negative frequency; of a decaying one the amplitude is a mean.
///
/// # Errors
/// Fewer than 8 samples, one that is not finite, a step that is not positive, a band that is not one.
///
/// # Source
/// Grandke, Interpolation algorithms for discrete Fourier transforms of weighted signals, IEEE Trans. Instrum.
/// Meas. 32, 350-355 (1983).
pub fn dominant(values: &[f64], step: f64, band: [f64; 2]) -> Result<Option<Tone>, Error> {
    let step = positive(Argument::Time, step)?;
    let least = least_zero(Argument::Frequency, band[0])?;
    let most = within(Argument::Frequency, band[1], least, 1e30)?;
    usable(0, values)?;
    if values.len() < LEAST {
        return Err(Error::Few { found: values.len(), least: LEAST });
    }
    let n = values.len() as f64;
    let sizes: Vec<f64> = transform(values).iter().map(|bin| bin.norm()).collect();
    // What rounding leaves of a constant is no sine.
    let noise = NOISE * n * values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let mut peak: Option<(usize, f64)> = None;
    for k in 1..sizes.len() - 1 {
        let frequency = k as f64 / (n * step);
        let inside = frequency >= least && frequency <= most;
        let top = sizes[k] > noise && sizes[k] > sizes[k - 1] && sizes[k] >= sizes[k + 1];
        if inside && top && peak.is_none_or(|(_, size)| sizes[k] > size) {
            peak = Some((k, sizes[k]));
        }
    }
    Ok(peak.map(|(k, size)| {
        let right = sizes[k + 1] >= sizes[k - 1];
        let ratio = if right { sizes[k + 1] } else { sizes[k - 1] } / size;
        let shift = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.5);
        let lobe = if shift > 0.0 { (PI * shift).sin() / (PI * shift) } else { 1.0 };
        let place = k as f64 + if right { shift } else { -shift };
        Tone { frequency: place / (n * step), amplitude: 4.0 * size * (1.0 - shift * shift) / (n * lobe) }
    }))
}

/// Bins of the history less its mean, under Hann's window.
fn transform(values: &[f64]) -> Vec<Complex<f64>> {
    let n = values.len() as f64;
    let mean = values.iter().map(|value| value / n).sum::<f64>();
    let window = |k: usize| 0.5 - 0.5 * (2.0 * PI * k as f64 / n).cos();
    let mut input: Vec<f64> =
        values.iter().enumerate().map(|(k, value)| (value - mean) * window(k)).collect();
    let plan = RealFftPlanner::<f64>::new().plan_fft_forward(values.len());
    let mut output = plan.make_output_vec();
    plan.process(&mut input, &mut output).expect("lengths are those of the plan");
    output
}
