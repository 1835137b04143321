//! Report content on the comparison with design codes.

use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use formats::scene::Scene;
use formats::text::number::rounded;
use results::codes::{CodeCheck, CodeComparison};

/// Significant digits of code values; codes give no more.
const DIGITS: usize = 5;

/// The section on code values, with those of all runs that have any; `None` where the scene does not ask for them.
#[must_use]
pub fn section(scene: &Scene, runs: &[(&str, Option<&CodeCheck>)]) -> Option<ReportSection> {
    let all: Vec<(&str, &CodeCheck)> =
        runs.iter().filter_map(|(label, codes)| Some((*label, (*codes)?))).collect();
    let (_, first) = *all.first()?;
    let mut section = ReportSection::new("Beside the codes").paragraph(
        "What the runs have beside values of codes for the same crane. Forces found include what moves alone. CodeCheck give \
         values for design, with their own partial factors on top: a run that stays below one is no proof, a run above \
         one is a question.",
    );
    for (name, value, dimension) in first.crane.list() {
        section = section.fact(name.replace('_', " "), value, scene.units.label(dimension));
    }
    if first.crane.approach_is_from_run {
        section = section.paragraph("The hook's approach is the least that the run has; practice.approach in the scene gives another.");
    }
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
    let caption = "Found, and by the codes.".to_owned();
    let table = ReportTable { caption, columns, rows };
    let heads = [("factor", ""), ("value", ""), ("unit", ""), ("code", ""), ("clause", ""), ("of", "")];
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
    let factors = ReportTable {
        caption: "Factors of the codes, and loads of one wheel by them.".to_owned(),
        columns: heads.map(|(name, unit)| TableColumn::new(name, unit)).into(),
        rows: factors.collect(),
    };
    Some(section.table(table).table(factors))
}
