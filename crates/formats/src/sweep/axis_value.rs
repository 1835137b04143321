//! A value of an axis.

use std::fmt;

/// A value of an axis in one run.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisValue {
    /// A number.
    Number(f64),
    /// A string.
    Text(String),
    /// `true` or `false`.
    Flag(bool),
}

impl AxisValue {
    /// The number; `None` for a string and for true and false.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            AxisValue::Number(value) => Some(*value),
            AxisValue::Text(_) | AxisValue::Flag(_) => None,
        }
    }

    /// The value as JSON; the text of a number has the fewest digits that mean the same double.
    #[must_use]
    pub fn json(&self) -> serde_json::Value {
        match self {
            AxisValue::Number(value) => serde_json::json!(value),
            AxisValue::Text(text) => serde_json::json!(text),
            AxisValue::Flag(flag) => serde_json::json!(flag),
        }
    }
}

impl fmt::Display for AxisValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            AxisValue::Text(text) => f.write_str(text),
            other => other.json().fmt(f),
        }
    }
}
