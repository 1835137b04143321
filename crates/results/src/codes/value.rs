//! Values of codes, with the clause that each comes from.

use serde_json::json;

/// A value of a code.
#[derive(Clone, Debug, PartialEq)]
pub struct CodeValue {
    /// The code.
    pub code: &'static str,
    /// Where in it.
    pub clause: &'static str,
    /// How it comes about.
    pub formula: String,
    /// The value.
    pub value: f64,
}

impl CodeValue {
    pub(super) fn json(&self) -> serde_json::Value {
        json!({ "code": self.code, "clause": self.clause, "formula": self.formula, "value": self.value + 0.0 })
    }
}
