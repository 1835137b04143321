//! Report content on the comparison with design codes.

use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use formats::scene::Scene;
use formats::text::number::rounded;
use results::codes::{CodeCheck, CodeComparison};

/// Significant digits of values of codes; the codes themselves state no more.
const DIGITS: usize = 5;

/// The section on values of codes, with those of all runs that have any; `None` where the scene does not ask for
/// them.
#[must_use]
pub fn section(scene: &Scene, runs: &[(&str, Option<&CodeCheck>)]) -> Option<ReportSection> {
    let all: Vec<(&str, &CodeCheck)> =
        runs.iter().filter_map(|(label, codes)| Some((*label, (*codes)?))).collect();
    let (_, first) = *all.first()?;
    let mut section = ReportSection::new("Comparison with design codes").paragraph(
        "Quantities of the runs compared with values of design codes for the same crane. The forces of the runs are \
         those of the moving loads, without the dead load of the structures. The codes state values for design, to \
         which their own partial factors apply: a run below a value is no proof of safety, and a run above it needs \
         an explanation.",
    );
    for (name, value, dimension) in first.crane.list() {
        section = section.fact(name.replace('_', " "), value, scene.units.label(dimension));
    }
    if first.crane.approach_is_from_run {
        section = section.paragraph(
            "The approach of the hook is the smallest in the run, because practice.approach is not set in the scene.",
        );
    }
    Some(section.table(comparisons(scene, &all, first)).table(factors(scene, first)))
}

/// Quantities of the runs, each with the values of codes: one line for each value.
fn comparisons(scene: &Scene, all: &[(&str, &CodeCheck)], first: &CodeCheck) -> ReportTable {
    let mut columns = vec![TableColumn::new("quantity", ""), TableColumn::new("unit", "")];
    columns.extend(all.iter().map(|(label, _)| TableColumn::new(*label, "")));
    columns.extend(["code", "clause", "formula"].map(|name| TableColumn::new(name, "")));
    columns.push(TableColumn::new("value", ""));
    let mut rows = Vec::new();
    for row in &first.rows {
        let found = |codes: &CodeCheck| {
            codes
                .rows
                .iter()
                .find(|other| other.name == row.name)
                .map(|other: &CodeComparison| other.measured.value)
        };
        let mut head = vec![TableCell::from(row.what), TableCell::from(scene.units.label(row.dimension))];
        head.extend(all.iter().map(|(_, codes)| {
            found(codes).map_or(TableCell::Empty, |value| TableCell::from(rounded(value, DIGITS)))
        }));
        for value in &row.values {
            let mut line = std::mem::replace(&mut head, vec![TableCell::Empty; 2 + all.len()]);
            line.extend([value.code, value.clause].map(TableCell::from));
            line.extend([
                TableCell::from(value.formula.clone()),
                TableCell::from(rounded(value.value, DIGITS)),
            ]);
            rows.push(line);
        }
    }
    ReportTable { caption: "Values of the runs and values of codes.".to_owned(), columns, rows }
}

/// Factors of the codes, and their loads of one wheel.
fn factors(scene: &Scene, first: &CodeCheck) -> ReportTable {
    let heads = [("factor", ""), ("value", ""), ("unit", ""), ("code", ""), ("clause", ""), ("formula", "")];
    let factors = first.factors.iter().map(|given| {
        let value = &given.value;
        vec![
            TableCell::from(given.name.replace('_', " ")),
            TableCell::from(rounded(value.value, DIGITS)),
            TableCell::from(scene.units.label(given.dimension)),
            TableCell::from(value.code),
            TableCell::from(value.clause),
            TableCell::from(value.formula.clone()),
        ]
    });
    ReportTable {
        caption: "Factors of the codes, and their loads of one wheel.".to_owned(),
        columns: heads.map(|(name, unit)| TableColumn::new(name, unit)).into(),
        rows: factors.collect(),
    }
}
