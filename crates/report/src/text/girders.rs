//! Report content on the extremes of girders in the runs.

use crate::figures::design::{
    digits, quantity_phrase, reading_unit, side_phrase, unit_of, with_unit,
};
use crate::figures::run_name::run_name;
use crate::text::girder_stresses;
use crate::{ReportSection, ReportTable, TableCell, TableColumn, cleared};
use formats::scene::{Document, Scene};
use formats::units::Dimension;
use results::case_result::CaseResult;
use results::girders::{GirderExtreme, GirderReaction};
use trains::GirderResponse;

/// Significant digits of values.
const DIGITS: usize = 4;
/// Largest number of rows of the table of all spans; summary.json has all.
const ROWS: usize = 80;

/// Which values stand in the first table, with their words.
pub(super) const GOVERNING: [(GirderResponse, bool, &str); 9] = [
    (
        GirderResponse::VerticalMoment,
        true,
        "largest sagging moment",
    ),
    (
        GirderResponse::VerticalMoment,
        false,
        "largest hogging moment",
    ),
    (GirderResponse::VerticalShear, true, "largest shear force"),
    (GirderResponse::VerticalShear, false, "smallest shear force"),
    (
        GirderResponse::LateralMoment,
        true,
        "largest lateral moment",
    ),
    (
        GirderResponse::LateralMoment,
        false,
        "smallest lateral moment",
    ),
    (GirderResponse::Torsion, true, "largest torsion"),
    (
        GirderResponse::VerticalDeflection,
        true,
        "largest deflection downwards",
    ),
    (
        GirderResponse::LateralDeflection,
        true,
        "largest deflection along +z",
    ),
];

/// The governing values of every run, and all extremes of the first; `None` where no structure has girders.
#[must_use]
pub fn section(document: &Document, outcomes: &[CaseResult]) -> Option<ReportSection> {
    if outcomes
        .iter()
        .all(|outcome| outcome.girders().extremes.is_empty())
    {
        return None;
    }
    let scene = document.scene();
    let (weight, deflections) = if scene.output.dead_load {
        (
            "with the dead load of the structure",
            "; deflections are those due to the wheels",
        )
    } else {
        ("without the dead load of the structure", "")
    };
    let mut section = ReportSection::new("Extremes of girders").paragraph(format!(
        "Moments, shear forces and torsion of the members that carry rails, and deflections of the rails, {weight}\
         {deflections}. A positive moment sags, shear is the derivative of the moment along the rail."
    ));
    section = section.table(governing(document, outcomes));
    let first = &outcomes[0];
    if !first.girders().extremes.is_empty() {
        section = section.table(spans(scene, first));
    }
    if !first.girders().reactions.is_empty() {
        section = section.table(reactions(scene, first));
    }
    if let Some((table, method)) = girder_stresses::table(document, outcomes) {
        section = section.table(table).paragraph(method);
    }
    section
        .paragraph("Envelopes along the rails are in envelope.csv, all extremes in summary.json.")
        .into()
}

/// The largest values of each run over all rails and spans.
fn governing(document: &Document, outcomes: &[CaseResult]) -> ReportTable {
    let length = document.scene().units.label(Dimension::LENGTH);
    let mut table = ReportTable {
        caption: "Governing values of every run".to_owned(),
        columns: vec![
            TableColumn::new("", ""),
            TableColumn::new("run", ""),
            TableColumn::new("value", ""),
            TableColumn::new("rail", ""),
            TableColumn::new("span", ""),
            TableColumn::new("x", length),
            TableColumn::new("side", ""),
            TableColumn::new("time", "s"),
        ],
        rows: Vec::new(),
    };
    for (quantity, is_max, words) in GOVERNING {
        for (case, outcome) in document.cases.iter().zip(outcomes) {
            let Some(found) = largest(outcome, quantity, is_max) else {
                continue;
            };
            let mut row = vec![
                TableCell::from(words),
                TableCell::from(run_name(&outcome.label)),
            ];
            row.extend(cells(&case.scene, found));
            table.rows.push(row);
        }
    }
    table
}

/// The largest or smallest value of a quantity over all rails and spans of a run; `None` where it never has that sign.
pub(super) fn largest(
    outcome: &CaseResult,
    quantity: GirderResponse,
    is_max: bool,
) -> Option<&GirderExtreme> {
    let sign = if is_max { 1.0 } else { -1.0 };
    let own = outcome.girders().extremes.iter();
    let own = own.filter(|e| e.quantity == quantity && e.is_max == is_max && sign * e.value > 0.0);
    own.reduce(|best, next| {
        if sign * next.value > sign * best.value {
            next
        } else {
            best
        }
    })
}

/// All extremes of one run.
fn spans(scene: &Scene, outcome: &CaseResult) -> ReportTable {
    let all = &outcome.girders().extremes;
    let shown = if all.len() > ROWS {
        ", the first of them; summary.json has all"
    } else {
        ""
    };
    let mut table = ReportTable {
        caption: format!(
            "Extremes of every span in the run \"{}\"{shown}",
            run_name(&outcome.label)
        ),
        columns: vec![
            TableColumn::new("quantity", ""),
            TableColumn::new("", ""),
            TableColumn::new("value", ""),
            TableColumn::new("rail", ""),
            TableColumn::new("span", ""),
            TableColumn::new("x", scene.units.label(Dimension::LENGTH)),
            TableColumn::new("side", ""),
            TableColumn::new("time", "s"),
        ],
        rows: Vec::new(),
    };
    for found in all.iter().filter(|found| found.value != 0.0).take(ROWS) {
        let kind = if found.is_max { "largest" } else { "smallest" };
        let mut row = vec![
            TableCell::from(quantity_phrase(found.quantity)),
            TableCell::from(kind),
        ];
        row.extend(cells(scene, found));
        table.rows.push(row);
    }
    table
}

/// Largest and smallest reactions of one run.
fn reactions(scene: &Scene, outcome: &CaseResult) -> ReportTable {
    let all = &outcome.girders().reactions;
    let (unit, by_force) = reading_unit(scene.units, Dimension::FORCE);
    let (moment_unit, by_moment) = reading_unit(scene.units, Dimension::MOMENT);
    let mut columns = vec![
        TableColumn::new("support", ""),
        TableColumn::new("direction", ""),
        TableColumn::new("largest", &unit),
        TableColumn::new("time", "s"),
        TableColumn::new("smallest", &unit),
        TableColumn::new("time", "s"),
    ];
    let has_dead = scene.output.dead_load;
    if has_dead {
        columns.insert(2, TableColumn::new("of dead load", &unit));
    }
    // forces and moments are of different kinds
    let is_moment = |found: &&GirderReaction| found.direction.to_string().starts_with('r');
    let most = |is_wanted: bool| {
        let sizes = all
            .iter()
            .filter(|found| is_moment(found) == is_wanted)
            .map(|found| found.value.abs());
        sizes.fold(0.0, f64::max)
    };
    // a moment is rounding beside the largest force at the farthest place
    let length = outcome
        .girders()
        .extremes
        .iter()
        .map(|found| found.x.abs())
        .fold(0.0, f64::max);
    let largest_of = [most(false), most(true).max(length * most(false))];
    let shown =
        |found: &GirderReaction| cleared(found.value, largest_of[usize::from(is_moment(&found))]);
    let (mut rows, mut zero) = (Vec::new(), Vec::new());
    for pair in all.chunks_exact(2) {
        let [largest, smallest] = [&pair[0], &pair[1]];
        if shown(largest) == 0.0 && shown(smallest) == 0.0 {
            zero.push(format!("{} {}", largest.support, largest.direction));
            continue;
        }
        let direction = largest.direction.to_string();
        let factor = if direction.starts_with('r') {
            by_moment
        } else {
            by_force
        };
        let mut row = vec![
            TableCell::from(largest.support.clone()),
            TableCell::from(direction),
        ];
        row.extend(has_dead.then(|| TableCell::from(digits(factor * largest.dead, DIGITS))));
        row.extend(
            pair.iter()
                .flat_map(|own| [factor * shown(own), own.time])
                .map(|n| TableCell::from(digits(n, DIGITS))),
        );
        rows.push(row);
    }
    let more = if rows.len() > ROWS {
        ", the first of them; summary.json has all"
    } else {
        ""
    };
    rows.truncate(ROWS);
    let without = if zero.is_empty() || zero.len() > ROWS {
        String::new()
    } else {
        format!("; zero: {}", zero.join(", "))
    };
    let caption = format!(
        "Reactions of supports in the run \"{}\": forces and moments on the structure, positive along the global axes; \
         moments (rx, ry, rz) in {}{more}{without}",
        run_name(&outcome.label),
        moment_unit
    );
    ReportTable {
        caption,
        columns,
        rows,
    }
}

/// Value, rail, span, place, side and time.
fn cells(scene: &Scene, found: &GirderExtreme) -> [TableCell; 6] {
    let (unit, factor) = unit_of(scene.units, found.quantity);
    let value = with_unit(&digits(factor * found.value, DIGITS), &unit);
    [
        TableCell::from(value),
        TableCell::from(scene.rails[found.rail].name.clone()),
        TableCell::from(found.span),
        TableCell::from(digits(found.x, DIGITS)),
        TableCell::from(side_phrase(found.side)),
        TableCell::from(digits(found.time, DIGITS)),
    ]
}
