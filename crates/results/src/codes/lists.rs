//! The two lists of a check: factors of the codes that no run changes, and quantities of the run beside the codes' values.

use practice::{TimedValue, aist, buffer, cmaa, factor};
use serde_json::json;

use super::formulas::{AIST, CMAA, CodeCase, CodeValue, EN};
use formats::units::Dimension;

/// A factor or a wheel load by a code, which does not depend on the run.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeFactor {
    /// Its name in summaries.
    pub name: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    /// Code, clause, formula and value.
    pub value: CodeValue,
}

/// All factors of the codes, and the loads of one wheel by them; those that a formula refuses are left out.
#[must_use]
pub(super) fn factors(case: &CodeCase) -> Vec<CodeFactor> {
    let (practice, measures) = (case.practice, case.measures);
    let in_si = |speed: Option<f64>| speed.map(|speed| speed * case.metre);
    let phi5 = factor::phi5(practice.drives);
    let phi2 = case.phi2;
    let group = phi2.and_then(|phi2| measures.crane.wheel_loads(factor::PHI1[1], phi2).ok());
    let impact = case.full.and_then(|full| aist::with_impact(practice.kind, full.near).ok());
    let hlf = in_si(measures.speeds[2]).and_then(|speed| cmaa::hoist_load_factor(speed).ok());
    let dlf = |speed| in_si(speed).and_then(|speed| cmaa::dead_load_factor(speed).ok());
    let skew = cmaa::skew_coefficient(measures.crane.span, measures.base()).ok();
    let number = Dimension::NUMBER;
    let force = Dimension::FORCE;
    let list = [
        ("phi1_least", number, EN, "Table 2.4", "dead weight, lifting", Some(factor::PHI1[0])),
        ("phi1_most", number, EN, "Table 2.4", "dead weight, lifting", Some(factor::PHI1[1])),
        ("phi2", number, EN, "Tables 2.4, 2.5", "load, lifting: phi2,min + beta2 v", phi2),
        (
            "phi3",
            number,
            EN,
            "Table 2.4",
            "load, all of it let go",
            factor::phi3(1.0, 1.0, practice.release).ok(),
        ),
        ("phi4", number, EN, "Table 2.4", "travelling on rails within tolerance", Some(factor::PHI4)),
        ("phi5_least", number, EN, "Table 2.6", "forces of drives", Some(phi5[0])),
        ("phi5_most", number, EN, "Table 2.6", "forces of drives", Some(phi5[1])),
        (
            "phi6",
            number,
            EN,
            "2.10",
            "dynamic test load: (1 + phi2)/2",
            phi2.and_then(|phi2| factor::phi6(phi2).ok()),
        ),
        ("phi7", number, EN, "Table 2.10", "buffers, springs", buffer::phi7(0.5).ok()),
        ("hoist_load_factor", number, CMAA, "3.3.2.1.4.2 (2010)", "HLF", hlf),
        (
            "dead_load_factor_bridge",
            number,
            CMAA,
            "3.3.2.1.4.1 (2010)",
            "DLF at its speed",
            dlf(measures.speeds[0]),
        ),
        (
            "dead_load_factor_trolley",
            number,
            CMAA,
            "3.3.2.1.4.1 (2010)",
            "DLF at its speed",
            dlf(measures.speeds[1]),
        ),
        ("skew_coefficient", number, CMAA, "3.3.2.2.2 (2010)", "S_sk", skew),
        (
            "impact",
            number,
            AIST,
            "3.7.2, Table 3.2 (2021)",
            "of the largest wheel loads",
            Some(practice.kind.fractions().impact),
        ),
        (
            "wheel_near",
            force,
            "mechanics",
            "statics",
            "trolley at its approach",
            case.full.map(|full| full.near),
        ),
        ("wheel_far", force, "mechanics", "statics", "on the other rail", case.full.map(|full| full.far)),
        ("wheel_group_1", force, EN, "2.6, Table 2.2", "near, phi1 and phi2", group.map(|group| group.near)),
        ("wheel_impact", force, AIST, "3.7.2, Table 3.2 (2021)", "near, with impact", impact),
    ];
    let kept = list.into_iter().filter_map(|(name, dimension, code, clause, formula, value)| {
        let value = value.filter(|value| value.is_finite())?;
        Some(CodeFactor {
            name,
            dimension,
            value: CodeValue { code, clause, formula: formula.to_owned(), value },
        })
    });
    kept.collect()
}

/// A quantity of the run with the values that codes have for it.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeComparison {
    /// Its name in summaries.
    pub name: &'static str,
    /// In words.
    pub what: &'static str,
    /// Dimension of all its values.
    pub dimension: Dimension,
    /// Its value in the run, with the time of the extreme.
    pub found: TimedValue,
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
            "measured": { "value": self.found.value + 0.0, "time": self.found.time },
            "codes": values.collect::<Vec<_>>(),
        })
    }
}

/// All quantities that the run has, each with the values by codes.
#[must_use]
pub(super) fn comparisons(case: &CodeCase) -> Vec<CodeComparison> {
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
            case.braking_distance(0),
        ),
        (
            "trolley_brake_way",
            "way in which the trolley is braked to a stand",
            Dimension::LENGTH,
            found.brakes[1].map(|b| b.0),
            case.braking_distance(1),
        ),
    ];
    let kept = list.into_iter().filter_map(|(name, what, dimension, found, values)| {
        Some(CodeComparison { name, what, dimension, found: found?, values: values.0 })
    });
    kept.collect()
}
