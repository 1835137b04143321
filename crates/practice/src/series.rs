//! Values over times: means, even samples, excursions.

use crate::Error;
use crate::error::{Argument, least_zero, positive, signed, usable, within};

/// Whether times and series belong together and hold numbers.
pub(crate) fn check(times: &[f64], series: &[&[f64]]) -> Result<(), Error> {
    for (index, values) in series.iter().enumerate() {
        if values.len() != times.len() {
            return Err(Error::Samples { series: index, found: values.len(), expected: times.len() });
        }
        usable(index, values)?;
    }
    usable(series.len(), times)?;
    match times.windows(2).position(|pair| pair[1] < pair[0]) {
        Some(before) => Err(Error::Order { sample: before + 1 }),
        None => Ok(()),
    }
}

/// The mean over time from `from` to the last sample, values joined by straight lines.
///
/// # Errors
/// Fewer than two samples; lengths that differ, numbers that are not finite, times that decrease; `from` outside
/// the times or at their end.
pub fn mean(times: &[f64], values: &[f64], from: f64) -> Result<f64, Error> {
    check(times, &[values])?;
    let [first, .., last] = times[..] else {
        return Err(Error::Few { found: times.len(), least: 2 });
    };
    within(Argument::Time, from, first, last)?;
    let length = positive(Argument::Time, last - from)?;
    let mut sum = 0.0;
    for k in 1..times.len() {
        let (start, end) = (times[k - 1].max(from), times[k]);
        if end > start {
            let middle = between(times, values, k, 0.5 * start + 0.5 * end);
            sum += (end - start) / length * middle;
        }
    }
    Ok(sum)
}

/// Values every `step` from `from` on, up to the last time, read from straight lines between the samples. Where
/// two samples are of one time the later counts.
///
/// # Errors
/// As of [`mean`]; a step that is not positive, or so short that more than 2^24 values would come.
pub fn resample(times: &[f64], values: &[f64], from: f64, step: f64) -> Result<Vec<f64>, Error> {
    check(times, &[values])?;
    let [first, .., last] = times[..] else {
        return Err(Error::Few { found: times.len(), least: 2 });
    };
    within(Argument::Time, from, first, last)?;
    let length = last - from;
    let step = within(Argument::Time, positive(Argument::Time, step)?, length / f64::from(1 << 24), 1e30)?;
    // The last step may miss the end by rounding.
    let count = (length / step * (1.0 + 1e-12)).floor() as usize + 1;
    let mut k = 1;
    Ok((0..count)
        .map(|index| {
            let time = (from + index as f64 * step).min(last);
            while k + 1 < times.len() && times[k] <= time {
                k += 1;
            }
            between(times, values, k, time)
        })
        .collect())
}

/// The value at a time between the samples k - 1 and k.
fn between(times: &[f64], values: &[f64], k: usize, time: f64) -> f64 {
    let length = times[k] - times[k - 1];
    let share = if length > 0.0 { ((time - times[k - 1]) / length).clamp(0.0, 1.0) } else { 1.0 };
    values[k - 1] * (1.0 - share) + values[k] * share
}

/// How often a history leaves a band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Excursions {
    /// Upwards.
    pub above: usize,
    /// Downwards.
    pub below: usize,
}

impl Excursions {
    /// Both.
    #[must_use]
    pub fn total(&self) -> usize {
        self.above + self.below
    }
}

/// Excursions beyond `mean` plus or minus `share` |mean|: each stretch of successive samples on one side counts
/// once, one at the start too.
///
/// # Errors
/// A mean that is not finite, a share that is negative; a sample that is not finite.
pub fn excursions(values: &[f64], mean: f64, share: f64) -> Result<Excursions, Error> {
    let mean = signed(Argument::Force, mean)?;
    let width = least_zero(Argument::Share, share)? * mean.abs();
    let mut counts = Excursions { above: 0, below: 0 };
    let mut side = 0;
    usable(0, values)?;
    for &value in values {
        let now = i32::from(value > mean + width) - i32::from(value < mean - width);
        counts.above += usize::from(now > 0 && side <= 0);
        counts.below += usize::from(now < 0 && side >= 0);
        side = now;
    }
    Ok(counts)
}
