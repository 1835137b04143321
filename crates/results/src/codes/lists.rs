//! The two lists of a check: factors of the codes, which do not depend on the run, and measured quantities with the
//! values by codes.

use practice::{TimedValue, aist, buffer, cmaa, factor};
use serde_json::json;

use super::formulas::{AIST, CMAA, CodeCase, CodeValue, CodeValues, EN};
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

/// Name, dimension, code, clause, formula and value of a factor.
type FactorEntry = (&'static str, Dimension, &'static str, &'static str, &'static str, Option<f64>);

/// All factors of the codes and the wheel loads by them; values outside the domain of a formula are omitted.
#[must_use]
pub(super) fn factors(case: &CodeCase) -> Vec<CodeFactor> {
    let list = eurocode_factors(case).into_iter().chain(cmaa_factors(case)).chain(wheel_loads(case));
    let finite = list.filter_map(|(name, dimension, code, clause, formula, value)| {
        let value = value.filter(|value| value.is_finite())?;
        Some(CodeFactor {
            name,
            dimension,
            value: CodeValue { code, clause, formula: formula.to_owned(), value },
        })
    });
    finite.collect()
}

/// Dynamic factors of EN 1991-3.
fn eurocode_factors(case: &CodeCase) -> [FactorEntry; 9] {
    let practice = case.practice;
    let phi5 = factor::phi5(practice.drives);
    let phi3 = factor::phi3(1.0, 1.0, practice.release).ok();
    let phi6 = case.phi2.and_then(|phi2| factor::phi6(phi2).ok());
    let number = Dimension::NUMBER;
    [
        ("phi1_least", number, EN, "Table 2.4", "dead weight, lifting", Some(factor::PHI1[0])),
        ("phi1_most", number, EN, "Table 2.4", "dead weight, lifting", Some(factor::PHI1[1])),
        ("phi2", number, EN, "Tables 2.4, 2.5", "load, lifting: phi2,min + beta2 v", case.phi2),
        ("phi3", number, EN, "Table 2.4", "load, the whole of it released", phi3),
        ("phi4", number, EN, "Table 2.4", "travelling on rails within tolerance", Some(factor::PHI4)),
        ("phi5_least", number, EN, "Table 2.6", "forces of drives", Some(phi5[0])),
        ("phi5_most", number, EN, "Table 2.6", "forces of drives", Some(phi5[1])),
        ("phi6", number, EN, "2.10", "dynamic test load: (1 + phi2)/2", phi6),
        ("phi7", number, EN, "Table 2.10", "buffers, springs", buffer::phi7(0.5).ok()),
    ]
}

/// Factors of CMAA 70.
fn cmaa_factors(case: &CodeCase) -> [FactorEntry; 4] {
    let crane = case.crane;
    let in_si = |speed: Option<f64>| speed.map(|speed| speed * case.metre);
    let hlf = in_si(crane.speeds[2]).and_then(|speed| cmaa::hoist_load_factor(speed).ok());
    let dlf = |speed| in_si(speed).and_then(|speed| cmaa::dead_load_factor(speed).ok());
    let [bridge, trolley] = [dlf(crane.speeds[0]), dlf(crane.speeds[1])];
    let skew = cmaa::skew_coefficient(crane.model.span, crane.wheel_base()).ok();
    let number = Dimension::NUMBER;
    [
        ("hoist_load_factor", number, CMAA, "3.3.2.1.4.2 (2010)", "HLF", hlf),
        ("dead_load_factor_bridge", number, CMAA, "3.3.2.1.4.1 (2010)", "DLF at its speed", bridge),
        ("dead_load_factor_trolley", number, CMAA, "3.3.2.1.4.1 (2010)", "DLF at its speed", trolley),
        ("skew_coefficient", number, CMAA, "3.3.2.2.2 (2010)", "S_sk", skew),
    ]
}

/// The impact factor, and loads of one wheel: static, in load group 1, and with impact.
fn wheel_loads(case: &CodeCase) -> [FactorEntry; 5] {
    let (practice, force) = (case.practice, Dimension::FORCE);
    let impact = Some(practice.kind.fractions().impact);
    let [near, far] = [case.full.map(|full| full.near), case.full.map(|full| full.far)];
    let group = case.phi2.and_then(|phi2| case.crane.model.wheel_loads(factor::PHI1[1], phi2).ok());
    let group = group.map(|group| group.near);
    let with_impact = case.full.and_then(|full| aist::with_impact(practice.kind, full.near).ok());
    let aist_clause = "3.7.2, Table 3.2 (2021)";
    [
        ("impact", Dimension::NUMBER, AIST, aist_clause, "of the largest wheel loads", impact),
        ("wheel_near", force, "mechanics", "statics", "trolley at its approach", near),
        ("wheel_far", force, "mechanics", "statics", "on the other rail", far),
        ("wheel_group_1", force, EN, "2.6, Table 2.2", "near, phi1 and phi2", group),
        ("wheel_impact", force, AIST, aist_clause, "near, with impact", with_impact),
    ]
}

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
type ComparisonEntry = (&'static str, &'static str, Dimension, Option<TimedValue>, CodeValues);

/// All quantities that were measured in the run, each with the values by codes.
#[must_use]
pub(super) fn comparisons(case: &CodeCase) -> Vec<CodeComparison> {
    let list = dynamic_factors(case).into_iter().chain(forces(case)).chain(braking_distances(case));
    let measured = list.filter_map(|(name, what, dimension, measured, values)| {
        Some(CodeComparison { name, what, dimension, measured: measured?, values: values.0 })
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
        ("wheel_factor", wheel, number, measured.wheel, case.vertical()),
        ("load_factor", lifted, number, measured.load[0], case.lifting()),
        ("release_factor", dropped, number, released, case.release()),
    ]
}

/// Horizontal forces of wheels, end stops and buffers.
fn forces(case: &CodeCase) -> [ComparisonEntry; 5] {
    let (measured, force) = (case.measured, Dimension::FORCE);
    let collision = "force of the buffer between two cranes";
    [
        ("lateral", "lateral force of all wheels together", force, measured.lateral, case.lateral()),
        ("wheel_lateral", "lateral force of one wheel", force, measured.wheel_lateral, case.flange()),
        (
            "longitudinal",
            "force of the wheels along one rail",
            force,
            measured.longitudinal,
            case.longitudinal(),
        ),
        ("buffer", "force of the end stops together", force, measured.end_stops, case.buffer()),
        ("collision", collision, force, measured.collision, case.collision()),
    ]
}

/// Braking distances of bridge and trolley.
fn braking_distances(case: &CodeCase) -> [ComparisonEntry; 2] {
    let measured = |body: usize| case.measured.brakes[body].map(|(distance, _)| distance);
    let length = Dimension::LENGTH;
    let bridge = "braking distance of the bridge to standstill";
    let trolley = "braking distance of the trolley to standstill";
    [
        ("bridge_brake_way", bridge, length, measured(0), case.braking_distance(0)),
        ("trolley_brake_way", trolley, length, measured(1), case.braking_distance(1)),
    ]
}
