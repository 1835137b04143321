//! Envelopes with coincident values.

use super::series::check;
use crate::Error;

/// The histories of one simulation.
#[derive(Clone, Copy, Debug)]
pub struct RunHistories<'a> {
    /// Times, not decreasing.
    pub times: &'a [f64],
    /// Series over these times, the same in every run: first those whose extremes are sought, then any others
    /// whose coincident values are wanted, such as the positions of crane and trolley.
    pub series: &'a [&'a [f64]],
}

/// The values of all series at the instant when one of them is extreme.
#[derive(Clone, Debug, PartialEq)]
pub struct ExtremeInstant {
    /// Index of the run.
    pub run: usize,
    /// Index of the sample.
    pub sample: usize,
    /// Time of the sample.
    pub time: f64,
    /// Values of all series at that instant, including the extreme one.
    pub values: Vec<f64>,
}

/// The extremes of one series over all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes {
    /// The instant of the largest value; the first of equals.
    pub max: ExtremeInstant,
    /// The instant of the smallest value; the first of equals.
    pub min: ExtremeInstant,
}

/// The largest and smallest value of each of the first `count` series over all runs, with the coincident
/// values of all series. Only samples are considered, without interpolation between them.
///
/// # Errors
/// [`Error::Few`] for no sample at all; [`Error::Series`] for runs that differ in their number of series or
/// have fewer than `count`; [`Error::Samples`], [`Error::Number`] and [`Error::Order`] for a series and times
/// of different length, a sample that is not finite, or times that decrease.
///
/// ```
/// use practice::{RunHistories, envelope};
///
/// let (times, moment, position) = ([0.0, 1.0, 2.0], [1.0, 8.0, 3.0], [10.0, 12.0, 14.0]);
/// let found = envelope(&[RunHistories { times: &times, series: &[&moment, &position] }], 1)?;
/// assert_eq!(found[0].max.values, [8.0, 12.0]);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn envelope(runs: &[RunHistories], count: usize) -> Result<Vec<Extremes>, Error> {
    let expected = runs.first().map_or(0, |run| run.series.len()).max(count);
    for (index, run) in runs.iter().enumerate() {
        if run.series.len() != expected {
            return Err(Error::Series {
                run: index,
                found: run.series.len(),
                expected,
            });
        }
        check(run.times, run.series)?;
    }
    if runs.iter().all(|run| run.times.is_empty()) {
        return Err(Error::Few { found: 0, least: 1 });
    }
    Ok((0..count)
        .map(|series| Extremes {
            max: extreme(runs, series, |value, best| value > best),
            min: extreme(runs, series, |value, best| value < best),
        })
        .collect())
}

/// The instant at which a series is `better` than at every one before. At least one run must have a sample.
fn extreme(
    runs: &[RunHistories],
    series: usize,
    better: impl Fn(f64, f64) -> bool,
) -> ExtremeInstant {
    let mut best: Option<(usize, usize, f64)> = None;
    for (index, run) in runs.iter().enumerate() {
        for (sample, &value) in run.series[series].iter().enumerate() {
            if best.is_none_or(|(.., found)| better(value, found)) {
                best = Some((index, sample, value));
            }
        }
    }
    let (run, sample, _) = best.expect("envelope refuses runs without samples");
    let values = runs[run]
        .series
        .iter()
        .map(|series| series[sample])
        .collect();
    ExtremeInstant {
        run,
        sample,
        time: runs[run].times[sample],
        values,
    }
}
