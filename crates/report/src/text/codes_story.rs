//! What the report says of codes.

use crate::{Cell, Column, Section, Table};
use formats::number::rounded;
use formats::scene::Scene;
use results::codes::{CodeCheck, CodeComparison};

/// Digits of values: codes have no more.
const DIGITS: usize = 5;

/// The section of all runs that have one; `None`: the scene does not ask for it.
#[must_use]
pub fn section(scene: &Scene, runs: &[(&str, Option<&CodeCheck>)]) -> Option<Section> {
    let all: Vec<(&str, &CodeCheck)> =
        runs.iter().filter_map(|(label, codes)| Some((*label, (*codes)?))).collect();
    let (_, first) = *all.first()?;
    let mut section = Section::new("Beside the codes").say(
        "What the runs have beside values of codes for the same crane. Forces found include what moves alone. CodeCheck give \
         values for design, with their own partial factors on top: a run that stays below one is no proof, a run above \
         one is a question.",
    );
    for (name, value, dimension) in first.measures.list() {
        section = section.fact(name.replace('_', " "), value, scene.units.label(dimension));
    }
    if first.measures.approach_is_found {
        section = section.say("The hook's approach is the least that the run has; practice.approach in the scene gives another.");
    }
    let mut columns = vec![Column::new("quantity", ""), Column::new("unit", "")];
    columns.extend(all.iter().map(|(label, _)| Column::new(*label, "")));
    columns.extend(["code", "clause", "formula"].map(|name| Column::new(name, "")));
    columns.push(Column::new("value", ""));
    let mut rows = Vec::new();
    for row in &first.rows {
        let found = |codes: &CodeCheck| {
            codes
                .rows
                .iter()
                .find(|other| other.name == row.name)
                .map(|other: &CodeComparison| other.found.value)
        };
        let mut head = vec![Cell::from(row.what), Cell::from(scene.units.label(row.dimension))];
        head.extend(
            all.iter().map(|(_, codes)| {
                found(codes).map_or(Cell::Empty, |value| Cell::from(rounded(value, DIGITS)))
            }),
        );
        for value in &row.values {
            let mut line = std::mem::replace(&mut head, vec![Cell::Empty; 2 + all.len()]);
            line.extend([value.code, value.clause].map(Cell::from));
            line.extend([Cell::from(value.formula.clone()), Cell::from(rounded(value.value, DIGITS))]);
            rows.push(line);
        }
    }
    let caption = "Found, and by the codes.".to_owned();
    let table = Table { caption, columns, rows };
    let heads = [("factor", ""), ("value", ""), ("unit", ""), ("code", ""), ("clause", ""), ("of", "")];
    let factors = first.factors.iter().map(|given| {
        let value = &given.value;
        vec![
            Cell::from(given.name.replace('_', " ")),
            Cell::from(rounded(value.value, DIGITS)),
            Cell::from(scene.units.label(given.dimension)),
            Cell::from(value.code),
            Cell::from(value.clause),
            Cell::from(value.formula.clone()),
        ]
    });
    let factors = Table {
        caption: "Factors of the codes, and loads of one wheel by them.".to_owned(),
        columns: heads.map(|(name, unit)| Column::new(name, unit)).into(),
        rows: factors.collect(),
    };
    Some(section.table(table).table(factors))
}
