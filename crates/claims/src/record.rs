//! What a test found, as it is kept.

use serde::{Deserialize, Serialize};

/// A figure found by a test.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Section of the book.
    pub section: String,
    /// What it is a figure of, with its unit.
    pub what: String,
    /// The figure known from elsewhere.
    pub known: f64,
    /// Where from.
    pub source: String,
    /// Ours.
    pub ours: f64,
    /// Relative tolerance of the assertion: of `known` where it is met, of our own value where it is corrected.
    pub within: f64,
    /// How they stand to each other.
    pub verdict: Verdict,
    /// Why ours is trusted, where the figure known is not met.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub why: String,
    /// File of the test, from the root of the repository.
    pub file: String,
    /// Its name.
    pub test: String,
}

/// How two figures stand to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Ours is that known within the tolerance.
    Met,
    /// Ours is at most that known.
    Below,
    /// Ours is another one.
    Corrected,
}
