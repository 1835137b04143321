//! Wheels off their rails.

use serde_json::{Value, json};

use crate::record::NamedColumns;
use formats::motion::Cast;

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
pub(super) fn all(cast: &Cast, record: &NamedColumns) -> Vec<Uplift> {
    let time = record.values("time");
    let of = |name: &str| {
        let found = stretches(time, record.part(name, "vertical"));
        let name = name.to_owned();
        found.into_iter().map(move |[time, duration]| Uplift { wheel: name.clone(), time, duration })
    };
    cast.wheels.iter().flat_map(|wheel| of(&wheel.name)).collect()
}

/// Beginning and length of each stretch of zeros.
fn stretches(time: &[f64], force: &[f64]) -> Vec<[f64; 2]> {
    let mut found = Vec::new();
    let mut since = None;
    for (t, force) in time.iter().zip(force) {
        match since {
            None if *force == 0.0 => since = Some(*t),
            Some(from) if *force != 0.0 => {
                found.push([from, t - from]);
                since = None;
            }
            _ => {}
        }
    }
    if let (Some(from), Some(last)) = (since, time.last()) {
        found.push([from, last - from]);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::stretches;

    #[test]
    fn stretches_of_zeros_are_found_at_the_start_between_and_at_the_end() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        let found = stretches(&time, &[0.0, 0.0, 3.0, 0.0, 2.0, 1.0, 0.0, 0.0]);
        assert_eq!(found, [[0.0, 2.0], [3.0, 1.0], [6.0, 1.0]]);
        assert!(stretches(&time, &[1.0; 8]).is_empty());
    }
}
