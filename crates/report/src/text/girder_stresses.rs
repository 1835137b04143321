//! Report content on the direct stresses of girders in the runs.

use crate::figures::design::{digits, side_phrase, with_unit};
use crate::figures::run_name::run_name;
use crate::text::design_stresses::{lateral_words, stress_unit};
use crate::{ReportTable, TableCell, TableColumn};
use formats::LateralSection;
use formats::scene::{Document, Scene};
use formats::units::Dimension;
use results::case_result::CaseResult;
use results::girders::GirderStress;

/// Significant digits of values.
const DIGITS: usize = 4;

/// The largest direct stress of the first run with its place, utilisation and model, and that of runs with the other model;
/// nothing where the scene does not ask for stresses.
pub(super) fn verdict_line(document: &Document, outcomes: &[CaseResult]) -> Option<String> {
    let scene = document.scene();
    let lateral = scene.lateral_section?;
    let Some(found) = outcomes[0].girders().stresses.governing() else {
        return Some(format!(
            "Direct stresses of girders are not available ({}); the section on warnings and notes has the reasons that are known.",
            lateral.phrase()
        ));
    };
    let (unit, factor) = stress_unit(scene.units);
    let text = |value: f64| with_unit(&digits(factor * value, DIGITS), &unit);
    let mut out = format!(
        "The largest direct stress of the girders is {} ({}) in {} on {} at x = {}, t = {} s, {}: {}",
        text(found.value),
        found.fibre,
        found.section,
        scene.rails[found.rail].name,
        digits(found.x, DIGITS),
        digits(found.time, DIGITS),
        lateral.phrase(),
        used(found, &text),
    );
    for (case, outcome) in document.cases.iter().zip(outcomes).skip(1) {
        let own = case.scene.lateral_section.filter(|own| *own != lateral);
        if let Some((own, found)) = own.zip(outcome.girders().stresses.governing()) {
            out.push_str(&format!(
                "; in the run \"{}\" {}, {}",
                run_name(&outcome.label),
                text(found.value),
                own.phrase()
            ));
        }
    }
    out.push('.');
    Some(out)
}

/// The utilisation in words.
fn used(found: &GirderStress, text: &dyn Fn(f64) -> String) -> String {
    match found.utilisation().zip(found.yield_strength) {
        Some((used, strength)) => {
            let beyond = if used > 1.0 {
                ", which is exceeded"
            } else {
                ""
            };
            format!(
                "{:.0} % of the yield strength of {}{beyond}",
                100.0 * used,
                text(strength)
            )
        }
        None => "the spec gives no yield strength `fy`".to_owned(),
    }
}

/// The largest direct stress of each section under each rail in every run, and how it is computed.
pub(super) fn table(document: &Document, outcomes: &[CaseResult]) -> Option<(ReportTable, String)> {
    let scene = document.scene();
    let (unit, factor) = stress_unit(scene.units);
    let mut table = ReportTable {
        caption: "Largest direct stress of each section under a rail".to_owned(),
        columns: vec![
            TableColumn::new("run", ""),
            TableColumn::new("rail", ""),
            TableColumn::new("span", ""),
            TableColumn::new("section, fibre", ""),
            TableColumn::new("value", unit.as_str()),
            TableColumn::new("of N, vertical, lateral", unit.as_str()),
            TableColumn::new("utilisation", ""),
            TableColumn::new("x", scene.units.label(Dimension::LENGTH)),
            TableColumn::new("side", ""),
            TableColumn::new("time", "s"),
        ],
        rows: Vec::new(),
    };
    let mut models: Vec<LateralSection> = Vec::new();
    for (case, outcome) in document.cases.iter().zip(outcomes) {
        for found in &outcome.girders().stresses.rows {
            table
                .rows
                .push(row(&case.scene, run_name(&outcome.label), found, factor));
            models.extend(
                case.scene
                    .lateral_section
                    .filter(|own| !models.contains(own)),
            );
        }
    }
    let words: Vec<&str> = models.iter().map(|own| lateral_words(*own)).collect();
    let dead = if scene.output.dead_load {
        "with"
    } else {
        "without"
    };
    let method = format!(
        "Direct stress is N/A + M z/I + M y/I at the edges of the flanges, {dead} the dead load of the structure, \
         from simultaneous normal force and moments. It is the largest at the times and sections that are evaluated. \
         Here {}. Shear, partial factors and stability are not included.",
        words.join("; in other runs ")
    );
    (!table.rows.is_empty()).then_some((table, method))
}

fn row(scene: &Scene, label: &str, found: &GirderStress, factor: f64) -> Vec<TableCell> {
    let parts: Vec<String> = found
        .parts
        .iter()
        .map(|part| digits(factor * part, 3))
        .collect();
    let percent = found
        .utilisation()
        .map(|used| TableCell::from(format!("{:.0} %", 100.0 * used)));
    vec![
        TableCell::from(label.to_owned()),
        TableCell::from(scene.rails[found.rail].name.clone()),
        TableCell::from(found.span),
        TableCell::from(format!("{}, {}", found.section, found.fibre)),
        TableCell::from(digits(factor * found.value, DIGITS)),
        TableCell::from(parts.join(", ")),
        percent.unwrap_or(TableCell::Empty),
        TableCell::from(digits(found.x, DIGITS)),
        TableCell::from(side_phrase(found.side)),
        TableCell::from(digits(found.time, DIGITS)),
    ]
}
