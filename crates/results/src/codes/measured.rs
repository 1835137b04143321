//! The quantities of a run that codes have values for, taken from its columns.

use practice::TimedValue;

use super::crane::CraneData;
use crate::columns::NamedColumns;
use formats::scene::motion::SimulationInput;
use formats::scene::{Practice, Scene, end_stops, root_body};

/// Time over which the mean acceleration of a trolley is taken, s.
const WINDOW: f64 = 0.5;
/// Speed below which a braked body counts as standing, as a fraction of its speed when the brakes came on.
const STANDS: f64 = 0.02;

/// Indices of a wheel's forces.
const VERTICAL: usize = 0;
const LATERAL: usize = 1;
const TRACTION: usize = 2;

/// Quantities of a run; `None` where the scene has no such thing, or the quantity is zero throughout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredCrane {
    /// Largest ratio of the vertical force of a rail to its static force at the same position of the trolley.
    pub rail: Option<TimedValue>,
    /// The same ratio of one wheel.
    pub wheel: Option<TimedValue>,
    /// Largest and smallest ratio of (force of the trolley on the bridge, less the trolley's weight) to the lifted load.
    pub load: [Option<TimedValue>; 2],
    /// Lateral force of all wheels together: largest magnitude.
    pub across: Option<TimedValue>,
    /// Lateral force of one wheel: largest magnitude.
    pub flange: Option<TimedValue>,
    /// Force of the wheels along a rail: largest magnitude.
    pub along: Option<TimedValue>,
    /// Largest force of the end stops together.
    pub buffer: Option<TimedValue>,
    /// Largest force of the buffer between two cranes.
    pub collision: Option<TimedValue>,
    /// Speed of the crane when it meets the end stops.
    pub meeting: Option<f64>,
    /// Largest mean acceleration of the trolley over half a second.
    pub acceleration: Option<f64>,
    /// Braking distances of bridge and trolley to a stand, with the speed when the brakes came on.
    pub brakes: [Option<(TimedValue, f64)>; 2],
}

impl MeasuredCrane {
    /// The quantities of the run with the columns `record`, for the crane `measures`.
    #[must_use]
    pub fn new(
        scene: &Scene,
        practice: &Practice,
        cast: &SimulationInput,
        measures: &CraneData,
        record: &NamedColumns,
    ) -> MeasuredCrane {
        let time = record.values("time");
        let forces: Vec<[&[f64]; 3]> = cast
            .wheels
            .iter()
            .map(|wheel| ["vertical", "lateral", "traction"].map(|part| record.part(&wheel.name, part)))
            .collect();
        let sum = |own: &[usize], part: usize, row: usize| -> f64 {
            own.iter().map(|w| forces[*w][part].get(row).copied().unwrap_or_default()).sum()
        };
        let ridden = cast.wheels.iter().enumerate();
        let ridden: Vec<usize> = ridden
            .filter(|(_, wheel)| practice.trolley == Some(root_body(scene, wheel.body).0))
            .map(|(w, _)| w)
            .collect();
        let mut found = MeasuredCrane::default();
        let places = practice.trolley.map(|trolley| record.part(&scene.bodies[trolley].name, "x"));
        for (row, &t) in time.iter().enumerate() {
            let x = places.and_then(|places| places.get(row));
            let z = measures.line.zip(x).map(|([origin, slope], x)| origin + slope * x);
            let rest = measures.at_rest(z);
            let mut across = 0.0;
            for (own, rest) in measures.wheels.iter().zip(rest) {
                let mut rail = 0.0;
                for &w in own {
                    let force = sum(&[w], VERTICAL, row);
                    rail += force;
                    raise(&mut found.wheel, force * own.len() as f64 / rest, t);
                    raise(&mut found.flange, sum(&[w], LATERAL, row).abs(), t);
                }
                raise(&mut found.rail, rail / rest, t);
                raise(&mut found.along, sum(own, TRACTION, row).abs(), t);
                across += sum(own, LATERAL, row);
            }
            raise(&mut found.across, across.abs(), t);
            if !ridden.is_empty() && measures.crane.lifted > 0.0 {
                let factor = (sum(&ridden, VERTICAL, row) - measures.crane.trolley) / measures.crane.lifted;
                raise(&mut found.load[0], factor, t);
                let mut least = found.load[1].map(|mark| TimedValue { value: 0.0 - mark.value, ..mark });
                raise(&mut least, 0.0 - factor, t);
                found.load[1] = least.map(|mark| TimedValue { value: 0.0 - mark.value, ..mark });
            }
        }
        found.stops(scene, practice, record);
        if let Some(between) = measures.between {
            let force = record.part(&scene.stops[between.stop].name, "force");
            time.iter().zip(force).for_each(|(t, force)| raise(&mut found.collision, *force, *t));
        }
        let bodies = [Some(practice.crane), practice.trolley];
        found.brakes = bodies.map(|body| brakes(record, &scene.bodies[body?].name));
        found.acceleration = practice.trolley.and_then(|body| acceleration(record, &scene.bodies[body].name));
        for mark in
            [&mut found.across, &mut found.flange, &mut found.along, &mut found.buffer, &mut found.collision]
        {
            *mark = mark.filter(|mark| mark.value > 0.0);
        }
        found
    }

    /// Forces of the end stops of the crane's rails, and the speed at which they are met.
    fn stops(&mut self, scene: &Scene, practice: &Practice, record: &NamedColumns) {
        let stops = end_stops(scene, practice);
        let forces: Vec<&[f64]> = stops.map(|stop| record.part(&stop.name, "force")).collect();
        let speed = record.part(&scene.bodies[practice.crane].name, "speed");
        for (row, &t) in record.values("time").iter().enumerate() {
            let force: f64 = forces.iter().map(|values| values[row]).sum();
            if force > 0.0 && self.meeting.is_none() {
                self.meeting = speed.get(row.saturating_sub(1)).map(|speed| speed.abs());
            }
            raise(&mut self.buffer, force, t);
        }
    }
}

/// Replaces `mark` by `value` where that is larger; values that are not finite are ignored.
fn raise(mark: &mut Option<TimedValue>, value: f64, time: f64) {
    if value.is_finite() && mark.is_none_or(|known| value > known.value) {
        *mark = Some(TimedValue { value, time });
    }
}

/// Largest mean acceleration of a body over [`WINDOW`].
fn acceleration(record: &NamedColumns, body: &str) -> Option<f64> {
    let (time, speed) = (record.values("time"), record.part(body, "speed"));
    let mut from = 0;
    let mut most = 0.0_f64;
    for to in 0..time.len().min(speed.len()) {
        while from + 1 < to && time[to] - time[from + 1] >= WINDOW {
            from += 1;
        }
        let length = time[to] - time[from];
        if length >= WINDOW {
            most = most.max((speed[to] - speed[from]).abs() / length);
        }
    }
    (most > 0.0).then_some(most)
}

/// Braking distance of a body with the time when it stands, and its speed when the brakes came on.
fn brakes(record: &NamedColumns, body: &str) -> Option<(TimedValue, f64)> {
    let [x, speed, brake] = ["x", "speed", "brake"].map(|part| record.part(body, part));
    let on = brake.iter().position(|force| *force != 0.0)?.saturating_sub(1);
    let first = speed.get(on)?.abs();
    let rest = speed.iter().skip(on).position(|speed| speed.abs() <= STANDS * first)? + on;
    let time = *record.values("time").get(rest)?;
    (first > 0.0).then_some((TimedValue { value: (x[rest] - x[on]).abs(), time }, first))
}
