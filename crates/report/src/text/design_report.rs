//! The report of a design: the verdict first, then envelopes, reactions and inputs.

use crate::figures::design::{
    deflection_unit, digits, envelope_charts, positions, quantity_phrase, side_phrase, unit_of,
    with_unit,
};
use crate::figures::influence_lines::influence_figure;
use crate::text::checks::verdict_section;
use crate::text::design_basis::basis;
use crate::text::design_codes::{codes, limits, sources};
use crate::text::design_governing::{DIGITS, governing};
use crate::text::design_inputs::inputs;
use crate::text::design_stresses::details;
use crate::{Report, ReportSection, ReportTable, TableCell, TableColumn, cleared, is_rounding};
use ::design::{DesignResult, GoverningLine, SolvedCase, load_word, plane_word};
use formats::design::Design;
use formats::units::Dimension;
use trains::GirderResponse;

/// The report of a design; `lines` are the influence lines of its governing values.
#[must_use]
pub fn design_report(design: &Design, result: &DesignResult, lines: &[GoverningLine]) -> Report {
    let mut sections = vec![
        verdict_section("Verdict", &::design::verdict(design, result), design.units),
        governing(design, result, lines),
        basis(design, result),
    ];
    sections.push(serviceability(design, result));
    sections.extend(influence_lines(design, lines));
    for (index, case) in result.cases.iter().enumerate() {
        sections.push(extremes(design, case, index));
    }
    sections.extend(details(design, result));
    sections.push(reactions(design, result));
    for index in 0..result.cases.len() {
        sections.push(envelopes(design, result, index));
    }
    sections.extend(codes(design, result));
    sections.push(inputs(design));
    sections.push(method(design, result));
    let units = format!(
        "{}, {}",
        design.units.length.word(),
        design.units.force.word()
    );
    Report {
        title: format!("Design of {}", design.name),
        subtitle: format!(
            "Static envelopes of wheel trains; structure {}; units {units}",
            design.spec_file
        ),
        sections,
    }
}

/// Deflections of all spans from their chords, and all limits of the code.
fn serviceability(design: &Design, result: &DesignResult) -> ReportSection {
    let mut section =
        ReportSection::new("Deflections and limits").table(deflections(design, result));
    if !result.limits.is_empty() {
        section = section.table(limits(design, &result.limits));
        for line in sources(result) {
            section = section.paragraph(line);
        }
    }
    section
}

/// The influence lines of the governing values; `None` where there are none.
fn influence_lines(design: &Design, lines: &[GoverningLine]) -> Option<ReportSection> {
    if lines.is_empty() {
        return None;
    }
    let mut section = ReportSection::new("Influence lines").paragraph(
        "The response at the governing section, or of a support, to a unit vertical load on the rail, as a function \
         of the position of the load. The wheels are at their governing positions; the numbers beside the line are \
         its ordinates under the wheels. Moments and deflections are drawn downwards. All points are in influence.csv.",
    );
    for line in lines {
        let (picture, caption) = influence_figure(design, line);
        section = section.figure(picture, caption);
    }
    Some(section)
}

fn deflections(design: &Design, result: &DesignResult) -> ReportTable {
    let (unit, factor) = deflection_unit(design.units);
    let rails = design.spec.rails();
    let mut table = ReportTable {
        caption:
            "Deflections from the chords of the spans under the trains alone, without dead load"
                .to_owned(),
        columns: vec![
            TableColumn::new("case", ""),
            TableColumn::new("rail", ""),
            TableColumn::new("span", ""),
            TableColumn::new("direction", ""),
            TableColumn::new("deflection", unit),
            TableColumn::new("x", design.units.label(Dimension::LENGTH)),
            TableColumn::new("span/deflection", ""),
        ],
        rows: Vec::new(),
    };
    for (index, case) in result.cases.iter().enumerate() {
        for found in &case.envelopes.deflections {
            let value = found.governing.value;
            let ratio = ((found.ends[1] - found.ends[0]) / value).abs();
            if value == 0.0 || !ratio.is_finite() {
                continue;
            }
            table.rows.push(vec![
                TableCell::from(index + 1),
                TableCell::from(rails[found.rail].name.clone()),
                TableCell::from(found.span),
                TableCell::from(plane_word(found.quantity)),
                TableCell::from(digits(factor * value, DIGITS)),
                TableCell::from(digits(found.governing.x, DIGITS)),
                TableCell::from(format!("L/{ratio:.0}")),
            ]);
        }
    }
    table
}

/// All extremes of a case.
fn extremes(design: &Design, case: &SolvedCase, index: usize) -> ReportSection {
    let length = design.units.label(Dimension::LENGTH);
    let columns = [
        ("rail", ""),
        ("span", ""),
        ("quantity", ""),
        ("", ""),
        ("value", ""),
        ("of dead load", ""),
        ("x", &length),
        ("side", ""),
        ("position of the train", &length),
    ];
    let mut table = ReportTable {
        caption: format!(
            "Extremes of case {} over each span, dead load and factors included",
            index + 1
        ),
        columns: columns
            .map(|(name, unit)| TableColumn::new(name, unit))
            .to_vec(),
        rows: Vec::new(),
    };
    let rails = design.spec.rails();
    let all = &case.envelopes.extremes;
    let size = |quantity: GirderResponse| {
        let own = all.iter().filter(|e| e.quantity == quantity);
        own.map(|e| e.governing.value.abs()).fold(0.0, f64::max)
    };
    for found in all {
        let g = &found.governing;
        if is_rounding(g.value, size(found.quantity)) {
            continue;
        }
        let (unit, factor) = unit_of(design.units, found.quantity);
        table.rows.push(vec![
            TableCell::from(rails[found.rail].name.clone()),
            TableCell::from(found.span),
            TableCell::from(quantity_phrase(found.quantity)),
            TableCell::from(if found.is_max { "largest" } else { "smallest" }),
            TableCell::from(with_unit(&digits(factor * g.value, DIGITS), &unit)),
            TableCell::from(digits(factor * g.dead, DIGITS)),
            TableCell::from(digits(g.x, DIGITS)),
            TableCell::from(side_phrase(g.side)),
            TableCell::from(positions(g)),
        ]);
    }
    let heading = format!("Case {}: {}", index + 1, case.name);
    let mut section = ReportSection::new(heading).table(table);
    if !design.sections.is_empty() {
        let mut table = ReportTable {
            caption: format!("Internal forces of named sections in case {}", index + 1),
            columns: ["section", "largest", "smallest", "of dead load"]
                .iter()
                .map(|name| TableColumn::new(*name, ""))
                .collect(),
            rows: Vec::new(),
        };
        for (named, [most, least]) in design.sections.iter().zip(&case.sections) {
            table.rows.push(vec![
                TableCell::from(named.name.clone()),
                TableCell::from(digits(most.value, DIGITS)),
                TableCell::from(digits(least.value, DIGITS)),
                TableCell::from(digits(most.dead, DIGITS)),
            ]);
        }
        section = section.table(table);
    }
    section
}

/// Reactions of all cases by load, for the designer of the columns.
fn reactions(design: &Design, result: &DesignResult) -> ReportSection {
    let mut section = ReportSection::new("Reactions by load").paragraph(
        "Forces and moments of the ground on the structure, positive along the global axes. The extremes of each load \
         alone occur at different positions; the last column has the extremes of all loads together. Loads have the \
         factors of the case; skewing, buffer and tilting forces for which it has none are listed with the factor 1.",
    );
    let unit = design.units.label(Dimension::FORCE);
    for (index, case) in result.cases.iter().enumerate() {
        let mut columns = vec![
            TableColumn::new("support", ""),
            TableColumn::new("direction", ""),
        ];
        columns.push(TableColumn::new("dead", &unit));
        for (kind, _) in &case.by_load {
            let word = load_word(*kind);
            columns.push(TableColumn::new(format!("{word}, largest"), &unit));
            columns.push(TableColumn::new("smallest", &unit));
        }
        columns.push(TableColumn::new("all, largest", &unit));
        columns.push(TableColumn::new("smallest", &unit));
        let size = case
            .reactions
            .iter()
            .flat_map(|r| &r.extremes)
            .map(|g| g.value.abs())
            .fold(0.0, f64::max);
        let shown = |value: f64| digits(cleared(value, size), DIGITS);
        let (mut rows, mut zero) = (Vec::new(), Vec::new());
        for (k, reaction) in case.reactions.iter().enumerate() {
            let mut row = vec![
                TableCell::from(reaction.name.support.clone()),
                TableCell::from(reaction.name.direction.clone()),
                TableCell::from(shown(reaction.extremes[0].dead)),
            ];
            let values = || {
                case.by_load
                    .iter()
                    .flat_map(|(_, all)| &all[k].extremes)
                    .chain(&reaction.extremes)
            };
            if values().all(|g| is_rounding(g.value, size) && is_rounding(g.dead, size)) {
                zero.push(format!(
                    "{} {}",
                    reaction.name.support, reaction.name.direction
                ));
                continue;
            }
            let alone = case.by_load.iter().flat_map(|(_, all)| &all[k].extremes);
            row.extend(
                alone
                    .chain(&reaction.extremes)
                    .map(|g| TableCell::from(shown(g.value))),
            );
            rows.push(row);
        }
        let without = if zero.is_empty() {
            String::new()
        } else {
            format!("; zero: {}", zero.join(", "))
        };
        let caption = format!(
            "Reactions in case {} ({}), with its factors; moments (rx, ry, rz) in {}{without}",
            index + 1,
            case.name,
            design.units.label(Dimension::MOMENT)
        );
        section = section.table(ReportTable {
            caption,
            columns,
            rows,
        });
    }
    section
}

fn envelopes(design: &Design, result: &DesignResult, case: usize) -> ReportSection {
    let mut section = ReportSection::new(format!("Envelopes, case {}", case + 1));
    for rail in 0..design.spec.rails().len() {
        for (chart, caption) in envelope_charts(design, result, case, rail) {
            section = section.figure(chart, caption);
        }
    }
    section
}

/// How the values were found, and what they are not.
fn method(design: &Design, result: &DesignResult) -> ReportSection {
    let mut section = ReportSection::new("Method");
    for warning in &result.warnings {
        section = section.paragraph(format!("Warning: {warning}."));
    }
    for note in &design.spec.notes {
        section = section.paragraph(format!("Note: {note}."));
    }
    section
        .paragraph(
            "Influence lines of straight uniform members are piecewise cubic. At a fixed section every response to a \
             train is therefore piecewise cubic in its position, and the extremes of moments, shear forces and \
             reactions are roots of polynomials: nothing is sampled. A wheel just before a section and one just \
             behind it are separate states. The largest deflections are found by bisection and enclosed by a bound.",
        )
        .paragraph(
            "The analysis is static and of first order. Vertical is the plane of the member's axis and up; a positive \
             moment sags, shear is the derivative of the moment along the rail, a normal force is positive in \
             tension. Loads act at the height of the rail.",
        )
        .fact("bound of the relative error of influence coefficients", result.error_bound, "")
}
