//! Histories of forces, run beside run, in the few numbers that engineers compare.

use practice::{Tone, View, dominant, resample, response};
use serde_json::{Map, Value, json};

use super::{Natural, Response};
use crate::record::Record;

/// Share of the run, at its end, that counts as settled.
const SETTLED: f64 = 0.25;

/// Half width of the band about the settled mean that an excursion leaves, as a share of the mean.
const BAND: f64 = 0.05;

/// Most waves that are told, the share of the first below which none is, and how far apart two of them are as a ratio.
const WAVES: usize = 3;
const FAINT: f64 = 0.1;
const APART: f64 = 1.15;

/// Fewest samples of which a dominant frequency is worth its name.
const FEWEST: usize = 64;

/// Every reaction and internal force, and the sum of each rail's wheel forces, that all runs have, by column and by the label of the run: settled mean, peak, least
/// value, excursions and dominant frequency.
///
/// A column that is zero in every run is left out. Empty where there is one run alone.
#[must_use]
pub fn comparison(runs: &[(&str, &Record, &Response)]) -> Map<String, Value> {
    let mut all = Map::new();
    let [(_, record, first), rest @ ..] = runs else { return all };
    if rest.is_empty() {
        return all;
    }
    let rails = record.columns.iter().map(|column| &column.name).filter(|name| name.ends_with(".reaction"));
    for name in rails.chain(first.columns.iter().map(|column| &column.name)) {
        let each: Option<Map<String, Value>> = runs
            .iter()
            .map(|(label, record, response)| Some(((*label).to_owned(), figures(record, response, name)?)))
            .collect();
        let is_zero = |record: &Record| record.values(name).iter().all(|value| *value == 0.0);
        if let Some(each) = each
            && !runs.iter().all(|(_, record, _)| is_zero(record))
        {
            all.insert(name.clone(), Value::Object(each));
        }
    }
    all
}

/// The numbers of one column, `None` where it has too few rows or the run has not got it.
fn figures(record: &Record, answers: &Response, column: &str) -> Option<Value> {
    let (times, values) = (record.values("time"), record.values(column));
    let (first, last) = (*times.first()?, *times.last()?);
    if values.len() != times.len() || times.len() < FEWEST || last <= first {
        return None;
    }
    let length = last - first;
    let step = length / (times.len() - 1) as f64;
    let view = View {
        from: first,
        settled: last - SETTLED * length,
        step,
        cut: None,
        share: BAND,
        band: [0.0, 0.5 / step],
        floor: BAND,
    };
    let found = response(times, values, &view).ok()?;
    // slower than two waves is the way of the crane, no vibration
    let band = [2.0 / (SETTLED * length), 0.5 / step];
    let late = resample(times, values, view.settled, step).ok()?;
    let tones = tones(&late, step, band);
    let waves: Vec<Value> = tones
        .iter()
        .map(|tone| {
            let mode = Natural::of(&answers.modes, tone.frequency).map(|mode| mode.name.as_str());
            json!({"hz": tone.frequency, "amplitude": tone.amplitude, "mode": mode})
        })
        .collect();
    Some(json!({
        "settled_mean": found.mean + 0.0,
        "peak": {"value": found.peak.value + 0.0, "time": found.peak.time},
        "least": {"value": found.least.value + 0.0, "time": found.least.time},
        "excursions": found.excursions.total(),
        "dominant_hz": tones.first().map(|tone| tone.frequency),
        "waves": waves,
    }))
}

/// The strongest waves of a history in `band`, strongest first, each apart from those before by [`APART`].
fn tones(values: &[f64], step: f64, band: [f64; 2]) -> Vec<Tone> {
    let (mut found, mut rest) = (Vec::<Tone>::new(), vec![band]);
    let strongest = |band: &[f64; 2]| dominant(values, step, *band).ok().flatten();
    while found.len() < WAVES {
        let all = rest.iter().enumerate().filter_map(|(k, band)| Some((k, strongest(band)?)));
        let best = all.max_by(|a, b| a.1.amplitude.total_cmp(&b.1.amplitude));
        let Some((k, tone)) = best else { break };
        if found.first().is_some_and(|first| tone.amplitude < FAINT * first.amplitude) {
            break;
        }
        let [low, high] = rest.swap_remove(k);
        let sides = [[low, tone.frequency / APART], [tone.frequency * APART, high]];
        rest.extend(sides.into_iter().filter(|[low, high]| low < high));
        found.push(tone);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::{Column, Kind};
    use crate::units::Dimension;

    /// A record with a damped wave of `hz` about `mean`, and its response.
    fn wave(hz: f64, mean: f64) -> (Record, Response) {
        let times: Vec<f64> = (0..=1000).map(|i| f64::from(i) * 0.01).collect();
        let values =
            times.iter().map(|t| mean + (-0.3 * t).exp() * (std::f64::consts::TAU * hz * t).cos()).collect();
        let mut record = Record::default();
        record.push("time", Dimension::NUMBER, times);
        record.push("a", Dimension::NUMBER, values);
        let column =
            Column { name: "a".into(), dimension: Dimension::NUMBER, kind: Kind::Reaction, direction: None };
        (record, Response { columns: vec![column], ..Response::default() })
    }

    /// Analytic: both settle at 5, the peak is 5 + 1 at the start, and each has its own frequency.
    #[test]
    fn a_slower_run_has_the_lower_frequency_and_the_same_mean() {
        let (slow, fast) = (wave(2.0, 5.0), wave(4.0, 5.0));
        let found = comparison(&[("flexible", &slow.0, &slow.1), ("rigid", &fast.0, &fast.1)]);
        for (label, hz) in [("flexible", 2.0), ("rigid", 4.0)] {
            let at = &found["a"][label];
            let near = |value: &Value, wanted: f64, by: f64| {
                value.as_f64().is_some_and(|value| (value - wanted).abs() < by)
            };
            assert!(near(&at["settled_mean"], 5.0, 1e-2), "{at}");
            assert!(near(&at["peak"]["value"], 6.0, 1e-12), "{at}");
            assert!(near(&at["dominant_hz"], hz, 0.05), "{at}");
        }
    }

    #[test]
    fn a_lone_run_is_beside_nothing() {
        let (record, response) = wave(2.0, 5.0);
        assert!(comparison(&[("only", &record, &response)]).is_empty());
    }
}
