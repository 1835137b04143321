//! How far two forms of the same tables are apart.

use serde_json::{Value, json};

/// The largest difference, relative to the largest value of the same table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviation {
    /// |difference| / largest.
    pub largest: f64,
    /// Table, x and z of it.
    pub at: Option<(String, f64, f64)>,
}

impl Deviation {
    /// Takes a difference into account.
    pub(super) fn take(&mut self, name: &str, x: f64, z: f64, error: f64) {
        if error > self.largest || self.at.is_none() {
            (self.largest, self.at) = (error, Some((name.to_owned(), x, z)));
        }
    }

    /// For people.
    #[must_use]
    pub fn message(&self) -> String {
        let place = self.at.as_ref().map(|(name, x, z)| format!(" ({name} at x = {x}, z = {z})"));
        format!("{:.2e} of the largest value{}", self.largest, place.unwrap_or_default())
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let at = self.at.as_ref().map(|(name, x, z)| json!({ "table": name, "x": x, "z": z }));
        json!({ "largest": self.largest, "at": at })
    }
}
