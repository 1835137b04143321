//! Extremes of a run: envelopes of columns with the state of the scene at each extreme, ranges of bodies in space,
//! and intervals in which wheels are off their rails.

use serde_json::{Map, Value, json};
use sim::{BodyDof, Channel, History};

use super::loaded::WheelLoadReader;
use crate::columns::NamedColumns;
use formats::scene::Scene;
use formats::scene::columns::Column;
use formats::scene::motion::SimulationInput;

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

/// An extreme value, with the state of the scene at its time.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnExtreme {
    /// The value.
    pub value: f64,
    /// Its row in the record.
    pub row: usize,
    /// Its time.
    pub time: f64,
    /// Positions of the bodies at that time, by name: x along the track, or X, Y and Z in space.
    pub bodies: Vec<(String, Vec<f64>)>,
    /// Forces of the wheels at that time, by name: vertical (down), lateral, along the rail.
    pub wheels: Vec<(String, [f64; 3])>,
}

impl ColumnEnvelope {
    /// The envelopes of `columns` of `record`, which has the rows of `history`.
    ///
    /// # Errors
    /// A column without values, or with fewer values than the record has rows.
    pub fn all(
        columns: &[Column],
        scene: &Scene,
        input: &SimulationInput,
        history: &History,
        loads: &WheelLoadReader,
        record: &NamedColumns,
    ) -> Result<Vec<ColumnEnvelope>, practice::Error> {
        if columns.is_empty() {
            return Ok(Vec::new());
        }
        let series: Vec<&[f64]> = columns
            .iter()
            .map(|column| record.values(&column.name))
            .collect();
        let run = practice::RunHistories {
            times: record.values("time"),
            series: &series,
        };
        let found = practice::envelope(&[run], columns.len())?;
        let extreme = |index: usize, at: &practice::ExtremeInstant| {
            let value = at.values[index];
            ColumnExtreme {
                value,
                time: at.time,
                ..scene_at(at.sample, scene, input, history, loads)
            }
        };
        let each = columns
            .iter()
            .zip(&found)
            .enumerate()
            .map(|(index, (column, found))| ColumnEnvelope {
                column: column.name.clone(),
                max: extreme(index, &found.max),
                min: extreme(index, &found.min),
            });
        Ok(each.collect())
    }

    /// The envelope as a member of `envelopes`.
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
            .map(|(name, at)| {
                (
                    name.clone(),
                    if let [x] = at[..] {
                        json!(x)
                    } else {
                        json!(at)
                    },
                )
            })
            .collect();
        let wheels: Map<String, Value> = self
            .wheels
            .iter()
            .map(|(name, force)| (name.clone(), json!(force.map(|part| part + 0.0))))
            .collect();
        json!({ "value": self.value + 0.0, "time": self.time, "bodies": bodies, "wheels": wheels })
    }
}

/// State of the scene at a row of the history, as an extreme of value 0.
fn scene_at(
    row: usize,
    scene: &Scene,
    input: &SimulationInput,
    history: &History,
    loads: &WheelLoadReader,
) -> ColumnExtreme {
    let sample = history.sample(row);
    let of = |channel: Channel| {
        history
            .channels()
            .iter()
            .position(|c| *c == channel)
            .map_or(0.0, |at| sample[at])
    };
    let bodies = scene.bodies.iter().enumerate().map(|(b, body)| {
        let all: &[BodyDof] = if body.in_space {
            &[BodyDof::X, BodyDof::Y, BodyDof::Z]
        } else {
            &[BodyDof::X]
        };
        let places = all.iter().map(|dof| of(Channel::Displacement(b, *dof)));
        (body.name.clone(), places.collect())
    });
    let forces = loads.at(sample);
    let wheels = input.wheels.iter().zip(&forces).map(|(wheel, load)| {
        let [along, up, side] = load.force;
        (wheel.name.clone(), [0.0 - up, side, along])
    });
    ColumnExtreme {
        value: 0.0,
        row,
        time: sample[0],
        bodies: bodies.collect(),
        wheels: wheels.collect(),
    }
}

/// Range of the positions of a body in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Sway {
    /// Its name.
    pub body: String,
    /// Smallest and largest X, Y and Z.
    pub range: [[f64; 2]; 3],
}

impl Sway {
    /// The ranges as a member of `sway`.
    #[must_use]
    pub fn json(&self) -> Value {
        let axes = ["X", "Y", "Z"].into_iter().zip(&self.range);
        Value::Object(
            axes.map(|(axis, range)| (axis.to_owned(), json!(range)))
                .collect::<Map<_, _>>(),
        )
    }
}

/// The ranges of every body in space.
pub(super) fn sways(scene: &Scene, record: &NamedColumns) -> Vec<Sway> {
    let bodies = scene.bodies.iter().filter(|body| body.in_space);
    let range = |values: &[f64]| {
        let least = values.iter().copied().reduce(f64::min)?;
        Some([least, values.iter().copied().reduce(f64::max)?])
    };
    bodies
        .filter_map(|body| {
            let [x, y, z] = ["X", "Y", "Z"].map(|axis| range(record.part(&body.name, axis)));
            Some(Sway {
                body: body.name.clone(),
                range: [x?, y?, z?],
            })
        })
        .collect()
}

/// An interval of time in which a wheel has no vertical force on its rail.
#[derive(Clone, Debug, PartialEq)]
pub struct Uplift {
    /// Name of the wheel.
    pub wheel: String,
    /// First output time without force.
    pub time: f64,
    /// Duration until the next output time with force, or until the last output time.
    pub duration: f64,
}

impl Uplift {
    /// The interval as an item of `uplift`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({ "wheel": self.wheel, "time": self.time, "duration": self.duration })
    }
}

/// All intervals without force at output times, wheel by wheel.
pub(super) fn uplifts(input: &SimulationInput, record: &NamedColumns) -> Vec<Uplift> {
    let time = record.values("time");
    let of = |name: &str| {
        let found = zero_intervals(time, record.part(name, "vertical"));
        let name = name.to_owned();
        found.into_iter().map(move |[time, duration]| Uplift {
            wheel: name.clone(),
            time,
            duration,
        })
    };
    input
        .wheels
        .iter()
        .flat_map(|wheel| of(&wheel.name))
        .collect()
}

/// Start and duration of each interval of zeros.
fn zero_intervals(time: &[f64], force: &[f64]) -> Vec<[f64; 2]> {
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
    use super::zero_intervals;

    #[test]
    fn intervals_of_zeros_are_found_at_the_start_between_and_at_the_end() {
        let time: Vec<f64> = (0..8).map(f64::from).collect();
        let found = zero_intervals(&time, &[0.0, 0.0, 3.0, 0.0, 2.0, 1.0, 0.0, 0.0]);
        assert_eq!(found, [[0.0, 2.0], [3.0, 1.0], [6.0, 1.0]]);
        assert!(zero_intervals(&time, &[1.0; 8]).is_empty());
    }
}
