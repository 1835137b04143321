//! Figures of a design: envelopes along its rails; values, units and positions as engineers read them.

use std::collections::BTreeMap;

use crate::chart::{Chart, ChartAxis, Series, Style};
use ::design::{DesignResult, plane_word, quantity_word};
use formats::design::Design;
use formats::units::{Dimension, Force, Length, Scale, Units};
use formats::verdict::rail_phrase;
use trains::{GirderResponse, Governing, SectionSide};

/// Largest length in mm or in that a table shows in these: longer ones are positions.
const SHORT: f64 = 1000.0;

/// Unit in which engineers read deflections, and its factor from `units`.
pub(crate) fn deflection_unit(units: Units) -> (&'static str, f64) {
    match units.length {
        Length::Metre | Length::Millimetre => ("mm", units.length.in_units_of(Length::Millimetre)),
        Length::Foot | Length::Inch => ("in", units.length.in_units_of(Length::Inch)),
    }
}

/// Unit in which engineers read forces, moments, stresses and properties of sections, and its factor from `units`: kN and
/// m, N and mm; kip and ft, kip and in.
pub(crate) fn reading_unit(units: Units, dimension: Dimension) -> (String, f64) {
    let is_small = !(dimension == Dimension::FORCE || dimension == Dimension::MOMENT);
    let is_metric = matches!(units.length, Length::Metre | Length::Millimetre);
    let to = match (is_metric, is_small) {
        (true, true) => Units {
            length: Length::Millimetre,
            force: Force::Newton,
        },
        (true, false) => Units {
            length: Length::Metre,
            force: Force::Kilonewton,
        },
        (false, true) => Units {
            length: Length::Inch,
            force: Force::Kip,
        },
        (false, false) => Units {
            length: Length::Foot,
            force: Force::Kip,
        },
    };
    let unit = to
        .label(dimension)
        .replace("^2", "\u{b2}")
        .replace("^4", "\u{2074}");
    (unit, Scale { from: units, to }.factor(dimension))
}

/// Unit in which the values of a column of a run are read, and its factor from `units`; `largest` is the largest
/// magnitude. Lengths of a metre and more, and speeds and others, stay in the units of the file.
pub(crate) fn column_unit(units: Units, dimension: Dimension, largest: f64) -> (String, f64) {
    let (short, factor) = deflection_unit(units);
    match dimension {
        Dimension::FORCE | Dimension::MOMENT | Dimension::STRESS => reading_unit(units, dimension),
        Dimension::LENGTH if factor * largest < SHORT => (short.to_owned(), factor),
        _ => (units.label(dimension), 1.0),
    }
}

/// Unit of a quantity for reading, and the factor from `units`.
pub(crate) fn unit_of(units: Units, quantity: GirderResponse) -> (String, f64) {
    match quantity {
        GirderResponse::VerticalDeflection | GirderResponse::LateralDeflection => {
            let (unit, factor) = deflection_unit(units);
            (unit.to_owned(), factor)
        }
        GirderResponse::Normal | GirderResponse::VerticalShear | GirderResponse::LateralShear => {
            reading_unit(units, Dimension::FORCE)
        }
        _ => reading_unit(units, Dimension::MOMENT),
    }
}

/// Points (x, y) with y in another unit.
pub(crate) fn scaled(points: Vec<[f64; 2]>, factor: f64) -> Vec<[f64; 2]> {
    points.into_iter().map(|[x, y]| [x, factor * y]).collect()
}

/// A value and its unit, which stay on one line.
pub(crate) fn with_unit(value: &str, unit: &str) -> String {
    format!("{value}\u{a0}{}", unit.replace(' ', "\u{a0}"))
}

/// A number in a few significant digits.
pub(crate) fn digits(value: f64, count: usize) -> String {
    crate::number(value, count).unwrap_or_default()
}

/// The side of a section in words; nothing where both sides are equal.
pub(crate) const fn side_phrase(side: SectionSide) -> &'static str {
    match side {
        SectionSide::Before => "just before",
        SectionSide::At => "",
        SectionSide::Behind => "just behind",
    }
}

/// A quantity without its plane, as sentences and axes name it.
fn force_word(quantity: GirderResponse) -> &'static str {
    match quantity {
        GirderResponse::Normal => "normal force",
        GirderResponse::VerticalShear | GirderResponse::LateralShear => "shear force",
        other => quantity_word(other),
    }
}

/// A quantity as sentences and tables name it, such as `vertical shear force`; normal forces and torsion have no plane.
pub(crate) fn quantity_phrase(quantity: GirderResponse) -> String {
    let word = force_word(quantity);
    match quantity {
        GirderResponse::Normal | GirderResponse::Torsion => word.to_owned(),
        _ => format!("{} {word}", plane_word(quantity)),
    }
}

/// Positions of the trains of a state, turned ones marked.
pub(crate) fn positions(governing: &Governing) -> String {
    let each = governing.trains.iter().map(|train| {
        let turned = if train.stance.turned { " turned" } else { "" };
        format!("{}{turned}", digits(train.position, 4))
    });
    each.collect::<Vec<_>>().join("; ")
}

/// A value of an envelope and that at the other side of its place, the one just before it first, so that a jump is drawn
/// as one; alone where both sides are equal.
fn in_order<'g>(governing: &'g Governing, other: Option<&'g Governing>) -> Vec<&'g Governing> {
    match other.filter(|other| other.value != governing.value) {
        Some(other) if governing.side == SectionSide::Before => vec![governing, other],
        Some(other) => vec![other, governing],
        None => vec![governing],
    }
}

/// Points of an envelope of forces with a jump at each of `supports` at which no member carries the rail, between two
/// members that end on either side of it: a force does not go over from one member to the other gradually.
fn with_jumps(points: Vec<[f64; 2]>, supports: &[f64]) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::with_capacity(points.len() + 2 * supports.len());
    let length = points.last().map_or(0.0, |last| last[0] - points[0][0]);
    let rounding = 1e-6 * length;
    for point in points {
        if let Some(&[before, value]) = out.last()
            && let Some(&x) = supports
                .iter()
                .find(|x| before + rounding < **x && **x < point[0] - rounding)
        {
            out.extend([[x, value], [x, point[1]]]);
        }
        out.push(point);
    }
    out
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
    let envelopes = &result.cases[case].envelopes;
    let other_sides: BTreeMap<usize, &Governing> = envelopes
        .other_sides
        .iter()
        .map(|(index, other)| (*index, other))
        .collect();
    let mut out = Vec::new();
    for quantity in order {
        let (unit, factor) = unit_of(design.units, quantity);
        let is_force = matches!(
            quantity,
            GirderResponse::Normal | GirderResponse::VerticalShear | GirderResponse::LateralShear
        );
        let supports: &[f64] = if is_force { &design.spans[rail] } else { &[] };
        let points = |is_max: bool| -> Vec<[f64; 2]> {
            let all = envelopes.envelopes.iter().enumerate();
            let own =
                all.filter(|(_, e)| (e.rail, e.quantity, e.is_max) == (rail, quantity, is_max));
            let sides =
                own.flat_map(|(index, e)| in_order(&e.governing, other_sides.get(&index).copied()));
            with_jumps(
                sides.map(|one| [one.x, factor * one.value]).collect(),
                supports,
            )
        };
        let (largest, smallest) = (points(true), points(false));
        if largest.iter().chain(&smallest).all(|point| point[1] == 0.0) {
            continue;
        }
        let name = quantity_phrase(quantity);
        let on = rail_phrase(&design.spec.rails()[rail].name);
        let title = format!("Envelope of {name}, case {}, {on}", case + 1);
        let length = design.units.label(Dimension::LENGTH);
        let mut y = ChartAxis::new(force_word(quantity), &unit);
        // Sagging moments and deflections are drawn downwards, as engineers draw them.
        if matches!(
            quantity,
            GirderResponse::VerticalMoment | GirderResponse::VerticalDeflection
        ) {
            y = y.downwards();
        }
        let chart = Chart::new(title, ChartAxis::new("x along the rail", length), y)
            .with(Series::new("largest", Style::Line, largest))
            .with(Series::new("smallest", Style::Dashed, smallest));
        let caption = format!(
            "Envelope of {name}: the largest and smallest value at each section over all positions of the train."
        );
        out.push((chart, caption));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::with_jumps;

    #[test]
    fn forces_jump_at_supports_between_members_that_end_beside_them() {
        let points = vec![[0.0, 1.0], [4.0, 1.0], [6.0, 3.0], [10.0, 3.0]];
        let jumping = [
            [0.0, 1.0],
            [4.0, 1.0],
            [5.0, 1.0],
            [5.0, 3.0],
            [6.0, 3.0],
            [10.0, 3.0],
        ];
        assert_eq!(with_jumps(points.clone(), &[0.0, 5.0, 10.0]), jumping);
        // members that end at the support have their values there
        assert_eq!(with_jumps(points.clone(), &[0.0, 4.0, 10.0]), points);
    }
}
