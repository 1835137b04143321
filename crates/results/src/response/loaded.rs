//! Loads on rails at one output time, by wheels and end stops, and the displacements of the rails under them.

use sim::{Channel, Foundation, History};
use splines::{Axis, Error, Influence, Probe};

use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use foundations::BuiltFoundation;

/// The force of one wheel, or of one end stop, on its rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelLoad {
    /// Index of the structure.
    pub structure: usize,
    /// Rail within the structure.
    pub rail: usize,
    /// Rail coordinate.
    pub x: f64,
    /// Along +x, up, +z of the rail.
    pub force: [f64; 3],
}

/// Reads the loads on rails off the samples of a history.
///
/// The force of a prescribed motion acts on no rail and is none of these loads.
pub struct WheelLoadReader {
    wheels: Vec<Wheel>,
    stops: Vec<Stop>,
}

struct Stop {
    channel: usize,
    structure: usize,
    rail: usize,
    x: f64,
    /// 1 where the body comes from below x.
    side: f64,
}

struct Wheel {
    structure: usize,
    rail: usize,
    /// First of four consecutive channels: place, vertical, lateral, traction.
    first: usize,
}

impl WheelLoadReader {
    /// Of every wheel of `cast`, in its order, and of the end stops of `scene` that stand on rails.
    #[must_use]
    pub fn new(scene: &Scene, cast: &SimulationInput, history: &History) -> WheelLoadReader {
        let channel = |wanted: Channel| history.channels().iter().position(|c| *c == wanted);
        let wheels = cast.wheels.iter().enumerate().map(|(w, wheel)| {
            let rail = &scene.rails[wheel.rail];
            Wheel {
                structure: rail.structure,
                rail: rail.rail,
                first: channel(Channel::Position(w)).unwrap_or_default(),
            }
        });
        let meetings =
            scene.stops.iter().flat_map(|stop| stop.points.iter().map(move |meeting| (stop, meeting)));
        let stops = meetings.enumerate().filter_map(|(index, (stop, meeting))| {
            let rail = &scene.rails[stop.rail?];
            Some(Stop {
                channel: channel(Channel::Stop(index))?,
                structure: rail.structure,
                rail: rail.rail,
                x: stop.place.clamp(rail.range[0], rail.range[1]),
                side: meeting.side,
            })
        });
        WheelLoadReader { wheels: wheels.collect(), stops: stops.collect() }
    }

    /// Loads of all wheels at a sample of the history, in their order, then those of the end stops.
    #[must_use]
    pub fn at(&self, sample: &[f64]) -> Vec<WheelLoad> {
        let mut loads: Vec<WheelLoad> = self
            .wheels
            .iter()
            .map(|wheel| {
                let [x, vertical, lateral, traction] = std::array::from_fn(|k| sample[wheel.first + k]);
                let force = [traction, 0.0 - vertical, lateral];
                WheelLoad { structure: wheel.structure, rail: wheel.rail, x, force }
            })
            .collect();
        loads.extend(self.stops.iter().map(|stop| {
            let force = [stop.side * sample[stop.channel], 0.0, 0.0];
            WheelLoad { structure: stop.structure, rail: stop.rail, x: stop.x, force }
        }));
        loads
    }
}

/// A structure under the wheels of a run.
pub(super) struct LoadedStructure<'a> {
    pub scene: &'a Scene,
    /// Index of the structure in the scene.
    pub s: usize,
    pub history: &'a History,
    pub loads: &'a WheelLoadReader,
    pub built: &'a BuiltFoundation,
}

impl LoadedStructure<'_> {
    /// Loads on it at an output time.
    pub fn on(&self, row: usize) -> Vec<WheelLoad> {
        let all = self.loads.at(self.history.sample(row)).into_iter();
        all.filter(|load| load.structure == self.s).collect()
    }

    /// Whether its displacements can be computed: it is flexible, and its degrees of freedom, if any, were recorded.
    pub fn is_known(&self) -> bool {
        let foundation = &self.built.foundation;
        match foundation.structure {
            Some(_) => self.start().is_some(),
            None => foundation.compliance.is_some(),
        }
    }

    /// Displacements at the probes at output time `row`, under the loads `on` it at that time; `None` where a probe has a
    /// direction that the structure does not resist.
    ///
    /// # Errors
    /// [`Error::OffRail`] for a place beyond a rail.
    pub fn displacements(
        &self,
        probes: &[Probe],
        on: &[WheelLoad],
        row: usize,
    ) -> Result<Option<Vec<f64>>, Error> {
        let foundation = &self.built.foundation;
        let sample = self.history.sample(row);
        let q = self.start().map_or(&[][..], |at| &sample[at..at + foundation.dofs()]);
        match displacements(foundation, probes, on, q) {
            Ok(moved) => Ok(Some(moved)),
            Err(Error::NoStiffness { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// Channel of its first degree of freedom.
    fn start(&self) -> Option<usize> {
        self.history.channels().iter().position(|c| *c == Channel::Coordinate(self.s, 0))
    }
}

/// At most `most` of `count` indices, evenly distributed from the first to the last.
pub(super) fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let chosen = count.min(most);
    (0..chosen).map(move |k| k * (count - 1) / (chosen - 1).max(1))
}

/// Displacements u = G F + Phi q at the probes; G: compliance, F: loads, q: degrees of freedom, Phi: their shapes.
fn displacements(
    foundation: &Foundation,
    probes: &[Probe],
    loads: &[WheelLoad],
    q: &[f64],
) -> Result<Vec<f64>, Error> {
    let mut out = vec![0.0; probes.len()];
    if let Some(compliance) = &foundation.compliance {
        let mut at = probes.to_vec();
        let mut forces = Vec::new();
        for load in loads {
            for (axis, force) in
                [Axis::Longitudinal, Axis::Vertical, Axis::Lateral].into_iter().zip(load.force)
            {
                if force != 0.0 && (axis != Axis::Longitudinal || foundation.is_loaded_along) {
                    at.push(Probe { rail: load.rail, x: load.x, axis });
                    forces.push(force);
                }
            }
        }
        let mut influence = Influence::zeros(at.len());
        compliance.fill(&at, &mut influence)?;
        for (i, out) in out.iter_mut().enumerate() {
            *out += forces
                .iter()
                .enumerate()
                .map(|(j, force)| influence.value[(i, probes.len() + j)] * force)
                .sum::<f64>();
        }
    }
    if let (Some(structure), false) = (&foundation.structure, q.is_empty()) {
        let (mut value, mut slope) = (vec![0.0; q.len()], vec![0.0; q.len()]);
        for (out, probe) in out.iter_mut().zip(probes) {
            structure.shapes.row(*probe, &mut value, &mut slope)?;
            *out += value.iter().zip(q).map(|(phi, q)| phi * q).sum::<f64>();
        }
    }
    Ok(out)
}
