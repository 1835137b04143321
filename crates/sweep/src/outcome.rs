//! What a run gives: results by name, or the reason why there are none.

use std::sync::Arc;

use formats::units::Dimension;

/// The results of a run, by name, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunRow {
    /// Names of the results; runs with the same share them.
    pub names: Arc<Vec<String>>,
    /// Their values, all finite.
    pub values: Vec<f64>,
    /// Their dimensions; empty for a row that was read from a file.
    pub dimensions: Vec<Dimension>,
}

impl RunRow {
    /// Adds a result.
    pub(crate) fn add(&mut self, name: String, value: f64, dimension: Dimension) {
        Arc::make_mut(&mut self.names).push(name);
        // no negative zero
        self.values.push(value + 0.0);
        self.dimensions.push(dimension);
    }

    /// Adds a ratio, or keeps the largest of those with this name.
    pub(crate) fn add_largest(&mut self, name: String, ratio: f64) {
        match self.names.iter().position(|known| *known == name) {
            Some(place) => self.values[place] = self.values[place].max(ratio),
            None => self.add(name, ratio, Dimension::NUMBER),
        }
    }
}

/// The results of a run, or the reason why it has none.
pub type RunOutcome = Result<RunRow, String>;

/// Why a run has no results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RunFailure {
    /// The run does not have a result that is wanted: its index in the list of the sweep, and the reason.
    Missing(usize, String),
    /// There is no run.
    Failed(String),
    /// It was told to stop.
    Stopped,
}

impl RunFailure {
    /// The reason; `None` for a run that was stopped.
    #[must_use]
    pub fn why(self) -> Option<String> {
        match self {
            RunFailure::Missing(_, why) | RunFailure::Failed(why) => Some(why),
            RunFailure::Stopped => None,
        }
    }
}

impl From<String> for RunFailure {
    fn from(why: String) -> Self {
        RunFailure::Failed(why)
    }
}
