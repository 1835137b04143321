//! Figures of a sweep: the distribution of a result over the runs, the result over its strongest axis, and the mean of a
//! damage with its confidence.

use sweep::{ResultDistribution, ResultTable, Sensitivity, SweepInfo};

use crate::chart::{Chart, ChartAxis, Series, Style};
use crate::figures::design::digits;
use crate::figures::run_figure::RunFigure;

/// Results with figures, and most of them with values of codes or damages as long as others are left.
const FIGURES: usize = 6;
const OF_A_KIND: usize = 3;

/// Fewest values of a lone axis of a grid that are joined by a line.
const LINE: usize = 3;

/// Numbers of runs at which a mean over the first runs is drawn.
const MEANS: usize = 200;

/// Fewest runs of which a mean is drawn.
const FEWEST: usize = 5;

/// Most classes of a histogram.
const CLASSES: usize = 40;

/// Distance from the ends of a histogram to a mark beyond the runs, as a fraction of their range.
const MARGIN: f64 = 0.05;

/// Most runs that are drawn as points.
const POINTS: usize = 1500;

/// Digits of values in figures.
const DIGITS: usize = 4;

/// A result of the sweep as figures and tables need it.
pub(crate) struct SweptResult<'t> {
    /// Its name.
    pub name: &'t str,
    /// Its unit.
    pub unit: String,
    /// Its index among the columns.
    pub column: usize,
    /// Its distribution.
    pub statistics: ResultDistribution,
    /// Its value for the input as it is written, where that has it.
    pub as_written: Option<f64>,
    /// Its dependence on each axis; may be empty.
    pub sensitivities: Vec<Sensitivity>,
    /// Values by codes beside a measured value: name and value. Of those that vary it is that of the input as written.
    pub codes: Vec<(String, f64)>,
    /// Largest magnitude of all results of the same unit.
    size: f64,
}

/// Differences below this fraction of the largest result of the same unit are rounding.
const ROUNDING: f64 = 1e-12;

impl<'t> SweptResult<'t> {
    /// The results of a table that have values; results of codes beside a measured value are not results of their own.
    pub fn all(info: &SweepInfo, table: &'t ResultTable) -> Vec<SweptResult<'t>> {
        let parent = |name: &str| {
            table.columns.iter().find(|one| {
                name.strip_prefix(one.as_str())
                    .is_some_and(|end| end.starts_with('.'))
            })
        };
        let own = table
            .columns
            .iter()
            .enumerate()
            .filter(|(_, name)| parent(name).is_none());
        let mut all: Vec<SweptResult<'t>> = own
            .filter_map(|(column, name)| {
                let statistics = ResultDistribution::new(&table.column(column))?;
                let written = info.as_written.iter().find(|(known, ..)| known == name);
                let beside = table
                    .columns
                    .iter()
                    .enumerate()
                    .filter(|(_, one)| parent(one) == Some(name));
                let codes = beside.filter_map(|(index, one)| {
                    let found = ResultDistribution::new(&table.column(index))?;
                    let code = one[name.len() + 1..].to_owned();
                    if found.least.0 == found.most.0 {
                        return Some((code, found.mean));
                    }
                    let (.., written) = info.as_written.iter().find(|(known, ..)| known == one)?;
                    Some((format!("{code}, as written"), *written))
                });
                Some(SweptResult {
                    name,
                    unit: written.map(|(_, unit, _)| unit.clone()).unwrap_or_default(),
                    column,
                    statistics,
                    as_written: written.map(|(.., value)| *value),
                    sensitivities: sweep::sensitivities(table, column),
                    codes: codes.collect(),
                    size: 0.0,
                })
            })
            .collect();
        let sizes: Vec<f64> = all
            .iter()
            .map(|result: &SweptResult<'_>| result.size_of_unit(&all))
            .collect();
        all.iter_mut()
            .zip(sizes)
            .for_each(|(result, size)| result.size = size);
        all
    }

    /// Largest magnitude of the results that have the unit of this one.
    fn size_of_unit(&self, all: &[SweptResult<'_>]) -> f64 {
        let own = all.iter().filter(|other| other.unit == self.unit);
        own.map(|other| {
            other
                .statistics
                .most
                .0
                .abs()
                .max(other.statistics.least.0.abs())
        })
        .fold(0.0, f64::max)
    }

    /// Whether the runs differ in this result by more than rounding.
    pub fn varies(&self) -> bool {
        self.statistics.most.0 - self.statistics.least.0 > ROUNDING * self.size
    }

    /// Whether it is a damage by fatigue, which adds up over runs.
    fn is_damage(&self) -> bool {
        self.name.ends_with("damage")
    }

    /// Its place among the results: what codes have values for comes first, then damages, those of the life before those
    /// of a run.
    fn order(&self) -> usize {
        match self.codes.is_empty() {
            false => 0,
            true if self.name.ends_with("life damage") => 1,
            true if self.is_damage() => 2,
            true => 3,
        }
    }

    /// The axis on which the result depends most, by the rank correlation or the first-order index; its index.
    pub fn strongest(&self) -> Option<usize> {
        let strength = |one: &Sensitivity| {
            one.rank_correlation
                .map_or(0.0, f64::abs)
                .max(one.first_order.map_or(0.0, f64::sqrt))
        };
        let ordered = self.sensitivities.iter().enumerate();
        ordered
            .max_by(|a, b| strength(a.1).total_cmp(&strength(b.1)).then(b.0.cmp(&a.0)))
            .map(|(axis, _)| axis)
    }
}

/// The results of a sweep and their figures.
pub struct SweepFigures<'t> {
    /// The results that vary: those for which codes have values, damages, and the others.
    pub(crate) varying: Vec<SweptResult<'t>>,
    /// How many results do not vary.
    pub(crate) constant: usize,
    /// The figures, in the order of the report.
    pub figures: Vec<RunFigure>,
}

impl<'t> SweepFigures<'t> {
    /// The figures of the first results that vary: three for which codes have values, three damages, and more where these
    /// are fewer.
    #[must_use]
    pub fn new(info: &SweepInfo, table: &'t ResultTable) -> SweepFigures<'t> {
        let all = SweptResult::all(info, table);
        let count = all.len();
        let mut varying: Vec<SweptResult<'t>> =
            all.into_iter().filter(SweptResult::varies).collect();
        varying.sort_by_key(SweptResult::order);
        let constant = count - varying.len();
        let is_line = info.axes.len() == 1 && info.sampling == "grid" && table.runs.len() >= LINE;
        let mut figures = Vec::new();
        for (index, result) in shown(&varying).into_iter().enumerate() {
            let mut add = |kind: &str, (chart, caption): (Chart, String)| {
                figures.push(RunFigure::chart(
                    format!("{kind}-{}", index + 1),
                    caption,
                    chart,
                ));
            };
            if !is_line {
                add("distribution", histogram(table, result));
            }
            let is_sample = info.sampling != "grid" && result.statistics.count >= FEWEST;
            if result.is_damage() && is_sample {
                add("mean", mean_over_runs(table, result));
            }
            let axis = if is_line { Some(0) } else { result.strongest() };
            if let Some(chart) = axis.and_then(|axis| over_axis(table, result, axis, is_line)) {
                add("dependence", chart);
            }
        }
        SweepFigures {
            varying,
            constant,
            figures,
        }
    }
}

/// The results with figures, in their order: of each kind some, then what there is room for.
fn shown<'a, 't>(varying: &'a [SweptResult<'t>]) -> Vec<&'a SweptResult<'t>> {
    let mut rank = std::collections::BTreeMap::new();
    let mut ordered: Vec<(bool, usize)> = Vec::with_capacity(varying.len());
    for (index, result) in varying.iter().enumerate() {
        let kind = if result.codes.is_empty() && result.is_damage() {
            1
        } else {
            result.order()
        };
        let before = rank.entry(kind).or_insert(0_usize);
        ordered.push((*before >= OF_A_KIND, index));
        *before += 1;
    }
    ordered.sort_unstable();
    ordered.truncate(FIGURES);
    let mut chosen: Vec<usize> = ordered.into_iter().map(|(_, index)| index).collect();
    chosen.sort_unstable();
    chosen.into_iter().map(|index| &varying[index]).collect()
}

/// Beginnings of the names of the figures of a sweep.
pub const SWEEP_FIGURES: [&str; 3] = ["distribution-", "mean-", "dependence-"];

/// The histogram of a result, with its median, its quantile of 95 %, the value as written, and values by codes.
fn histogram(table: &ResultTable, result: &SweptResult<'_>) -> (Chart, String) {
    let found = &result.statistics;
    let (low, high) = (found.least.0, found.most.0);
    let classes = ((found.count as f64).sqrt() as usize).clamp(5, CLASSES);
    let width = (high - low) / classes as f64;
    let mut counts = vec![0_usize; classes];
    for (_, value) in table.column(result.column) {
        counts[(((value - low) / width) as usize).min(classes - 1)] += 1;
    }
    let share = |count: usize| 100.0 * count as f64 / found.count as f64;
    // values by codes near the runs are shown as well
    let near = |value: &f64| (2.0 * low - high..=2.0 * high - low).contains(value);
    let marked = || {
        result
            .codes
            .iter()
            .map(|(_, value)| *value)
            .chain(result.as_written)
            .filter(near)
    };
    let margin = MARGIN * (high - low);
    let begin = marked().map(|value| value - margin).fold(low, f64::min);
    let end = marked().map(|value| value + margin).fold(high, f64::max);
    let mut points = vec![[begin, 0.0], [low, 0.0]];
    points.extend(
        counts
            .iter()
            .enumerate()
            .map(|(k, count)| [low + width * k as f64, share(*count)]),
    );
    points.extend([[high, 0.0], [end, 0.0]]);
    let axes = [
        ChartAxis::new(result.name, &result.unit),
        ChartAxis::new("runs in the class", "%"),
    ];
    let [x, y] = axes;
    let mut chart = Chart::new(format!("Distribution of {}", result.name), x, y)
        .with(Series::new("runs", Style::Step, points))
        .mark(found.quantiles[1], "median")
        .mark(found.quantiles[2], "95 %");
    if let Some(value) = result.as_written {
        chart = chart.mark(value, "as written");
    }
    for (name, value) in &result.codes {
        chart = chart.mark(*value, name.clone());
    }
    let caption = format!(
        "{} runs in {classes} classes: mean {}, standard deviation {}, median {}, 95 % quantile {} (between {} and {} \
         with a confidence of 95 %).",
        found.count,
        digits(found.mean, DIGITS),
        digits(found.deviation, DIGITS),
        digits(found.quantiles[1], DIGITS),
        digits(found.quantiles[2], DIGITS),
        digits(found.upper_interval.low, DIGITS),
        digits(found.upper_interval.high, DIGITS),
    );
    (chart, caption)
}

/// A result over the values of an axis; `None` where these are not numbers.
fn over_axis(
    table: &ResultTable,
    result: &SweptResult<'_>,
    axis: usize,
    is_line: bool,
) -> Option<(Chart, String)> {
    let values = &table.axis_values[axis];
    let point = |row| {
        Some((
            values.value(row).number()?,
            table.result(result.column, row)?,
        ))
    };
    let rows = (0..table.runs.len()).filter_map(point);
    let mut points: Vec<[f64; 2]> = rows.take(POINTS).map(|(x, y)| [x, y]).collect();
    if points.is_empty() {
        return None;
    }
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let style = if is_line {
        Style::Marked
    } else {
        Style::Points
    };
    let name = &table.axes[axis];
    let axes = [
        ChartAxis::new(name, ""),
        ChartAxis::new(result.name, &result.unit),
    ];
    let [x, y] = axes;
    let count = points.len();
    let chart = Chart::new(format!("{} over {name}", result.name), x, y)
        .with(Series::new("runs", style, points));
    let all = table.runs.len();
    let caption = if count < all {
        format!("The first {count} of {all} runs; the axis in the units of its file.")
    } else {
        "Every run; the axis in the units of its file.".to_owned()
    };
    Some((chart, caption))
}

/// The mean of a damage over the first runs, with the interval that contains the mean of all possible runs with a
/// confidence of 95 %: the mean is the damage of a life whose crossings scatter like the runs.
fn mean_over_runs(table: &ResultTable, result: &SweptResult<'_>) -> (Chart, String) {
    let values = table.column(result.column);
    let count = values.len();
    let step = count.div_ceil(MEANS);
    let numbers = (FEWEST..=count).filter(|n| (count - n).is_multiple_of(step));
    let found: Vec<ResultDistribution> = numbers
        .filter_map(|n| ResultDistribution::new(&values[..n]))
        .collect();
    let at = |one: &ResultDistribution, value: f64| [one.count as f64, value];
    let curve =
        |of: fn(&ResultDistribution) -> f64| found.iter().map(|one| at(one, of(one))).collect();
    let [x, y] = [
        ChartAxis::new("runs", ""),
        ChartAxis::new(result.name, &result.unit),
    ];
    let chart = Chart::new(format!("Mean of {} with its confidence", result.name), x, y)
        .with(Series::new(
            "mean of the first runs",
            Style::Line,
            curve(|one| one.mean),
        ))
        .with(Series::new(
            "95 % confidence, upper end",
            Style::Limit,
            curve(|one| one.mean_interval.high),
        ))
        .with(Series::new(
            "lower end",
            Style::Limit,
            curve(|one| one.mean_interval.low),
        ));
    let all = &result.statistics;
    let caption = format!(
        "Damage accumulates linearly, so the mean {} of {count} runs is the damage where crossings scatter like the \
         runs; the mean of all possible runs is between {} and {} with a confidence of 95 %, as if the runs were \
         independent.",
        digits(all.mean, DIGITS),
        digits(all.mean_interval.low, DIGITS),
        digits(all.mean_interval.high, DIGITS),
    );
    (chart, caption)
}
