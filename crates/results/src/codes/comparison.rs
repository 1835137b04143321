//! Measured quantities of a run, each with the values by codes.

use practice::TimedValue;
use serde_json::json;

use super::case::CodeCase;
use super::value::{CodeValue, CodeValues};
use formats::units::Dimension;

/// A measured quantity of the run with its values by codes.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeComparison {
    /// Its name in summaries.
    pub name: &'static str,
    /// Description in words.
    pub what: &'static str,
    /// Dimension of all its values.
    pub dimension: Dimension,
    /// Its measured value in the run, with the time of the extreme.
    pub measured: TimedValue,
    /// The values by codes.
    pub values: Vec<CodeValue>,
}

impl CodeComparison {
    /// As a member of `values`.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let values = self.values.iter().map(CodeValue::json);
        json!({
            "what": self.what,
            "measured": { "value": self.measured.value + 0.0, "time": self.measured.time },
            "codes": values.collect::<Vec<_>>(),
        })
    }
}

/// Name, description, dimension, measured value and values by codes of a quantity.
type ComparisonEntry = (
    &'static str,
    &'static str,
    Dimension,
    Option<TimedValue>,
    CodeValues,
);

/// All quantities that were measured in the run, each with the values by codes.
#[must_use]
pub(super) fn comparisons(case: &CodeCase) -> Vec<CodeComparison> {
    let list = dynamic_factors(case)
        .into_iter()
        .chain(forces(case))
        .chain(braking_distances(case));
    let measured = list.filter_map(|(name, what, dimension, measured, values)| {
        Some(CodeComparison {
            name,
            what,
            dimension,
            measured: measured?,
            values: values.0,
        })
    });
    measured.collect()
}

/// Ratios of vertical forces to their static values.
fn dynamic_factors(case: &CodeCase) -> [ComparisonEntry; 4] {
    let (measured, number) = (case.measured, Dimension::NUMBER);
    let released = measured.load[1].filter(|_| case.releases_load);
    let rail = "vertical force of a rail over its static force";
    let wheel = "vertical force of a wheel over its static force";
    let lifted = "force of the lifted load on the trolley over its weight, largest";
    let dropped = "force of the lifted load on the trolley over its weight, smallest";
    [
        ("rail_factor", rail, number, measured.rail, case.vertical()),
        (
            "wheel_factor",
            wheel,
            number,
            measured.wheel,
            case.vertical(),
        ),
        (
            "load_factor",
            lifted,
            number,
            measured.load[0],
            case.lifting(),
        ),
        ("release_factor", dropped, number, released, case.release()),
    ]
}

/// Horizontal forces of wheels, end stops and buffers.
fn forces(case: &CodeCase) -> [ComparisonEntry; 5] {
    let (measured, force) = (case.measured, Dimension::FORCE);
    let collision = "buffer force between two cranes";
    [
        (
            "lateral",
            "total lateral force of all wheels",
            force,
            measured.lateral,
            case.lateral(),
        ),
        (
            "wheel_lateral",
            "lateral force of one wheel",
            force,
            measured.wheel_lateral,
            case.flange(),
        ),
        (
            "longitudinal",
            "total longitudinal force of the wheels on one rail",
            force,
            measured.longitudinal,
            case.longitudinal(),
        ),
        (
            "buffer",
            "total force of the end stops",
            force,
            measured.end_stops,
            case.buffer(),
        ),
        (
            "collision",
            collision,
            force,
            measured.collision,
            case.collision(),
        ),
    ]
}

/// Braking distances of bridge and trolley.
fn braking_distances(case: &CodeCase) -> [ComparisonEntry; 2] {
    let measured = |body: usize| case.measured.brakes[body].map(|(distance, _)| distance);
    let length = Dimension::LENGTH;
    let bridge = "braking distance of the bridge to standstill";
    let trolley = "braking distance of the trolley to standstill";
    [
        (
            "bridge_brake_way",
            bridge,
            length,
            measured(0),
            case.braking_distance(0),
        ),
        (
            "trolley_brake_way",
            trolley,
            length,
            measured(1),
            case.braking_distance(1),
        ),
    ]
}
