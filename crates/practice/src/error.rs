//! Errors: numbers and samples that a formula refuses.

/// The quantity that a refused number was given for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Argument {
    /// A weight or another force.
    Force,
    /// A mass.
    Mass,
    /// A length or distance.
    Length,
    /// A speed.
    Speed,
    /// An acceleration.
    Acceleration,
    /// A stiffness.
    Stiffness,
    /// An angle.
    Angle,
    /// A coefficient of friction.
    Friction,
    /// A dynamic factor.
    Factor,
    /// A fraction of a whole.
    Fraction,
    /// A number of wheels, rails, pairs or cycles.
    Count,
    /// A stress range or stress.
    Range,
    /// A partial factor.
    Partial,
    /// An area, or a second moment of area.
    Section,
    /// A frequency.
    Frequency,
    /// A time or a time step.
    Time,
}

/// Errors of this crate. They contain numbers and indices; the caller adds the names of its data.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A number is outside the range that the formula allows. No formula takes numbers beyond 1e30.
    #[error("{argument:?} is {value}, must be between {least} and {most}")]
    Range {
        /// The quantity.
        argument: Argument,
        /// The number given.
        value: f64,
        /// The smallest number allowed.
        least: f64,
        /// The largest number allowed.
        most: f64,
    },
    /// All wheel pairs are at the guide, so that the crane has no centre of rotation behind it.
    #[error("no wheel pair lies behind the guide")]
    NoRotationCentre,
    /// A series and its times differ in length.
    #[error("series {series} has {found} samples, expected {expected}")]
    Samples {
        /// Which series, from 0.
        series: usize,
        /// Samples of the series.
        found: usize,
        /// Samples of the times.
        expected: usize,
    },
    /// Runs differ in their number of series.
    #[error("run {run} has {found} series, expected {expected}")]
    Series {
        /// Which run, from 0.
        run: usize,
        /// Series given.
        found: usize,
        /// Series of the first run.
        expected: usize,
    },
    /// There are fewer samples than needed.
    #[error("{found} samples, at least {least} needed")]
    Few {
        /// Samples given.
        found: usize,
        /// Smallest number of samples.
        least: usize,
    },
    /// A sample is not a number, or beyond 1e100.
    #[error("sample {sample} of series {series} cannot be used")]
    Number {
        /// Which series, from 0.
        series: usize,
        /// Which sample, from 0.
        sample: usize,
    },
    /// A time is before the one that precedes it.
    #[error("time {sample} does not lie after the one before it")]
    Order {
        /// Which sample, from 0.
        sample: usize,
    },
}

/// The largest number that formulas take, so that products and powers of several stay finite.
const LARGE: f64 = 1e30;

/// The largest magnitude of a sample.
const LARGEST_SAMPLE: f64 = 1e100;

/// Returns the value if it is in `least..=most`.
pub(crate) fn within(argument: Argument, value: f64, least: f64, most: f64) -> Result<f64, Error> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(Error::Range {
            argument,
            value,
            least,
            most,
        })
    }
}

/// Returns the value if it is a number of either sign.
pub(crate) fn signed(argument: Argument, value: f64) -> Result<f64, Error> {
    within(argument, value, -LARGE, LARGE)
}

/// Returns the value if it is zero or positive.
pub(crate) fn non_negative(argument: Argument, value: f64) -> Result<f64, Error> {
    within(argument, value, 0.0, LARGE)
}

/// Returns the value if it is above zero.
pub(crate) fn positive(argument: Argument, value: f64) -> Result<f64, Error> {
    within(argument, value, 1.0 / LARGE, LARGE)
}

/// Returns a count as a number if it is at least one.
pub(crate) fn count(value: u32) -> Result<f64, Error> {
    within(Argument::Count, f64::from(value), 1.0, LARGE)
}

/// Checks that every sample of a series is a number within bounds.
pub(crate) fn check_samples(series: usize, values: &[f64]) -> Result<(), Error> {
    match values
        .iter()
        .position(|value| value.is_nan() || value.abs() > LARGEST_SAMPLE)
    {
        Some(sample) => Err(Error::Number { series, sample }),
        None => Ok(()),
    }
}
