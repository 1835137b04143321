//! The report of a design: the verdict first, then envelopes, reactions and inputs.

use crate::figures::design::{deflection_unit, digits, envelope_charts, position_sketch, unit_of};
use crate::text::design_codes::{codes, limits, sources};
use crate::text::design_stresses::{details, governing_stresses, utilisation};
use crate::{Report, ReportSection, ReportTable, TableCell, TableColumn};
use ::design::{DesignResult, ReactionExtremes, SolvedCase, load_word, plane_word, quantity_word};
use formats::design::{Design, DesignTrain};
use formats::units::Dimension;
use trains::{GirderResponse, Governing, SectionSide, SpanExtreme};

/// Significant digits of values in the report.
const DIGITS: usize = 4;
/// Values below this fraction of the largest of their kind are shown as zero.
const ROUNDING: f64 = 1e-9;

/// The report of a design.
#[must_use]
pub fn design_report(design: &Design, result: &DesignResult) -> Report {
    let mut sections = vec![verdict(design, result)];
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
    sections.push(method(result));
    let units = format!("{}, {}", design.units.length.word(), design.units.force.word());
    Report {
        title: format!("Design of {}", design.name),
        subtitle: format!("Static envelopes of wheel trains; structure {}; units {units}", design.spec_file),
        sections,
    }
}

/// Which governing values stand on the first page, with their words.
const GOVERNING: [(GirderResponse, bool, &str); 7] = [
    (GirderResponse::VerticalMoment, true, "largest sagging moment"),
    (GirderResponse::VerticalMoment, false, "largest hogging moment"),
    (GirderResponse::VerticalShear, true, "largest shear force"),
    (GirderResponse::VerticalShear, false, "smallest shear force"),
    (GirderResponse::LateralMoment, true, "largest lateral moment"),
    (GirderResponse::Torsion, true, "largest torsion"),
    (GirderResponse::VerticalDeflection, true, "largest deflection downwards"),
];

/// The first page: what governs, whether limits are kept, and the position that causes the largest moment.
fn verdict(design: &Design, result: &DesignResult) -> ReportSection {
    let mut section = ReportSection::new("Verdict");
    section = section.paragraph(sentence(result));
    if let Some(line) = utilisation(result) {
        section = section.paragraph(line);
    }
    if let Some(table) = governing_stresses(design, result) {
        section = section.table(table);
    }
    for warning in &result.warnings {
        section = section.paragraph(format!("Warning: {warning}."));
    }
    for note in &design.spec.notes {
        section = section.paragraph(format!("Note: {note}."));
    }
    let columns = ["", "value", "case", "rail or support", "span", "x", "position of the train"];
    let mut table = ReportTable {
        caption: "Governing values, dead load and factors included".to_owned(),
        columns: columns.iter().map(|name| TableColumn::new(*name, "")).collect(),
        rows: Vec::new(),
    };
    let length = design.units.label(Dimension::LENGTH);
    table.columns[5].unit = length.clone();
    table.columns[6].unit = length;
    let rails = design.spec.rails();
    for (quantity, is_max, words) in GOVERNING {
        let Some((case, found)) = largest(result, quantity, is_max) else { continue };
        let (unit, factor) = unit_of(design.units, quantity);
        table.rows.push(vec![
            TableCell::from(words),
            TableCell::from(with_unit(digits(factor * found.governing.value, DIGITS), &unit)),
            TableCell::from(case + 1),
            TableCell::from(rails[found.rail].name.clone()),
            TableCell::from(found.span),
            TableCell::from(digits(found.governing.x, DIGITS)),
            TableCell::from(positions(&found.governing)),
        ]);
    }
    for (words, is_max) in [("largest vertical reaction", true), ("smallest vertical reaction", false)] {
        let Some((case, reaction, governing)) = largest_reaction(design, result, is_max) else { continue };
        table.rows.push(vec![
            TableCell::from(words),
            TableCell::from(with_unit(
                digits(governing.value, DIGITS),
                &design.units.label(Dimension::FORCE),
            )),
            TableCell::from(case + 1),
            TableCell::from(reaction.name.support.clone()),
            TableCell::Empty,
            TableCell::Empty,
            TableCell::from(positions(governing)),
        ]);
    }
    section = section.table(table).table(deflections(design, result));
    if !result.limits.is_empty() {
        section = section.table(limits(design, result));
        for line in sources(result) {
            section = section.paragraph(line);
        }
    }
    if let Some((case, found)) = largest(result, GirderResponse::VerticalMoment, true) {
        let caption = format!(
            "The position that causes the largest sagging moment, {} {} at x = {} (case {}); wheel forces without \
             factors.",
            digits(found.governing.value, DIGITS),
            design.units.label(Dimension::MOMENT),
            digits(found.governing.x, DIGITS),
            case + 1
        );
        section = section.figure(position_sketch(design, case, found.rail, &found.governing), caption);
    }
    section
}

/// A value and its unit, which stay on one line.
fn with_unit(value: String, unit: &str) -> String {
    format!("{value}\u{a0}{}", unit.replace(' ', "\u{a0}"))
}

/// Side of a section in words; nothing where both sides are the same.
const fn side(side: SectionSide) -> &'static str {
    match side {
        SectionSide::Before => "just before",
        SectionSide::At => "",
        SectionSide::Behind => "just behind",
    }
}

/// One sentence that says whether all limits are kept.
fn sentence(result: &DesignResult) -> String {
    let failed = result.limits.iter().filter(|limit| !limit.within()).count();
    match (result.limits.len(), failed) {
        (0, _) => "No limits of a code were checked: the design names no code.".to_owned(),
        (count, 0) => format!("All {count} limits of the code are kept."),
        (count, failed) => format!("{failed} of {count} limits of the code are exceeded."),
    }
}

/// The extreme of largest size over all cases, rails and spans.
fn largest(result: &DesignResult, quantity: GirderResponse, is_max: bool) -> Option<(usize, &SpanExtreme)> {
    let sign = if is_max { 1.0 } else { -1.0 };
    let all = result
        .cases
        .iter()
        .enumerate()
        .flat_map(|(case, solved)| solved.envelopes.extremes.iter().map(move |extreme| (case, extreme)));
    let own =
        all.filter(|(_, e)| e.quantity == quantity && e.is_max == is_max && sign * e.governing.value > 0.0);
    own.reduce(
        |best, next| if sign * next.1.governing.value > sign * best.1.governing.value { next } else { best },
    )
}

/// The largest or smallest vertical reaction over all cases.
fn largest_reaction<'r>(
    design: &Design,
    result: &'r DesignResult,
    is_max: bool,
) -> Option<(usize, &'r ReactionExtremes, &'r Governing)> {
    let up = vertical_direction(design)?;
    let sign = if is_max { 1.0 } else { -1.0 };
    let all = result.cases.iter().enumerate().flat_map(|(case, solved)| {
        solved
            .reactions
            .iter()
            .map(move |reaction| (case, reaction, &reaction.extremes[usize::from(!is_max)]))
    });
    let own = all.filter(|(_, reaction, _)| reaction.name.direction == up);
    own.reduce(|best, next| if sign * next.2.value > sign * best.2.value { next } else { best })
}

/// Word of the global direction that is nearest to up.
fn vertical_direction(design: &Design) -> Option<&'static str> {
    let (model, _) = design.spec.model().ok()?;
    let axis = (0..3).max_by(|&a, &b| model.up[a].abs().total_cmp(&model.up[b].abs()))?;
    Some(["ux", "uy", "uz"][axis])
}

/// Positions of the trains of a state, turned ones marked.
fn positions(governing: &Governing) -> String {
    let each = governing.trains.iter().map(|train| {
        let turned = if train.stance.turned { " turned" } else { "" };
        format!("{}{turned}", digits(train.position, DIGITS))
    });
    each.collect::<Vec<_>>().join("; ")
}

fn deflections(design: &Design, result: &DesignResult) -> ReportTable {
    let (unit, factor) = deflection_unit(design.units);
    let rails = design.spec.rails();
    let mut table = ReportTable {
        caption: "Deflections from the chords of the spans under the trains alone, without dead load"
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
    let mut table = ReportTable {
        caption: format!("Extremes of case {} over each span, dead load and factors included", index + 1),
        columns: [
            "rail",
            "span",
            "quantity",
            "",
            "value",
            "of dead load",
            "x",
            "side",
            "position of the train",
        ]
        .iter()
        .map(|name| TableColumn::new(*name, ""))
        .collect(),
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
        if g.value.abs() <= ROUNDING * size(found.quantity) {
            continue;
        }
        let (unit, factor) = unit_of(design.units, found.quantity);
        let word = quantity_word(found.quantity);
        let is_plain = matches!(found.quantity, GirderResponse::Normal | GirderResponse::Torsion);
        let name = if is_plain { word.to_owned() } else { format!("{} {word}", plane_word(found.quantity)) };
        table.rows.push(vec![
            TableCell::from(rails[found.rail].name.clone()),
            TableCell::from(found.span),
            TableCell::from(name),
            TableCell::from(if found.is_max { "largest" } else { "smallest" }),
            TableCell::from(with_unit(digits(factor * g.value, DIGITS), &unit)),
            TableCell::from(digits(factor * g.dead, DIGITS)),
            TableCell::from(digits(g.x, DIGITS)),
            TableCell::from(side(g.side)),
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
         alone occur at positions of their own; the last column has the extremes of all loads together.",
    );
    let unit = design.units.label(Dimension::FORCE);
    for (index, case) in result.cases.iter().enumerate() {
        let mut columns = vec![TableColumn::new("support", ""), TableColumn::new("direction", "")];
        columns.push(TableColumn::new("dead", &unit));
        for (kind, _) in &case.by_load {
            let word = load_word(*kind);
            columns.push(TableColumn::new(format!("{word}, largest"), &unit));
            columns.push(TableColumn::new("smallest", &unit));
        }
        columns.push(TableColumn::new("all, largest", &unit));
        columns.push(TableColumn::new("smallest", &unit));
        let size = case.reactions.iter().flat_map(|r| &r.extremes).map(|g| g.value.abs()).fold(0.0, f64::max);
        let shown =
            |value: f64| if value.abs() <= ROUNDING * size { "0".to_owned() } else { digits(value, DIGITS) };
        let mut rows = Vec::new();
        for (k, reaction) in case.reactions.iter().enumerate() {
            let mut row = vec![
                TableCell::from(reaction.name.support.clone()),
                TableCell::from(reaction.name.direction.clone()),
                TableCell::from(shown(reaction.extremes[0].dead)),
            ];
            let alone = case.by_load.iter().flat_map(|(_, all)| &all[k].extremes);
            row.extend(alone.chain(&reaction.extremes).map(|g| TableCell::from(shown(g.value))));
            rows.push(row);
        }
        let caption = format!(
            "Reactions in case {} ({}), with its factors; moments (rx, ry, rz) in {}",
            index + 1,
            case.name,
            design.units.label(Dimension::MOMENT)
        );
        section = section.table(ReportTable { caption, columns, rows });
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

/// Trains, cases and dead load as given.
fn inputs(design: &Design) -> ReportSection {
    let force = design.units.label(Dimension::FORCE);
    let length = design.units.label(Dimension::LENGTH);
    let mut section = ReportSection::new("Inputs");
    let rails = design.spec.rails();
    for (rail, spans) in rails.iter().zip(&design.spans) {
        let text: Vec<String> = spans.iter().map(|x| digits(*x, 6)).collect();
        section = section.fact(format!("rail {}: spans between", rail.name), text.join(", "), &length);
    }
    let gravity = design.dead.gravity;
    let weight =
        if gravity > 0.0 { format!("acts, g = {}", digits(gravity, 6)) } else { "does not act".to_owned() };
    section = section.fact("weight of the structure", weight, "");
    for (rail, line) in rails.iter().zip(&design.dead.lines).filter(|(_, line)| **line != 0.0) {
        let unit = design.units.label(Dimension::STIFFNESS);
        section = section.fact(format!("dead load along rail {}", rail.name), *line, unit);
    }
    for train in &design.trains {
        section = section.table(train_table(design, train, [&length, &force]));
    }
    let mut cases = ReportTable {
        caption: "Load cases; factors not listed are 1, those of skewing and buffer forces 0".to_owned(),
        columns: ["case", "name", "trains", "gap", "factors"]
            .iter()
            .map(|name| TableColumn::new(*name, ""))
            .collect(),
        rows: Vec::new(),
    };
    for (index, case) in design.cases.iter().enumerate() {
        let names: Vec<&str> = case.trains.iter().map(|&train| design.trains[train].name.as_str()).collect();
        let factors: Vec<String> =
            case.factors.iter().map(|(name, factor)| format!("{name} {}", digits(*factor, 6))).collect();
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
    let turned = if train.turned { "tried both ways round" } else { "not turned" };
    let signs =
        if train.reverses { "horizontal forces with either sign" } else { "horizontal forces as given" };
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
            [(_, force)] => vec![digits(*force, 6)],
            parts => parts.iter().map(|(name, force)| format!("{name} {}", digits(*force, 6))).collect(),
        };
        table.rows.push(vec![
            TableCell::from(k + 1),
            TableCell::from(rails[wheel.rail].name.clone()),
            TableCell::from(digits(wheel.x, 6)),
            TableCell::from(parts.join(" + ")),
            TableCell::from(digits(wheel.lateral, 6)),
            TableCell::from(digits(wheel.longitudinal, 6)),
            TableCell::from(digits(wheel.eccentricity, 6)),
        ]);
    }
    table
}

/// How the values were found, and what they are not.
fn method(result: &DesignResult) -> ReportSection {
    ReportSection::new("Method")
        .paragraph(
            "Influence lines of straight uniform members are piecewise cubic. At a fixed place every response to a train \
             is therefore piecewise cubic in its position, and the extremes of moments, shear forces and reactions are \
             roots of polynomials: nothing is sampled. A wheel just before and just behind a section are two states. \
             The largest deflections are found by bisection and enclosed by a bound.",
        )
        .paragraph(
            "Statics is of first order. Vertical is the plane of the member's axis and up; a positive moment sags, shear \
             is the derivative of the moment along the rail, a normal force is positive in tension. Loads act at the \
             height of the rail.",
        )
        .fact("bound of the relative error of influence coefficients", result.error_bound, "")
}
