//! The quantities by which "auto" judges the runs of a scene: all columns of its history, and the reactions, internal
//! forces and stresses that its output requests.

use sim::{BodyDof, Channel, History, Record, RecordedQuantity};

use crate::response::{ColumnInfluence, WheelLoadReader, influence_lines};
use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use formats::scene::quantity::quantities;
use formats::units::Dimension;
use foundations::{
    BuiltFoundation, Error, MotionBasis, SolvedModel, SolvedStructure, TrialObserver, solution_of,
};

/// Kinds of quantities.
const FORCE: &str = "force";
const MOMENT: &str = "moment";
const DISPLACEMENT: &str = "displacement";
const ROTATION: &str = "rotation";
/// Fraction of the product of the largest force and the longest rail up to which moments are rounding errors.
const ROUNDING: f64 = 1e-6;

/// Observer of the trials of a scene.
pub struct ColumnObserver<'a> {
    scene: &'a Scene,
    input: &'a SimulationInput,
    known: &'a [SolvedStructure],
    /// Influence lines of the columns of each structure, without motions of its own; computed when first needed.
    lines: Option<Vec<Option<ColumnInfluence>>>,
    trial: &'a dyn Fn(&str),
}

impl<'a> ColumnObserver<'a> {
    /// Observes the runs of `scene`, whose simulation input is `input`, with the solutions `known` of its specs. `trial`
    /// receives the description of each run before it starts.
    #[must_use]
    pub fn new(
        scene: &'a Scene,
        input: &'a SimulationInput,
        known: &'a [SolvedStructure],
        trial: &'a dyn Fn(&str),
    ) -> Self {
        ColumnObserver {
            scene,
            input,
            known,
            lines: None,
            trial,
        }
    }

    fn solved(&self, structure: usize) -> Option<&'a SolvedModel> {
        solution_of(self.known, &self.scene.structures[structure].origin)
    }

    /// The influence lines of the columns of every structure.
    fn lines(&mut self) -> Result<&mut [Option<ColumnInfluence>], Error> {
        if self.lines.is_none() {
            let structures = self.scene.structures.iter();
            let bare: Vec<BuiltFoundation> = structures
                .map(|_| sim::Foundation::rigid().into())
                .collect();
            let solved: Vec<_> = (0..bare.len()).map(|s| self.solved(s)).collect();
            let lines =
                influence_lines(self.scene, &bare, &solved).map_err(|error| match error {
                    crate::Error::Lines { structure, source } => Error::Frame { structure, source },
                    other => Error::Observed(other.to_string()),
                })?;
            self.lines = Some(lines);
        }
        Ok(self.lines.get_or_insert_default())
    }

    /// Values of the columns of structure `s`.
    fn columns(
        &mut self,
        s: usize,
        history: &History,
        basis: Option<&MotionBasis>,
        quantities: &mut Vec<RecordedQuantity>,
    ) -> Result<(), Error> {
        let (scene, solved) = (self.scene, self.solved(s));
        let loads = WheelLoadReader::new(scene, self.input, history);
        let (Some(lines), Some(solved)) = (&mut self.lines()?[s], solved) else {
            return Ok(());
        };
        let frame_error = Error::frame(&scene.structures[s].name);
        lines.set_motion(basis, solved).map_err(frame_error)?;
        let start = history.position(Channel::Acceleration(s, 0));
        let mut values = vec![Vec::with_capacity(history.len()); lines.columns().len()];
        let mut now = vec![0.0; lines.columns().len()];
        for sample in history.samples() {
            let acceleration = start.map_or(&[][..], |at| &sample[at..at + lines.dofs()]);
            let on = loads.at(sample);
            lines.at(
                on.iter().filter(|load| load.structure == s),
                acceleration,
                &mut now,
            );
            values
                .iter_mut()
                .zip(&now)
                .for_each(|(column, value)| column.push(*value));
        }
        quantities.extend(lines.columns().iter().zip(values).map(|(column, values)| {
            let kind = match column.dimension {
                Dimension::MOMENT => MOMENT,
                Dimension::STRESS => "stress",
                _ => FORCE,
            };
            let name = column.name.clone();
            RecordedQuantity {
                name,
                kind,
                channel: None,
                is_position: false,
                group: String::new(),
                least_scale: 0.0,
                values,
            }
        }));
        Ok(())
    }

    /// The group of a quantity at a wheel: its part and the body of the wheel.
    fn group(&self, channel: Channel) -> String {
        let (part, w) = match channel {
            Channel::Vertical(w) => ("vertical", w),
            Channel::Lateral(w) => ("lateral", w),
            Channel::Traction(w) => ("traction", w),
            Channel::Penetration(w) => ("penetration", w),
            Channel::Deflection(w) => ("deflection", w),
            _ => return String::new(),
        };
        format!("{part} of body {}", self.input.wheels[w].body)
    }

    /// Sets the least scales of moments and rotations, which may all be zero but for rounding: those that the largest
    /// force and displacement make with the longest rail, times 1e-6.
    fn set_least_scales(&self, found: &mut [RecordedQuantity]) {
        let lengths = self
            .scene
            .rails
            .iter()
            .map(|rail| rail.range[1] - rail.range[0]);
        let length = lengths.fold(0.0, f64::max);
        let largest = |kind: &str| {
            let values = found
                .iter()
                .filter(|own| own.kind == kind)
                .flat_map(|own| &own.values);
            values.fold(0.0_f64, |most, value| most.max(value.abs()))
        };
        let (moment, rotation) = (largest(FORCE) * length, largest(DISPLACEMENT) / length);
        for own in found.iter_mut() {
            let scale = match own.kind {
                MOMENT => moment,
                ROTATION => rotation,
                _ => continue,
            };
            own.least_scale = if scale.is_finite() {
                ROUNDING * scale
            } else {
                0.0
            };
        }
    }
}

impl TrialObserver for ColumnObserver<'_> {
    fn record(
        &mut self,
        history: &History,
        bases: &[Option<MotionBasis>],
    ) -> Result<Record, Error> {
        let mut found = Vec::new();
        for quantity in quantities(self.scene) {
            let Some((kind, is_position)) = quantity
                .terms
                .first()
                .and_then(|(channel, _)| kind(*channel))
            else {
                continue;
            };
            let parts: Vec<(Vec<f64>, f64)> = quantity
                .terms
                .iter()
                .map(|(channel, factor)| (history.column(*channel), *factor))
                .collect();
            let sum = |i: usize| {
                parts
                    .iter()
                    .map(|(values, factor)| factor * values[i])
                    .sum::<f64>()
            };
            let channel = match quantity.terms.as_slice() {
                [(channel, _)] => Some(*channel),
                _ => None,
            };
            let values = (0..history.len()).map(sum).collect();
            let group = channel.map_or_else(String::new, |channel| self.group(channel));
            found.push(RecordedQuantity {
                name: quantity.name,
                kind,
                channel,
                is_position,
                group,
                least_scale: 0.0,
                values,
            });
        }
        for (s, basis) in bases.iter().enumerate() {
            self.columns(s, history, basis.as_ref(), &mut found)?;
        }
        self.set_least_scales(&mut found);
        Ok(Record {
            time: history.column(Channel::Time),
            quantities: found,
        })
    }

    fn effects(
        &mut self,
        structure: usize,
        basis: &MotionBasis,
    ) -> Result<Vec<(String, Vec<f64>)>, Error> {
        let solved = self.solved(structure);
        let frame_error = Error::frame(&self.scene.structures[structure].name);
        let (Some(lines), Some(solved)) = (&mut self.lines()?[structure], solved) else {
            return Ok(Vec::new());
        };
        lines.set_motion(Some(basis), solved).map_err(frame_error)?;
        let columns = lines.columns().iter().enumerate();
        Ok(columns
            .map(|(c, column)| (column.name.clone(), lines.per_acceleration(c)))
            .collect())
    }

    fn begin(&mut self, trial: &str) {
        (self.trial)(trial);
    }
}

/// Kind of a quantity by its first channel, and whether it is a position; `None` for time, which is not judged.
fn kind(channel: Channel) -> Option<(&'static str, bool)> {
    Some(match channel {
        Channel::Time => return None,
        Channel::Displacement(_, BodyDof::X) | Channel::Position(_) | Channel::SpinAngle(_) => {
            ("position", true)
        }
        Channel::Displacement(_, BodyDof::Roll | BodyDof::Yaw | BodyDof::Pitch) => {
            (ROTATION, false)
        }
        Channel::Displacement(..) | Channel::Deflection(_) | Channel::Gauge(_) => {
            (DISPLACEMENT, false)
        }
        Channel::Penetration(_) => ("penetration", false),
        Channel::Speed(..) => ("speed", false),
        Channel::SpinSpeed(_) => ("spin", false),
        Channel::SpinMoment(_) => (MOMENT, false),
        Channel::Length(_) => ("length", false),
        Channel::Drive(_) | Channel::Brake(_) | Channel::Traction(_) => (FORCE, false),
        Channel::Vertical(_) | Channel::Lateral(_) | Channel::Tension(_) | Channel::Stop(_) => {
            (FORCE, false)
        }
        Channel::Coordinate(..) | Channel::Acceleration(..) => return None,
    })
}
