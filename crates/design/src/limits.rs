//! Limits of codes against the results of a design.

use formats::design::Design;

use crate::solve::SolvedCase;

/// A limit of a code against a result.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCheck {
    /// The code with its edition.
    pub code: String,
    /// Clause or table.
    pub clause: String,
    /// What is limited, in words.
    pub quantity: String,
    /// The result, in the units of the design.
    pub value: f64,
    /// Its limit.
    pub limit: f64,
    /// Number of the case from 1.
    pub case: usize,
    /// Name of the rail.
    pub rail: String,
    /// Number of the span from 1.
    pub span: usize,
}

impl LimitCheck {
    /// Whether the limit is kept.
    #[must_use]
    pub fn within(&self) -> bool {
        self.value.abs() <= self.limit
    }
}

/// Checks the limits of the design's code.
pub(crate) fn check_limits(_design: &Design, _cases: &[SolvedCase]) -> Vec<LimitCheck> {
    Vec::new()
}
