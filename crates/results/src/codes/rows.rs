//! Quantities of a crane that codes give values for.

use practice::TimedValue;
use serde_json::json;

use super::case::CodeCase;
use super::value::CodeValue;
use formats::units::Dimension;

/// One quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeComparison {
    /// Its name in summaries.
    pub name: &'static str,
    /// In words.
    pub what: &'static str,
    /// Dimension of all its values.
    pub dimension: Dimension,
    /// What the run has.
    pub found: TimedValue,
    /// What codes have.
    pub values: Vec<CodeValue>,
}

impl CodeComparison {
    /// As a member of `values`.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let values = self.values.iter().map(CodeValue::json);
        json!({
            "what": self.what,
            "measured": { "value": self.found.value + 0.0, "time": self.found.time },
            "codes": values.collect::<Vec<_>>(),
        })
    }
}

/// All quantities that the run has.
#[must_use]
pub(super) fn rows(case: &CodeCase) -> Vec<CodeComparison> {
    let found = case.found;
    let list = [
        (
            "rail_factor",
            "vertical force of a rail over its static force",
            Dimension::NUMBER,
            found.rail,
            case.vertical(),
        ),
        (
            "wheel_factor",
            "vertical force of a wheel over its static force",
            Dimension::NUMBER,
            found.wheel,
            case.vertical(),
        ),
        (
            "load_factor",
            "force of the lifted load on the trolley over its weight, largest",
            Dimension::NUMBER,
            found.load[0],
            case.lifting(),
        ),
        (
            "release_factor",
            "the same, smallest",
            Dimension::NUMBER,
            found.load[1].filter(|_| case.drops),
            case.release(),
        ),
        ("lateral", "lateral force of all wheels together", Dimension::FORCE, found.across, case.lateral()),
        ("wheel_lateral", "lateral force of one wheel", Dimension::FORCE, found.flange, case.flange()),
        (
            "longitudinal",
            "force of the wheels along one rail",
            Dimension::FORCE,
            found.along,
            case.longitudinal(),
        ),
        ("buffer", "force of the end stops together", Dimension::FORCE, found.buffer, case.buffer()),
        (
            "collision",
            "force of the buffer between two cranes",
            Dimension::FORCE,
            found.collision,
            case.collision(),
        ),
        (
            "bridge_brake_way",
            "way in which the bridge is braked to a stand",
            Dimension::LENGTH,
            found.brakes[0].map(|b| b.0),
            case.way(0),
        ),
        (
            "trolley_brake_way",
            "way in which the trolley is braked to a stand",
            Dimension::LENGTH,
            found.brakes[1].map(|b| b.0),
            case.way(1),
        ),
    ];
    let kept = list.into_iter().filter_map(|(name, what, dimension, found, values)| {
        Some(CodeComparison { name, what, dimension, found: found?, values: values.0 })
    });
    kept.collect()
}
