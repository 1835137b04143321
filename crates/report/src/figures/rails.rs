//! Sums of wheel forces on each rail, compared between runs.

use crate::chart::{Chart, ChartAxis, Series, Style};
use crate::figures::design::{reading_unit, scaled};
use crate::figures::run_figure::{LabelledRun, RunFigure};
use crate::number;
use formats::scene::Scene;
use formats::units::Dimension;
use results::columns::NamedColumns;
use results::response::{ColumnStatistics, RunComparison, rail_sums};

/// Largest number of rails that are drawn.
const RAILS: usize = 4;

/// Largest number of runs whose peaks are marked and whose statistics stand below the chart; a table has those of all.
const NOTED: usize = 2;

/// Fraction of the range below which a mean is treated as zero.
const SMALL: f64 = 0.1;

/// Charts of the vertical and lateral force sums of each rail on the ground over time, with their statistics as
/// notes; none for a single run. `comparison` contains the statistics of these runs.
#[must_use]
pub fn rail_sum_charts(runs: &[LabelledRun], comparison: &RunComparison) -> Vec<RunFigure> {
    let [first, _, ..] = runs else {
        return Vec::new();
    };
    let grounded = |name: &String| {
        let rail = name.rsplit_once('.').map_or("", |(rail, _)| rail);
        let own = first.scene.rails.iter().find(|own| own.name == rail);
        own.is_some_and(|rail| first.scene.structures[rail.structure].carrier.is_none())
    };
    let sums = rail_sums(first.record)
        .into_iter()
        .filter(|sums| sums.iter().all(grounded))
        .take(RAILS);
    sums.flatten()
        .filter_map(|column| chart(first.scene, &column, runs, comparison))
        .collect()
}

/// Chart of one sum in all runs; `None` if it is zero in all of them.
fn chart(
    scene: &Scene,
    column: &str,
    runs: &[LabelledRun],
    comparison: &RunComparison,
) -> Option<RunFigure> {
    let (rail, part) = column.rsplit_once('.')?;
    let word = if part == "lateral" {
        "lateral"
    } else {
        "vertical"
    };
    let zero = |record: &NamedColumns| record.values(column).iter().all(|value| *value == 0.0);
    if runs.iter().all(|run| zero(run.record)) {
        return None;
    }
    let (unit, factor) = reading_unit(scene.units, Dimension::FORCE);
    let title = format!("Sum of {word} wheel forces on {rail}");
    let mut chart = Chart::new(
        title,
        ChartAxis::new("time", "s"),
        ChartAxis::new(format!("{word} force"), &unit),
    );
    let mut notes = Vec::new();
    let figures = comparison.of(column).unwrap_or_default();
    for (index, run) in runs.iter().enumerate() {
        let style = if index == 0 {
            Style::Line
        } else {
            Style::Dashed
        };
        chart = chart.with(Series::new(
            &run.label,
            style,
            scaled(run.record.points("time", column), factor),
        ));
        let Some(found) = figures.get(index).and_then(Option::as_ref) else {
            continue;
        };
        if runs.len() > NOTED && index > 0 {
            continue;
        }
        chart = chart.mark(found.peak.time, format!("peak, {}", run.label));
        notes.push(line(&run.label, found, (&unit, factor)));
    }
    chart.note = notes.join(" ");
    let whose = if runs.len() > NOTED {
        ", here of the first run,"
    } else {
        ""
    };
    let caption = format!(
        "Sum of the {word} forces of all wheels on {rail} in every run. Means and frequencies{whose} are those of the \
         last quarter; an excursion leaves the band of 5 % about the mean."
    );
    Some(RunFigure::chart(
        format!("rail-{rail}-{word}"),
        caption,
        chart,
    ))
}

/// Text with the statistics of one run, in a unit with its factor.
fn line(label: &str, found: &ColumnStatistics, (unit, factor): (&str, f64)) -> String {
    let text = |value: f64| number(value, 4).unwrap_or_default();
    let hertz = found
        .hertz()
        .map_or_else(String::new, |hertz| format!(", {} Hz", text(hertz)));
    // a band of 5 % about a mean of zero has no width
    let swings = found.settled.abs() > SMALL * (found.peak.value - found.least.value);
    let times = if swings {
        format!(", {} excursions", found.excursions)
    } else {
        String::new()
    };
    format!(
        "{label}: mean {} {unit}, largest {} at {} s, smallest {} at {} s{times}{hertz}.",
        text(factor * found.settled),
        text(factor * found.peak.value),
        text(found.peak.time),
        text(factor * found.least.value),
        text(found.least.time),
    )
}
