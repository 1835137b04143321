//! Extremes of a run: envelopes of columns with the state of the scene at each extreme, ranges of bodies in space,
//! and intervals in which wheels are off their rails.

use serde_json::{Map, Value, json};
use sim::{BodyDof, Channel, Side, Solution};

use crate::columns::NamedColumns;
use crate::loads::WheelLoadReader;
use crate::steps::{ColumnInstant, SteppedColumns};
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
    /// Its time.
    pub time: f64,
    /// Positions of the bodies at that time, by name: x along the track, or X, Y and Z in space.
    pub bodies: Vec<(String, Vec<f64>)>,
    /// Forces of the wheels at that time, by name: vertical (down), lateral, along the rail.
    pub wheels: Vec<(String, [f64; 3])>,
}

impl ColumnEnvelope {
    /// The envelope of a column by its largest and smallest value.
    pub(super) fn new(
        column: &Column,
        [max, min]: [ColumnInstant; 2],
        (scene, input): (&Scene, &SimulationInput),
        solution: &Solution,
        loads: &WheelLoadReader,
    ) -> ColumnEnvelope {
        let extreme = |found: ColumnInstant| ColumnExtreme {
            value: found.value,
            ..scene_at(found.time, scene, input, solution, loads)
        };
        ColumnEnvelope {
            column: column.name.clone(),
            max: extreme(max),
            min: extreme(min),
        }
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

/// State of the scene at a time, as an extreme of value 0.
fn scene_at(
    time: f64,
    scene: &Scene,
    input: &SimulationInput,
    solution: &Solution,
    loads: &WheelLoadReader,
) -> ColumnExtreme {
    let mut sample = Vec::new();
    solution.row(time, Side::Before, &mut sample);
    let of = |channel: Channel| solution.position(channel).map_or(0.0, |at| sample[at]);
    let bodies = scene.bodies.iter().enumerate().map(|(b, body)| {
        let all: &[BodyDof] = if body.in_space {
            &[BodyDof::X, BodyDof::Y, BodyDof::Z]
        } else {
            &[BodyDof::X]
        };
        let places = all.iter().map(|dof| of(Channel::Displacement(b, *dof)));
        (body.name.clone(), places.collect())
    });
    let forces = loads.at(&sample);
    let wheels = input.wheels.iter().zip(&forces).map(|(wheel, load)| {
        let [along, up, side] = load.force;
        (wheel.name.clone(), [0.0 - up, side, along])
    });
    ColumnExtreme {
        value: 0.0,
        time,
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
    /// Time from which it has no force.
    pub time: f64,
    /// How long.
    pub duration: f64,
}

impl Uplift {
    /// The interval as an item of `uplift`.
    #[must_use]
    pub fn json(&self) -> Value {
        json!({ "wheel": self.wheel, "time": self.time, "duration": self.duration })
    }
}

/// All intervals without force, wheel by wheel.
pub(super) fn uplifts(input: &SimulationInput, steps: &SteppedColumns) -> Vec<Uplift> {
    let of = |name: &str| {
        let found = steps.zeros(steps.record.part(name, "vertical"));
        let name = name.to_owned();
        found.into_iter().map(move |[from, to]| Uplift {
            wheel: name.clone(),
            time: from,
            duration: to - from,
        })
    };
    input
        .wheels
        .iter()
        .flat_map(|wheel| of(&wheel.name))
        .collect()
}
