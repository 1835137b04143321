//! Charts of a study.

use crate::measure::front::front;
use crate::measure::quantity::ErrorGroup;
use crate::runs::investigate::Study;
use crate::runs::point::{PointOutcome, StudyPoint};
use crate::settings::setting::{Against, SettingFamily};
use report::chart::{Chart, ChartAxis, Error, Series, Style, stack};

/// A picture, and whether equal studies may differ in it: it has times.
#[derive(Clone, Debug)]
pub struct StudyPicture {
    /// Its name in the folder `plots`, without ending.
    pub name: String,
    /// The SVG file.
    pub svg: String,
    /// Whether times are in it.
    pub varies: bool,
}

/// What is along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cost {
    /// Median time of a run, ms.
    Time,
    /// Contact solutions in stages.
    Stages,
    /// Memory of foundations and run, kB.
    Memory,
    /// What varies along each curve.
    Knob,
}

/// Which families a chart shows.
type Takes = fn(SettingFamily) -> bool;

fn is_foundation(family: SettingFamily) -> bool {
    family.against() == Against::Whole && !matches!(family, SettingFamily::Written | SettingFamily::Auto)
}

fn is_method(family: SettingFamily) -> bool {
    family.against() == Against::Own
}

fn is_table(family: SettingFamily) -> bool {
    matches!(family, SettingFamily::Table(_))
}

/// All charts of a study: each is a file with a chart a quantity, below each other.
///
/// # Errors
/// None in practice: all values are finite, and positive where an axis is logarithmic.
pub fn pictures(study: &Study, name: &str) -> Result<Vec<StudyPicture>, Error> {
    let all: [(&str, &str, Takes, Cost); 10] = [
        ("foundations-time", "foundations", is_foundation, Cost::Time),
        ("foundations-stages", "foundations", is_foundation, Cost::Stages),
        ("foundations-memory", "foundations", is_foundation, Cost::Memory),
        ("methods-time", "methods of integration", is_method, Cost::Time),
        ("methods-stages", "methods of integration", is_method, Cost::Stages),
        ("tables-time", "readings of tables", is_table, Cost::Time),
        ("stations", "readings of tables", is_table, Cost::Knob),
        ("modes", "modes", |own| matches!(own, SettingFamily::Modal | SettingFamily::Pure), Cost::Knob),
        ("parts", "rigid parts", |own| own == SettingFamily::Parts, Cost::Knob),
        ("elements", "elements", |own| own == SettingFamily::Mesh, Cost::Knob),
    ];
    let mut out = Vec::new();
    for (file, what, takes, cost) in all {
        let mut charts = Vec::new();
        for quantity in ErrorGroup::ALL {
            if let Some(chart) = chart(study, name, what, takes, cost, quantity) {
                charts.push(chart.svg()?);
            }
        }
        if !charts.is_empty() {
            let svg = stack(&charts).file();
            out.push(StudyPicture { name: file.to_owned(), svg, varies: cost == Cost::Time });
        }
    }
    Ok(out)
}

/// Cost of a point, where it has one.
fn cost_of(point: &StudyPoint, cost: Cost) -> Option<f64> {
    let measured = point.measured()?;
    let value = match cost {
        Cost::Time => 1e3 * measured.time?.median,
        Cost::Stages => measured.counts.stages as f64,
        Cost::Memory => 1e-3 * measured.memory?.total() as f64,
        Cost::Knob => point.setting.value,
    };
    (value > 0.0).then_some(value)
}

/// One chart; `None` where nothing can be drawn.
fn chart(
    study: &Study,
    name: &str,
    what: &str,
    takes: Takes,
    cost: Cost,
    quantity: ErrorGroup,
) -> Option<Chart> {
    let shown = || study.points.iter().filter(|point| takes(point.setting.family));
    let against = shown().next()?.setting.family.against();
    let reference = study.reference(against)?;
    let least = reference.resolution_of(quantity)?;
    // errors below what the reference can tell stand at that line
    let place = |point: &StudyPoint| Some([cost_of(point, cost)?, point.error(quantity)?.max(least)]);
    let knob = shown().next()?.setting.knob;
    let x = match cost {
        Cost::Time => ChartAxis::new("time of a run (median; bar: least to most)", "ms"),
        Cost::Stages => ChartAxis::new("contact solutions", ""),
        Cost::Memory => ChartAxis::new("memory of foundations and run", "kB"),
        Cost::Knob if knob == "stations" => ChartAxis::new("stations a rail", ""),
        Cost::Knob if knob == "elements" => ChartAxis::new("elements a member", ""),
        Cost::Knob => ChartAxis::new(knob, ""),
    };
    let mut title = format!("{name}: error of the {} against ", quantity.name());
    title += match cost {
        Cost::Time => "time",
        Cost::Stages => "work",
        Cost::Memory => "memory",
        Cost::Knob => knob,
    };
    if cost != Cost::Knob || what != knob {
        title += &format!(", {what}");
    }
    if let Some(time) = study.until {
        title += &format!(", until {time} s");
    }
    let mut chart = Chart::new(title, x.log(), ChartAxis::new("largest error / largest value", "").log());
    let mut families: Vec<SettingFamily> = Vec::new();
    for point in shown() {
        if !families.contains(&point.setting.family) {
            families.push(point.setting.family);
        }
    }
    let mut all: Vec<[f64; 2]> = Vec::new();
    for family in families {
        let own: Vec<&StudyPoint> = shown().filter(|point| point.setting.family == family).collect();
        let points: Vec<[f64; 2]> = own.iter().filter_map(|point| place(point)).collect();
        if points.is_empty() {
            continue;
        }
        let mut series = Series::new(family.name(), Style::Marked, points.clone());
        if cost == Cost::Time {
            let ends = own.iter().filter(|point| place(point).is_some());
            let spread =
                ends.filter_map(|point| point.measured()?.time).map(|t| [1e3 * t.least, 1e3 * t.most]);
            series = series.spread(spread.collect());
        }
        all.extend(points);
        chart.series.push(series);
    }
    // nothing but points that the reference cannot tell from it
    if all.iter().all(|own| own[1] <= least) {
        return None;
    }
    if cost != Cost::Knob {
        marks(study, &mut chart, &mut all, cost, against, &place);
        // first: under the points, and in the darkest ink
        chart.series.insert(0, Series::new("Pareto front", Style::Step, front(&all)));
    }
    let low = all.iter().map(|own| own[0]).fold(f64::INFINITY, f64::min);
    let high = all.iter().map(|own| own[0]).fold(0.0, f64::max);
    chart.series.push(Series::new(
        "what the reference tells",
        Style::Limit,
        vec![[low, least], [high, least]],
    ));
    let gone = shown().filter(|point| !matches!(point.outcome, PointOutcome::Done(_))).count();
    chart.note = format!(
        "Largest difference at an output time by the largest value there is; points on the dashed line err by no more than that. \
         Reference: {}; beside it {}: {:.1e} apart.",
        reference.words[0],
        reference.words[1],
        least / crate::runs::reference::MARGIN
    );
    if gone > 0 {
        chart.note += &format!(" {gone} settings refused or stopped: see study.json.");
    }
    Some(chart)
}

/// The scene as written and what "auto" chose, on charts against the reference that tells of both.
fn marks(
    study: &Study,
    chart: &mut Chart,
    all: &mut Vec<[f64; 2]>,
    cost: Cost,
    against: Against,
    place: &dyn Fn(&StudyPoint) -> Option<[f64; 2]>,
) {
    if against != Against::Whole {
        return;
    }
    for (family, label) in [(SettingFamily::Written, "as written"), (SettingFamily::Auto, "auto's choice")] {
        let own = study.points.iter().find(|point| point.setting.family == family).and_then(place);
        let Some(own) = own else { continue };
        chart.series.push(Series::new(label, Style::Points, vec![own]));
        all.push(own);
        let trials = study.auto.as_ref().ok().and_then(|auto| auto.trials);
        if let (SettingFamily::Auto, Cost::Time, Some(trials)) = (family, cost, trials) {
            let at = vec![[1e3 * trials.median, own[1]]];
            let spread = vec![[1e3 * trials.least, 1e3 * trials.most]];
            chart.series.push(Series::new("auto with its trials", Style::Points, at).spread(spread));
        }
    }
}
