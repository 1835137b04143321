//! The table of governing values of a run, with the range of the other runs.

use crate::figures::design::{deflection_unit, digits, reading_unit, unit_of, with_unit};
use crate::figures::responses::ground_reactions;
use crate::figures::run_name::run_name;
use crate::text::design_stresses::stress_unit;
use crate::text::girders::{GOVERNING, largest};
use crate::{ReportTable, TableCell, TableColumn, cleared, is_rounding};
use fea::Dof;
use formats::scene::columns::Direction;
use formats::scene::{Document, Scene};
use formats::units::Dimension;
use results::case_result::CaseResult;
use results::steps::ColumnInstant;
use trains::GirderResponse;

/// Significant digits of values.
const DIGITS: usize = 4;

/// A row of the governing values: words, unit and factor, value of the first run with its place, values of the others.
struct GoverningRow {
    words: String,
    unit: String,
    factor: f64,
    value: f64,
    /// Text behind the value, such as the ratio of span to deflection.
    more: String,
    name: String,
    span: TableCell,
    x: TableCell,
    time: f64,
    others: Vec<f64>,
    /// Largest value of its kind; fractions of it that are only rounding are shown as zero.
    size: f64,
}

impl GoverningRow {
    /// A row without place, text behind the value and other runs.
    fn new(
        words: &str,
        (unit, factor): (&str, f64),
        value: f64,
        name: &str,
        time: f64,
    ) -> GoverningRow {
        GoverningRow {
            words: words.to_owned(),
            unit: unit.to_owned(),
            factor,
            value,
            more: String::new(),
            name: name.to_owned(),
            span: TableCell::Empty,
            x: TableCell::Empty,
            time,
            others: Vec::new(),
            size: 0.0,
        }
    }

    fn cells(self) -> Vec<TableCell> {
        let text = |value: f64| digits(self.factor * cleared(value, self.size), DIGITS);
        let low = self.others.iter().copied().reduce(f64::min);
        let high = self.others.iter().copied().reduce(f64::max);
        let others = match low.zip(high) {
            Some((low, high)) if text(low) == text(high) => text(low),
            Some((low, high)) => format!("{} to {}", text(low), text(high)),
            None => String::new(),
        };
        vec![
            TableCell::from(self.words),
            TableCell::from(format!(
                "{}{}",
                with_unit(&text(self.value), &self.unit),
                self.more
            )),
            TableCell::from(self.name),
            self.span,
            self.x,
            TableCell::from(digits(self.time, DIGITS)),
            TableCell::from(others),
        ]
    }
}

/// The values that govern in the first run, and the range of the same values in the others.
pub(super) fn governing(document: &Document, outcomes: &[CaseResult]) -> ReportTable {
    let scene = document.scene();
    let (first, others) = (&outcomes[0], &outcomes[1..]);
    let mut rows = girder_rows(scene, first, others);
    rows.extend(stress_row(scene, first, others));
    rows.extend(deflection_rows(scene, first, others));
    rows.extend(wheel_rows(scene, first, others));
    rows.extend(reaction_rows(scene, first, others));
    let mut columns = vec![
        TableColumn::new("", ""),
        TableColumn::new("value", ""),
        TableColumn::new("rail, wheel or support", ""),
        TableColumn::new("span", ""),
        TableColumn::new("x", scene.units.label(Dimension::LENGTH)),
        TableColumn::new("time", "s"),
        TableColumn::new("other runs", ""),
    ];
    let mut rows: Vec<Vec<TableCell>> = rows.into_iter().map(GoverningRow::cells).collect();
    if others.is_empty() {
        columns.pop();
        rows.iter_mut().for_each(|row| row.truncate(columns.len()));
    }
    let dead = if scene.output.dead_load {
        "with"
    } else {
        "without"
    };
    let stress = if scene.lateral_section.is_some() {
        ", stresses"
    } else {
        ""
    };
    let caption = format!(
        "Governing values of the run \"{}\", moments, shear forces{stress} and reactions {dead} the dead load of the structure",
        run_name(&first.label)
    );
    ReportTable {
        caption,
        columns,
        rows,
    }
}

fn girder_rows(scene: &Scene, first: &CaseResult, others: &[CaseResult]) -> Vec<GoverningRow> {
    let row = |(quantity, is_max, words): &(GirderResponse, bool, &str)| {
        let found = largest(first, *quantity, *is_max)?;
        let (unit, factor) = unit_of(scene.units, *quantity);
        let same = others
            .iter()
            .filter_map(|other| largest(other, *quantity, *is_max));
        let name = &scene.rails[found.rail].name;
        Some(GoverningRow {
            span: TableCell::from(found.span),
            x: TableCell::from(digits(found.x, DIGITS)),
            others: same.map(|found| found.value).collect(),
            ..GoverningRow::new(words, (&unit, factor), found.value, name, found.time)
        })
    };
    GOVERNING.iter().filter_map(row).collect()
}

/// The direct stress that governs, where the scene asks for stresses.
fn stress_row(scene: &Scene, first: &CaseResult, others: &[CaseResult]) -> Option<GoverningRow> {
    let found = first.girders().stresses.governing()?;
    let (unit, factor) = stress_unit(scene.units);
    let more = found.utilisation().map_or_else(String::new, |used| {
        format!(" = {:.0} % of fy", 100.0 * used)
    });
    let same = others
        .iter()
        .filter_map(|other| other.girders().stresses.governing());
    Some(GoverningRow {
        more,
        span: TableCell::from(found.span),
        x: TableCell::from(digits(found.x, DIGITS)),
        others: same.map(|found| found.value).collect(),
        ..GoverningRow::new(
            "largest direct stress",
            (&unit, factor),
            found.value,
            &scene.rails[found.rail].name,
            found.time,
        )
    })
}

/// The deflection from the chord that is the largest part of its span, in each direction.
fn deflection_rows(scene: &Scene, first: &CaseResult, others: &[CaseResult]) -> Vec<GoverningRow> {
    let worst = |outcome: &CaseResult, direction: &str| {
        let own = outcome
            .response
            .deflections
            .iter()
            .filter(|found| found.direction == direction);
        let known = own.filter_map(|found| Some((found.ratio()?, found.clone())));
        known.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let (unit, factor) = deflection_unit(scene.units);
    let row = |direction: &str| {
        let (ratio, found) = worst(first, direction)?;
        let same = others.iter().filter_map(|other| worst(other, direction));
        let words = format!("{direction} deflection from the chord");
        Some(GoverningRow {
            more: format!(" = L/{ratio:.0}"),
            x: TableCell::from(digits(found.x, DIGITS)),
            others: same.map(|(_, found)| found.value).collect(),
            ..GoverningRow::new(&words, (unit, factor), found.value, &found.rail, found.time)
        })
    };
    ["vertical", "lateral"]
        .into_iter()
        .filter_map(row)
        .collect()
}

/// Largest and smallest vertical wheel force, and the largest lateral one of either sign.
fn wheel_rows(scene: &Scene, first: &CaseResult, others: &[CaseResult]) -> Vec<GoverningRow> {
    let (unit, factor) = reading_unit(scene.units, Dimension::FORCE);
    // sign times value is sought; 0 stands for the magnitude
    let worst = |outcome: &CaseResult, part: &str, sign: f64| {
        let size = |value: f64| {
            if sign == 0.0 {
                value.abs()
            } else {
                sign * value
            }
        };
        let wheels = outcome.input.wheels.iter().enumerate();
        let peaks = wheels.filter_map(|(wheel, own)| {
            let peak = outcome.peak(&own.name, part)?;
            let at = if size(peak.min.value) > size(peak.max.value) {
                peak.min
            } else {
                peak.max
            };
            Some((at, wheel))
        });
        peaks.reduce(|a, b| {
            if size(b.0.value) > size(a.0.value) {
                b
            } else {
                a
            }
        })
    };
    let size = worst(first, "vertical", 0.0).map_or(0.0, |(at, _)| at.value.abs());
    let kinds = [
        ("largest vertical wheel force", "vertical", 1.0),
        ("smallest vertical wheel force", "vertical", -1.0),
        ("largest lateral wheel force", "lateral", 0.0),
    ];
    let row = |(words, part, sign): (&str, &str, f64)| {
        let (ColumnInstant { value, time }, wheel) = worst(first, part, sign)
            .filter(|(at, _)| part == "vertical" || !is_rounding(at.value, size))?;
        let name = &first.input.wheels[wheel].name;
        let x = first.columns.at_time(name, "x", time);
        Some(GoverningRow {
            x: x.map_or(TableCell::Empty, |x| TableCell::from(digits(x, DIGITS))),
            others: others
                .iter()
                .filter_map(|other| worst(other, part, sign))
                .map(|(at, _)| at.value)
                .collect(),
            size,
            ..GoverningRow::new(words, (&unit, factor), value, name, time)
        })
    };
    kinds.into_iter().filter_map(row).collect()
}

/// A reaction of the ground with its name and time.
type NamedReaction = (f64, f64, String);

/// Largest and smallest vertical reaction, and the largest lateral and longitudinal ones of either sign, of structures on the
/// ground.
fn reaction_rows(scene: &Scene, first: &CaseResult, others: &[CaseResult]) -> Vec<GoverningRow> {
    let (unit, factor) = reading_unit(scene.units, Dimension::FORCE);
    // sign times value is sought; 0 stands for the magnitude
    let worst = |outcome: &CaseResult, direction: Option<Direction>, sign: f64| {
        let size = |value: f64| {
            if sign == 0.0 {
                value.abs()
            } else {
                sign * value
            }
        };
        let all = ground_forces(scene, outcome, direction).into_iter();
        all.reduce(|best, next| {
            if size(next.0) > size(best.0) {
                next
            } else {
                best
            }
        })
    };
    let size = worst(first, Some(Direction::Vertical), 0.0).map_or(0.0, |(value, ..)| value.abs());
    let kinds = [
        ("largest vertical reaction", Some(Direction::Vertical), 1.0),
        (
            "smallest vertical reaction",
            Some(Direction::Vertical),
            -1.0,
        ),
        ("largest lateral reaction", Some(Direction::Lateral), 0.0),
        ("largest longitudinal reaction", None, 0.0),
    ];
    let row = |(words, direction, sign): (&str, Option<Direction>, f64)| {
        let (value, time, name) =
            worst(first, direction, sign).filter(|(value, ..)| !is_rounding(*value, size))?;
        let same = others
            .iter()
            .filter_map(|other| worst(other, direction, sign));
        Some(GoverningRow {
            others: same.map(|found| found.0).collect(),
            size,
            ..GoverningRow::new(words, (&unit, factor), value, &name, time)
        })
    };
    kinds.into_iter().filter_map(row).collect()
}

/// The extremes of the forces of the ground in a direction (`None`: along the rails); those of the history's columns for
/// structures whose girders have no extremes.
fn ground_forces(
    scene: &Scene,
    outcome: &CaseResult,
    direction: Option<Direction>,
) -> Vec<NamedReaction> {
    let mut out = Vec::new();
    let known = &outcome.girders().reactions;
    for own in known
        .iter()
        .filter(|own| scene.structures[own.structure].carrier.is_none())
    {
        if own.relative == direction && own.direction < Dof::Rx {
            out.push((
                own.value,
                own.time,
                format!("{} {}", own.support, own.direction),
            ));
        }
    }
    let is_ground = ground_reactions(scene);
    for (column, envelope) in outcome
        .response
        .columns
        .iter()
        .zip(&outcome.response.envelopes)
    {
        let is_known = known
            .iter()
            .any(|own| column.name.starts_with(&format!("{}.", own.support)));
        if direction.is_some() && column.direction == direction && is_ground(column) && !is_known {
            let extremes = [&envelope.max, &envelope.min];
            out.extend(extremes.map(|extreme| (extreme.value, extreme.time, column.name.clone())));
        }
    }
    out
}
