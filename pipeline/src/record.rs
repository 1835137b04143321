//! Histories as named columns.

use sim::{Channel, Freedom, History};
use splines::Axis;

use crate::motion::Cast;
use crate::scene::{Along, FREEDOMS, Scene};
use crate::units::Dimension;

/// One column of a history file.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Dimension of its values; angles have none.
    pub dimension: Dimension,
    /// One value a sample.
    pub values: Vec<f64>,
}

/// A history as named columns, `time` first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// The columns.
    pub columns: Vec<Column>,
}

impl Record {
    /// Names the channels of a run: bodies first, then wheels, then the sums of the vertical forces on each rail.
    #[must_use]
    pub fn new(scene: &Scene, cast: &Cast, history: &History) -> Record {
        let mut record = Record::default();
        record.push("time", Dimension::TIME, history.column(Channel::Time));
        for (b, body) in scene.bodies.iter().enumerate() {
            let name = &body.name;
            if body.in_space {
                for (axis, freedom) in ["X", "Y", "Z"].into_iter().zip(Freedom::ALL) {
                    let place = history.column(Channel::Displacement(b, freedom));
                    record.push(format!("{name}.{axis}"), Dimension::LENGTH, place);
                    let speed = history.column(Channel::Speed(b, freedom));
                    record.push(format!("{name}.{axis}_speed"), Dimension::SPEED, speed);
                }
                continue;
            }
            record.push(
                format!("{name}.x"),
                Dimension::LENGTH,
                history.column(Channel::Displacement(b, Freedom::X)),
            );
            let lift = history.column(Channel::Displacement(b, Freedom::Y));
            record.push(
                format!("{name}.deflection"),
                Dimension::LENGTH,
                lift.into_iter().map(|y| 0.0 - y).collect(),
            );
            for (i, freedom) in Freedom::ALL.into_iter().enumerate().skip(2).filter(|(i, _)| body.free[*i]) {
                let dimension = if i == 2 { Dimension::LENGTH } else { Dimension::NUMBER };
                let values = history.column(Channel::Displacement(b, freedom));
                record.push(format!("{name}.{}", FREEDOMS[i]), dimension, values);
            }
            record.push(
                format!("{name}.speed"),
                Dimension::SPEED,
                history.column(Channel::Speed(b, Freedom::X)),
            );
            if matches!(body.motion, Along::Prescribed(_) | Along::Driven(_)) {
                record.push(format!("{name}.drive"), Dimension::FORCE, history.column(Channel::Drive(b)));
            }
            if body.brake.is_some() {
                record.push(format!("{name}.brake"), Dimension::FORCE, history.column(Channel::Brake(b)));
            }
        }
        for (w, wheel) in cast.wheels.iter().enumerate() {
            let name = &wheel.name;
            let parts = [
                ("x", Dimension::LENGTH, Channel::Place(w)),
                ("vertical", Dimension::FORCE, Channel::Vertical(w)),
                ("lateral", Dimension::FORCE, Channel::Lateral(w)),
                ("traction", Dimension::FORCE, Channel::Traction(w)),
                ("penetration", Dimension::LENGTH, Channel::Penetration(w)),
                ("rail_deflection", Dimension::LENGTH, Channel::Give(w)),
            ];
            for (part, dimension, channel) in parts {
                record.push(format!("{name}.{part}"), dimension, history.column(channel));
            }
            if wheel.spins {
                record.push(
                    format!("{name}.spin_angle"),
                    Dimension::NUMBER,
                    history.column(Channel::SpinAngle(w)),
                );
                let rate = Dimension::of(0, 0, -1);
                record.push(format!("{name}.spin_speed"), rate, history.column(Channel::SpinSpeed(w)));
            }
        }
        for (r, rope) in scene.ropes.iter().enumerate() {
            let name = &rope.name;
            let tension = history.column(Channel::Tension(r));
            record.push(format!("{name}.tension"), Dimension::FORCE, tension);
            record.push(format!("{name}.length"), Dimension::LENGTH, history.column(Channel::Length(r)));
        }
        let mut first = 0;
        for stop in &scene.stops {
            let met: Vec<Vec<f64>> = (first..first + stop.meetings.len())
                .map(|meeting| history.column(Channel::Stop(meeting)))
                .collect();
            first += met.len();
            let sums = (0..history.len()).map(|i| met.iter().map(|forces| forces[i]).sum()).collect();
            record.push(format!("{}.force", stop.name), Dimension::FORCE, sums);
        }
        let gauges = scene.structures.iter().flat_map(|structure| {
            structure.gauges.iter().map(move |gauge| (format!("{}.{}", structure.name, gauge.name), gauge))
        });
        for (k, (name, gauge)) in gauges.enumerate() {
            let sign = if gauge.axis == Axis::Vertical { -1.0 } else { 1.0 };
            let values = history.column(Channel::Gauge(k)).into_iter().map(|u| sign * u).collect();
            record.push(name, Dimension::LENGTH, values);
        }
        for (r, rail) in scene.rails.iter().enumerate() {
            let on_rail: Vec<Vec<f64>> = (0..cast.wheels.len())
                .filter(|&w| cast.wheels[w].rail == r)
                .map(|w| history.column(Channel::Vertical(w)))
                .collect();
            if !on_rail.is_empty() {
                let sums = (0..history.len()).map(|i| on_rail.iter().map(|forces| forces[i]).sum()).collect();
                record.push(format!("{}.reaction", rail.name), Dimension::FORCE, sums);
            }
        }
        record
    }

    fn push(&mut self, name: impl Into<String>, dimension: Dimension, values: Vec<f64>) {
        self.columns.push(Column { name: name.into(), dimension, values });
    }

    /// One column by name; empty where there is none.
    #[must_use]
    pub fn values(&self, name: &str) -> &[f64] {
        self.columns.iter().find(|column| column.name == name).map_or(&[], |column| &column.values)
    }

    /// The column `<owner>.<part>`, such as a body's deflection; empty where there is none.
    #[must_use]
    pub(crate) fn part(&self, owner: &str, part: &str) -> &[f64] {
        self.values(&format!("{owner}.{part}"))
    }

    /// Two columns as points.
    #[must_use]
    pub fn points(&self, x: &str, y: &str) -> Vec<[f64; 2]> {
        self.values(x).iter().zip(self.values(y)).map(|(&x, &y)| [x, y]).collect()
    }

    /// As comma-separated values with a header; every number reads back to the last bit.
    ///
    /// # Errors
    /// None in practice: memory takes every byte.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|column| &column.name))?;
        let rows = self.columns.first().map_or(0, |column| column.values.len());
        for i in 0..rows {
            // adding zero turns -0 into 0
            writer.write_record(self.columns.iter().map(|column| format!("{:?}", column.values[i] + 0.0)))?;
        }
        writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
    }
}

/// Largest value of a column, with its index.
#[must_use]
pub fn peak(values: &[f64]) -> Option<(usize, f64)> {
    values.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
}
