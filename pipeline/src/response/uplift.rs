//! Wheels off their rails.

use serde_json::{Value, json};

use crate::motion::Cast;
use crate::record::Record;

/// A stretch of time in which a wheel does not press on its rail.
#[derive(Clone, Debug, PartialEq)]
pub struct Uplift {
    /// Name of the wheel.
    pub wheel: String,
    /// First output time without force.
    pub time: f64,
    /// From there to the next output time with force, or to the last one.
    pub duration: f64,
}

impl Uplift {
    /// As an item of `uplift`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({ "wheel": self.wheel, "time": self.time, "duration": self.duration })
    }
}

/// All of them, wheel by wheel, as far as output times show them.
pub(super) fn all(cast: &Cast, record: &Record) -> Vec<Uplift> {
    let time = record.values("time");
    let mut found = Vec::new();
    for wheel in &cast.wheels {
        let mut since = None;
        for (t, force) in time.iter().zip(record.part(&wheel.name, "vertical")) {
            match since {
                None if *force == 0.0 => since = Some(*t),
                Some(from) if *force != 0.0 => {
                    found.push(Uplift { wheel: wheel.name.clone(), time: from, duration: t - from });
                    since = None;
                }
                _ => {}
            }
        }
        if let (Some(from), Some(last)) = (since, time.last()) {
            found.push(Uplift { wheel: wheel.name.clone(), time: from, duration: last - from });
        }
    }
    found
}
