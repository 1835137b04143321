//! Gauges: places on a structure's rails whose displacement is recorded.

use splines::Axis;

use super::raw::RawGauge;
use crate::check::Check;
use crate::entries::Entries;
use crate::fault::Fault;
use crate::place::Place;
use crate::spec::RailOutline;
use crate::units::Dimension;

/// A place whose displacement a run records as `<structure>.<name>`.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauge {
    /// Its name.
    pub name: String,
    /// Rail of the structure.
    pub rail: usize,
    /// Rail coordinate.
    pub x: f64,
    /// Direction; vertical displacements are recorded positive down.
    pub axis: Axis,
}

const DIRECTIONS: [(&str, Axis); 3] =
    [("vertical", Axis::Vertical), ("lateral", Axis::Lateral), ("longitudinal", Axis::Longitudinal)];

/// Index of the rail named at `at` among those of its structure; the only one where none is named.
pub(super) fn rail_among(
    given: Option<&String>,
    rails: &[RailOutline],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Option<usize> {
    let words: Vec<(&str, usize)> =
        rails.iter().enumerate().map(|(index, rail)| (rail.name.as_str(), index)).collect();
    match (given, rails.len()) {
        (Some(rail), _) => check.faults.word(rail, &at.key("rail"), &words),
        (None, 1) => Some(0),
        (None, _) => check.faults.need(&given, at, "rail").map(|_| 0),
    }
}

pub(super) fn read(
    raw: &Entries<RawGauge>,
    rails: &[RailOutline],
    at: &Place<'_>,
    check: &mut Check<'_>,
) -> Vec<Gauge> {
    let mut gauges = Vec::new();
    for (name, raw) in &raw.0 {
        let at = at.key(name);
        super::name(name, &at, check.faults);
        let rail = rail_among(raw.rail.as_ref(), rails, &at, check);
        let x = check.faults.need(&raw.x, &at, "x").copied();
        let axis = match &raw.direction {
            Some(word) => check.faults.word(word, &at.key("direction"), &DIRECTIONS),
            None => Some(Axis::Vertical),
        };
        let (Some(rail), Some(x), Some(axis)) = (rail, x, axis) else { continue };
        let place = at.key("x");
        let x = check.number(x, &place, Dimension::LENGTH);
        let [first, last] = rails[rail].range;
        if x < first || x > last {
            let fault = Fault::new(&place, format!("must lie on rail {}", rails[rail].name)).got(x);
            check.faults.add(fault.hint(format!("it runs from {first} to {last}")));
        }
        gauges.push(Gauge { name: name.clone(), rail, x, axis });
    }
    gauges
}
