//! The characteristics of a response that engineers compare.

use super::filter::low_pass;
use super::series::{Excursions, excursions, mean, resample};
use crate::Error;
use crate::error::{Argument, within};

/// How a response is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseSettings {
    /// Time from which the response is evaluated.
    pub from: f64,
    /// Time from which the response is taken as settled.
    pub settled: f64,
    /// Interval of the even samples.
    pub step: f64,
    /// Cut-off frequency of the low-pass filter, in cycles per unit of time; `None` for no filter.
    pub cut_off: Option<f64>,
    /// Half width of the band of excursions, as a fraction of the settled mean.
    pub excursion_fraction: f64,
}

/// A value and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedValue {
    /// Time.
    pub time: f64,
    /// Value.
    pub value: f64,
}

/// The characteristics of a response from [`ResponseSettings::from`] on, which is sampled evenly and, if requested,
/// filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResponseCharacteristics {
    /// Time average of the unfiltered history from [`ResponseSettings::settled`] to the end.
    pub mean: f64,
    /// Largest value.
    pub peak: TimedValue,
    /// Smallest value.
    pub trough: TimedValue,
    /// Excursions beyond the band about the mean.
    pub excursions: Excursions,
}

/// The settled mean, extremes and excursions of a history.
///
/// # Errors
/// Those of [`mean`], [`resample`], [`low_pass`] and [`excursions`].
///
/// ```
/// use practice::{ResponseSettings, response};
///
/// // A step to 50 at time zero that oscillates at 2 Hz with a damping of 3 %.
/// let times: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k)).collect();
/// let omega = 4.0 * std::f64::consts::PI;
/// let step = |t: &f64| 50.0 - 50.0 * (-0.03 * omega * t).exp() * (omega * t).cos();
/// let values: Vec<f64> = times.iter().map(step).collect();
/// let view = ResponseSettings {
///     from: 0.0,
///     settled: 8.0,
///     step: 0.01,
///     cut_off: None,
///     excursion_fraction: 0.1,
/// };
/// let found = response(&times, &values, &view)?;
/// assert!((found.mean - 50.0).abs() < 0.5 && found.peak.value > 90.0);
/// // Every crest above 55 and every trough below 45: 50 exp(-0.03 pi k) > 5 for k = 0 to 24.
/// assert_eq!(found.excursions.total(), 25);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn response(
    times: &[f64],
    values: &[f64],
    view: &ResponseSettings,
) -> Result<ResponseCharacteristics, Error> {
    let settled = within(Argument::Time, view.settled, view.from, 1e30)?;
    let mean = mean(times, values, settled)?;
    let even = resample(times, values, view.from, view.step)?;
    let even = match view.cut_off {
        Some(cut) => low_pass(&even, view.step, cut)?,
        None => even,
    };
    let best = |better: fn(f64, f64) -> bool| {
        let sample = (0..even.len()).fold(
            0,
            |best, k| if better(even[k], even[best]) { k } else { best },
        );
        TimedValue {
            time: view.from + sample as f64 * view.step,
            value: even[sample],
        }
    };
    Ok(ResponseCharacteristics {
        mean,
        peak: best(|value, found| value > found),
        trough: best(|value, found| value < found),
        excursions: excursions(&even, mean, view.excursion_fraction)?,
    })
}
