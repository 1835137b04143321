//! Report content on reactions, internal forces, deflections of rails and uplift of wheels.

use crate::figures::design::{column_unit, deflection_unit};
use crate::{ReportSection, ReportTable, TableCell, TableColumn, cleared, is_rounding};
use formats::scene::Scene;
use formats::scene::columns::Column;
use formats::text::number::rounded;
use formats::units::Dimension;
use results::columns::NamedColumns;
use results::response::{ColumnEnvelope, ColumnStatistics, Response, RunComparison};

/// Largest number of rows of a table; summary.json has all.
const ROWS: usize = 60;

/// The section on the first run.
#[must_use]
pub fn section(scene: &Scene, label: &str, response: &Response) -> ReportSection {
    let mut section = ReportSection::new("Reactions, deflections and uplift");
    if !response.columns.is_empty() {
        let weight = if scene.output.dead_load {
            "with"
        } else {
            "without"
        };
        section = section
            .paragraph(format!(
                "Reactions of the ground on the structures, positive along the global axes, and internal forces at \
                 named sections: influence lines times wheel forces, minus the inertia forces of the structure, \
                 {weight} the dead load of the structures. The last column shows the dead load alone."
            ))
            .table(envelopes(scene, label, response));
    }
    if !response.deflections.is_empty() {
        section = section.table(deflections(scene, label, response));
    }
    if !response.drifts.is_empty() {
        section = section.table(drifts(scene, label, response));
    }
    if !response.uplifts.is_empty() {
        let mut table = ReportTable {
            caption: format!("Uplift: wheels that leave their rails in the run \"{label}\"."),
            columns: vec![
                TableColumn::new("wheel", ""),
                TableColumn::new("from", "s"),
                TableColumn::new("duration", "s"),
            ],
            rows: Vec::new(),
        };
        for uplift in response.uplifts.iter().take(ROWS) {
            table.rows.push(vec![
                TableCell::from(uplift.wheel.clone()),
                TableCell::from(uplift.time),
                TableCell::from(uplift.duration),
            ]);
        }
        section = section.table(table);
    }
    for sway in &response.sways {
        let unit = scene.units.label(Dimension::LENGTH);
        for (axis, [least, most]) in ["X", "Y", "Z"].into_iter().zip(sway.range) {
            section = section.fact(
                format!("{}: range of {axis}", sway.body),
                most - least,
                &unit,
            );
        }
    }
    for note in &response.notes {
        section = section.paragraph(format!("{note}."));
    }
    section
}

/// Statistics of the columns in all runs; `None` where there is a single run or nothing to compare.
///
/// `labels`: labels of the compared runs; `record`: columns of the first of them.
#[must_use]
pub fn comparison(
    scene: &Scene,
    labels: &[&str],
    record: &NamedColumns,
    comparison: &RunComparison,
) -> Option<ReportSection> {
    let of = |name: &str| record.columns.iter().find(|column| column.name == name);
    let most = |figures: &[&ColumnStatistics]| {
        figures.iter().fold(0.0_f64, |most, found| {
            most.max(size(found.peak.value, found.least.value))
        })
    };
    // the largest value of the same dimension in any run
    let largest = |dimension: Dimension| {
        let same = comparison
            .columns()
            .filter(|(name, _)| of(name).is_some_and(|own| own.dimension == dimension));
        same.map(|(_, figures)| most(&figures)).fold(0.0, f64::max)
    };
    let (zero, all): (Vec<_>, Vec<_>) = comparison.columns().partition(|(name, figures)| {
        of(name).is_some_and(|column| is_rounding(most(figures), largest(column.dimension)))
    });
    if all.is_empty() {
        return None;
    }
    let zero: Vec<&str> = zero.into_iter().map(|(name, _)| name).collect();
    let without = if zero.is_empty() {
        String::new()
    } else {
        format!(" Zero throughout: {}.", zero.join(", "))
    };
    let more = all.len().saturating_sub(ROWS);
    let rest = if more > 0 {
        format!(" {more} more are in summary.json.")
    } else {
        String::new()
    };
    let mut rows = Vec::new();
    for (name, figures) in all.into_iter().take(ROWS) {
        let (unit, factor) = of(name).map_or_else(
            || (String::new(), 1.0),
            |column| column_unit(scene.units, column.dimension, most(&figures)),
        );
        let mut head = vec![TableCell::from(name.to_owned()), TableCell::from(unit)];
        for (label, found) in labels.iter().zip(figures) {
            let mut row = std::mem::replace(&mut head, vec![TableCell::Empty; 2]);
            row.push(TableCell::from(*label));
            let range = found.peak.value - found.least.value;
            let [settled, peak, least] = [found.settled, found.peak.value, found.least.value]
                .map(|value| short(factor * cleared(value, range)));
            row.extend([
                settled,
                peak,
                short(found.peak.time),
                least,
                short(found.least.time),
            ]);
            row.push(TableCell::from(found.excursions));
            row.push(found.hertz().map_or(TableCell::Empty, short));
            rows.push(row);
        }
    }
    let columns = [
        ("quantity", ""),
        ("unit", ""),
        ("run", ""),
        ("mean of last quarter", ""),
        ("largest", ""),
        ("at time", "s"),
        ("smallest", ""),
        ("at time", "s"),
        ("excursions", ""),
        ("frequency", "Hz"),
    ];
    let caption = format!(
        "Mean over the last quarter of each run, extremes, sampled at the output times, number of excursions from the band of 5 % about this \
         mean, and the frequency of largest amplitude in that quarter.{rest}{without}"
    );
    let columns = columns
        .map(|(name, unit)| TableColumn::new(name, unit))
        .into();
    Some(
        ReportSection::new("Comparison of the runs").table(ReportTable {
            caption,
            columns,
            rows,
        }),
    )
}

/// Extremes of reactions and internal forces.
fn envelopes(scene: &Scene, label: &str, response: &Response) -> ReportTable {
    let more = (response.envelopes.len() - zero_columns(response).len()).saturating_sub(ROWS);
    let rest = if more > 0 {
        format!(" {more} more are in summary.json.")
    } else {
        String::new()
    };
    let length = scene.units.label(Dimension::LENGTH);
    let mut columns = [
        ("quantity", ""),
        ("unit", ""),
        ("", ""),
        ("value", ""),
        ("at time", "s"),
    ]
    .map(|(n, u)| TableColumn::new(n, u))
    .to_vec();
    columns.extend(
        scene
            .bodies
            .iter()
            .map(|body| TableColumn::new(body.name.as_str(), &length)),
    );
    columns.push(TableColumn::new("dead load", ""));
    let mut rows = Vec::new();
    let own = response.columns.iter().zip(&response.dead_load);
    let zero = zero_columns(response);
    let shown = response
        .envelopes
        .iter()
        .zip(own)
        .filter(|(envelope, _)| !zero.contains(&envelope.column.as_str()));
    for (envelope, (column, dead)) in shown.take(ROWS) {
        let most = size(envelope.max.value, envelope.min.value).max(dead.abs());
        let (unit, factor) = column_unit(scene.units, column.dimension, most);
        let range = envelope.max.value - envelope.min.value;
        let mut head = vec![
            TableCell::from(envelope.column.clone()),
            TableCell::from(unit),
        ];
        let mut weight = TableCell::from(factor * cleared(*dead, most));
        for (word, extreme) in [("max", &envelope.max), ("min", &envelope.min)] {
            let mut row = std::mem::replace(&mut head, vec![TableCell::Empty; 2]);
            let value = TableCell::from(factor * cleared(extreme.value, range));
            row.extend([TableCell::from(word), value, TableCell::from(extreme.time)]);
            row.extend(
                extreme
                    .bodies
                    .iter()
                    .map(|(_, at)| TableCell::from(place(at))),
            );
            row.push(std::mem::take(&mut weight));
            rows.push(row);
        }
    }
    let without = if zero.is_empty() {
        String::new()
    } else {
        format!(" Zero throughout: {}.", zero.join(", "))
    };
    let caption = format!(
        "Envelopes of the run \"{label}\", with the governing times and positions of the bodies.{rest}{without}"
    );
    ReportTable {
        caption,
        columns,
        rows,
    }
}

/// Names of the columns that are zero throughout, dead load included, up to rounding of the largest value of their
/// dimension.
fn zero_columns(response: &Response) -> Vec<&str> {
    let all = || {
        response
            .envelopes
            .iter()
            .zip(response.columns.iter().zip(&response.dead_load))
    };
    let magnitude = |max: f64, min: f64, dead: f64| size(max, min).max(dead.abs());
    let largest = |dimension: Dimension| {
        let same = all().filter(|(_, (column, _))| column.dimension == dimension);
        same.map(|(e, (_, dead))| magnitude(e.max.value, e.min.value, *dead))
            .fold(0.0, f64::max)
    };
    let is_zero = |(e, (column, dead)): &(&ColumnEnvelope, (&Column, &f64))| {
        is_rounding(
            magnitude(e.max.value, e.min.value, **dead),
            largest(column.dimension),
        )
    };
    all()
        .filter(is_zero)
        .map(|(envelope, _)| envelope.column.as_str())
        .collect()
}

/// The larger magnitude.
fn size(one: f64, other: f64) -> f64 {
    one.abs().max(other.abs())
}

/// A number to four digits.
fn short(value: f64) -> TableCell {
    TableCell::from(rounded(value, 4))
}

/// Coordinates of a body.
fn place(at: &[f64]) -> String {
    at.iter()
        .map(|x| crate::number(*x, 4).unwrap_or_default())
        .collect::<Vec<_>>()
        .join("; ")
}

/// Lateral displacements of rails at columns, with the limits of codes.
fn drifts(scene: &Scene, label: &str, response: &Response) -> ReportTable {
    let unit = scene.units.label(Dimension::LENGTH);
    let (short_unit, factor) = deflection_unit(scene.units);
    let columns = [
        "rail",
        "column at",
        "height",
        "displacement",
        "at time",
        "height / displacement",
        "code",
        "edition",
        "source",
        "limit",
        "within limit",
    ];
    let unit_of = |name: &str| match name {
        "column at" | "height" => unit.as_str(),
        "displacement" | "limit" => short_unit,
        "at time" => "s",
        _ => "",
    };
    let mut rows = Vec::new();
    for found in response.drifts.iter().take(ROWS) {
        let mut head = vec![
            TableCell::from(found.rail.clone()),
            TableCell::from(found.x),
            TableCell::from(found.height),
            TableCell::from(factor * found.value),
            TableCell::from(found.time),
            found
                .ratio()
                .map_or(TableCell::Empty, |ratio| TableCell::from(ratio.round())),
        ];
        for (clause, formula, most) in &found.limits {
            let mut row = std::mem::replace(&mut head, vec![TableCell::Empty; 6]);
            row.push(TableCell::from(format!(
                "{}, {}: {formula}",
                clause.standard, clause.clause
            )));
            row.extend([clause.edition, clause.evidence.words()].map(TableCell::from));
            row.push(TableCell::from(factor * *most));
            row.push(TableCell::from(if found.value <= *most {
                "yes"
            } else {
                "no"
            }));
            rows.push(row);
        }
    }
    ReportTable {
        caption: format!(
            "Largest lateral displacement of each rail at a column in the run \"{label}\"."
        ),
        columns: columns
            .map(|name| TableColumn::new(name, unit_of(name)))
            .into(),
        rows,
    }
}

/// Deflections of the rails within each span.
fn deflections(scene: &Scene, label: &str, response: &Response) -> ReportTable {
    let unit = scene.units.label(Dimension::LENGTH);
    let (short_unit, factor) = deflection_unit(scene.units);
    let mut table = ReportTable {
        caption: format!(
            "Largest deflections of the rails relative to the ends of each span in the run \"{label}\", and \
             span-to-deflection ratios. L/600 and L/400 are limits of the deflection under static wheel loads; the \
             deflections here are those of the run."
        ),
        columns: vec![
            TableColumn::new("rail", ""),
            TableColumn::new("direction", ""),
            TableColumn::new("from", &unit),
            TableColumn::new("to", &unit),
            TableColumn::new("deflection", short_unit),
            TableColumn::new("at", &unit),
            TableColumn::new("at time", "s"),
            TableColumn::new("span / deflection", ""),
            TableColumn::new("compared with static limits", ""),
        ],
        rows: Vec::new(),
    };
    for found in response.deflections.iter().take(ROWS) {
        let kept = match (found.is_within(600.0), found.is_within(400.0)) {
            (true, _) => "L/600",
            (false, true) => "L/400, not L/600",
            (false, false) => "not L/400",
        };
        table.rows.push(vec![
            TableCell::from(found.rail.clone()),
            TableCell::from(found.direction.to_owned()),
            TableCell::from(found.span[0]),
            TableCell::from(found.span[1]),
            TableCell::from(factor * found.value),
            TableCell::from(found.x),
            TableCell::from(found.time),
            found
                .ratio()
                .map_or(TableCell::Empty, |ratio| TableCell::from(ratio.round())),
            TableCell::from(kept.to_owned()),
        ]);
    }
    table
}
