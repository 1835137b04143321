//! Comparison of a run with design codes: values of EN 1991-3, CMAA 70, AIST TR-13, FEM and OSHA for the crane of a
//! scene, and the same quantities measured in its run.
//!
//! The crane is reduced to the data that formulas of codes need ([`CraneData`]: weights, span, approach, wheels,
//! speeds). The quantities for which codes have values are measured in the columns of the run ([`MeasuredCrane`]).
//! The formulas are evaluated, and both values are listed.
//!
//! Files, lowest first: crane, measured, formulas, lists, this one.

mod crane;
mod formulas;
mod lists;
mod measured;

pub use crane::CraneData;
pub use formulas::CodeValue;
pub use lists::{CodeComparison, CodeFactor};
pub use measured::MeasuredCrane;

use serde_json::{Map, json};

use self::formulas::CodeCase;
use self::lists::{comparisons, factors};
use crate::columns::NamedColumns;
use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use foundations::Error;

/// The values of codes for a crane, and the measured values of its run.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeCheck {
    /// Data of the crane.
    pub crane: CraneData,
    /// Factors of the codes and wheel loads that do not depend on the run.
    pub factors: Vec<CodeFactor>,
    /// Each measured quantity of the run with the values by codes.
    pub rows: Vec<CodeComparison>,
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
    ) -> Result<Option<CodeCheck>, Error> {
        let Some(practice) = &scene.practice else { return Ok(None) };
        let crane = CraneData::new(scene, practice, input, record)?;
        let measured = MeasuredCrane::new(scene, practice, input, &crane, record);
        let case = CodeCase::new(scene, practice, &crane, &measured);
        let (rows, factors) = (comparisons(&case), factors(&case));
        Ok(Some(CodeCheck { crane, factors, rows }))
    }

    /// As the member `practice` of a run's summary.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let crane: Map<_, _> =
            self.crane.list().into_iter().map(|(name, value, _)| (name.to_owned(), json!(value))).collect();
        let rows: Map<_, _> = self.rows.iter().map(|row| (row.name.to_owned(), row.json())).collect();
        let factors: Map<_, _> =
            self.factors.iter().map(|factor| (factor.name.to_owned(), factor.value.json())).collect();
        let approach_is_from_run = self.crane.approach_is_from_run;
        json!({ "factors": factors, "crane": crane, "approach_from_run": approach_is_from_run, "values": rows })
    }
}
