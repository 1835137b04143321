//! A response in the few numbers that engineers compare.

use crate::Error;
use crate::decay::{Decay, decay};
use crate::error::{Argument, within};
use crate::filter::low_pass;
use crate::series::{Excursions, excursions, mean, resample};
use crate::spectrum::{Tone, dominant};

/// What is looked at, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From when on the response counts.
    pub from: f64,
    /// From when on it is taken as settled.
    pub settled: f64,
    /// Between even samples.
    pub step: f64,
    /// Cut of the low-pass, cycles per unit of time, if there is one.
    pub cut: Option<f64>,
    /// Half width of the band for excursions, as a share of the settled mean.
    pub share: f64,
    /// Frequencies among which the dominant one is sought.
    pub band: [f64; 2],
    /// The smallest range that counts for damping, as a share of the largest.
    pub floor: f64,
}

/// A value and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// When.
    pub time: f64,
    /// How much.
    pub value: f64,
}

/// A response from [`View::from`] on, sampled evenly and, if asked, filtered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Mean over time from [`View::settled`] to the end, of the history as given.
    pub mean: f64,
    /// Largest value.
    pub peak: Mark,
    /// Smallest value.
    pub least: Mark,
    /// Beyond the band about the mean.
    pub excursions: Excursions,
    /// Strongest sine.
    pub tone: Option<Tone>,
    /// Damping, if the response is that of one mode.
    pub decay: Option<Decay>,
}

/// Settled mean, extremes, excursions, dominant frequency and damping of a history.
///
/// # Errors
/// As of [`mean`], [`resample`], [`low_pass`], [`excursions`], [`dominant`] and [`decay`].
pub fn response(times: &[f64], values: &[f64], view: &View) -> Result<Response, Error> {
    let settled = within(Argument::Time, view.settled, view.from, 1e30)?;
    let mean = mean(times, values, settled)?;
    let even = resample(times, values, view.from, view.step)?;
    let even = match view.cut {
        Some(cut) => low_pass(&even, view.step, cut)?,
        None => even,
    };
    let best = |better: fn(f64, f64) -> bool| {
        let sample = (0..even.len()).fold(0, |best, k| if better(even[k], even[best]) { k } else { best });
        Mark { time: view.from + sample as f64 * view.step, value: even[sample] }
    };
    Ok(Response {
        mean,
        peak: best(|value, found| value > found),
        least: best(|value, found| value < found),
        excursions: excursions(&even, mean, view.share)?,
        tone: dominant(&even, view.step, view.band)?,
        decay: decay(&even, view.step, view.floor)?,
    })
}
