//! Comparison of a run with design codes: values of EN 1991-3, CMAA 70, AIST TR-13, FEM and OSHA for the crane of a
//! scene, and the same quantities measured in its run.
//!
//! The crane is reduced to the data that formulas of codes need ([`CraneData`]: weights, span, approach, wheels,
//! speeds). The quantities for which codes have values are measured in the columns of the run ([`MeasuredCrane`]).
//! The formulas are evaluated, and both values are listed.
//!
//! Every value has its code, edition and clause, and states how it was checked ([`CodeValue`]). Limits of deflections
//! stand beside the deflections under static wheel loads ([`StaticDeflection`]), to which they apply.
//!
//! Files, lowest first: value, crane, measured, case, formulas, factors, comparison, groups, deflection, this one.

mod case;
mod comparison;
mod crane;
mod deflection;
mod factors;
mod formulas;
mod groups;
mod measured;
mod value;

pub use comparison::CodeComparison;
pub use crane::CraneData;
pub use deflection::{AllowableDisplacement, SpanResponse, StaticDeflection};
pub use factors::CodeFactor;
pub use groups::CraneLoadGroup;
pub use measured::MeasuredCrane;
pub use value::CodeValue;

use serde_json::{Map, json};

use self::case::CodeCase;
use crate::columns::NamedColumns;
use formats::scene::motion::SimulationInput;
use formats::scene::{Practice, Scene};
use foundations::Error;

/// The values of codes for a crane, and the measured values of its run.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeCheck {
    /// Data of the crane.
    pub crane: CraneData,
    /// Factors of the codes and wheel loads by them.
    pub factors: Vec<CodeFactor>,
    /// Each measured quantity of the run with the values by codes.
    pub rows: Vec<CodeComparison>,
    /// Groups of loads with their factors.
    pub groups: Vec<CraneLoadGroup>,
    /// Deflections under static wheel loads with the limits of codes.
    pub limits: Vec<StaticDeflection>,
    /// Values that are left out, and the keys of `practice` that they need.
    pub left_out: Vec<&'static str>,
}

impl CodeCheck {
    /// The check of a run with the columns `record`; `None` for a scene without the member `practice`.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(
        scene: &Scene,
        input: &SimulationInput,
        record: &NamedColumns,
        run: &SpanResponse<'_>,
    ) -> Result<Option<CodeCheck>, Error> {
        let Some(practice) = &scene.practice else {
            return Ok(None);
        };
        let crane = CraneData::new(scene, practice, input, record)?;
        let measured = MeasuredCrane::new(scene, practice, input, &crane, record);
        let case = CodeCase::new(scene, practice, &crane, &measured);
        let (rows, factors) = (comparison::comparisons(&case), factors::factors(&case));
        let groups = groups::load_groups(&case);
        let limits = deflection::static_deflections(scene, practice, input, &crane, run);
        let left_out = left_out(practice, &case);
        Ok(Some(CodeCheck {
            crane,
            factors,
            rows,
            groups,
            limits,
            left_out,
        }))
    }

    /// As the member `practice` of a run's summary.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let crane: Map<_, _> = self
            .crane
            .list()
            .into_iter()
            .map(|(name, value, _)| (name.to_owned(), json!(value)))
            .collect();
        let rows: Map<_, _> = self
            .rows
            .iter()
            .map(|row| (row.name.to_owned(), row.json()))
            .collect();
        let factors: Map<_, _> = self
            .factors
            .iter()
            .map(|factor| (factor.name.to_owned(), factor.value.json()))
            .collect();
        let approach_is_from_run = self.crane.approach_is_from_run;
        json!({
            "factors": factors,
            "crane": crane,
            "approach_from_run": approach_is_from_run,
            "values": rows,
            "limits": self.limits.iter().map(StaticDeflection::json).collect::<Vec<_>>(),
            "load_groups": self.groups.iter().map(CraneLoadGroup::json).collect::<Vec<_>>(),
            "left_out": self.left_out,
        })
    }
}

/// Values that are left out because the scene does not give what they need.
fn left_out(practice: &Practice, case: &CodeCase<'_>) -> Vec<&'static str> {
    let all = [
        (
            case.phi2.is_none(),
            "phi2, phi6 and groups of EN 1991-3: need hoisting and hoist_speed",
        ),
        (
            practice.s_class.is_none(),
            "damage-equivalent wheel loads of EN 1991-3: need s_class",
        ),
        (
            practice.class.is_none(),
            "limits of AISC Design Guide 7: need class",
        ),
        (
            practice.building_class.is_none(),
            "limits of AIST TR-13 differ between classes A and B, and C and D: specify building_class",
        ),
        (
            practice.bumper_stroke.is_none(),
            "stopping force of bumpers: needs bumper_stroke",
        ),
    ];
    all.into_iter()
        .filter(|(is_missing, _)| *is_missing)
        .map(|(_, words)| words)
        .collect()
}
