//! The values that govern a design, below its verdict.

use crate::figures::design::{
    deflection_unit, digits, positions, reading_unit, unit_of, with_unit,
};
use crate::figures::influence_lines::subject_words;
use crate::figures::rail_sketch::RailSketch;
use crate::text::design_stresses::governing_stresses;
use crate::{ReportSection, ReportTable, TableCell, TableColumn};
use ::design::{
    DesignResult, GoverningLine, LineSubject, ReactionExtremes, governing_reaction, plane_word,
};
use formats::design::Design;
use formats::units::Dimension;
use trains::{GirderResponse, Governing, SpanDeflection, SpanExtreme};

/// Significant digits of values in the report.
pub(super) const DIGITS: usize = 4;
/// Largest number of warnings and notes on the first page.
const MOST: usize = 5;

/// Which governing values stand on the first page, with their words.
const GOVERNING: [(GirderResponse, bool, &str); 7] = [
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
    (GirderResponse::Torsion, true, "largest torsion"),
    (
        GirderResponse::VerticalDeflection,
        true,
        "largest deflection downwards",
    ),
];

/// The governing values, warnings, and the position that causes the largest sagging moment.
pub(super) fn governing(
    design: &Design,
    result: &DesignResult,
    lines: &[GoverningLine],
) -> ReportSection {
    let mut section = ReportSection::new("Governing values");
    section.paragraphs.extend(fatigue_sentence(design, result));
    let notes = result
        .warnings
        .iter()
        .map(|text| format!("Warning: {text}."));
    let notes: Vec<String> = notes
        .chain(
            design
                .spec
                .notes
                .iter()
                .map(|text| format!("Note: {text}.")),
        )
        .collect();
    let more = notes.len().saturating_sub(MOST);
    section.paragraphs.extend(notes.into_iter().take(MOST));
    if more > 0 {
        section = section.paragraph(format!(
            "{more} more warnings and notes are in the section on the method."
        ));
    }
    section = section.table(governing_table(design, result));
    if let Some(table) = governing_stresses(design, result) {
        section = section.table(table);
    }
    if let Some((line, rail)) = largest_sagging(lines) {
        let (force, factor) = reading_unit(design.units, Dimension::FORCE);
        let sketch = RailSketch {
            range: design.spec.rails()[rail].range,
            supports: &design.spans[rail],
            length_unit: &design.units.label(Dimension::LENGTH),
            wheels: line
                .wheels
                .iter()
                .filter(|wheel| wheel.rail == rail)
                .map(|wheel| (wheel.x, factor * wheel.force))
                .collect(),
            section: Some(line.governing.x),
        };
        let caption = format!(
            "The position of the wheels that causes the {} (case {}), drawn to scale along the rail; at each wheel \
             its vertical force in {force}, factors included, and its position in {}.",
            subject_words(design, line),
            line.case + 1,
            design.units.label(Dimension::LENGTH),
        );
        section = section.figure(sketch.svg("Governing position of the wheels"), caption);
    }
    section
}

/// The line of the largest sagging moment of all rails, with its rail.
fn largest_sagging(lines: &[GoverningLine]) -> Option<(&GoverningLine, usize)> {
    let own = lines.iter().filter_map(|line| match line.subject {
        LineSubject::Girder {
            rail,
            quantity: GirderResponse::VerticalMoment,
            ..
        } if line.is_max => Some((line, rail)),
        _ => None,
    });
    own.reduce(|best, next| {
        if next.0.governing.value > best.0.governing.value {
            next
        } else {
            best
        }
    })
}

/// The largest damage-equivalent wheel load.
fn fatigue_sentence(design: &Design, result: &DesignResult) -> Option<String> {
    let all = result
        .fatigue
        .iter()
        .flat_map(|loads| loads.wheels.iter().map(move |wheel| (loads, wheel)));
    let (loads, wheel) =
        all.reduce(|best, next| if next.1[0] > best.1[0] { next } else { best })?;
    let (unit, factor) = reading_unit(design.units, Dimension::FORCE);
    let [normal, shear] = wheel.map(|force| with_unit(&digits(factor * force, DIGITS), &unit));
    Some(format!(
        "Fatigue: the largest damage-equivalent wheel load is {normal} for direct stress and {shear} for shear stress \
         (train {}, EN 1991-3:2006, 2.12.1).",
        loads.train
    ))
}

/// The values that govern over all cases, rails and spans.
fn governing_table(design: &Design, result: &DesignResult) -> ReportTable {
    let columns = [
        "",
        "value",
        "dead load",
        "case",
        "rail or support",
        "span",
        "x",
        "position of the train",
    ];
    let mut table = ReportTable {
        caption: "Governing values, dead load and factors included; deflections from the chord are those of the trains \
                  alone"
            .to_owned(),
        columns: columns.iter().map(|name| TableColumn::new(*name, "")).collect(),
        rows: Vec::new(),
    };
    let length = design.units.label(Dimension::LENGTH);
    table.columns[6].unit = length.clone();
    table.columns[7].unit = length;
    let rails = design.spec.rails();
    for (quantity, is_max, words) in GOVERNING {
        let Some((case, found)) = largest(result, quantity, is_max) else {
            continue;
        };
        let (unit, factor) = unit_of(design.units, quantity);
        let g = &found.governing;
        let place = Some((found.span, g.x));
        table.rows.push(row(
            words,
            (g, factor, &unit),
            case,
            &rails[found.rail].name,
            place,
        ));
    }
    for plane in ["vertical", "lateral"] {
        let Some((case, found)) = largest_from_chord(result, plane) else {
            continue;
        };
        let (unit, factor) = deflection_unit(design.units);
        let ratio = ((found.ends[1] - found.ends[0]) / found.governing.value).abs();
        let words = format!("{plane} deflection from the chord");
        let g = &found.governing;
        let place = Some((found.span, g.x));
        let mut cells = row(
            &words,
            (g, factor, unit),
            case,
            &rails[found.rail].name,
            place,
        );
        cells[1] = TableCell::from(format!(
            "{} = L/{ratio:.0}",
            with_unit(&digits(factor * g.value, DIGITS), unit)
        ));
        table.rows.push(cells);
    }
    let (unit, factor) = reading_unit(design.units, Dimension::FORCE);
    for (words, is_max) in [
        ("largest vertical reaction", true),
        ("smallest vertical reaction", false),
    ] {
        let Some((case, reaction, g)) = governing_reaction(design, result, is_max) else {
            continue;
        };
        table.rows.push(row(
            words,
            (g, factor, &unit),
            case,
            &reaction.name.support,
            None,
        ));
    }
    for direction in ["ux", "uy", "uz"] {
        let is_vertical = governing_reaction(design, result, true)
            .is_some_and(|(_, own, _)| own.name.direction == direction);
        if is_vertical {
            continue;
        }
        let Some((case, reaction, g)) = largest_horizontal(result, direction) else {
            continue;
        };
        let words = format!("largest horizontal reaction, {direction}");
        table.rows.push(row(
            &words,
            (g, factor, &unit),
            case,
            &reaction.name.support,
            None,
        ));
    }
    table
}

/// A row of the governing values; `place` is the span with the coordinate of a section.
fn row(
    words: &str,
    (governing, factor, unit): (&Governing, f64, &str),
    case: usize,
    name: &str,
    place: Option<(usize, f64)>,
) -> Vec<TableCell> {
    let [span, x] = place.map_or([TableCell::Empty, TableCell::Empty], |(span, x)| {
        [TableCell::from(span), TableCell::from(digits(x, DIGITS))]
    });
    vec![
        TableCell::from(words),
        TableCell::from(with_unit(&digits(factor * governing.value, DIGITS), unit)),
        TableCell::from(digits(factor * governing.dead, DIGITS)),
        TableCell::from(case + 1),
        TableCell::from(name),
        span,
        x,
        TableCell::from(positions(governing)),
    ]
}

/// The extreme of largest size over all cases, rails and spans.
fn largest(
    result: &DesignResult,
    quantity: GirderResponse,
    is_max: bool,
) -> Option<(usize, &SpanExtreme)> {
    let sign = if is_max { 1.0 } else { -1.0 };
    let all = result.cases.iter().enumerate().flat_map(|(case, solved)| {
        solved
            .envelopes
            .extremes
            .iter()
            .map(move |extreme| (case, extreme))
    });
    let own = all.filter(|(_, e)| {
        e.quantity == quantity && e.is_max == is_max && sign * e.governing.value > 0.0
    });
    own.reduce(|best, next| {
        if sign * next.1.governing.value > sign * best.1.governing.value {
            next
        } else {
            best
        }
    })
}

/// The deflection from the chord of a span that is the largest part of the span, over all cases.
fn largest_from_chord<'r>(
    result: &'r DesignResult,
    plane: &str,
) -> Option<(usize, &'r SpanDeflection)> {
    let part =
        |found: &SpanDeflection| found.governing.value.abs() / (found.ends[1] - found.ends[0]);
    let all = result.cases.iter().enumerate();
    let all = all.flat_map(|(case, own)| {
        own.envelopes
            .deflections
            .iter()
            .map(move |found| (case, found))
    });
    let own = all.filter(|(_, found)| {
        plane_word(found.quantity) == plane && part(found) > 0.0 && (1.0 / part(found)).is_finite()
    });
    own.reduce(|best, next| {
        if part(next.1) > part(best.1) {
            next
        } else {
            best
        }
    })
}

/// The reaction of the largest size in a direction, over all cases.
fn largest_horizontal<'r>(
    result: &'r DesignResult,
    direction: &str,
) -> Option<(usize, &'r ReactionExtremes, &'r Governing)> {
    let all = result.cases.iter().enumerate().flat_map(|(case, own)| {
        let own = own
            .reactions
            .iter()
            .filter(|reaction| reaction.name.direction == direction);
        own.flat_map(move |reaction| reaction.extremes.iter().map(move |g| (case, reaction, g)))
    });
    all.filter(|(.., g)| g.value != 0.0).reduce(|best, next| {
        if next.2.value.abs() > best.2.value.abs() {
            next
        } else {
            best
        }
    })
}
