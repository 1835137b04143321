//! The quantities of a run for which codes have values, measured in its columns.

use practice::TimedValue;

use super::crane::CraneData;
use crate::columns::NamedColumns;
use formats::scene::motion::SimulationInput;
use formats::scene::{Practice, Scene, end_stops, root_body};

/// Time over which the mean acceleration of a bridge is computed, s.
const ACCELERATION_WINDOW: f64 = 0.5;
/// Speed below which a braked body counts as standing, as a fraction of its speed when the brakes are applied.
const STANDSTILL: f64 = 0.02;

/// Indices of the forces of a wheel.
const VERTICAL: usize = 0;
const LATERAL: usize = 1;
const TRACTION: usize = 2;

/// Quantities of a run; `None` where the scene does not have the quantity, or where it is zero throughout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredCrane {
    /// Largest ratio of the vertical force of a rail to its static force at the same position of the trolley.
    pub rail: Option<TimedValue>,
    /// The same ratio for one wheel.
    pub wheel: Option<TimedValue>,
    /// Largest and smallest ratio of (force of the trolley on the bridge minus the weight of the trolley) to the
    /// lifted load.
    pub load: [Option<TimedValue>; 2],
    /// Largest magnitude of the lateral force of all wheels together.
    pub lateral: Option<TimedValue>,
    /// Largest magnitude of the lateral force of one wheel.
    pub wheel_lateral: Option<TimedValue>,
    /// Largest magnitude of the longitudinal force of the wheels on one rail.
    pub longitudinal: Option<TimedValue>,
    /// Largest force of all end stops together.
    pub end_stops: Option<TimedValue>,
    /// Largest force of the buffer between two cranes.
    pub collision: Option<TimedValue>,
    /// Speed of the crane when it meets the end stops.
    pub impact_speed: Option<f64>,
    /// Largest mean acceleration of the bridge over half a second.
    pub acceleration: Option<f64>,
    /// Braking distances of bridge and trolley to standstill, with the speed when the brakes are applied.
    pub brakes: [Option<(TimedValue, f64)>; 2],
}

impl MeasuredCrane {
    /// The quantities of the run with the columns `record` for the given crane.
    #[must_use]
    pub fn new(
        scene: &Scene,
        practice: &Practice,
        input: &SimulationInput,
        crane: &CraneData,
        record: &NamedColumns,
    ) -> MeasuredCrane {
        let time = record.values("time");
        let forces = WheelForces::new(input, record);
        let carriers = input.wheels.iter().enumerate();
        let trolley_wheels: Vec<usize> = carriers
            .filter(|(_, wheel)| practice.trolley == Some(root_body(scene, wheel.body).0))
            .map(|(w, _)| w)
            .collect();
        let mut out = MeasuredCrane::default();
        let positions = practice
            .trolley
            .map(|trolley| record.part(&scene.bodies[trolley].name, "x"));
        for (row, &t) in time.iter().enumerate() {
            let x = positions.and_then(|positions| positions.get(row));
            let z = crane
                .trolley_line
                .zip(x)
                .map(|([origin, slope], x)| origin + slope * x);
            out.add_rail_forces(crane, &forces, z, row, t);
            if !trolley_wheels.is_empty() && crane.model.lifted > 0.0 {
                out.add_load_factor(crane, forces.sum(&trolley_wheels, VERTICAL, row), t);
            }
        }
        out.add_end_stops(scene, practice, record);
        if let Some(buffer) = crane.buffer {
            let force = record.part(&scene.stops[buffer.stop].name, "force");
            time.iter()
                .zip(force)
                .for_each(|(t, force)| raise(&mut out.collision, *force, *t));
        }
        let bodies = [Some(practice.crane), practice.trolley];
        out.brakes = bodies.map(|body| braking_distance(record, &scene.bodies[body?].name));
        out.acceleration = acceleration(record, &scene.bodies[practice.crane].name);
        for mark in [
            &mut out.lateral,
            &mut out.wheel_lateral,
            &mut out.longitudinal,
            &mut out.end_stops,
            &mut out.collision,
        ] {
            *mark = mark.filter(|mark| mark.value > 0.0);
        }
        out
    }

    /// Adds the wheel forces at one output time `t`, with the trolley at the lateral coordinate `z`.
    fn add_rail_forces(
        &mut self,
        crane: &CraneData,
        forces: &WheelForces<'_>,
        z: Option<f64>,
        row: usize,
        t: f64,
    ) {
        let mut lateral = 0.0;
        for (own, static_force) in crane.wheels.iter().zip(crane.static_rail_forces(z)) {
            let mut rail = 0.0;
            for &w in own {
                let force = forces.sum(&[w], VERTICAL, row);
                rail += force;
                raise(&mut self.wheel, force * own.len() as f64 / static_force, t);
                raise(
                    &mut self.wheel_lateral,
                    forces.sum(&[w], LATERAL, row).abs(),
                    t,
                );
            }
            raise(&mut self.rail, rail / static_force, t);
            raise(
                &mut self.longitudinal,
                forces.sum(own, TRACTION, row).abs(),
                t,
            );
            lateral += forces.sum(own, LATERAL, row);
        }
        raise(&mut self.lateral, lateral.abs(), t);
    }

    /// Adds the ratio of the force of the lifted load to its weight at time `t`, from the vertical `force` of the
    /// wheels of the trolley.
    fn add_load_factor(&mut self, crane: &CraneData, force: f64, t: f64) {
        let factor = (force - crane.model.trolley) / crane.model.lifted;
        raise(&mut self.load[0], factor, t);
        let mut least = self.load[1].map(|mark| TimedValue {
            value: 0.0 - mark.value,
            ..mark
        });
        raise(&mut least, 0.0 - factor, t);
        self.load[1] = least.map(|mark| TimedValue {
            value: 0.0 - mark.value,
            ..mark
        });
    }

    /// Adds the forces of the end stops of the crane's rails, and the speed at which they are met.
    fn add_end_stops(&mut self, scene: &Scene, practice: &Practice, record: &NamedColumns) {
        let stops = end_stops(scene, practice);
        let forces: Vec<&[f64]> = stops.map(|stop| record.part(&stop.name, "force")).collect();
        let speed = record.part(&scene.bodies[practice.crane].name, "speed");
        for (row, &t) in record.values("time").iter().enumerate() {
            let force: f64 = forces.iter().map(|values| values[row]).sum();
            if force > 0.0 && self.impact_speed.is_none() {
                self.impact_speed = speed.get(row.saturating_sub(1)).map(|speed| speed.abs());
            }
            raise(&mut self.end_stops, force, t);
        }
    }
}

/// Columns of the forces of every wheel: vertical, lateral, traction.
struct WheelForces<'r>(Vec<[&'r [f64]; 3]>);

impl<'r> WheelForces<'r> {
    fn new(input: &SimulationInput, record: &'r NamedColumns) -> WheelForces<'r> {
        let parts = ["vertical", "lateral", "traction"];
        WheelForces(
            input
                .wheels
                .iter()
                .map(|wheel| parts.map(|part| record.part(&wheel.name, part)))
                .collect(),
        )
    }

    /// Sum of one component over several wheels at one output time; a missing column counts as zero.
    fn sum(&self, wheels: &[usize], component: usize, row: usize) -> f64 {
        wheels
            .iter()
            .map(|w| self.0[*w][component].get(row).copied().unwrap_or_default())
            .sum()
    }
}

/// Replaces `mark` by `value` if that is larger; values that are not finite are ignored.
fn raise(mark: &mut Option<TimedValue>, value: f64, time: f64) {
    if value.is_finite() && mark.is_none_or(|known| value > known.value) {
        *mark = Some(TimedValue { value, time });
    }
}

/// Largest mean acceleration of a body over [`ACCELERATION_WINDOW`].
fn acceleration(record: &NamedColumns, body: &str) -> Option<f64> {
    let (time, speed) = (record.values("time"), record.part(body, "speed"));
    let mut from = 0;
    let mut most = 0.0_f64;
    for to in 0..time.len().min(speed.len()) {
        while from + 1 < to && time[to] - time[from + 1] >= ACCELERATION_WINDOW {
            from += 1;
        }
        let length = time[to] - time[from];
        if length >= ACCELERATION_WINDOW {
            most = most.max((speed[to] - speed[from]).abs() / length);
        }
    }
    (most > 0.0).then_some(most)
}

/// Braking distance of a body with the time of its standstill, and its speed when the brakes are applied.
fn braking_distance(record: &NamedColumns, body: &str) -> Option<(TimedValue, f64)> {
    let [x, speed, brake] = ["x", "speed", "brake"].map(|part| record.part(body, part));
    let on = brake
        .iter()
        .position(|force| *force != 0.0)?
        .saturating_sub(1);
    let first = speed.get(on)?.abs();
    let rest = speed
        .iter()
        .skip(on)
        .position(|speed| speed.abs() <= STANDSTILL * first)?
        + on;
    let time = *record.values("time").get(rest)?;
    (first > 0.0).then_some((
        TimedValue {
            value: (x[rest] - x[on]).abs(),
            time,
        },
        first,
    ))
}
