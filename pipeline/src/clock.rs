//! Where the time of a job goes.

use std::time::Instant;

use serde_json::{Map, Value, json};

/// Seconds spent in each stage, in order.
pub struct StageClock {
    started: Instant,
    last: Instant,
    stages: Vec<(&'static str, f64)>,
}

impl Default for StageClock {
    fn default() -> Self {
        StageClock::new()
    }
}

impl StageClock {
    /// A clock that starts now.
    #[must_use]
    pub fn new() -> StageClock {
        let now = Instant::now();
        StageClock { started: now, last: now, stages: Vec::new() }
    }

    /// Books the time since the last lap to `stage`.
    pub fn lap(&mut self, stage: &'static str) {
        let now = Instant::now();
        self.stages.push((stage, (now - self.last).as_secs_f64()));
        self.last = now;
    }

    /// Seconds by stage, and in all.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut stages: Map<String, Value> =
            self.stages.iter().map(|(stage, seconds)| ((*stage).to_owned(), json!(seconds))).collect();
        stages.insert("total".to_owned(), json!((self.last - self.started).as_secs_f64()));
        Value::Object(stages)
    }
}
