//! The spectrum of a history and its dominant frequencies.

use std::cell::RefCell;
use std::f64::consts::PI;

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use crate::Error;
use crate::error::{Argument, check_samples, non_negative, positive, within};

/// Smallest number of samples of a spectrum.
const LEAST: usize = 8;

/// Amplitudes below this fraction of the largest value are rounding.
pub(crate) const NOISE: f64 = 64.0 * f64::EPSILON;

/// A sine component of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SineComponent {
    /// Frequency, in cycles per unit of time.
    pub frequency: f64,
    /// Amplitude, half of the range from trough to crest.
    pub amplitude: f64,
}

/// The spectrum of a history without its mean, under Hann's window. Several bands of it can be searched.
///
/// ```
/// use practice::HistorySpectrum;
///
/// let wave = |t: f64| (2.0 * t).sin() + 0.3 * (9.0 * t).sin();
/// let values: Vec<f64> = (0..400).map(|k| wave(0.1 * f64::from(k))).collect();
/// let spectrum = HistorySpectrum::new(&values, 0.1)?;
/// let [slow, fast] = [[0.1, 1.0], [1.0, 5.0]].map(|band| spectrum.strongest(band));
/// assert!((slow?.expect("a peak").amplitude - 1.0).abs() < 0.01);
/// assert!((fast?.expect("a peak").amplitude - 0.3).abs() < 0.01);
/// # Ok::<(), practice::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct HistorySpectrum {
    /// Magnitudes of the bins.
    sizes: Vec<f64>,
    /// Magnitudes up to this are rounding.
    noise: f64,
    count: f64,
    step: f64,
}

impl HistorySpectrum {
    /// The spectrum of values at intervals of `step`.
    ///
    /// # Errors
    /// [`Error::Few`] for fewer than 8 samples; [`Error::Number`] for a sample that is not finite;
    /// [`Error::Range`] for a step that is not positive.
    pub fn new(values: &[f64], step: f64) -> Result<HistorySpectrum, Error> {
        let step = positive(Argument::Time, step)?;
        check_samples(0, values)?;
        if values.len() < LEAST {
            return Err(Error::Few {
                found: values.len(),
                least: LEAST,
            });
        }
        let count = values.len() as f64;
        let sizes = transform(values).iter().map(|bin| bin.norm()).collect();
        // The rounding errors of a constant history must not count as a sine.
        let noise = NOISE
            * count
            * values
                .iter()
                .fold(0.0, |most: f64, value| most.max(value.abs()));
        Ok(HistorySpectrum {
            sizes,
            noise,
            count,
            step,
        })
    }

    /// The strongest sine component with a frequency in `band`, given by its lower and upper limit in cycles per unit of
    /// time; `None` if the spectrum has no peak in the band.
    ///
    /// At the highest peak, in bin k, let a be the ratio of the magnitude of the larger neighbour k +- 1 to that of the
    /// peak. The frequency is that of k +- d with d = (2 a - 1)/(a + 1), and the amplitude
    /// 4 |X_k| (1 - d^2) pi d/(n sin(pi d)). This is exact for a single sine except for the leakage of its negative
    /// frequency; for a decaying sine the amplitude is an average.
    ///
    /// # Errors
    /// [`Error::Range`] for limits of the band that are negative or in the wrong order.
    ///
    /// # Source
    /// Grandke, Interpolation algorithms for discrete Fourier transforms of weighted signals, IEEE Trans.
    /// Instrum. Meas. 32, 350-355 (1983).
    pub fn strongest(&self, band: [f64; 2]) -> Result<Option<SineComponent>, Error> {
        let least = non_negative(Argument::Frequency, band[0])?;
        let most = within(Argument::Frequency, band[1], least, 1e30)?;
        let HistorySpectrum {
            sizes,
            noise,
            count,
            step,
        } = self;
        let mut peak: Option<(usize, f64)> = None;
        for k in 1..sizes.len() - 1 {
            let frequency = k as f64 / (count * step);
            let inside = frequency >= least && frequency <= most;
            let top = sizes[k] > *noise && sizes[k] > sizes[k - 1] && sizes[k] >= sizes[k + 1];
            if inside && top && peak.is_none_or(|(_, size)| sizes[k] > size) {
                peak = Some((k, sizes[k]));
            }
        }
        Ok(peak.map(|(k, size)| {
            let right = sizes[k + 1] >= sizes[k - 1];
            let ratio = if right { sizes[k + 1] } else { sizes[k - 1] } / size;
            let shift = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.5);
            let lobe = if shift > 0.0 {
                (PI * shift).sin() / (PI * shift)
            } else {
                1.0
            };
            let place = k as f64 + if right { shift } else { -shift };
            SineComponent {
                frequency: place / (count * step),
                amplitude: 4.0 * size * (1.0 - shift * shift) / (count * lobe),
            }
        }))
    }
}

thread_local! {
    /// The plans of the lengths transformed so far: a plan costs many times a transform.
    static PLANNER: RefCell<RealFftPlanner<f64>> = RefCell::new(RealFftPlanner::new());
}

/// The Fourier transform of the history without its mean, under Hann's window.
fn transform(values: &[f64]) -> Vec<Complex<f64>> {
    let n = values.len() as f64;
    let mean = values.iter().map(|value| value / n).sum::<f64>();
    let window = |k: usize| 0.5 - 0.5 * (2.0 * PI * k as f64 / n).cos();
    let mut input: Vec<f64> = values
        .iter()
        .enumerate()
        .map(|(k, value)| (value - mean) * window(k))
        .collect();
    let plan = PLANNER.with_borrow_mut(|planner| planner.plan_fft_forward(values.len()));
    let mut output = plan.make_output_vec();
    plan.process(&mut input, &mut output)
        .expect("lengths are those of the plan");
    output
}
