//! What a run gives: results by name, or the reason why there are none.

/// The results of a run, by name, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunRow {
    /// Names of the results.
    pub names: Vec<String>,
    /// Their values, all finite.
    pub values: Vec<f64>,
}

impl RunRow {
    /// Adds a result.
    pub(crate) fn add(&mut self, name: String, value: f64) {
        self.names.push(name);
        // no negative zero
        self.values.push(value + 0.0);
    }
}

/// The results of a run, or the reason why it has none.
pub type RunOutcome = Result<RunRow, String>;
