//! Figures of a sweep: the distribution of a result over the runs, and the result over its strongest axis.

use sweep::{ResultDistribution, ResultTable, Sensitivity, SweepInfo};

use crate::chart::{Chart, ChartAxis, Series, Style};
use crate::figures::design::digits;

/// Most classes of a histogram.
const CLASSES: usize = 40;

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
    /// Runs and values.
    pub values: Vec<(usize, f64)>,
    /// Its distribution.
    pub statistics: ResultDistribution,
    /// Its value for the input as it is written, where that has it.
    pub as_written: Option<f64>,
    /// Its dependence on each axis; may be empty.
    pub sensitivities: Vec<Sensitivity>,
    /// Values by codes beside a measured value that do not vary: name and value.
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
            table
                .columns
                .iter()
                .find(|one| name.strip_prefix(one.as_str()).is_some_and(|end| end.starts_with('.')))
        };
        let own = table.columns.iter().enumerate().filter(|(_, name)| parent(name).is_none());
        let mut all: Vec<SweptResult<'t>> = own
            .filter_map(|(column, name)| {
                let values = table.column(column);
                let statistics = ResultDistribution::new(&values)?;
                let written = info.as_written.iter().find(|(known, ..)| known == name);
                let beside = table.columns.iter().enumerate().filter(|(_, one)| parent(one) == Some(name));
                let codes = beside.filter_map(|(index, one)| {
                    let found = ResultDistribution::new(&table.column(index))?;
                    let is_constant = found.least.0 == found.most.0;
                    is_constant.then(|| (one[name.len() + 1..].to_owned(), found.mean))
                });
                Some(SweptResult {
                    name,
                    unit: written.map(|(_, unit, _)| unit.clone()).unwrap_or_default(),
                    column,
                    statistics,
                    as_written: written.map(|(.., value)| *value),
                    sensitivities: sweep::sensitivities(table, column),
                    codes: codes.collect(),
                    values,
                    size: 0.0,
                })
            })
            .collect();
        let sizes: Vec<f64> = all.iter().map(|result: &SweptResult<'_>| result.size_of_unit(&all)).collect();
        all.iter_mut().zip(sizes).for_each(|(result, size)| result.size = size);
        all
    }

    /// Largest magnitude of the results that have the unit of this one.
    fn size_of_unit(&self, all: &[SweptResult<'_>]) -> f64 {
        let own = all.iter().filter(|other| other.unit == self.unit);
        own.map(|other| other.statistics.most.0.abs().max(other.statistics.least.0.abs())).fold(0.0, f64::max)
    }

    /// Whether the runs differ in this result by more than rounding.
    pub fn varies(&self) -> bool {
        self.statistics.most.0 - self.statistics.least.0 > ROUNDING * self.size
    }

    /// The axis on which the result depends most, by the rank correlation or the first-order index; its index.
    pub fn strongest(&self) -> Option<usize> {
        let strength = |one: &Sensitivity| {
            one.rank_correlation.map_or(0.0, f64::abs).max(one.first_order.map_or(0.0, f64::sqrt))
        };
        let ordered = self.sensitivities.iter().enumerate();
        ordered
            .max_by(|a, b| strength(a.1).total_cmp(&strength(b.1)).then(b.0.cmp(&a.0)))
            .map(|(axis, _)| axis)
    }
}

/// The histogram of a result, with its median, its quantile of 95 %, the value as written, and values by codes.
pub(crate) fn histogram(result: &SweptResult<'_>) -> (Chart, String) {
    let found = &result.statistics;
    let (low, high) = (found.least.0, found.most.0);
    let classes = ((result.values.len() as f64).sqrt() as usize).clamp(5, CLASSES);
    let width = (high - low) / classes as f64;
    let mut counts = vec![0_usize; classes];
    for (_, value) in &result.values {
        counts[(((value - low) / width) as usize).min(classes - 1)] += 1;
    }
    let share = |count: usize| 100.0 * count as f64 / result.values.len() as f64;
    let mut points = vec![[low, 0.0]];
    points.extend(counts.iter().enumerate().map(|(k, count)| [low + width * k as f64, share(*count)]));
    points.push([high, 0.0]);
    let axes = [ChartAxis::new(result.name, &result.unit), ChartAxis::new("runs in the class", "%")];
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
pub(crate) fn over_axis(
    table: &ResultTable,
    result: &SweptResult<'_>,
    axis: usize,
    is_line: bool,
) -> Option<(Chart, String)> {
    let rows =
        table.rows.iter().filter_map(|row| Some((row.axes[axis].number()?, row.values[result.column]?)));
    let mut points: Vec<[f64; 2]> = rows.take(POINTS).map(|(x, y)| [x, y]).collect();
    if points.is_empty() {
        return None;
    }
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let style = if is_line { Style::Marked } else { Style::Points };
    let name = &table.axes[axis];
    let axes = [ChartAxis::new(name, ""), ChartAxis::new(result.name, &result.unit)];
    let [x, y] = axes;
    let count = points.len();
    let chart =
        Chart::new(format!("{} over {name}", result.name), x, y).with(Series::new("runs", style, points));
    let all = table.rows.len();
    let caption = if count < all {
        format!("The first {count} of {all} runs; the axis in the units of its file.")
    } else {
        "Every run; the axis in the units of its file.".to_owned()
    };
    Some((chart, caption))
}
