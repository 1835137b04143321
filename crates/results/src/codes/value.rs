//! Values by codes, with code, edition, clause, formula and the check of the value.

use design::clause_json;
use practice::clause::CodeClause;
use serde_json::{Value, json};

/// A value by a code, with its clause.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeValue {
    /// Code, edition, clause, and how the value was checked.
    pub clause: CodeClause,
    /// The formula in words.
    pub formula: String,
    /// The value.
    pub value: f64,
}

impl CodeValue {
    pub(super) fn json(&self) -> Value {
        let mut members = clause_json(&self.clause);
        members["formula"] = json!(self.formula);
        members["value"] = json!(self.value + 0.0);
        members
    }
}

/// Values for one quantity; values outside the domain of a formula are omitted.
#[derive(Default)]
pub(super) struct CodeValues(pub Vec<CodeValue>);

impl CodeValues {
    pub(super) fn add(
        mut self,
        clause: CodeClause,
        formula: impl Into<String>,
        value: Option<f64>,
    ) -> CodeValues {
        if let Some(value) = value.filter(|value| value.is_finite()) {
            self.0.push(CodeValue {
                clause,
                formula: formula.into(),
                value,
            });
        }
        self
    }
}

/// Words that follow the formula of a factor for which the scene gives no speed.
pub(super) const NO_SPEED: &str = "minimum value, no speed given";

/// A formula, with [`NO_SPEED`] where no speed is known.
pub(super) fn with_speed(formula: &str, speed: Option<f64>) -> String {
    match speed {
        Some(_) => formula.to_owned(),
        None => format!("{formula}: {NO_SPEED}"),
    }
}
