//! What codes say of a design: limits with their sources, loads for fatigue, and what is left out.

use ::design::{DesignResult, LimitCheck};
use formats::design::Design;
use formats::units::Dimension;

use crate::figures::design::{deflection_unit, digits};
use crate::{ReportSection, ReportTable, TableCell, TableColumn};

/// Significant digits of values.
const DIGITS: usize = 4;

/// Limits of deflections.
pub(super) fn limits(design: &Design, checks: &[LimitCheck]) -> ReportTable {
    let (unit, factor) = deflection_unit(design.units);
    let columns = [
        ("case", ""),
        ("rail", ""),
        ("span", ""),
        ("limited", ""),
        ("limit", ""),
        ("deflection", unit),
        ("allowed", unit),
        ("of limit", ""),
        ("", ""),
    ];
    let mut table = ReportTable {
        caption: "Deflections under wheel loads without factors, and the limits of the code"
            .to_owned(),
        columns: columns
            .iter()
            .map(|(name, unit)| TableColumn::new(*name, *unit))
            .collect(),
        rows: Vec::new(),
    };
    for check in checks {
        table.rows.push(vec![
            TableCell::from(check.case),
            TableCell::from(check.rail.clone()),
            TableCell::from(check.span),
            TableCell::from(check.quantity.to_owned()),
            TableCell::from(check.formula.clone()),
            TableCell::from(digits(factor * check.value, DIGITS)),
            TableCell::from(digits(factor * check.limit, DIGITS)),
            TableCell::from(format!("{:.0} %", 100.0 * check.value.abs() / check.limit)),
            TableCell::from(if check.within() { "kept" } else { "exceeded" }),
        ]);
    }
    table
}

/// One line for each limit: its clause, the loads to which it applies, and its source.
pub(super) fn sources(result: &DesignResult) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for check in &result.limits {
        let line = format!(
            "{}, {}: {}, for {} ({}).",
            capital(check.quantity),
            check.formula,
            code(check),
            check.loads,
            check.clause.evidence.words()
        );
        if !out.contains(&line) {
            out.push(line);
        }
    }
    out
}

/// Standard, edition where the name of the standard does not have it, and clause.
fn code(check: &LimitCheck) -> String {
    let clause = &check.clause;
    if clause.standard.contains(clause.edition) {
        format!("{}, {}", clause.standard, clause.clause)
    } else {
        format!("{} {}, {}", clause.standard, clause.edition, clause.clause)
    }
}

fn capital(text: &str) -> String {
    let mut all = text.chars();
    all.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(all).collect()
    })
}

/// Loads for fatigue; nothing for a design without them.
pub(super) fn codes(design: &Design, result: &DesignResult) -> Option<ReportSection> {
    let has_loads = !result.fatigue.is_empty();
    has_loads.then(|| ReportSection::new("Loads for fatigue").table(fatigue(design, result)))
}

/// Damage-equivalent loads of all wheels.
fn fatigue(design: &Design, result: &DesignResult) -> ReportTable {
    let force = design.units.label(Dimension::FORCE);
    let columns = [
        ("train", ""),
        ("wheel", ""),
        ("for direct stress", force.as_str()),
        ("for shear stress", force.as_str()),
    ];
    let mut table = ReportTable {
        caption: "Damage-equivalent wheel loads by EN 1991-3:2006, 2.12.1: the load whose 2 million cycles cause the \
                  damage of the service life of the crane"
            .to_owned(),
        columns: columns.iter().map(|(name, unit)| TableColumn::new(*name, *unit)).collect(),
        rows: Vec::new(),
    };
    for loads in &result.fatigue {
        for (index, [normal, shear]) in loads.wheels.iter().enumerate() {
            table.rows.push(vec![
                TableCell::from(loads.train.clone()),
                TableCell::from(index + 1),
                TableCell::from(digits(*normal, DIGITS)),
                TableCell::from(digits(*shear, DIGITS)),
            ]);
        }
    }
    table
}
