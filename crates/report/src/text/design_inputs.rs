//! The inputs of a design as given: spans, dead load, trains, cases.

use crate::figures::design::digits;
use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use formats::design::{Design, DesignTrain};
use formats::units::Dimension;
use formats::verdict::rail_phrase;

/// Significant digits of inputs.
const DIGITS: usize = 6;

/// Trains, cases and dead load as given.
pub(super) fn inputs(design: &Design) -> ReportSection {
    let force = design.units.label(Dimension::FORCE);
    let length = design.units.label(Dimension::LENGTH);
    let mut section = ReportSection::new("Inputs");
    let rails = design.spec.rails();
    for (rail, spans) in rails.iter().zip(&design.spans) {
        let text: Vec<String> = spans.iter().map(|x| digits(*x, DIGITS)).collect();
        section = section.fact(
            format!("{}: spans between", rail_phrase(&rail.name)),
            text.join(", "),
            &length,
        );
    }
    let gravity = design.dead.gravity;
    let weight = if gravity > 0.0 {
        format!("acts, g = {} {length}/s\u{b2}", digits(gravity, DIGITS))
    } else {
        "does not act".to_owned()
    };
    section = section.fact("weight of the structure", weight, "");
    for (rail, line) in rails
        .iter()
        .zip(&design.dead.lines)
        .filter(|(_, line)| **line != 0.0)
    {
        let unit = design.units.label(Dimension::STIFFNESS);
        section = section.fact(
            format!("dead load along {}", rail_phrase(&rail.name)),
            *line,
            unit,
        );
    }
    for train in &design.trains {
        section = section.table(train_table(design, train, [&length, &force]));
    }
    let mut cases = ReportTable {
        caption:
            "Load cases; factors not listed are 1, those of skewing, buffer and tilting forces 0"
                .to_owned(),
        columns: [
            ("case", ""),
            ("name", ""),
            ("trains", ""),
            ("gap", &length),
            ("factors", ""),
        ]
        .map(|(name, unit)| TableColumn::new(name, unit))
        .to_vec(),
        rows: Vec::new(),
    };
    for (index, case) in design.cases.iter().enumerate() {
        let names: Vec<&str> = case
            .trains
            .iter()
            .map(|&train| design.trains[train].name.as_str())
            .collect();
        let factors: Vec<String> = case
            .factors
            .iter()
            .map(|(name, factor)| format!("{name} {}", digits(*factor, DIGITS)))
            .collect();
        cases.rows.push(vec![
            TableCell::from(index + 1),
            TableCell::from(case.name.clone()),
            TableCell::from(names.join(" + ")),
            TableCell::from(digits(case.gap, DIGITS)),
            TableCell::from(factors.join(", ")),
        ]);
    }
    section.table(cases)
}

fn train_table(design: &Design, train: &DesignTrain, [length, force]: [&str; 2]) -> ReportTable {
    let turned = if train.turned {
        "in both orientations"
    } else {
        "not turned"
    };
    let signs = if train.reverses {
        "horizontal forces with either sign"
    } else {
        "horizontal forces as given"
    };
    let mut table = ReportTable {
        caption: format!("Train {}: {turned}, {signs}", train.name),
        columns: vec![
            TableColumn::new("wheel", ""),
            TableColumn::new("rail", ""),
            TableColumn::new("x", length),
            TableColumn::new("vertical", force),
            TableColumn::new("lateral", force),
            TableColumn::new("longitudinal", force),
            TableColumn::new("eccentricity", length),
        ],
        rows: Vec::new(),
    };
    let rails = design.spec.rails();
    for (k, wheel) in train.wheels.iter().enumerate() {
        let parts: Vec<String> = match &wheel.vertical[..] {
            [(_, force)] => vec![digits(*force, DIGITS)],
            parts => parts
                .iter()
                .map(|(name, force)| format!("{name} {}", digits(*force, DIGITS)))
                .collect(),
        };
        table.rows.push(vec![
            TableCell::from(k + 1),
            TableCell::from(rails[wheel.rail].name.clone()),
            TableCell::from(digits(wheel.x, DIGITS)),
            TableCell::from(parts.join(" + ")),
            TableCell::from(digits(wheel.lateral, DIGITS)),
            TableCell::from(digits(wheel.longitudinal, DIGITS)),
            TableCell::from(digits(wheel.eccentricity, DIGITS)),
        ]);
    }
    table
}
