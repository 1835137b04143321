//! Groups of crane loads with their factors for one crane.

use design::clause_json;
use practice::combination::{DynamicFactors, LoadGroup, eurocode_groups};
use practice::factor;
use practice::mill_combination::mill_fatigue;
use serde_json::{Map, Value, json};

use super::case::CodeCase;

/// A group of loads with the factors of one crane.
#[derive(Clone, Debug, PartialEq)]
pub struct CraneLoadGroup {
    /// The group.
    pub group: LoadGroup,
    /// Names and factors of its loads.
    pub factors: Vec<(&'static str, f64)>,
}

impl CraneLoadGroup {
    fn new(group: LoadGroup, crane: &DynamicFactors) -> CraneLoadGroup {
        let factors = group
            .loads
            .iter()
            .map(|factored| (factored.load.word(), factored.factor.value(crane)));
        CraneLoadGroup {
            factors: factors.collect(),
            group,
        }
    }

    /// As an item of `load_groups`.
    pub(super) fn json(&self) -> Value {
        let mut members = clause_json(&self.group.clause);
        let factors: Map<String, Value> = self
            .factors
            .iter()
            .map(|(name, factor)| ((*name).to_owned(), json!(factor + 0.0)))
            .collect();
        members["name"] = json!(self.group.name);
        members["factors"] = Value::Object(factors);
        members
    }
}

/// Groups 1 to 10 of EN 1991-3 where the hoisting factor phi2 is known, and the fatigue combination of AIST TR-13.
pub(super) fn load_groups(case: &CodeCase) -> Vec<CraneLoadGroup> {
    let phi5 = factor::phi5(case.practice.drives)[1];
    let of_phi2 = |phi2: f64| DynamicFactors::of_crane(phi2, phi5, case.practice.release).ok();
    let known = case.phi2.and_then(of_phi2);
    let mut groups: Vec<CraneLoadGroup> = Vec::new();
    if let Some(crane) = &known {
        groups.extend(
            eurocode_groups()
                .into_iter()
                .map(|group| CraneLoadGroup::new(group, crane)),
        );
    }
    // the factors of TR-13 are numbers, which do not depend on phi2
    groups.extend(
        known
            .or_else(|| of_phi2(1.0))
            .map(|crane| CraneLoadGroup::new(mill_fatigue(), &crane)),
    );
    groups
}
