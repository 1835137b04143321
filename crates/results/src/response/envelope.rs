//! Extremes of a quantity over a run, with what goes with them.

use serde_json::{Map, Value, json};
use sim::{Channel, Freedom, History};

use super::wheel_load::WheelLoadHistories;
use crate::record::NamedColumns;
use formats::motion::Cast;
use formats::scene::Scene;
use formats::scene::columns::Column;

/// Largest and smallest value of one column.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnEnvelope {
    /// Its name.
    pub column: String,
    /// The largest value.
    pub max: ColumnExtreme,
    /// The smallest.
    pub min: ColumnExtreme,
}

/// A value, and what was elsewhere at that time.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnExtreme {
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

impl ColumnEnvelope {
    /// Of `columns` of `record`, which has the rows of `history`.
    ///
    /// # Errors
    /// A column without values.
    pub fn all(
        columns: &[Column],
        scene: &Scene,
        cast: &Cast,
        history: &History,
        loads: &WheelLoadHistories,
        record: &NamedColumns,
    ) -> Result<Vec<ColumnEnvelope>, practice::Error> {
        if columns.is_empty() {
            return Ok(Vec::new());
        }
        let series: Vec<&[f64]> = columns.iter().map(|column| record.values(&column.name)).collect();
        let run = practice::RunHistories { times: record.values("time"), series: &series };
        let found = practice::envelope(&[run], columns.len())?;
        let extreme = |index: usize, at: &practice::ExtremeInstant| {
            let value = at.values[index];
            ColumnExtreme { value, time: at.time, ..elsewhere(at.sample, scene, cast, history, loads) }
        };
        let each = columns.iter().zip(&found).enumerate().map(|(index, (column, found))| ColumnEnvelope {
            column: column.name.clone(),
            max: extreme(index, &found.max),
            min: extreme(index, &found.min),
        });
        Ok(each.collect())
    }

    /// As a member of `envelopes`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({ "max": self.max.json(), "min": self.min.json() })
    }
}

impl ColumnExtreme {
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

/// What is at a row of the history.
fn elsewhere(
    row: usize,
    scene: &Scene,
    cast: &Cast,
    history: &History,
    loads: &WheelLoadHistories,
) -> ColumnExtreme {
    let sample = history.sample(row);
    let of =
        |channel: Channel| history.channels().iter().position(|c| *c == channel).map_or(0.0, |at| sample[at]);
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
    ColumnExtreme { value: 0.0, row, time: sample[0], bodies: bodies.collect(), wheels: wheels.collect() }
}
