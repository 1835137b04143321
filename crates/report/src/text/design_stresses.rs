//! Stresses, end stops and pairs of rails of a design.

use ::design::{DesignResult, StressCheck, WheelStress};
use formats::LateralSection;
use formats::design::Design;
use formats::units::{Dimension, Units};

use crate::figures::design::{deflection_unit, digits, positions, reading_unit};
use crate::{ReportSection, ReportTable, TableCell, TableColumn};

/// Significant digits of values.
const DIGITS: usize = 4;

/// Unit of stresses for reading, and the factor from `units`.
pub(super) fn stress_unit(units: Units) -> (String, f64) {
    let (unit, factor) = reading_unit(units, Dimension::STRESS);
    (unit.replace("kip/in\u{b2}", "ksi"), factor)
}

/// The largest stress of each kind on each rail over all cases; nothing where no stress is known.
pub(super) fn governing_stresses(design: &Design, result: &DesignResult) -> Option<ReportTable> {
    let (unit, factor) = stress_unit(design.units);
    let length = design.units.label(Dimension::LENGTH);
    let columns = [
        ("stress", ""),
        ("rail", ""),
        ("case", ""),
        ("value", unit.as_str()),
        ("strength", unit.as_str()),
        ("utilisation", ""),
        ("x", length.as_str()),
        ("position of the train", length.as_str()),
    ];
    let mut out = table(
        "Largest stresses of each rail, dead load and factors included",
        &columns,
    );
    for rail in design.spec.rails() {
        for quantity in ["direct stress", "shear stress in the web"] {
            let own = result
                .stresses
                .iter()
                .filter(|check| check.rail == rail.name && check.quantity == quantity);
            let worst = own.reduce(|a, b| {
                if b.utilisation() > a.utilisation() {
                    b
                } else {
                    a
                }
            });
            out.rows.extend(worst.map(|check| {
                vec![
                    TableCell::from(place(check)),
                    TableCell::from(check.rail.clone()),
                    TableCell::from(check.case),
                    TableCell::from(digits(factor * check.value, DIGITS)),
                    TableCell::from(digits(factor * check.strength, DIGITS)),
                    TableCell::from(format!("{:.0} %", 100.0 * check.utilisation())),
                    TableCell::from(digits(check.governing.x, DIGITS)),
                    TableCell::from(positions(&check.governing)),
                ]
            }));
        }
        let own = result
            .wheel_stresses
            .iter()
            .filter(|found| found.rail == rail.name);
        let worst = own.reduce(|a, b| if b.vertical > a.vertical { b } else { a });
        out.rows.extend(worst.map(|found| {
            let strength = |text: &dyn Fn(f64) -> String| {
                found
                    .yield_strength
                    .map_or(TableCell::Empty, |fy| TableCell::from(text(fy)))
            };
            vec![
                TableCell::from("local stress in the web under a wheel"),
                TableCell::from(found.rail.clone()),
                TableCell::from(found.case),
                TableCell::from(digits(-factor * found.vertical, DIGITS)),
                strength(&|fy| digits(factor * fy, DIGITS)),
                strength(&|fy| format!("{:.0} %", 100.0 * found.vertical / fy)),
                TableCell::from("anywhere"),
                TableCell::Empty,
            ]
        }));
    }
    (!out.rows.is_empty()).then_some(out)
}

/// Stresses, end stops and pairs of rails in all cases, with their methods; nothing where the design has none.
pub(super) fn details(design: &Design, result: &DesignResult) -> Option<ReportSection> {
    let mut section = ReportSection::new("Stresses, end stops and pairs of rails");
    if !result.stresses.is_empty() {
        section = section
            .table(stresses(design, result))
            .paragraph(method(design));
    }
    if !result.wheel_stresses.is_empty() {
        section = section.table(wheel_stresses(design, result));
        for line in wheel_sources(result) {
            section = section.paragraph(line);
        }
    }
    if !result.end_stops.is_empty() {
        section = section.table(end_stops(design, result));
    }
    if !result.pairs.is_empty() {
        section = section.table(pairs(design, result));
    }
    (!section.tables.is_empty()).then_some(section)
}

fn table(caption: &str, columns: &[(&str, &str)]) -> ReportTable {
    ReportTable {
        caption: caption.to_owned(),
        columns: columns
            .iter()
            .map(|(name, unit)| TableColumn::new(*name, *unit))
            .collect(),
        rows: Vec::new(),
    }
}

fn stresses(design: &Design, result: &DesignResult) -> ReportTable {
    let (unit, factor) = stress_unit(design.units);
    let length = design.units.label(Dimension::LENGTH);
    let columns = [
        ("case", ""),
        ("rail", ""),
        ("stress", ""),
        ("section", ""),
        ("value", unit.as_str()),
        ("strength", unit.as_str()),
        ("utilisation", ""),
        ("of N, vertical, lateral", unit.as_str()),
        ("x", length.as_str()),
        ("position of the train", length.as_str()),
    ];
    let mut out = table(
        "Stresses and the yield strength, dead load and factors included",
        &columns,
    );
    for check in &result.stresses {
        let parts: Vec<String> = check
            .parts
            .iter()
            .map(|(_, part)| digits(factor * part, 3))
            .collect();
        let percent = 100.0 * check.utilisation();
        let bound = check.bound.map_or_else(String::new, |bound| {
            format!(" (at most {:.0} %)", 100.0 * bound)
        });
        out.rows.push(vec![
            TableCell::from(check.case),
            TableCell::from(check.rail.clone()),
            TableCell::from(place(check)),
            TableCell::from(check.section.clone()),
            TableCell::from(digits(factor * check.value, DIGITS)),
            TableCell::from(digits(factor * check.strength, DIGITS)),
            TableCell::from(format!("{percent:.0} %{bound}")),
            TableCell::from(parts.join(", ")),
            TableCell::from(digits(check.governing.x, DIGITS)),
            TableCell::from(positions(&check.governing)),
        ]);
    }
    out
}

/// The stress with its fibre.
fn place(check: &StressCheck) -> String {
    match check.fibre {
        Some(fibre) => format!("{}, {fibre}", check.quantity),
        None => check.quantity.to_owned(),
    }
}

/// What resists lateral moments, as the end of a sentence.
pub(super) fn lateral_words(lateral: LateralSection) -> &'static str {
    match lateral {
        LateralSection::Whole => {
            "the whole section resists lateral moments, and warping by torsion is not included"
        }
        LateralSection::TopFlange => {
            "the top flange alone resists lateral moments, M/(t b\u{b2}/6)"
        }
    }
}

/// How the stresses follow from the forces.
fn method(design: &Design) -> String {
    let lateral = lateral_words(design.practice.lateral_section);
    format!(
        "Direct stress is N/A + M z/I + M y/I at the edges of the flanges, from coincident forces of the states that govern \
         normal force and moments; it is not an exact envelope, and the utilisation in brackets is not exceeded by any state. \
         Here {lateral}. Shear stress is V/(h t) of the web, against the yield strength over \u{221a}3. Partial factors and \
         stability are not included."
    )
}

fn wheel_stresses(design: &Design, result: &DesignResult) -> ReportTable {
    let (unit, factor) = stress_unit(design.units);
    let (short, to_short) = deflection_unit(design.units);
    let force = design.units.label(Dimension::FORCE);
    let columns = [
        ("case", ""),
        ("rail", ""),
        ("crane rail on section", ""),
        ("largest wheel", force.as_str()),
        ("effective length", short),
        ("vertical stress", unit.as_str()),
        ("of yield strength", ""),
        ("local shear", unit.as_str()),
        ("with the girder's shear", unit.as_str()),
        ("cycles of a passage: vertical, shear", unit.as_str()),
    ];
    let mut out = table(
        "Local stresses in the web under a wheel, with the factors of the case",
        &columns,
    );
    for found in &result.wheel_stresses {
        let cycle = |range: &::design::WheelCycle| {
            format!(
                "{}, {}",
                digits(factor * range.vertical, 3),
                digits(factor * range.shear, 3)
            )
        };
        let used = found
            .yield_strength
            .map(|fy| format!("{:.0} %", 100.0 * found.vertical / fy));
        out.rows.push(vec![
            TableCell::from(found.case),
            TableCell::from(found.rail.clone()),
            TableCell::from(format!("{} on {}", found.crane_rail, found.section)),
            TableCell::from(digits(found.force, DIGITS)),
            TableCell::from(digits(to_short * found.length, DIGITS)),
            TableCell::from(digits(factor * found.vertical, DIGITS)),
            used.map_or(TableCell::Empty, TableCell::from),
            TableCell::from(digits(factor * found.shear, DIGITS)),
            TableCell::from(digits(factor * found.total_shear(), DIGITS)),
            TableCell::from(
                found
                    .cycles
                    .iter()
                    .map(cycle)
                    .collect::<Vec<_>>()
                    .join("; "),
            ),
        ]);
    }
    out
}

/// The clause of each effective length, with the fastening that it is for.
fn wheel_sources(result: &DesignResult) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    let line = |found: &WheelStress| {
        let (word, is_assumed) = found.fastening;
        let rail = match word {
            "rigid" => "a rail that is rigidly fastened",
            "pad" => "a rail on an elastic pad",
            _ => "a loose rail",
        };
        let assumed = if is_assumed {
            ", which is assumed: specify `rail_fastening`"
        } else {
            ""
        };
        let clause = &found.clause;
        format!(
            "Effective length: {}, {}, for {rail}{assumed} ({}).",
            clause.standard,
            clause.clause,
            clause.evidence.words()
        )
    };
    for found in &result.wheel_stresses {
        let line = line(found);
        if !out.contains(&line) {
            out.push(line);
        }
    }
    out
}

fn end_stops(design: &Design, result: &DesignResult) -> ReportTable {
    let (force, length) = (
        design.units.label(Dimension::FORCE),
        design.units.label(Dimension::LENGTH),
    );
    let columns = [
        ("case", ""),
        ("train", ""),
        ("rail", ""),
        ("stop at x", length.as_str()),
        ("factor", ""),
        ("force along the rail", force.as_str()),
    ];
    let mut out = table(
        "Forces of buffers on the end stops, at the height of the rail",
        &columns,
    );
    for found in &result.end_stops {
        out.rows.push(vec![
            TableCell::from(found.case),
            TableCell::from(found.train.clone()),
            TableCell::from(found.rail.clone()),
            TableCell::from(digits(found.x, DIGITS)),
            TableCell::from(digits(found.factor, DIGITS)),
            TableCell::from(digits(found.force, DIGITS)),
        ]);
    }
    out
}

fn pairs(design: &Design, result: &DesignResult) -> ReportTable {
    let (unit, factor) = deflection_unit(design.units);
    let length = design.units.label(Dimension::LENGTH);
    let columns = [
        ("case", ""),
        ("rails", ""),
        ("", ""),
        ("distance", length.as_str()),
        ("value", unit),
        ("x", length.as_str()),
        ("position of the train", length.as_str()),
    ];
    let caption = "Two rails under a train on both, without dead load, in the states that govern the deflections of \
                   either rail";
    let mut out = table(caption, &columns);
    for found in &result.pairs {
        out.rows.push(vec![
            TableCell::from(found.case),
            TableCell::from(found.rails.join(", ")),
            TableCell::from(found.quantity),
            TableCell::from(digits(found.distance, DIGITS)),
            TableCell::from(digits(factor * found.value, DIGITS)),
            TableCell::from(digits(found.x, DIGITS)),
            TableCell::from(positions(&found.governing)),
        ]);
    }
    out
}
