//! Report content on the comparison with design codes.

use crate::figures::design::{column_unit, deflection_unit};
use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use formats::scene::Scene;
use formats::text::number::rounded;
use formats::units::Dimension;
use practice::clause::CodeClause;
use results::codes::{CodeCheck, CodeComparison, StaticDeflection};

/// Significant digits of values of codes; the codes themselves state no more.
const DIGITS: usize = 4;

/// The section on values of codes, with those of all runs that have any; `None` where the scene does not ask for
/// them.
#[must_use]
pub fn section(scene: &Scene, runs: &[(&str, Option<&CodeCheck>)]) -> Option<ReportSection> {
    let all: Vec<(&str, &CodeCheck)> = runs
        .iter()
        .filter_map(|(label, codes)| Some((*label, (*codes)?)))
        .collect();
    let (_, first) = *all.first()?;
    let mut section = ReportSection::new("Comparison with design codes").paragraph(
        "Quantities of the runs compared with values of design codes for the same crane. The forces of the runs are \
         those of the moving loads, without the dead load of the structures. The codes state values for design, to \
         which their own partial factors apply: a run below a value does not prove safety, and a run above it \
         requires an explanation.",
    );
    for (name, value, dimension) in first.crane.list() {
        // spans and approaches are lengths of the plan, however short
        let (unit, factor) = column_unit(scene.units, dimension, f64::INFINITY);
        section = section.fact(name.replace('_', " "), factor * value, unit);
    }
    if first.crane.approach_is_from_run {
        section = section.paragraph(
            "The hook approach is the smallest in the run, because practice.approach is not set in the scene.",
        );
    }
    section = section
        .table(comparisons(scene, &all, first))
        .table(factors(scene, first));
    if !first.limits.is_empty() {
        section = section
            .paragraph(
                "The limits of deflections apply to static wheel loads, not to the forces of a run. The deflections \
                 of the next table are those of the largest static wheel loads at the positions of the wheels in the \
                 run, from the chord between the ends of the span; laterally under a tenth of these loads.",
            )
            .table(limits(scene, &first.limits));
    }
    if !first.groups.is_empty() {
        section = section.table(groups(first));
    }
    for words in &first.left_out {
        section = section.paragraph(format!("Not included: {words}."));
    }
    Some(section)
}

/// Heads of the columns of [`clause_cells`].
const CLAUSE_HEADS: [&str; 3] = ["code", "clause", "source"];

/// Code with its edition, clause and check of a value.
fn clause_cells(clause: &CodeClause) -> [TableCell; 3] {
    let code = code_with_edition(clause);
    [code.as_str(), clause.clause, clause.evidence.words()].map(TableCell::from)
}

/// Name of a code, with its edition where the name does not have it.
pub(super) fn code_with_edition(clause: &CodeClause) -> String {
    let CodeClause {
        standard, edition, ..
    } = clause;
    if standard.contains(edition) || edition.is_empty() {
        (*standard).to_owned()
    } else {
        format!("{standard} {edition}")
    }
}

/// Quantities of the runs, each with the values of codes: one line for each value.
fn comparisons(scene: &Scene, all: &[(&str, &CodeCheck)], first: &CodeCheck) -> ReportTable {
    let mut columns = vec![
        TableColumn::new("quantity", ""),
        TableColumn::new("unit", ""),
    ];
    columns.extend(all.iter().map(|(label, _)| TableColumn::new(*label, "")));
    columns.extend(CLAUSE_HEADS.map(|name| TableColumn::new(name, "")));
    columns.extend(["formula", "value"].map(|name| TableColumn::new(name, "")));
    let mut rows = Vec::new();
    for row in &first.rows {
        let found = |codes: &CodeCheck| {
            codes
                .rows
                .iter()
                .find(|other| other.name == row.name)
                .map(|other: &CodeComparison| other.measured.value)
        };
        let most = row
            .values
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.value.abs()));
        let (unit, factor) = column_unit(scene.units, row.dimension, most);
        let mut head = vec![TableCell::from(row.what), TableCell::from(unit)];
        head.extend(all.iter().map(|(_, codes)| {
            found(codes).map_or(TableCell::Empty, |value| {
                TableCell::from(rounded(factor * value, DIGITS))
            })
        }));
        for value in &row.values {
            let mut line = std::mem::replace(&mut head, vec![TableCell::Empty; 2 + all.len()]);
            line.extend(clause_cells(&value.clause));
            line.extend([
                formula(&value.formula),
                TableCell::from(rounded(factor * value.value, DIGITS)),
            ]);
            rows.push(line);
        }
    }
    ReportTable {
        caption: "Values of the runs compared with values of codes.".to_owned(),
        columns,
        rows,
    }
}

/// The formula of a code, with the unit of its acceleration raised.
fn formula(given: &str) -> TableCell {
    TableCell::from(given.replace("/s2", "/s\u{b2}"))
}

/// Factors of the codes, and their loads of one wheel.
fn factors(scene: &Scene, first: &CodeCheck) -> ReportTable {
    let mut columns = ["factor", "value", "unit"]
        .map(|name| TableColumn::new(name, ""))
        .to_vec();
    columns.extend(CLAUSE_HEADS.map(|name| TableColumn::new(name, "")));
    columns.push(TableColumn::new("formula", ""));
    let factors = first.factors.iter().map(|given| {
        let value = &given.value;
        let (unit, scale) = column_unit(scene.units, given.dimension, value.value.abs());
        let mut line = vec![
            TableCell::from(given.name.replace('_', " ")),
            TableCell::from(rounded(scale * value.value, DIGITS)),
            TableCell::from(unit),
        ];
        line.extend(clause_cells(&value.clause));
        line.push(formula(&value.formula));
        line
    });
    let rows = factors.collect();
    ReportTable {
        caption: "Factors of the codes, and the resulting loads of one wheel.".to_owned(),
        columns,
        rows,
    }
}

/// Deflections under static wheel loads, one line for each limit.
fn limits(scene: &Scene, all: &[StaticDeflection]) -> ReportTable {
    let unit = scene.units.label(Dimension::LENGTH);
    let (short_unit, factor) = deflection_unit(scene.units);
    let mut columns = vec![
        TableColumn::new("deflection", ""),
        TableColumn::new("rail", ""),
        TableColumn::new("from", &unit),
        TableColumn::new("to", &unit),
        TableColumn::new("static", short_unit),
        TableColumn::new("span / deflection", ""),
        TableColumn::new("limit", ""),
        TableColumn::new("allowable", short_unit),
        TableColumn::new("within limit", ""),
    ];
    columns.extend(CLAUSE_HEADS.map(|name| TableColumn::new(name, "")));
    let mut rows = Vec::new();
    for found in all {
        let mut head = vec![
            TableCell::from(found.displacement.word().replace('_', " ")),
            TableCell::from(found.rail.clone()),
            TableCell::from(found.span[0]),
            TableCell::from(found.span[1]),
            TableCell::from(rounded(factor * found.value, DIGITS)),
            found
                .ratio()
                .map_or(TableCell::Empty, |ratio| TableCell::from(ratio.round())),
        ];
        for limit in &found.limits {
            let mut line = std::mem::replace(&mut head, vec![TableCell::Empty; 6]);
            line.push(TableCell::from(limit.limit.formula()));
            line.push(TableCell::from(rounded(factor * limit.value, DIGITS)));
            line.push(TableCell::from(if found.value <= limit.value {
                "yes"
            } else {
                "no"
            }));
            line.extend(clause_cells(&limit.limit.clause));
            rows.push(line);
        }
    }
    ReportTable {
        caption: "Largest deflections under static wheel loads at all positions of the run, and limits of codes."
            .to_owned(),
        columns,
        rows,
    }
}

/// Loads with their factors as a sum, without those of factor zero.
fn sum_of_loads(factors: &[(&str, f64)]) -> String {
    let mut sum = String::new();
    for (name, factor) in factors.iter().filter(|(_, factor)| *factor != 0.0) {
        sum.push_str(match (sum.is_empty(), *factor < 0.0) {
            (true, false) => "",
            (false, false) => " + ",
            (true, true) => "\u{2212}",
            (false, true) => " \u{2212} ",
        });
        sum.push_str(&format!("{} {name}", rounded(factor.abs(), DIGITS)));
    }
    sum
}

/// Groups of loads with the factors of this crane.
fn groups(first: &CodeCheck) -> ReportTable {
    let mut columns = ["group", "loads and factors"]
        .map(|name| TableColumn::new(name, ""))
        .to_vec();
    columns.extend(CLAUSE_HEADS.map(|name| TableColumn::new(name, "")));
    let rows = first.groups.iter().map(|group| {
        let mut line = vec![
            TableCell::from(group.group.name),
            TableCell::from(sum_of_loads(&group.factors)),
        ];
        line.extend(clause_cells(&group.group.clause));
        line
    });
    let rows = rows.collect();
    ReportTable {
        caption: "Groups of crane loads with their factors.".to_owned(),
        columns,
        rows,
    }
}
