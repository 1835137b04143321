//! The verdict in a report: banner, table of checks, and what was not checked.

use formats::units::{Dimension, Units};
use formats::verdict::{Verdict, VerdictCheck, VerdictResult};

use practice::clause::Evidence;

use crate::figures::design::{deflection_unit, digits};
use crate::text::design_stresses::stress_unit;
use crate::{Banner, BannerTone, ReportSection, ReportTable, TableCell, TableColumn};

/// Largest number of checks in the table on the first page; the others are in the sections on limits and stresses.
const MAX_ROWS: usize = 14;
/// Largest number of checks on a terminal.
const MAX_LINES: usize = 4;
/// Significant digits of values.
const DIGITS: usize = 4;

/// The section with the banner and the tables of a verdict.
pub(crate) fn verdict_section(heading: &str, verdict: &Verdict, units: Units) -> ReportSection {
    let mut section = ReportSection::new(heading);
    section.banner = Some(Banner {
        text: verdict.banner(),
        tone: match verdict.result {
            VerdictResult::Ok => BannerTone::Good,
            VerdictResult::NotOk => BannerTone::Bad,
            VerdictResult::NotChecked => BannerTone::Neutral,
        },
    });
    section = section.table(checks(verdict, units));
    if !verdict.not_checked.is_empty() {
        section = section.table(not_checked(verdict));
    }
    section
}

/// Of each check of each clause the worst, by falling utilisation.
fn checks(verdict: &Verdict, units: Units) -> ReportTable {
    let worst = verdict.worst();
    let columns = [
        "check",
        "applied",
        "limit",
        "utilisation",
        "result",
        "where",
        "loads",
        "clause",
    ];
    let mut table = ReportTable {
        caption: match (worst.len() > MAX_ROWS, worst.len() < verdict.checks.len()) {
            (true, _) => format!(
                "The {MAX_ROWS} checks of highest utilisation of {}; all are in summary.json",
                verdict.checks.len()
            ),
            (false, true) => format!(
                "Checks, each at its highest utilisation of {} in all, which are in summary.json",
                verdict.checks.len()
            ),
            (false, false) => "Checks".to_owned(),
        },
        columns: columns
            .iter()
            .map(|name| TableColumn::new(*name, ""))
            .collect(),
        rows: Vec::new(),
    };
    for check in worst.into_iter().take(MAX_ROWS) {
        table.rows.push(row(check, units));
    }
    table
}

fn row(check: &VerdictCheck, units: Units) -> Vec<TableCell> {
    let (unit, factor) = reading(check, units);
    let value = |value: f64| {
        format!("{} {unit}", digits(factor * value, DIGITS))
            .trim_end()
            .to_owned()
    };
    let limit = match &check.formula {
        Some(formula) => format!("{} ({formula})", value(check.limit)),
        None => value(check.limit),
    };
    let sampled = if check.sampled { " (sampled)" } else { "" };
    let factors: Vec<String> = check
        .factors
        .iter()
        .map(|(name, factor)| format!("{name} {}", digits(*factor, DIGITS)))
        .collect();
    let mut loads = check.loads.clone().unwrap_or_default();
    if !factors.is_empty() {
        loads.push_str(&format!("; factors {}", factors.join(", ")));
    }
    let mut place = check.place();
    if let Some(x) = check.x {
        place.push_str(&format!(
            ", x = {} {}",
            digits(x, DIGITS),
            units.label(Dimension::LENGTH)
        ));
    }
    if let Some(time) = check.time {
        place.push_str(&format!(", t = {} s", digits(time, DIGITS)));
    }
    if let Some(bound) = &check.bound {
        loads.push_str(&format!("; {bound}"));
    }
    // The sources of all limits are in the section on limits; what no source confirms is said here.
    let mut clause = check.reference();
    if check.source.as_deref() == Some(Evidence::Memory.words()) {
        clause.push_str(", from memory");
    }
    vec![
        TableCell::from(format!("{}{sampled}", check.check)),
        TableCell::from(value(check.applied)),
        TableCell::from(limit),
        TableCell::from(percent(check.utilisation)),
        TableCell::from(check.word()),
        TableCell::from(place.trim_start_matches(", ").to_owned()),
        TableCell::from(loads),
        TableCell::from(clause),
    ]
}

/// The verdict in lines for a terminal: banner, the checks of highest utilisation, number of checks that were not done.
#[must_use]
pub fn verdict_lines(verdict: &Verdict, units: Units) -> Vec<String> {
    let mut lines = vec![format!("verdict: {}", verdict.banner())];
    let worst = verdict.worst();
    for check in worst.iter().take(MAX_LINES) {
        let (unit, factor) = reading(check, units);
        let [applied, limit] =
            [check.applied, check.limit].map(|value| digits(factor * value, DIGITS));
        let parts = [check.place(), check.reference()];
        let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        let line = format!(
            "  {} {}: {applied} of {limit} {unit}, {}  {}",
            check.word(),
            check.check,
            percent(check.utilisation),
            parts.join(", "),
        );
        lines.push(
            line.replace("  ,", ",")
                .replace(" , ", ", ")
                .trim_end()
                .to_owned(),
        );
    }
    match worst.len().saturating_sub(MAX_LINES) {
        0 => {}
        1 => lines.push("  one more check in the report".to_owned()),
        more => lines.push(format!("  {more} more checks in the report")),
    }
    if !verdict.not_checked.is_empty() {
        lines.push(format!(
            "  not checked: {}, listed in the report",
            verdict.not_checked.len()
        ));
    }
    lines
}

/// A utilisation in percent; small ones as a bound.
pub(crate) fn percent(utilisation: f64) -> String {
    if utilisation < 0.005 {
        "< 1 %".to_owned()
    } else {
        format!("{:.0} %", 100.0 * utilisation)
    }
}

/// Unit in which engineers read the values of a check, and its factor.
fn reading(check: &VerdictCheck, units: Units) -> (String, f64) {
    if check.unit == units.label(Dimension::LENGTH) {
        let (unit, factor) = deflection_unit(units);
        (unit.to_owned(), factor)
    } else if check.unit == units.label(Dimension::STRESS) {
        stress_unit(units)
    } else if check.unit == "1" {
        (String::new(), 1.0)
    } else {
        (check.unit.clone(), 1.0)
    }
}

/// What was not checked, by reason.
fn not_checked(verdict: &Verdict) -> ReportTable {
    let mut groups: Vec<(&str, &str, Vec<String>)> = Vec::new();
    for one in &verdict.not_checked {
        let name = match &one.clause {
            Some(clause) => format!("{} ({clause})", one.check),
            None => one.check.clone(),
        };
        let code = one.code.as_deref().unwrap_or("");
        match groups
            .iter_mut()
            .find(|known| (known.0, known.1) == (code, one.reason.as_str()))
        {
            Some(known) => known.2.push(name),
            None => groups.push((code, &one.reason, vec![name])),
        }
    }
    let rows = groups.into_iter().map(|(code, reason, checks)| {
        vec![
            TableCell::from(checks.join("; ")),
            TableCell::from(code),
            TableCell::from(reason),
        ]
    });
    ReportTable {
        caption: "Not checked".to_owned(),
        columns: ["check", "code", "reason"]
            .iter()
            .map(|name| TableColumn::new(*name, ""))
            .collect(),
        rows: rows.collect(),
    }
}
