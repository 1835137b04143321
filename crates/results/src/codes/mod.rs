//! A run beside codes: values of EN 1991-3, CMAA 70, AIST TR-13, FEM and OSHA for the crane of a scene, and the same
//! quantities measured in its run.
//!
//! The crane is reduced to what formulas of codes need ([`CraneData`]: weights, span, approach, wheels, speeds); the same
//! quantities are taken from the columns of the run ([`MeasuredCrane`]); the formulas are evaluated, and both are listed.
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

/// The values of codes for a crane, and those of its run.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeCheck {
    /// The crane as codes describe it.
    pub crane: CraneData,
    /// Factors of the codes, and wheel loads by them, whatever the run.
    pub factors: Vec<CodeFactor>,
    /// Each quantity of the run with its values by codes.
    pub rows: Vec<CodeComparison>,
}

impl CodeCheck {
    /// The check of a run with the columns `record`; `None` for a scene without the member `practice`.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(
        scene: &Scene,
        cast: &SimulationInput,
        record: &NamedColumns,
    ) -> Result<Option<CodeCheck>, Error> {
        let Some(practice) = &scene.practice else { return Ok(None) };
        let measures = CraneData::new(scene, practice, cast, record)?;
        let found = MeasuredCrane::new(scene, practice, cast, &measures, record);
        let case = CodeCase::new(scene, practice, &measures, &found);
        let (rows, factors) = (comparisons(&case), factors(&case));
        Ok(Some(CodeCheck { crane: measures, factors, rows }))
    }

    /// As the member `practice` of a run's summary.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let crane: Map<_, _> =
            self.crane.list().into_iter().map(|(name, value, _)| (name.to_owned(), json!(value))).collect();
        let rows: Map<_, _> = self.rows.iter().map(|row| (row.name.to_owned(), row.json())).collect();
        let factors: Map<_, _> =
            self.factors.iter().map(|factor| (factor.name.to_owned(), factor.value.json())).collect();
        json!({ "factors": factors, "crane": crane, "approach_from_run": self.crane.approach_is_found, "values": rows })
    }
}
