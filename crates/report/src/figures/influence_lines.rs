//! Figures of influence lines with the wheels that govern above them.

use std::fmt::Write;

use super::design::{deflection_unit, digits, reading_unit, unit_of};
use super::rail_sketch::{FINE, INK, RailSketch, SECTION, WHEEL, WIDTH, placed_texts, write_text};
use crate::chart::{Svg, stack};
use ::design::{GoverningLine, LineSubject};
use formats::design::Design;
use formats::units::Dimension;
use formats::verdict::rail_phrase;
use trains::GirderResponse;

/// Height of the influence line, in pixels.
const HEIGHT: f64 = 110.0;
/// Space above and below it for ordinates, in pixels.
const SPACE: f64 = 32.0;
/// Distance in pixels within which wheels share the height of the label.
const NEAR: f64 = 30.0;
/// Distance of two lines of ordinates, in pixels.
const LINE: f64 = 13.0;
/// Fraction of the largest ordinate below which one is not written.
const SMALL: f64 = 0.02;

/// A governing value in words, such as `largest sagging moment under rail a, span 2`.
pub(crate) fn subject_words(design: &Design, line: &GoverningLine) -> String {
    match &line.subject {
        LineSubject::Girder {
            rail,
            span,
            quantity,
        } => {
            let word = match (quantity, line.is_max) {
                (GirderResponse::VerticalMoment, true) => "largest sagging moment",
                (GirderResponse::VerticalMoment, false) => "largest hogging moment",
                (GirderResponse::VerticalShear, true) => "largest shear force",
                (GirderResponse::VerticalShear, false) => "smallest shear force",
                (_, true) => "largest deflection downwards",
                (_, false) => "largest deflection upwards",
            };
            let name = rail_phrase(&design.spec.rails()[*rail].name);
            format!(
                "{word} under {name}, span {span}, x = {}",
                digits(line.governing.x, 4)
            )
        }
        LineSubject::Reaction { support, .. } => {
            let word = if line.is_max { "largest" } else { "smallest" };
            format!("{word} vertical reaction, {support}")
        }
    }
}

/// The influence line of a governing value for loads on each rail that matters, with its caption.
pub(crate) fn influence_figure(design: &Design, line: &GoverningLine) -> (Svg, String) {
    let rails = design.spec.rails();
    let length = design.units.label(Dimension::LENGTH);
    let (force, by_force) = reading_unit(design.units, Dimension::FORCE);
    let (unit, factor, ordinates) = match line.subject {
        LineSubject::Girder { quantity, .. } => {
            let (unit, factor) = unit_of(design.units, quantity);
            let per = match quantity {
                GirderResponse::VerticalMoment => format!(", in {length},"),
                GirderResponse::VerticalShear => String::new(),
                _ => format!(", in {} per {force},", deflection_unit(design.units).0),
            };
            (unit, factor, per)
        }
        LineSubject::Reaction { .. } => (force.clone(), by_force, String::new()),
    };
    let loaded = line.loaded_rails();
    let most = |rail: &usize| {
        line.points(*rail)
            .iter()
            .map(|p| p[1].abs())
            .fold(0.0, f64::max)
    };
    let scale = loaded.iter().map(most).fold(0.0, f64::max);
    let mut pictures = Vec::new();
    let mut names = Vec::new();
    for rail in loaded {
        let section = match line.subject {
            LineSubject::Girder { rail: own, .. } if own == rail => Some(line.governing.x),
            _ => None,
        };
        let wheels = line.wheels.iter().filter(|wheel| wheel.rail == rail);
        let sketch = RailSketch {
            range: rails[rail].range,
            supports: design.spans[rail].as_slice(),
            length_unit: &length,
            wheels: wheels
                .map(|wheel| (wheel.x, by_force * wheel.force))
                .collect(),
            section,
        };
        pictures.push(picture(line, rail, &sketch, (scale, factor / by_force)));
        names.push(rails[rail].name.as_str());
    }
    let value = |value: f64| digits(factor * value, 4);
    let rest = line.governing.value - line.governing.dead - line.of_wheels();
    let others = if rest.abs() > 1e-6 * line.governing.value.abs() {
        format!(", other loads {}", value(rest))
    } else {
        String::new()
    };
    let caption = format!(
        "Influence line of the {} (case {}, {}): response to a unit vertical load{ordinates} over its position on {}, \
         with the governing wheels, each with its force ({}, factors included) and position. Forces times ordinates \
         {}, dead load {}{others}; total {} {unit}.",
        subject_words(design, line),
        line.case + 1,
        design.cases[line.case].name,
        names.join(" (above) and "),
        force,
        value(line.of_wheels()),
        value(line.governing.dead),
        value(line.governing.value),
    );
    (stack(&pictures), caption)
}

/// The line for loads on one rail, with the wheels above it.
fn picture(
    line: &GoverningLine,
    rail: usize,
    sketch: &RailSketch<'_>,
    (largest, factor): (f64, f64),
) -> Svg {
    let mut out = "<title>Influence line with the governing wheels</title>\n".to_owned();
    let top = sketch.draw(&mut out, 4.0) + SPACE;
    let points = line.points(rail);
    // moments and deflections are drawn downwards, as engineers draw them
    let is_downwards = matches!(
        line.subject,
        LineSubject::Girder {
            quantity: GirderResponse::VerticalMoment | GirderResponse::VerticalDeflection,
            ..
        }
    );
    let sign = if is_downwards { 1.0 } else { -1.0 };
    let [low, high] = points
        .iter()
        .map(|point| sign * point[1] / largest)
        .fold([0.0_f64; 2], |[low, high], value| {
            [low.min(value), high.max(value)]
        });
    let scale = HEIGHT / (high - low).max(0.2);
    let zero = top - low * scale;
    let y = |value: f64| FINE * (zero + sign * value / largest * scale);
    let x = |place: f64| FINE * sketch.at(place);
    let mut path = String::new();
    for [place, value] in &points {
        let _ = write!(path, " L {:.0} {:.0}", x(*place), y(*value));
    }
    let [first, last] =
        [points.first(), points.last()].map(|point| point.map_or(0.0, |point| x(point[0])));
    let _ = writeln!(
        out,
        "<path d=\"M {first:.0} {0:.0}{path} L {last:.0} {0:.0} z\" fill=\"#DCE9F5\" stroke=\"{INK}\" \
         stroke-width=\"16\"/>\n<line x1=\"{first:.0}\" y1=\"{0:.0}\" x2=\"{last:.0}\" y2=\"{0:.0}\" stroke=\"{INK}\" \
         stroke-width=\"8\"/>",
        FINE * zero
    );
    let wheels: Vec<[f64; 4]> = line
        .wheels
        .iter()
        .filter(|wheel| wheel.rail == rail)
        .map(|wheel| {
            [
                sketch.at(wheel.x),
                y(wheel.ordinate) / FINE,
                wheel.ordinate,
                factor * wheel.ordinate,
            ]
        })
        .collect();
    write_ordinates(&mut out, &wheels, zero, SMALL * largest);
    if let Some(place) = sketch.section {
        let _ = writeln!(
            out,
            "<line x1=\"{0:.0}\" y1=\"{1:.0}\" x2=\"{0:.0}\" y2=\"{2:.0}\" stroke=\"{SECTION}\" stroke-width=\"10\" \
             stroke-dasharray=\"50 30\"/>",
            x(place),
            FINE * top,
            FINE * (zero + high * scale)
        );
    }
    Svg::new(WIDTH, zero + high * scale + SPACE, out)
}

/// Draws ordinates under wheels, and writes them beyond the line, each on its side of the axis at `zero`; those up to
/// `small` are not written. By wheel: abscissa and ordinate in the picture, value, value in the unit of reading.
fn write_ordinates(out: &mut String, wheels: &[[f64; 4]], zero: f64, small: f64) {
    for [x, y, ..] in wheels {
        let _ = writeln!(
            out,
            "<line x1=\"{0:.0}\" y1=\"{1:.0}\" x2=\"{0:.0}\" y2=\"{2:.0}\" stroke=\"{WHEEL}\" stroke-width=\"12\"/>\n\
             <circle cx=\"{0:.0}\" cy=\"{2:.0}\" r=\"32\" fill=\"{WHEEL}\"/>",
            FINE * x,
            FINE * zero,
            FINE * y
        );
    }
    let mut shown: Vec<[f64; 4]> = wheels
        .iter()
        .filter(|wheel| wheel[2].abs() > small)
        .copied()
        .collect();
    shown.sort_by(|a, b| a[0].total_cmp(&b[0]));
    for is_below in [false, true] {
        let own = || shown.iter().filter(|[_, y, ..]| (*y > zero) == is_below);
        let labels = own().map(|[x, _, _, value]| (*x, digits(*value, 4)));
        for label in placed_texts(labels.collect(), 2) {
            // neighbours share the height of the farthest one, which keeps the labels off the line
            let near = own()
                .filter(|[x, ..]| (x - label.x).abs() < NEAR)
                .map(|[_, y, ..]| *y);
            let edge = near
                .reduce(if is_below { f64::max } else { f64::min })
                .unwrap_or(zero);
            let level = LINE * label.level as f64;
            let y = if is_below {
                edge + 14.0 + level
            } else {
                edge - 5.0 - level
            };
            write_text(out, &label.text, [label.x, y], WHEEL);
        }
    }
}
