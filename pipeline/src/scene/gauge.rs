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
        let words: Vec<(&str, usize)> =
            rails.iter().enumerate().map(|(index, rail)| (rail.name.as_str(), index)).collect();
        let rail = match (&raw.rail, rails.len()) {
            (Some(rail), _) => check.faults.word(rail, &at.key("rail"), &words),
            (None, 1) => Some(0),
            (None, _) => check.faults.need(&raw.rail, &at, "rail").map(|_| 0),
        };
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
