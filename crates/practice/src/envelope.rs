//! Envelopes with coincident values.

use crate::Error;
use crate::series::check;

/// Histories of one simulation.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// Times, not decreasing.
    pub times: &'a [f64],
    /// Series over these times, the same in every run: first those to be enveloped, then any others whose
    /// values are wanted beside them, such as positions of the crane and its trolley.
    pub series: &'a [&'a [f64]],
}

/// Everything at the instant when one series is extreme.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// Which run.
    pub run: usize,
    /// Which sample of it.
    pub sample: usize,
    /// When.
    pub time: f64,
    /// Values of all series at that instant, the extreme one among them.
    pub values: Vec<f64>,
}

/// The extremes of one series over all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Extremes {
    /// Where it is largest; the first of equals.
    pub most: Instant,
    /// Where it is smallest; the first of equals.
    pub least: Instant,
}

/// Largest and smallest value of each of the first `count` series over all runs, with the values of all series at
/// those instants. Samples are taken as they are, without interpolation between them.
///
/// # Errors
/// No sample at all, runs that differ in their number of series or have fewer than `count`, a series of another
/// length than its times, a number that is not finite, times that decrease.
pub fn envelope(runs: &[Run], count: usize) -> Result<Vec<Extremes>, Error> {
    let expected = runs.first().map_or(0, |run| run.series.len()).max(count);
    for (index, run) in runs.iter().enumerate() {
        if run.series.len() != expected {
            return Err(Error::Series { run: index, found: run.series.len(), expected });
        }
        check(run.times, run.series)?;
    }
    if runs.iter().all(|run| run.times.is_empty()) {
        return Err(Error::Few { found: 0, least: 1 });
    }
    Ok((0..count)
        .map(|series| Extremes {
            most: extreme(runs, series, |value, best| value > best),
            least: extreme(runs, series, |value, best| value < best),
        })
        .collect())
}

/// Where a series is better than anywhere before; some run has a sample.
fn extreme(runs: &[Run], series: usize, better: impl Fn(f64, f64) -> bool) -> Instant {
    let mut best: Option<(usize, usize, f64)> = None;
    for (index, run) in runs.iter().enumerate() {
        for (sample, &value) in run.series[series].iter().enumerate() {
            if best.is_none_or(|(.., found)| better(value, found)) {
                best = Some((index, sample, value));
            }
        }
    }
    let (run, sample, _) = best.expect("envelope refuses runs without samples");
    let values = runs[run].series.iter().map(|series| series[sample]).collect();
    Instant { run, sample, time: runs[run].times[sample], values }
}
