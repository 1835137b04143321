//! Extremes of a quantity over a run, with what goes with them.

use serde_json::{Map, Value, json};
use sim::{Channel, Freedom, History};

use super::wheel_load::WheelLoads;
use crate::motion::Cast;
use crate::record::Record;
use crate::scene::Scene;

/// Largest and smallest value of one column.
#[derive(Clone, Debug, PartialEq)]
pub struct Envelope {
    /// Its name.
    pub column: String,
    /// The largest value.
    pub max: Extreme,
    /// The smallest.
    pub min: Extreme,
}

/// A value, and what was elsewhere at that time.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// Row of the record.
    pub row: usize,
    /// When.
    pub time: f64,
    /// Where the bodies were, by name: x along the track, or X, Y and Z in space.
    pub bodies: Vec<(String, Vec<f64>)>,
    /// Forces of the wheels, by name: pressing down, sideways, along the rail.
    pub wheels: Vec<(String, [f64; 3])>,
}

impl Envelope {
    /// Of a column of `record`, which has the rows of `history`; `None` where it has none.
    #[must_use]
    pub fn new(
        column: &str,
        scene: &Scene,
        cast: &Cast,
        history: &History,
        loads: &WheelLoads,
        record: &Record,
    ) -> Option<Envelope> {
        let values = record.values(column);
        let pick = |better: fn(f64, f64) -> bool| {
            (0..values.len()).reduce(|best, i| if better(values[i], values[best]) { i } else { best })
        };
        let extreme = |row: usize| {
            let sample = history.sample(row);
            let of = |channel: Channel| {
                history.channels().iter().position(|c| *c == channel).map_or(0.0, |at| sample[at])
            };
            let bodies = scene.bodies.iter().enumerate().map(|(b, body)| {
                let all: &[Freedom] =
                    if body.in_space { &[Freedom::X, Freedom::Y, Freedom::Z] } else { &[Freedom::X] };
                let places = all.iter().map(|freedom| of(Channel::Displacement(b, *freedom)));
                (body.name.clone(), places.collect())
            });
            let forces = loads.at(sample);
            let wheels = cast.wheels.iter().zip(&forces).map(|(wheel, load)| {
                let [along, up, side] = load.force;
                (wheel.name.clone(), [0.0 - up, side, along])
            });
            Extreme {
                value: values[row],
                row,
                time: of(Channel::Time),
                bodies: bodies.collect(),
                wheels: wheels.collect(),
            }
        };
        Some(Envelope {
            column: column.to_owned(),
            max: extreme(pick(|a, b| a > b)?),
            min: extreme(pick(|a, b| a < b)?),
        })
    }

    /// As a member of `envelopes`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({ "max": self.max.json(), "min": self.min.json() })
    }
}

impl Extreme {
    fn json(&self) -> Value {
        let bodies: Map<String, Value> = self
            .bodies
            .iter()
            .map(|(name, at)| (name.clone(), if let [x] = at[..] { json!(x) } else { json!(at) }))
            .collect();
        let wheels: Map<String, Value> = self
            .wheels
            .iter()
            .map(|(name, force)| (name.clone(), json!(force.map(|part| part + 0.0))))
            .collect();
        json!({ "value": self.value + 0.0, "time": self.time, "bodies": bodies, "wheels": wheels })
    }
}
