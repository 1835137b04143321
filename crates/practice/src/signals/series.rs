//! Histories over time: means, even samples, excursions.

use crate::Error;
use crate::error::{Argument, check_samples, non_negative, positive, signed, within};

/// Checks that every series is as long as the times, that all samples are numbers, and that times do not
/// decrease.
pub(crate) fn check(times: &[f64], series: &[&[f64]]) -> Result<(), Error> {
    for (index, values) in series.iter().enumerate() {
        if values.len() != times.len() {
            return Err(Error::Samples {
                series: index,
                found: values.len(),
                expected: times.len(),
            });
        }
        check_samples(index, values)?;
    }
    check_samples(series.len(), times)?;
    match times.windows(2).position(|pair| pair[1] < pair[0]) {
        Some(before) => Err(Error::Order { sample: before + 1 }),
        None => Ok(()),
    }
}

/// The time average from `from` to the last sample, with values interpolated linearly between samples.
///
/// # Errors
/// [`Error::Few`] for fewer than two samples; [`Error::Samples`], [`Error::Number`] and [`Error::Order`] for
/// lengths that differ, samples that are not finite, or times that decrease; [`Error::Range`] for `from`
/// outside the times or at their end.
///
/// ```
/// let (times, values) = ([0.0, 1.0, 3.0], [0.0, 2.0, 2.0]);
/// assert_eq!(practice::mean(&times, &values, 1.0)?, 2.0);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn mean(times: &[f64], values: &[f64], from: f64) -> Result<f64, Error> {
    check(times, &[values])?;
    let [first, .., last] = times[..] else {
        return Err(Error::Few {
            found: times.len(),
            least: 2,
        });
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

/// Even samples at intervals of `step` from `from` to the last time, interpolated linearly. Where two samples
/// have the same time, the later one is used.
///
/// # Errors
/// Those of [`mean`]; [`Error::Range`] for a step that is not positive, or so short that there would be more
/// than 2^24 samples.
pub fn resample(times: &[f64], values: &[f64], from: f64, step: f64) -> Result<Vec<f64>, Error> {
    check(times, &[values])?;
    let [first, .., last] = times[..] else {
        return Err(Error::Few {
            found: times.len(),
            least: 2,
        });
    };
    within(Argument::Time, from, first, last)?;
    let length = last - from;
    let step = within(
        Argument::Time,
        positive(Argument::Time, step)?,
        length / f64::from(1 << 24),
        1e30,
    )?;
    // The tolerance keeps the last sample where rounding would put it just beyond the end.
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

/// The value at a time between the samples k - 1 and k, interpolated linearly.
fn between(times: &[f64], values: &[f64], k: usize, time: f64) -> f64 {
    let length = times[k] - times[k - 1];
    let fraction = if length > 0.0 {
        ((time - times[k - 1]) / length).clamp(0.0, 1.0)
    } else {
        1.0
    };
    values[k - 1] * (1.0 - fraction) + values[k] * fraction
}

/// The number of times that a history leaves a band.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Excursions {
    /// Excursions above the band.
    pub above: usize,
    /// Excursions below the band.
    pub below: usize,
}

impl Excursions {
    /// Excursions on both sides.
    #[must_use]
    pub fn total(&self) -> usize {
        self.above + self.below
    }
}

/// The excursions of a history beyond `mean` plus or minus `fraction` |mean|. Successive samples on the same
/// side outside the band count as one excursion, also at the start.
///
/// # Errors
/// [`Error::Range`] for a mean that is not finite or a `fraction` that is negative; [`Error::Number`] for a
/// sample that is not finite.
pub fn excursions(values: &[f64], mean: f64, fraction: f64) -> Result<Excursions, Error> {
    let mean = signed(Argument::Force, mean)?;
    let width = non_negative(Argument::Fraction, fraction)? * mean.abs();
    let mut counts = Excursions { above: 0, below: 0 };
    let mut side = 0;
    check_samples(0, values)?;
    for &value in values {
        let now = i32::from(value > mean + width) - i32::from(value < mean - width);
        counts.above += usize::from(now > 0 && side <= 0);
        counts.below += usize::from(now < 0 && side >= 0);
        side = now;
    }
    Ok(counts)
}
