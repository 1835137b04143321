//! Values of codes for the crane of a scene, beside what its run has.

mod case;
mod found;
mod givens;
mod measures;
mod rows;
mod value;

pub use found::MeasuredCrane;
pub use givens::CodeFactor;
pub use measures::CraneData;
pub use rows::CodeComparison;
pub use value::CodeValue;

use serde_json::{Map, json};

use self::case::CodeCase;
use self::givens::givens;
use self::rows::rows;
use crate::record::NamedColumns;
use formats::motion::Cast;
use formats::scene::Scene;
use foundations::Error;

/// A run beside the codes.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeCheck {
    /// The crane as they see it.
    pub measures: CraneData,
    /// Factors of the codes, and wheel loads by them.
    pub factors: Vec<CodeFactor>,
    /// Quantity by quantity.
    pub rows: Vec<CodeComparison>,
}

impl CodeCheck {
    /// Of a run of a scene with the member `practice`.
    ///
    /// # Errors
    /// A spec that no model can be made of.
    pub fn new(scene: &Scene, cast: &Cast, record: &NamedColumns) -> Result<Option<CodeCheck>, Error> {
        let Some(practice) = &scene.practice else { return Ok(None) };
        let measures = CraneData::new(scene, practice, cast, record)?;
        let found = MeasuredCrane::new(scene, practice, cast, &measures, record);
        let case = CodeCase::new(scene, practice, &measures, &found);
        let (rows, givens) = (rows(&case), givens(&case));
        Ok(Some(CodeCheck { measures, factors: givens, rows }))
    }

    /// As the member `practice` of a run's summary.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        let crane: Map<_, _> = self
            .measures
            .list()
            .into_iter()
            .map(|(name, value, _)| (name.to_owned(), json!(value)))
            .collect();
        let rows: Map<_, _> = self.rows.iter().map(|row| (row.name.to_owned(), row.json())).collect();
        let givens: Map<_, _> =
            self.factors.iter().map(|given| (given.name.to_owned(), given.value.json())).collect();
        json!({ "factors": givens, "crane": crane, "approach_from_run": self.measures.approach_is_found, "values": rows })
    }
}
