//! Charts of differences.

use super::outcome::PeerOutcome;
use report::chart::{Chart, ChartAxis, Series, Style};

/// Lower bound of drawn differences, because zero cannot be drawn on a logarithmic axis.
const LEAST: f64 = 1e-17;

/// Charts of the largest difference of each grid over the station of the deflection, one for each rail.
#[must_use]
pub fn charts(outcome: &PeerOutcome, rails: &[String], unit: &str) -> Vec<Chart> {
    let of_rail = |(rail, name): (usize, &String)| {
        let here = |k: &usize| outcome.stations[*k].0 == rail;
        let kept: Vec<usize> = (0..outcome.stations.len()).filter(here).collect();
        let x = |k: &usize| outcome.stations[*k].1;
        let title = match rails {
            [_, _, ..] => format!("Differences from {}, rail {name}", outcome.code),
            _ => format!("Differences from {}", outcome.code),
        };
        let mut chart = Chart::new(
            title,
            ChartAxis::new("place of the deflection along the rail", unit),
            ChartAxis::new("largest difference over all loads", "").log(),
        );
        for difference in &outcome.differences {
            let points = kept
                .iter()
                .map(|k| [x(k), difference.profile[*k].max(LEAST)])
                .collect();
            chart = chart.with(Series::new(difference.quantity.name(), Style::Line, points));
        }
        let ends = kept.first().into_iter().chain(kept.last());
        let limit = ends.map(|k| [x(k), outcome.tolerance]).collect();
        chart = chart.with(Series::new("tolerance", Style::Dashed, limit));
        for (quantity, tolerance) in &outcome.own_tolerances {
            let ends = kept.first().into_iter().chain(kept.last());
            let limit = ends.map(|k| [x(k), *tolerance]).collect();
            chart = chart.with(Series::new(
                format!("tolerance, {quantity}"),
                Style::Dashed,
                limit,
            ));
        }
        chart
    };
    rails
        .iter()
        .enumerate()
        .map(of_rail)
        .filter(|chart| chart.series.iter().any(|s| !s.points.is_empty()))
        .collect()
}
