//! Figures of reactions of the ground, bending moments and influence lines.

use splines::{Axis as Direction, Probe};

use crate::chart::{Chart, ChartAxis, Series, Style};
use crate::figures::design::{column_unit, digits, reading_unit, scaled, with_unit};
use crate::figures::run_figure::{LabelledRun, RunFigure};
use crate::is_rounding;
use formats::scene::columns::{Column, Direction as Toward, Kind};
use formats::scene::{Origin, Scene};
use formats::units::Dimension;
use results::girders::GirderExtremes;
use results::response::{ColumnInfluence, Response};
use trains::GirderResponse;

/// Largest number of curves in a chart.
const CURVES: usize = 8;
/// Largest number of reactions of one direction that are compared between runs.
const SHOWN: usize = 2;
/// Fraction of the largest reaction of a direction below which a reaction is not compared between runs.
const COMPARED: f64 = 1e-3;
/// Significant digits of values in notes.
const DIGITS: usize = 4;
/// Number of points at which an influence line is evaluated.
const SAMPLES: usize = 241;

/// Reactions of the first run over time, the largest of them in all runs, envelopes of bending moments, and influence
/// lines of named sections.
#[must_use]
pub fn response_charts(
    runs: &[LabelledRun],
    responses: &[&Response],
    lines: &[Option<ColumnInfluence>],
    girders: &GirderExtremes,
) -> Vec<RunFigure> {
    let Some((run, response)) = runs.first().zip(responses.first()) else {
        return Vec::new();
    };
    let mut figures = reactions(runs, run, response);
    figures.extend(moments(run, girders));
    figures.extend(influences(run.scene, response, lines));
    figures
}

/// Whether a column is a reaction of the ground: those of structures on a body are not.
pub(crate) fn ground_reactions(scene: &Scene) -> impl Fn(&Column) -> bool {
    let carried: Vec<String> = scene
        .structures
        .iter()
        .filter(|structure| structure.carrier.is_some())
        .map(|structure| format!("{}.", structure.name))
        .collect();
    move |column| {
        column.kind == Kind::Reaction
            && !carried
                .iter()
                .any(|structure| column.name.starts_with(structure))
    }
}

/// Coordinates of the supports of a rail; none for a structure of tables, or one whose model cannot be made.
pub(crate) fn supports(scene: &Scene, rail: usize) -> Vec<f64> {
    let rail = &scene.rails[rail];
    let Origin::Spec { spec, .. } = &scene.structures[rail.structure].origin else {
        return Vec::new();
    };
    spec.model().map_or_else(
        |_| Vec::new(),
        |(model, rails)| spec.spans(&model, &rails, rail.rail),
    )
}

/// Reactions of the ground in each direction over time: the largest ones of the first run, and a few in all runs.
fn reactions(runs: &[LabelledRun], run: &LabelledRun, response: &Response) -> Vec<RunFigure> {
    let scene = run.scene;
    let mut figures = Vec::new();
    let is_ground = ground_reactions(scene);
    let forces = response
        .columns
        .iter()
        .filter(|column| is_ground(column))
        .filter(|column| column.direction.is_some());
    let most = forces
        .map(|column| largest_magnitude(run.record.values(&column.name)))
        .fold(0.0, f64::max);
    for (toward, word) in [(Toward::Vertical, "vertical"), (Toward::Lateral, "lateral")] {
        let mut own: Vec<(f64, &Column)> = response
            .columns
            .iter()
            .filter(|column| is_ground(column))
            .filter(|column| column.direction == Some(toward))
            .map(|column| (largest_magnitude(run.record.values(&column.name)), column))
            .filter(|(magnitude, _)| !is_rounding(*magnitude, most))
            .collect();
        // largest first, in a stable order
        own.sort_by(|a, b| b.0.total_cmp(&a.0));
        let largest = own.first().map_or(0.0, |(magnitude, _)| *magnitude);
        let mut shown: Vec<&Column> = own.iter().take(CURVES).map(|(_, column)| *column).collect();
        shown.sort_by_key(|column| response.columns.iter().position(|known| known == *column));
        if !shown.is_empty() {
            let few = if own.len() > CURVES {
                format!(", the largest {CURVES} of {}", own.len())
            } else {
                String::new()
            };
            figures.push(largest_reactions(run, &shown, word, &few));
        }
        if runs.len() > 1 {
            let compared_columns = own
                .iter()
                .filter(|(magnitude, _)| *magnitude > COMPARED * largest)
                .take(SHOWN);
            figures.extend(compared_columns.map(|(_, column)| compared(runs, scene, column)));
        }
    }
    figures
}

/// The largest reactions of one direction over time.
fn largest_reactions(run: &LabelledRun, shown: &[&Column], word: &str, few: &str) -> RunFigure {
    let title = format!("Reactions of the ground, {word}");
    let (mut chart, factor) = over_time(run.scene, &title, Dimension::FORCE);
    for (index, column) in shown.iter().enumerate() {
        let style = Style::alternating(index);
        let points = scaled(run.record.points("time", &column.name), factor);
        chart = chart.with(Series::new(&column.name, style, points));
    }
    let caption = format!(
        "Reactions over time, {word}{few} ({}); positive along their axes.",
        run.label
    );
    RunFigure::chart(format!("reactions-{word}"), caption, chart)
}

/// One reaction over time in every run.
fn compared(runs: &[LabelledRun], scene: &Scene, column: &Column) -> RunFigure {
    let (mut chart, factor) = over_time(
        scene,
        &format!("{} in all runs", column.name),
        column.dimension,
    );
    for (index, other) in runs.iter().enumerate() {
        let points = other.record.points("time", &column.name);
        if points.is_empty() {
            continue;
        }
        let style = if index == 0 {
            Style::Line
        } else {
            Style::Dashed
        };
        chart = chart.with(Series::new(&other.label, style, scaled(points, factor)));
    }
    let caption = format!("The reaction {} over time in every run.", column.name);
    RunFigure::chart(format!("reaction-{}", column.name), caption, chart)
}

/// Influence lines of the named sections for every rail whose loads affect them.
fn influences(
    scene: &Scene,
    response: &Response,
    lines: &[Option<ColumnInfluence>],
) -> Vec<RunFigure> {
    let mut figures = Vec::new();
    for (structure, lines) in scene.structures.iter().zip(lines) {
        let (Some(lines), Origin::Spec { spec, .. }) = (lines, &structure.origin) else {
            continue;
        };
        let Ok((model, rails)) = spec.model() else {
            continue;
        };
        for (rail, outline) in structure.rails.iter().enumerate() {
            let supports = spec.spans(&model, &rails, rail);
            for (index, column) in lines
                .columns()
                .iter()
                .enumerate()
                .filter(|(_, column)| column.kind == Kind::Section)
            {
                let [from, to] = outline.range;
                let point = |x: f64| {
                    let value = lines.unit(Probe {
                        rail,
                        x,
                        axis: Direction::Vertical,
                    })?;
                    // a wheel load acts downward
                    Some([x, 0.0 - value[index]])
                };
                let place = |i: usize| from + (to - from) * i as f64 / (SAMPLES - 1) as f64;
                let points =
                    with_jumps((0..SAMPLES).map(place).filter_map(point).collect(), &point);
                let largest = points
                    .iter()
                    .fold(0.0_f64, |most, point| most.max(point[1].abs()));
                if largest < 1e-9 {
                    continue;
                }
                figures.push(influence(
                    scene,
                    response,
                    column,
                    &outline.name,
                    points,
                    &supports,
                ));
            }
        }
    }
    figures
}

/// Envelopes of the vertical moments of the girders, one figure for each rail whose moments are not zero throughout.
fn moments(run: &LabelledRun, girders: &GirderExtremes) -> Vec<RunFigure> {
    let mut figures = Vec::new();
    for (index, rail) in run.scene.rails.iter().enumerate() {
        let points = |is_max: bool| -> Vec<[f64; 2]> {
            let own = girders.envelope.iter().filter(|e| {
                (e.rail, e.quantity, e.is_max) == (index, GirderResponse::VerticalMoment, is_max)
            });
            own.map(|e| [e.x, e.value]).collect()
        };
        let (largest, smallest) = (points(true), points(false));
        if largest.iter().chain(&smallest).all(|point| point[1] == 0.0) {
            continue;
        }
        let supports = supports(run.scene, index);
        figures.push(moment_envelope(
            run, &rail.name, largest, smallest, &supports,
        ));
    }
    figures
}

/// The largest and smallest moments along one rail.
fn moment_envelope(
    run: &LabelledRun,
    rail: &str,
    largest: Vec<[f64; 2]>,
    smallest: Vec<[f64; 2]>,
    supports: &[f64],
) -> RunFigure {
    let units = run.scene.units;
    let (unit, factor) = reading_unit(units, Dimension::MOMENT);
    let ends = [largest.first(), largest.last()]
        .map(|point| point.map_or([0.0; 2], |point| [point[0], 0.0]));
    let chart = Chart::new(
        format!("Bending moments under {rail}"),
        ChartAxis::new("position along the rail", units.label(Dimension::LENGTH)),
        ChartAxis::new("moment, sagging positive", unit).downwards(),
    )
    .with(Series::new("largest", Style::Line, scaled(largest, factor)))
    .with(Series::new(
        "smallest",
        Style::Line,
        scaled(smallest, factor),
    ))
    .with(Series::new(
        "supports",
        Style::Points,
        supports.iter().map(|x| [*x, 0.0]).collect(),
    ))
    .with(Series::new("girder", Style::Limit, ends.to_vec()));
    let dead = if run.scene.output.dead_load {
        "with"
    } else {
        "without"
    };
    let caption = format!(
        "Envelope of the bending moments of the members under {rail} over the run, {dead} dead load ({}).",
        run.label
    );
    RunFigure::chart(format!("moments-{rail}"), caption, chart)
}

/// Parts into which the distance of two points is divided until what is left of their difference is a jump.
const HALVINGS: usize = 30;

/// Points of a function of x, in order, with both sides of each jump between them: of shear forces at their section.
fn with_jumps(points: Vec<[f64; 2]>, point: &dyn Fn(f64) -> Option<[f64; 2]>) -> Vec<[f64; 2]> {
    let values = || points.iter().map(|[_, y]| *y);
    let range = values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
    let is_large = |[a, b]: [[f64; 2]; 2]| (b[1] - a[1]).abs() > 0.25 * range;
    let jump = |mut ends: [[f64; 2]; 2]| {
        for _ in 0..HALVINGS {
            let middle = point(0.5 * (ends[0][0] + ends[1][0]))?;
            // the half with the larger difference
            let is_first = (middle[1] - ends[0][1]).abs() > (ends[1][1] - middle[1]).abs();
            ends[usize::from(is_first)] = middle;
        }
        is_large(ends).then_some(ends)
    };
    let mut all = Vec::with_capacity(points.len() + 2);
    for (index, own) in points.iter().enumerate() {
        let ends = index.checked_sub(1).map(|before| [points[before], *own]);
        all.extend(
            ends.filter(|ends| is_large(*ends))
                .and_then(jump)
                .into_iter()
                .flatten(),
        );
        all.push(*own);
    }
    all
}

/// An influence line over the girder, with the extremes of the run.
fn influence(
    scene: &Scene,
    response: &Response,
    column: &Column,
    rail: &str,
    points: Vec<[f64; 2]>,
    supports: &[f64],
) -> RunFigure {
    let own = if column.dimension == Dimension::MOMENT {
        scene.units.label(Dimension::LENGTH)
    } else {
        String::new()
    };
    let ends = [points.first(), points.last()].map(|point| point.map_or([0.0; 2], |p| [p[0], 0.0]));
    let mut chart = Chart::new(
        format!("Influence line of {} for wheels on {rail}", column.name),
        ChartAxis::new(
            "position of the wheel along the rail",
            scene.units.label(Dimension::LENGTH),
        ),
        ChartAxis::new("per unit wheel load", own).downwards(),
    )
    .with(Series::new("influence line", Style::Line, points))
    .with(Series::new("girder", Style::Limit, ends.to_vec()))
    .with(Series::new(
        "supports",
        Style::Points,
        supports.iter().map(|x| [*x, 0.0]).collect(),
    ));
    let mut caption = format!(
        "{} per unit load of a wheel on {rail}, over the position of the wheel.",
        column.name
    );
    if let Some(envelope) = response
        .envelopes
        .iter()
        .find(|envelope| envelope.column == column.name)
    {
        let most = envelope.max.value.abs().max(envelope.min.value.abs());
        let (unit, factor) = column_unit(scene.units, column.dimension, most);
        let text = |extreme: &results::response::ColumnExtreme| {
            let value = with_unit(&digits(factor * extreme.value, DIGITS), &unit);
            format!("{value} at t = {} s", digits(extreme.time, DIGITS))
        };
        chart.note = format!(
            "In this run: max {}; min {}.",
            text(&envelope.max),
            text(&envelope.min)
        );
        caption.push_str(" The extremes of the run are stated below the chart.");
    }
    RunFigure::chart(format!("influence-{}-{rail}", column.name), caption, chart)
}

/// An empty chart over time, and the factor of its values from the units of the scene.
fn over_time(scene: &Scene, title: &str, dimension: Dimension) -> (Chart, f64) {
    let what = if dimension == Dimension::MOMENT {
        "moment"
    } else {
        "force"
    };
    let (unit, factor) = reading_unit(scene.units, dimension);
    (
        Chart::new(
            title,
            ChartAxis::new("time", "s"),
            ChartAxis::new(what, unit),
        ),
        factor,
    )
}

fn largest_magnitude(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_between_two_points_has_both_sides_and_a_kink_none() {
        // the shear force and the moment at x = 0.3 of a simple beam of length 1 under a unit load at x
        let shear = |x: f64| Some([x, if x < 0.3 { -x } else { 1.0 - x }]);
        let moment = |x: f64| Some([x, if x < 0.3 { 0.7 * x } else { 0.3 * (1.0 - x) }]);
        let points = |of: &dyn Fn(f64) -> Option<[f64; 2]>| -> Vec<[f64; 2]> {
            (0..=7).filter_map(|i| of(f64::from(i) / 7.0)).collect()
        };
        let found = with_jumps(points(&shear), &shear);
        assert_eq!(found.len(), 10);
        let [before, behind] = [found[3], found[4]];
        assert!(
            (before[0] - 0.3).abs() < 1e-9 && (before[1] + 0.3).abs() < 1e-9,
            "{before:?}"
        );
        assert!(
            (behind[0] - 0.3).abs() < 1e-9 && (behind[1] - 0.7).abs() < 1e-9,
            "{behind:?}"
        );
        assert_eq!(with_jumps(points(&moment), &moment), points(&moment));
    }
}
