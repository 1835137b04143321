//! Figures of a design: the rail with a governing position of the trains, and envelopes along it.

use std::fmt::Write;

use crate::chart::{Chart, ChartAxis, Series, Style, Svg};
use ::design::{DesignResult, plane_word, quantity_word};
use formats::design::Design;
use formats::units::{Dimension, Length, Units};
use trains::{GirderResponse, Governing};

/// Width of a sketch in pixels.
const WIDTH: f64 = 860.0;
/// Height of a sketch in pixels.
const HEIGHT: f64 = 150.0;
/// Space beside the girder, in pixels.
const MARGIN: f64 = 50.0;
/// Units of a picture in a pixel.
const FINE: f64 = 10.0;
/// Height of the axis of the girder in the sketch, in pixels from above.
const AXIS: f64 = 92.0;

/// Unit in which engineers read deflections, and its factor from `units`.
pub(crate) fn deflection_unit(units: Units) -> (&'static str, f64) {
    match units.length {
        Length::Metre | Length::Millimetre => ("mm", units.length.in_units_of(Length::Millimetre)),
        Length::Foot | Length::Inch => ("in", units.length.in_units_of(Length::Inch)),
    }
}

/// Unit of a quantity for reading, and the factor from `units`.
pub(crate) fn unit_of(units: Units, quantity: GirderResponse) -> (String, f64) {
    let plain = |dimension| (units.label(dimension), 1.0);
    match quantity {
        GirderResponse::VerticalDeflection | GirderResponse::LateralDeflection => {
            let (unit, factor) = deflection_unit(units);
            (unit.to_owned(), factor)
        }
        GirderResponse::Normal | GirderResponse::VerticalShear | GirderResponse::LateralShear => {
            plain(Dimension::FORCE)
        }
        _ => plain(Dimension::MOMENT),
    }
}

/// A rail with the ends of its spans, the section that governs and the wheels in the governing position.
pub(crate) fn position_sketch(design: &Design, case: usize, rail: usize, governing: &Governing) -> Svg {
    let [low, high] = design.spec.rails()[rail].range;
    let scale = (WIDTH - 2.0 * MARGIN) / (high - low);
    let at = |x: f64| FINE * (MARGIN + (x - low) * scale);
    let y = FINE * AXIS;
    let mut out = String::new();
    let _ = writeln!(
        out,
        "<title>Governing position of the trains</title>\n<line x1=\"{:.0}\" y1=\"{y:.0}\" x2=\"{:.0}\" y2=\"{y:.0}\" \
         stroke=\"#202020\" stroke-width=\"45\"/>",
        at(low),
        at(high)
    );
    for x in &design.spans[rail] {
        let _ = writeln!(
            out,
            "<path d=\"M {0:.0} {1:.0} l -80 140 h 160 z\" fill=\"#FFFFFF\" stroke=\"#202020\" stroke-width=\"12\"/>\n\
             <text x=\"{0:.0}\" y=\"{2:.0}\" font-size=\"120\" text-anchor=\"middle\">{3}</text>",
            at(*x),
            y + 22.0,
            y + 290.0,
            digits(*x, 4)
        );
    }
    let _ = writeln!(
        out,
        "<line x1=\"{0:.0}\" y1=\"{1:.0}\" x2=\"{0:.0}\" y2=\"{2:.0}\" stroke=\"#B00020\" stroke-width=\"15\" \
         stroke-dasharray=\"50 30\"/>\n<text x=\"{0:.0}\" y=\"{3:.0}\" font-size=\"120\" fill=\"#B00020\" \
         text-anchor=\"middle\">x = {4}</text>",
        at(governing.x),
        y - 110.0,
        y + 110.0,
        y + 440.0,
        digits(governing.x, 4)
    );
    for (x, force) in wheels(design, case, rail, governing) {
        let _ = writeln!(
            out,
            "<circle cx=\"{0:.0}\" cy=\"{1:.0}\" r=\"60\" fill=\"#FFFFFF\" stroke=\"#00539C\" stroke-width=\"15\"/>\n\
             <path d=\"M {0:.0} {2:.0} v 330 m -40 -90 l 40 90 l 40 -90\" fill=\"none\" stroke=\"#00539C\" \
             stroke-width=\"15\"/>\n<text x=\"{0:.0}\" y=\"{3:.0}\" font-size=\"120\" fill=\"#00539C\" \
             text-anchor=\"middle\">{4}</text>",
            at(x),
            y - 85.0,
            y - 490.0,
            y - 530.0,
            digits(force, 3)
        );
    }
    Svg::new(WIDTH, HEIGHT, out)
}

/// Coordinates and vertical forces of the wheels on a rail in a governing position.
fn wheels(design: &Design, case: usize, rail: usize, governing: &Governing) -> Vec<(f64, f64)> {
    let mut out = Vec::new();
    for (&train, standing) in design.cases[case].trains.iter().zip(&governing.trains) {
        let train = &design.trains[train];
        let first = train.wheels[0].rail;
        for wheel in train.wheels.iter().filter(|wheel| wheel.rail == rail && first == rail) {
            let ahead = if standing.stance.turned { -wheel.x } else { wheel.x };
            out.push((standing.position + ahead, wheel.vertical.iter().map(|(_, force)| force).sum()));
        }
    }
    out
}

/// A number in a few significant digits.
pub(crate) fn digits(value: f64, count: usize) -> String {
    crate::number(value, count).unwrap_or_default()
}

/// Charts of the envelopes of a case along a rail, in the order of an engineer's interest; quantities that are zero are
/// left out.
pub(crate) fn envelope_charts(
    design: &Design,
    result: &DesignResult,
    case: usize,
    rail: usize,
) -> Vec<(Chart, String)> {
    let order = [
        GirderResponse::VerticalMoment,
        GirderResponse::VerticalShear,
        GirderResponse::VerticalDeflection,
        GirderResponse::LateralMoment,
        GirderResponse::LateralShear,
        GirderResponse::LateralDeflection,
        GirderResponse::Normal,
        GirderResponse::Torsion,
    ];
    let rows = &result.cases[case].envelopes.envelopes;
    let mut out = Vec::new();
    for quantity in order {
        let (unit, factor) = unit_of(design.units, quantity);
        let points = |is_max: bool| -> Vec<[f64; 2]> {
            let own = rows.iter().filter(|e| (e.rail, e.quantity, e.is_max) == (rail, quantity, is_max));
            own.map(|e| [e.governing.x, factor * e.governing.value]).collect()
        };
        let (largest, smallest) = (points(true), points(false));
        if largest.iter().chain(&smallest).all(|point| point[1] == 0.0) {
            continue;
        }
        let word = quantity_word(quantity);
        let is_torsion = matches!(quantity, GirderResponse::Normal | GirderResponse::Torsion);
        let name = if is_torsion { word.to_owned() } else { format!("{} {word}", plane_word(quantity)) };
        let title = format!("Envelope of {name}, case {}, rail {}", case + 1, design.spec.rails()[rail].name);
        let length = design.units.label(Dimension::LENGTH);
        let mut y = ChartAxis::new(word, &unit);
        // Sagging moments and deflections are drawn downwards, as engineers draw them.
        if matches!(quantity, GirderResponse::VerticalMoment | GirderResponse::VerticalDeflection) {
            y = y.downwards();
        }
        let chart = Chart::new(title, ChartAxis::new("x along the rail", length), y)
            .with(Series::new("largest", Style::Line, largest))
            .with(Series::new("smallest", Style::Dashed, smallest));
        let caption =
            format!("Envelope of {name}: the largest and smallest value at each place over all positions.");
        out.push((chart, caption));
    }
    out
}
