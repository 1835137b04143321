//! Charts of a study: error against cost, with the Pareto front.

use crate::measure::front::front;
use crate::measure::quantity::ErrorGroup;
use crate::runs::investigate::Study;
use crate::runs::point::{PointOutcome, StudyPoint};
use crate::settings::setting::{ReferenceKind, SettingFamily};
use report::chart::{Chart, ChartAxis, Error, Series, Style, stack};

/// A figure of a study.
#[derive(Clone, Debug)]
pub struct StudyFigure {
    /// Its file name in the folder `plots`, without extension.
    pub name: String,
    /// The SVG file.
    pub svg: String,
    /// Whether it shows times, in which equal studies differ.
    pub varies: bool,
}

/// The quantity along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cost {
    /// Median time of a run, ms.
    Time,
    /// Number of contact solutions.
    Stages,
    /// Memory of foundations and run, kB.
    Memory,
    /// The parameter that varies along each curve.
    Parameter,
}

/// Whether a chart shows a family.
type Filter = fn(SettingFamily) -> bool;

/// Families that vary the foundation.
fn is_foundation(family: SettingFamily) -> bool {
    family.reference_kind() == ReferenceKind::Whole
        && !matches!(family, SettingFamily::Written | SettingFamily::Auto)
}

/// Families that vary the method of integration.
fn is_method(family: SettingFamily) -> bool {
    family.reference_kind() == ReferenceKind::Own
}

/// Families that read tables.
fn is_table(family: SettingFamily) -> bool {
    matches!(family, SettingFamily::Table(_))
}

/// All figures of a study: each has one chart for each group of columns, below each other.
///
/// # Errors
/// None in practice: all values are finite, and positive where an axis is logarithmic.
pub fn figures(study: &Study, name: &str) -> Result<Vec<StudyFigure>, Error> {
    let all: [(&str, &str, Filter, Cost); 10] = [
        ("foundations-time", "foundations", is_foundation, Cost::Time),
        (
            "foundations-stages",
            "foundations",
            is_foundation,
            Cost::Stages,
        ),
        (
            "foundations-memory",
            "foundations",
            is_foundation,
            Cost::Memory,
        ),
        (
            "methods-time",
            "methods of integration",
            is_method,
            Cost::Time,
        ),
        (
            "methods-stages",
            "methods of integration",
            is_method,
            Cost::Stages,
        ),
        ("tables-time", "readings of tables", is_table, Cost::Time),
        ("stations", "readings of tables", is_table, Cost::Parameter),
        (
            "modes",
            "modes",
            |own| {
                matches!(
                    own,
                    SettingFamily::Modal | SettingFamily::ModalWithoutResidual
                )
            },
            Cost::Parameter,
        ),
        (
            "parts",
            "rigid parts",
            |own| own == SettingFamily::Parts,
            Cost::Parameter,
        ),
        (
            "elements",
            "elements",
            |own| own == SettingFamily::Mesh,
            Cost::Parameter,
        ),
    ];
    let mut out = Vec::new();
    for (file, what, is_shown, cost) in all {
        let mut charts = Vec::new();
        for quantity in ErrorGroup::ALL {
            if let Some(chart) = chart(study, name, what, is_shown, cost, quantity) {
                charts.push(chart.svg()?);
            }
        }
        if !charts.is_empty() {
            let svg = stack(&charts).file();
            out.push(StudyFigure {
                name: file.to_owned(),
                svg,
                varies: cost == Cost::Time,
            });
        }
    }
    Ok(out)
}

/// Cost of a point, where it ran to its end and has one.
fn cost_of(point: &StudyPoint, cost: Cost) -> Option<f64> {
    let measured = point.measured()?;
    let value = match cost {
        Cost::Time => 1e3 * measured.time?.median,
        Cost::Stages => measured.counts.stages as f64,
        Cost::Memory => 1e-3 * measured.memory?.total() as f64,
        Cost::Parameter => point.setting.value,
    };
    (value > 0.0).then_some(value)
}

/// One chart; `None` where there is nothing to draw: no such settings, no reference, or no error that it resolves.
fn chart(
    study: &Study,
    name: &str,
    what: &str,
    is_shown: Filter,
    cost: Cost,
    quantity: ErrorGroup,
) -> Option<Chart> {
    let shown: Vec<&StudyPoint> = study
        .points
        .iter()
        .filter(|point| is_shown(point.setting.family))
        .collect();
    let first = &shown.first()?.setting;
    let kind = first.family.reference_kind();
    let reference = study.reference(kind)?;
    let least = reference.usable_resolution(quantity)?;
    // errors below the resolution of the reference are drawn at this resolution
    let place =
        |point: &StudyPoint| Some([cost_of(point, cost)?, point.error(quantity)?.max(least)]);
    let title = title(study, name, what, cost, first.parameter, quantity);
    let x = cost_axis(cost, first.parameter);
    let mut chart = Chart::new(
        title,
        x.log(),
        ChartAxis::new("largest error / largest value", "").log(),
    );
    let mut all = add_curves(&mut chart, &shown, cost, &place);
    if all.iter().all(|own| own[1] <= least) {
        return None;
    }
    if cost != Cost::Parameter {
        marks(study, &mut chart, &mut all, cost, kind, &place);
        // first: below the points, and in the darkest colour
        chart
            .series
            .insert(0, Series::new("Pareto front", Style::Step, front(&all)));
    }
    let low = all.iter().map(|own| own[0]).fold(f64::INFINITY, f64::min);
    let high = all.iter().map(|own| own[0]).fold(0.0, f64::max);
    chart.series.push(Series::new(
        "resolution of the reference",
        Style::Limit,
        vec![[low, least], [high, least]],
    ));
    let unfinished = shown
        .iter()
        .filter(|point| !matches!(point.outcome, PointOutcome::Done(_)))
        .count();
    chart.note = format!(
        "{} relative to the largest value of the reference. Errors of points on \
         the dashed line are not resolved. Reference: {}; second run: {}; difference of the two: {:.1e}.",
        match reference.measure {
            sim::Measure::Extremes =>
                "Largest difference of the extremes of a quantity over the run,",
            sim::Measure::History => "Largest difference at an output time,",
        },
        reference.descriptions[0],
        reference.descriptions[1],
        least / crate::runs::reference::RESOLUTION_FACTOR
    );
    if unfinished > 0 {
        chart.note += &format!(" Settings refused or stopped, listed in study.json: {unfinished}.");
    }
    Some(chart)
}

/// The axis of a cost.
fn cost_axis(cost: Cost, parameter: &str) -> ChartAxis {
    match cost {
        Cost::Time => ChartAxis::new("time of a run (median; bar: smallest to largest)", "ms"),
        Cost::Stages => ChartAxis::new("contact solutions", ""),
        Cost::Memory => ChartAxis::new("memory of foundations and run", "kB"),
        Cost::Parameter if parameter == "stations" => ChartAxis::new("stations per rail", ""),
        Cost::Parameter if parameter == "elements" => ChartAxis::new("elements per member", ""),
        Cost::Parameter => ChartAxis::new(parameter, ""),
    }
}

/// The title of a chart.
fn title(
    study: &Study,
    name: &str,
    what: &str,
    cost: Cost,
    parameter: &str,
    quantity: ErrorGroup,
) -> String {
    let mut title = format!("{name}: error of the {} against ", quantity.name());
    title += match cost {
        Cost::Time => "time",
        Cost::Stages => "work",
        Cost::Memory => "memory",
        Cost::Parameter => parameter,
    };
    if cost != Cost::Parameter || what != parameter {
        title += &format!(", {what}");
    }
    if let Some(time) = study.until {
        title += &format!(", until {time} s");
    }
    title
}

/// Adds one curve for each family, and returns the points of all.
fn add_curves(
    chart: &mut Chart,
    shown: &[&StudyPoint],
    cost: Cost,
    place: &dyn Fn(&StudyPoint) -> Option<[f64; 2]>,
) -> Vec<[f64; 2]> {
    let mut families: Vec<SettingFamily> = Vec::new();
    for point in shown {
        if !families.contains(&point.setting.family) {
            families.push(point.setting.family);
        }
    }
    let mut all: Vec<[f64; 2]> = Vec::new();
    for family in families {
        let own: Vec<&StudyPoint> = shown
            .iter()
            .copied()
            .filter(|point| point.setting.family == family)
            .collect();
        let points: Vec<[f64; 2]> = own.iter().filter_map(|point| place(point)).collect();
        if points.is_empty() {
            continue;
        }
        let mut series = Series::new(family.name(), Style::Marked, points.clone());
        if cost == Cost::Time {
            let ends = own.iter().filter(|point| place(point).is_some());
            let spread = ends
                .filter_map(|point| point.measured()?.time)
                .map(|t| [1e3 * t.min, 1e3 * t.max]);
            series = series.spread(spread.collect());
        }
        all.extend(points);
        chart.series.push(series);
    }
    all
}

/// Adds the scene as written and the choice of "auto", on charts against the most complete reference.
fn marks(
    study: &Study,
    chart: &mut Chart,
    all: &mut Vec<[f64; 2]>,
    cost: Cost,
    kind: ReferenceKind,
    place: &dyn Fn(&StudyPoint) -> Option<[f64; 2]>,
) {
    if kind != ReferenceKind::Whole {
        return;
    }
    for (family, label) in [
        (SettingFamily::Written, "as written"),
        (SettingFamily::Auto, "choice of auto"),
    ] {
        let own = study
            .points
            .iter()
            .find(|point| point.setting.family == family)
            .and_then(place);
        let Some(own) = own else { continue };
        chart
            .series
            .push(Series::new(label, Style::Points, vec![own]));
        all.push(own);
        let trials = study.auto.as_ref().ok().and_then(|auto| auto.trials);
        if let (SettingFamily::Auto, Cost::Time, Some(trials)) = (family, cost, trials) {
            let at = vec![[1e3 * trials.median, own[1]]];
            let spread = vec![[1e3 * trials.min, 1e3 * trials.max]];
            chart
                .series
                .push(Series::new("auto with its trial runs", Style::Points, at).spread(spread));
        }
    }
}
