//! Comparison of the force histories of several runs by statistics: mean, extremes, excursions, oscillations.

use practice::{HistorySpectrum, ResponseSettings, SineComponent, TimedValue, resample, response};
use serde_json::{Map, Value, json};

use super::{Response, SceneMode};
use crate::columns::NamedColumns;
use crate::steps::{ColumnInstant, ColumnPeak};
use crate::threads::parallel_map;

/// Fraction of the run, at its end, over which the settled mean is computed.
const SETTLED: f64 = 0.25;

/// Half width of the band about the settled mean outside which an excursion is counted, as a fraction of the mean.
const BAND: f64 = 0.05;

/// Largest number of oscillations that are reported.
const MAX_OSCILLATIONS: usize = 3;
/// Amplitude, as a fraction of the largest amplitude, below which an oscillation is not reported.
const MIN_AMPLITUDE: f64 = 0.1;
/// Smallest ratio of the frequencies of two reported oscillations.
const MIN_RATIO: f64 = 1.15;

/// Smallest number of samples from which a dominant frequency is computed.
const MIN_SAMPLES: usize = 64;

/// A run that is compared with others.
#[derive(Clone, Copy, Debug)]
pub struct ComparedRun<'a> {
    /// Its label.
    pub label: &'a str,
    /// Its rows.
    pub record: &'a NamedColumns,
    /// The response of its structures.
    pub response: &'a Response,
    /// The largest and smallest values of its columns over all times.
    pub peaks: &'a [ColumnPeak],
}

/// Statistics of a history.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnStatistics {
    /// Mean over the last quarter of the run.
    pub settled: f64,
    /// Largest value.
    pub peak: TimedValue,
    /// Smallest value.
    pub least: TimedValue,
    /// Number of times the history leaves the band of 5 % about the settled mean.
    pub excursions: usize,
    /// Up to three oscillations in the last quarter of the run, of at least two periods, largest amplitude first.
    pub waves: Vec<SineComponent>,
}

/// Statistics of several runs: of every reaction, internal force and stress, and of the sums of each rail's vertical
/// and lateral wheel forces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunComparison {
    rows: Vec<Row>,
}

/// One column of the first run.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    column: String,
    /// One entry per run; `None` where the run does not have the column or has too few rows.
    statistics: Vec<Option<ColumnStatistics>>,
    /// Whether the column is zero in every run.
    is_zero: bool,
}

impl RunComparison {
    /// The statistics of `runs` for the columns of the first, on at most `threads` threads; empty for a single run.
    #[must_use]
    pub fn new(runs: &[ComparedRun<'_>], threads: Option<u16>) -> RunComparison {
        let [first, _, ..] = runs else {
            return RunComparison::default();
        };
        let structural = first
            .response
            .columns
            .iter()
            .map(|column| column.name.clone());
        let names: Vec<String> = rail_sums(first.record)
            .into_iter()
            .flatten()
            .chain(structural)
            .collect();
        let rows = parallel_map(&names, threads, |_, name| {
            let is_zero =
                |record: &NamedColumns| record.values(name).iter().all(|value| *value == 0.0);
            Row {
                column: name.clone(),
                statistics: runs
                    .iter()
                    .map(|run| ColumnStatistics::new(run, name))
                    .collect(),
                is_zero: runs.iter().all(|run| is_zero(run.record)),
            }
        });
        RunComparison { rows }
    }

    /// Statistics of a column, one entry per run.
    #[must_use]
    pub fn of(&self, column: &str) -> Option<&[Option<ColumnStatistics>]> {
        self.rows
            .iter()
            .find(|row| row.column == column)
            .map(|row| row.statistics.as_slice())
    }

    /// Columns that all runs have and that are not zero in all of them, with their statistics, one entry per run.
    pub fn columns(&self) -> impl Iterator<Item = (&str, Vec<&ColumnStatistics>)> {
        self.rows
            .iter()
            .filter(|row| !row.is_zero)
            .filter_map(|row| {
                let all: Option<Vec<&ColumnStatistics>> =
                    row.statistics.iter().map(Option::as_ref).collect();
                Some((row.column.as_str(), all?))
            })
    }

    /// The statistics by column and by label of the run; `runs` are the runs from which they were computed.
    #[must_use]
    pub fn json(&self, runs: &[ComparedRun<'_>]) -> Map<String, Value> {
        let of_runs = |statistics: Vec<&ColumnStatistics>| -> Map<String, Value> {
            let pairs = runs.iter().zip(statistics);
            pairs
                .map(|(run, one)| (run.label.to_owned(), one.json(&run.response.modes)))
                .collect()
        };
        self.columns()
            .map(|(name, all)| (name.to_owned(), Value::Object(of_runs(all))))
            .collect()
    }
}

/// For each rail, the names of the columns of the sums of its wheel forces: vertical, then lateral where there is
/// one.
pub fn rail_sums(record: &NamedColumns) -> Vec<Vec<String>> {
    let rails = record
        .columns
        .iter()
        .filter_map(|column| column.name.strip_suffix(".reaction"));
    let of = |rail: &str| {
        let lateral = format!("{rail}.lateral");
        let mut names = vec![format!("{rail}.reaction")];
        names.extend(Some(lateral).filter(|name| !record.values(name).is_empty()));
        names
    };
    rails.map(of).collect()
}

impl ColumnStatistics {
    /// The statistics of one column; `None` where the record does not have it, or has fewer than 64 rows. Peaks are those of all
    /// times, the others those of the rows.
    #[must_use]
    pub fn new(run: &ComparedRun<'_>, column: &str) -> Option<ColumnStatistics> {
        let record = run.record;
        let (times, values) = (record.values("time"), record.values(column));
        let (first, last) = (*times.first()?, *times.last()?);
        if values.len() != times.len() || times.len() < MIN_SAMPLES || last <= first {
            return None;
        }
        let length = last - first;
        let step = length / (times.len() - 1) as f64;
        let settings = ResponseSettings {
            from: first,
            settled: last - SETTLED * length,
            step,
            cut_off: None,
            excursion_fraction: BAND,
        };
        let found = response(times, values, &settings).ok()?;
        // fewer than two periods in the last quarter come from the travel of the crane, not from vibration
        let band = [2.0 / (SETTLED * length), 0.5 / step];
        let late = resample(times, values, settings.settled, step).ok()?;
        let own = run.peaks.iter().find(|peak| peak.column == column);
        let instant = |at: ColumnInstant| TimedValue {
            time: at.time,
            value: at.value,
        };
        Some(ColumnStatistics {
            settled: found.mean,
            peak: own.map_or(found.peak, |own| instant(own.max)),
            least: own.map_or(found.trough, |own| instant(own.min)),
            excursions: found.excursions.total(),
            waves: oscillations(&HistorySpectrum::new(&late, step).ok()?, band),
        })
    }

    /// Frequency of the oscillation with the largest amplitude.
    #[must_use]
    pub fn hertz(&self) -> Option<f64> {
        self.waves.first().map(|tone| tone.frequency)
    }

    fn json(&self, modes: &[SceneMode]) -> Value {
        let wave = |tone: &SineComponent| {
            let mode = SceneMode::of(modes, tone.frequency).map(|mode| mode.name.as_str());
            json!({"hz": tone.frequency, "amplitude": tone.amplitude, "mode": mode})
        };
        json!({
            "settled_mean": self.settled + 0.0,
            "peak": {"value": self.peak.value + 0.0, "time": self.peak.time},
            "least": {"value": self.least.value + 0.0, "time": self.least.time},
            "excursions": self.excursions,
            "dominant_hz": self.hertz(),
            "waves": self.waves.iter().map(wave).collect::<Vec<Value>>(),
        })
    }
}

/// Up to [`MAX_OSCILLATIONS`] oscillations of a spectrum in the frequency `band`, largest amplitude first.
///
/// The strongest oscillation of the band is found. The frequencies within the ratio [`MIN_RATIO`] of it are removed,
/// which divides the band in two. The search continues with the strongest oscillation of all remaining bands and ends
/// when its amplitude is below the fraction [`MIN_AMPLITUDE`] of the first.
fn oscillations(spectrum: &HistorySpectrum, band: [f64; 2]) -> Vec<SineComponent> {
    let (mut found, mut bands) = (Vec::<SineComponent>::new(), vec![band]);
    let strongest = |band: &[f64; 2]| spectrum.strongest(*band).ok().flatten();
    while found.len() < MAX_OSCILLATIONS {
        let all = bands
            .iter()
            .enumerate()
            .filter_map(|(k, band)| Some((k, strongest(band)?)));
        let best = all.max_by(|a, b| a.1.amplitude.total_cmp(&b.1.amplitude));
        let Some((k, tone)) = best else { break };
        if found
            .first()
            .is_some_and(|first| tone.amplitude < MIN_AMPLITUDE * first.amplitude)
        {
            break;
        }
        let [low, high] = bands.swap_remove(k);
        // the spectrum of an oscillation that was found before may be largest at the edge of a remaining band
        let is_known =
            |known: &SineComponent| (known.frequency / tone.frequency).ln().abs() < MIN_RATIO.ln();
        if found.iter().any(is_known) {
            continue;
        }
        let sides = [
            [low, tone.frequency / MIN_RATIO],
            [tone.frequency * MIN_RATIO, high],
        ];
        bands.extend(sides.into_iter().filter(|[low, high]| low < high));
        found.push(tone);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::{Column, Kind};
    use formats::units::Dimension;

    /// A record with a damped wave of `hz` about `mean`, and its response.
    fn wave(hz: f64, mean: f64) -> (NamedColumns, Response) {
        let times: Vec<f64> = (0..=1000).map(|i| f64::from(i) * 0.01).collect();
        let values = times
            .iter()
            .map(|t| mean + (-0.3 * t).exp() * (std::f64::consts::TAU * hz * t).cos())
            .collect();
        let mut record = NamedColumns::default();
        record.push("time", Dimension::NUMBER, times);
        record.push("a", Dimension::NUMBER, values);
        let column = Column {
            name: "a".into(),
            dimension: Dimension::NUMBER,
            kind: Kind::Reaction,
            direction: None,
        };
        (
            record,
            Response {
                columns: vec![column],
                ..Response::default()
            },
        )
    }

    fn compared<'a>(
        label: &'a str,
        (record, response): &'a (NamedColumns, Response),
    ) -> ComparedRun<'a> {
        ComparedRun {
            label,
            record,
            response,
            peaks: &[],
        }
    }

    /// Analytic: both settle at 5, the peak is 5 + 1 at the start, and each has its own frequency.
    #[test]
    fn a_slower_run_has_the_lower_frequency_and_the_same_mean() {
        let (slow, fast) = (wave(2.0, 5.0), wave(4.0, 5.0));
        let runs = [("flexible", &slow), ("rigid", &fast)].map(|(label, own)| compared(label, own));
        let found = RunComparison::new(&runs, Some(1)).json(&runs);
        for (label, hz) in [("flexible", 2.0), ("rigid", 4.0)] {
            let at = &found["a"][label];
            let near = |value: &Value, wanted: f64, by: f64| {
                value
                    .as_f64()
                    .is_some_and(|value| (value - wanted).abs() < by)
            };
            assert!(near(&at["settled_mean"], 5.0, 1e-2), "{at}");
            assert!(near(&at["peak"]["value"], 6.0, 1e-12), "{at}");
            assert!(near(&at["dominant_hz"], hz, 0.05), "{at}");
        }
    }

    #[test]
    fn a_single_run_is_not_compared() {
        let (record, response) = wave(2.0, 5.0);
        let own = (record, response);
        let runs = [compared("only", &own)];
        assert!(RunComparison::new(&runs, Some(1)).json(&runs).is_empty());
    }
}
