//! The report of a sweep: what was varied, distributions of the results, the runs that govern, and sensitivities.

use sweep::{ResultTable, Sensitivity, SweepInfo};

use crate::figures::design::digits;
use crate::figures::run_figure::RunFigure;
use crate::figures::sweep::{SweepFigures, SweptResult};
use crate::{Report, ReportSection, ReportTable, TableCell, TableColumn};

/// Digits of values.
const DIGITS: usize = 4;

/// Rows of a table; more are in the files.
const ROWS: usize = 60;

/// Failures that are listed.
const FAILURES: usize = 10;

/// The report of a sweep from its description, its table and its figures.
#[must_use]
pub fn sweep_report(info: &SweepInfo, table: &ResultTable, figures: SweepFigures<'_>) -> Report {
    let SweepFigures {
        varying,
        constant,
        figures,
    } = figures;
    let mut sections = vec![overview(info, table)];
    sections.push(distributions(&varying, constant, figures));
    sections.push(governing(info, &varying));
    sections.extend(dependence(table, &varying));
    sections.extend(failures(table));
    sections.push(method(info));
    let what = if info.is_design { "design" } else { "scene" };
    Report {
        title: format!("Sweep {}", info.name),
        subtitle: format!("{} runs of the {what} {}", info.runs, info.input),
        sections,
    }
}

/// What was run and what was varied.
fn overview(info: &SweepInfo, table: &ResultTable) -> ReportSection {
    let how = match info.sampling.as_str() {
        "grid" => "every combination of the values".to_owned(),
        "latin" => format!("a Latin hypercube with seed {}", info.seed),
        _ => format!("a Sobol sequence with seed {}", info.seed),
    };
    let made = table.runs.len() + table.failures.len();
    let mut section = ReportSection::new("Overview").paragraph(format!(
        "{} of {} runs have results, {} have none. The runs are {how}.",
        table.runs.len(),
        info.runs,
        table.failures.len()
    ));
    if made < info.runs {
        section = section.paragraph(format!(
            "This is a part of the sweep: {made} of its {} runs.",
            info.runs
        ));
    }
    let rows = info.axes.iter().map(|[pointer, values]| {
        vec![
            TableCell::from(pointer.clone()),
            TableCell::from(values.clone()),
        ]
    });
    section.table(ReportTable {
        caption: "Parameters".to_owned(),
        columns: vec![
            TableColumn::new("value in the files", ""),
            TableColumn::new("values", ""),
        ],
        rows: rows.collect(),
    })
}

/// Distributions of all results, and pictures of the first that vary.
fn distributions(
    varying: &[SweptResult<'_>],
    constant: usize,
    figures: Vec<RunFigure>,
) -> ReportSection {
    let mut section = ReportSection::new("Distributions");
    for RunFigure {
        picture, caption, ..
    } in figures
    {
        section = section.figure(picture, caption);
    }
    let columns = [
        "result",
        "unit",
        "as written",
        "mean",
        "standard deviation",
        "smallest",
        "median",
        "95 %",
        "99 %",
        "largest",
    ];
    let row = |result: &SweptResult<'_>| {
        let found = &result.statistics;
        let [_, q50, q95, q99] = found.quantiles;
        let mut row = vec![
            TableCell::from(result.name),
            TableCell::from(result.unit.clone()),
        ];
        row.push(
            result
                .as_written
                .map_or(TableCell::Empty, |value| digits(value, DIGITS).into()),
        );
        let numbers = [
            found.mean,
            found.deviation,
            found.least.0,
            q50,
            q95,
            q99,
            found.most.0,
        ];
        row.extend(numbers.map(|value| TableCell::from(digits(value, DIGITS))));
        row
    };
    let unchanged = if constant > 0 {
        format!("; {constant} results do not vary")
    } else {
        String::new()
    };
    section.table(ReportTable {
        caption: format!(
            "Distributions of the results over the runs{}{unchanged}",
            more(varying.len())
        ),
        columns: columns.map(|name| TableColumn::new(name, "")).to_vec(),
        rows: varying.iter().take(ROWS).map(row).collect(),
    })
}

/// The runs with the extremes of each result, and how to repeat them.
fn governing(info: &SweepInfo, varying: &[SweptResult<'_>]) -> ReportSection {
    let example = varying.first().map_or(1, |result| result.statistics.most.1);
    let row = |result: &SweptResult<'_>| {
        let found = &result.statistics;
        vec![
            TableCell::from(result.name),
            TableCell::from(result.unit.clone()),
            TableCell::from(digits(found.most.0, DIGITS)),
            TableCell::from(found.most.1),
            TableCell::from(digits(found.least.0, DIGITS)),
            TableCell::from(found.least.1),
        ]
    };
    ReportSection::new("Governing runs")
        .paragraph(format!(
            "To repeat a run with all its files, specify its number: girderway sweep {} --run {example} -o out/run-{example}",
            info.file
        ))
        .table(ReportTable {
            caption: format!("Extremes over all runs, and the runs in which they occur{}", more(varying.len())),
            columns: ["result", "unit", "largest", "in run", "smallest", "in run"]
                .map(|name| TableColumn::new(name, ""))
                .to_vec(),
            rows: varying.iter().take(ROWS).map(row).collect(),
        })
}

/// How much each axis has to do with each result; `None` with too few runs.
fn dependence(table: &ResultTable, varying: &[SweptResult<'_>]) -> Option<ReportSection> {
    let known: Vec<_> = varying
        .iter()
        .filter(|result| !result.sensitivities.is_empty())
        .collect();
    if known.is_empty() {
        return None;
    }
    let columns: Vec<TableColumn> = ["result".to_owned()]
        .into_iter()
        .chain(table.axes.iter().cloned())
        .map(|name| TableColumn::new(name, ""))
        .collect();
    let table_of = |caption: String, cell: &dyn Fn(&Sensitivity) -> Option<String>| ReportTable {
        caption,
        columns: columns.clone(),
        rows: known
            .iter()
            .take(ROWS)
            .map(|result| {
                let cells = result.sensitivities.iter();
                let cells = cells.map(|one| cell(one).map_or(TableCell::Empty, TableCell::from));
                [TableCell::from(result.name)]
                    .into_iter()
                    .chain(cells)
                    .collect()
            })
            .collect(),
    };
    let rank = |one: &Sensitivity| {
        let mark = if one.chance.is_some_and(|chance| chance < 0.01) {
            ""
        } else {
            " (chance)"
        };
        one.rank_correlation
            .map(|value| format!("{value:.2}{mark}"))
    };
    let first = |one: &Sensitivity| {
        one.first_order
            .map(|value| format!("{:.0} %", 100.0 * value))
    };
    let cut = more(known.len());
    Some(
        ReportSection::new("Sensitivity")
            .paragraph(
                "The rank correlation shows whether a result increases (+1) or decreases (-1) with an axis. Those \
                 whose probability by chance alone is 1 % or more are marked. The first-order index is the fraction \
                 of the variance of the result that the axis explains by itself; the remainder of the sum of all \
                 indices to 1 is due to interactions.",
            )
            .table(table_of(format!("Rank correlation of Spearman with each axis{cut}"), &rank))
            .table(table_of(format!("First-order index of Sobol of each axis{cut}"), &first)),
    )
}

/// The runs without results; `None` where there are none.
fn failures(table: &ResultTable) -> Option<ReportSection> {
    if table.failures.is_empty() {
        return None;
    }
    let rows = table.failures.iter().take(FAILURES);
    let rows = rows
        .map(|(run, _, why)| vec![TableCell::from(*run), TableCell::from(why.clone())])
        .collect();
    let count = table.failures.len();
    let cut = if count > FAILURES {
        format!("; the first {FAILURES} of {count}, all are in failures.csv")
    } else {
        String::new()
    };
    Some(
        ReportSection::new("Runs without results").table(ReportTable {
            caption: format!("Runs that have no results, with the reason{cut}"),
            columns: vec![TableColumn::new("run", ""), TableColumn::new("reason", "")],
            rows,
        }),
    )
}

fn method(info: &SweepInfo) -> ReportSection {
    let mut section = ReportSection::new("Method").paragraph(
        "Every run is identical to a single run of girderway on the files with these values, and its results are \
         those of its summary. All results of all runs are in results.csv and results.parquet.",
    );
    if info.sampling != "grid" {
        section = section.paragraph(
            "Quantiles are interpolated between the ordered values. The interval of a quantile follows from the order \
             of the values alone and holds for independent runs; Latin hypercubes and Sobol sequences estimate means \
             more closely than independent runs do. A quantile beyond 1 - 1/n cannot be estimated from n runs.",
        );
    } else {
        section = section.paragraph(
            "The runs of a grid have no probabilities: fractions of runs are those of the values listed in the file.",
        );
    }
    section
}

/// What the caption of a table says if it has only the first of its rows.
fn more(count: usize) -> String {
    if count > ROWS {
        format!("; the first {ROWS} of {count}, all are in summary.json")
    } else {
        String::new()
    }
}
