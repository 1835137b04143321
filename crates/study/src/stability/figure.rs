//! Maps as figures: one chart for each method, up to four below each other.

use super::map::{MapScale, MapVerdict, StabilityMap};
use report::chart::{Chart, ChartAxis, Error, Series, Style, stack};

/// The axis of a chart over `range`, 3 % wider at both ends.
fn axis(scale: &MapScale, range: [f64; 2]) -> ChartAxis {
    let axis = ChartAxis::new(scale.label.clone(), scale.unit.clone());
    let [low, high] = range;
    if scale.log {
        let room = (high / low).powf(0.03);
        axis.log().range(low / room, high * room)
    } else {
        let room = 0.03 * (high - low).max(1e-9);
        axis.range(low - room, high + room)
    }
}

/// Largest number of charts in a figure.
const CHARTS: usize = 4;

/// The figures of a map as SVG files, each with as many methods as fit on a page.
///
/// # Errors
/// None in practice: all values are finite, and positive where an axis is logarithmic.
pub fn figures(map: &StabilityMap) -> Result<Vec<String>, Error> {
    let is_drawable = |at: &[f64; 2]| {
        let fits = |k: usize| at[k].is_finite() && (!map.axes[k].log || at[k] > 0.0);
        fits(0) && fits(1)
    };
    let points = || {
        map.layers
            .iter()
            .flat_map(|layer| &layer.points)
            .map(|point| point.at)
            .filter(|at| is_drawable(at))
    };
    let range = |k: usize| {
        let low = points().map(|at| at[k]).fold(f64::INFINITY, f64::min);
        [low, points().map(|at| at[k]).fold(f64::MIN, f64::max)]
    };
    if points().next().is_none() {
        return Ok(Vec::new());
    }
    let ranges = [range(0), range(1)];
    let mut charts = Vec::new();
    for layer in &map.layers {
        let title = format!("{} ({})", map.title, layer.method);
        let (x, y) = (axis(&map.axes[0], ranges[0]), axis(&map.axes[1], ranges[1]));
        let mut chart = Chart::new(title, x, y);
        for word in MapVerdict::WORDS {
            let own = layer
                .points
                .iter()
                .filter(|point| point.verdict.word() == word)
                .map(|point| point.at);
            chart.series.push(Series::new(
                word,
                Style::Points,
                own.filter(|at| is_drawable(at)).collect(),
            ));
        }
        for line in &layer.lines {
            let points = line
                .points
                .iter()
                .copied()
                .filter(|at| is_drawable(at))
                .collect();
            chart.series.push(Series {
                points,
                ..line.clone()
            });
        }
        let counts = layer.counts();
        let summary: Vec<String> = MapVerdict::WORDS
            .iter()
            .zip(counts)
            .filter(|(_, count)| *count > 0)
            .map(|(word, count)| format!("{count} {word}"))
            .collect();
        chart.note = format!("{} Points: {}.", map.note, summary.join(", "));
        if layer.points.iter().any(|point| is_drawable(&point.at)) {
            charts.push(chart.svg()?);
        }
    }
    Ok(charts.chunks(CHARTS).map(|few| stack(few).file()).collect())
}
