//! What can go wrong.

/// Which argument a number was given for.
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
    /// A share of a whole.
    Share,
    /// How many wheels, rails or pairs.
    Count,
    /// A range of stress.
    Range,
    /// A partial factor.
    Partial,
    /// An area, or a second moment of area.
    Section,
    /// A frequency.
    Frequency,
    /// A time, or a step of time.
    Time,
}

/// Errors of this crate: numbers and places; the caller knows the names.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A number outside what the formula allows; nothing beyond 1e30 is.
    #[error("{argument:?} is {value}, must be between {least} and {most}")]
    Range {
        /// Which.
        argument: Argument,
        /// What was given.
        value: f64,
        /// The least that is allowed.
        least: f64,
        /// The most that is allowed.
        most: f64,
    },
    /// Wheel pairs that cannot be steered: all at the guide.
    #[error("no wheel pair lies behind the guide")]
    NoReach,
    /// A series of another length than its times.
    #[error("series {series} has {found} samples, expected {expected}")]
    Samples {
        /// Which, from 0.
        series: usize,
        /// Samples given.
        found: usize,
        /// Samples of the times.
        expected: usize,
    },
    /// Runs that differ in their number of series.
    #[error("run {run} has {found} series, expected {expected}")]
    Series {
        /// Which run, from 0.
        run: usize,
        /// Series given.
        found: usize,
        /// Series of the first run.
        expected: usize,
    },
    /// Fewer samples than needed.
    #[error("{found} samples, at least {least} needed")]
    Few {
        /// Samples given.
        found: usize,
        /// Fewest that will do.
        least: usize,
    },
    /// A sample that is not a number, or beyond 1e100.
    #[error("sample {sample} of series {series} cannot be used")]
    Number {
        /// Which series, from 0.
        series: usize,
        /// Which sample, from 0.
        sample: usize,
    },
    /// Times that do not increase.
    #[error("time {sample} does not lie after the one before it")]
    Order {
        /// Which sample, from 0.
        sample: usize,
    },
}

/// The largest number that formulas take: powers and products of such stay finite.
const LARGE: f64 = 1e30;

/// The largest sample that series take.
const LARGEST_SAMPLE: f64 = 1e100;

/// The value, if it lies in `least..=most`.
pub(crate) fn within(argument: Argument, value: f64, least: f64, most: f64) -> Result<f64, Error> {
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(Error::Range { argument, value, least, most })
    }
}

/// The value, if it is a number of either sign.
pub(crate) fn signed(argument: Argument, value: f64) -> Result<f64, Error> {
    within(argument, value, -LARGE, LARGE)
}

/// The value, if it is a number that is not negative.
pub(crate) fn least_zero(argument: Argument, value: f64) -> Result<f64, Error> {
    within(argument, value, 0.0, LARGE)
}

/// The value, if it is a number above zero.
pub(crate) fn positive(argument: Argument, value: f64) -> Result<f64, Error> {
    within(argument, value, 1.0 / LARGE, LARGE)
}

/// How many, if there is at least one.
pub(crate) fn count(value: u32) -> Result<f64, Error> {
    within(Argument::Count, f64::from(value), 1.0, LARGE)
}

/// Whether every sample of a series can be used.
pub(crate) fn usable(series: usize, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|value| value.is_nan() || value.abs() > LARGEST_SAMPLE) {
        Some(sample) => Err(Error::Number { series, sample }),
        None => Ok(()),
    }
}
