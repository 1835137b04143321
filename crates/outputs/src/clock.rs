//! Measurement of the time that each stage of a command takes.

use std::time::Instant;

use serde_json::{Map, Value, json};

/// Clock that records the duration of each stage of a command, in order.
#[derive(Clone, Debug)]
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
    /// Creates a clock that starts now.
    #[must_use]
    pub fn new() -> StageClock {
        let now = Instant::now();
        StageClock {
            started: now,
            last: now,
            stages: Vec::new(),
        }
    }

    /// Records the time since the previous lap as the duration of `stage`.
    pub fn lap(&mut self, stage: &'static str) {
        let now = Instant::now();
        self.stages.push((stage, (now - self.last).as_secs_f64()));
        self.last = now;
    }

    /// Goes on after a pause, which is not counted.
    pub fn resume(&mut self) {
        let now = Instant::now();
        self.started += now - self.last;
        self.last = now;
    }

    /// Adds the time since the previous lap to the duration of the last stage.
    pub fn prolong(&mut self) {
        let now = Instant::now();
        if let Some((_, seconds)) = self.stages.last_mut() {
            *seconds += (now - self.last).as_secs_f64();
        }
        self.last = now;
    }

    /// Durations of the stages and their total as JSON, s.
    #[must_use]
    pub fn json(&self) -> Value {
        let mut stages: Map<String, Value> = self
            .stages
            .iter()
            .map(|(stage, seconds)| ((*stage).to_owned(), json!(seconds)))
            .collect();
        stages.insert(
            "total".to_owned(),
            json!((self.last - self.started).as_secs_f64()),
        );
        Value::Object(stages)
    }
}
