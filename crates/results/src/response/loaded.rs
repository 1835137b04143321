//! Loads on rails by wheels and end stops at one output time, and the displacements of the rails under these loads.

use sim::{Channel, Foundation, History};
use splines::{Axis, Error, Probe};

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
    /// Components along +x, up and along +z of the rail.
    pub force: [f64; 3],
}

/// Reads the loads on rails from the samples of a history.
///
/// The force of a prescribed motion does not act on a rail and is not included.
pub struct WheelLoadReader {
    wheels: Vec<Wheel>,
    stops: Vec<Stop>,
}

struct Stop {
    channel: usize,
    structure: usize,
    rail: usize,
    x: f64,
    /// 1 where the body approaches from smaller x, -1 from larger x.
    side: f64,
}

struct Wheel {
    structure: usize,
    rail: usize,
    /// First of four consecutive channels: position, vertical, lateral, traction.
    first: usize,
}

impl WheelLoadReader {
    /// A reader for every wheel of `input`, in its order, and for the end stops of `scene` that stand on rails.
    #[must_use]
    pub fn new(scene: &Scene, input: &SimulationInput, history: &History) -> WheelLoadReader {
        let channel = |wanted: Channel| history.channels().iter().position(|c| *c == wanted);
        let wheels = input.wheels.iter().enumerate().map(|(w, wheel)| {
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

    /// The channels that the loads are read from.
    pub(crate) fn channels(&self) -> Vec<usize> {
        let wheels = self.wheels.iter().flat_map(|wheel| wheel.first..wheel.first + 4);
        wheels.chain(self.stops.iter().map(|stop| stop.channel)).collect()
    }

    /// The channels that the loads on a structure are read from: those of positions, and those of forces.
    pub(crate) fn channels_on(&self, structure: usize) -> [Vec<usize>; 2] {
        let wheels = self.wheels.iter().filter(|wheel| wheel.structure == structure);
        let stops = self.stops.iter().filter(|stop| stop.structure == structure);
        let forces = wheels.clone().flat_map(|wheel| wheel.first + 1..wheel.first + 4);
        [wheels.map(|wheel| wheel.first).collect(), forces.chain(stops.map(|stop| stop.channel)).collect()]
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

/// A structure with the wheel loads of a run.
pub(super) struct LoadedStructure<'a> {
    pub scene: &'a Scene,
    /// Index of the structure in the scene.
    pub s: usize,
    pub history: &'a History,
    pub loads: &'a WheelLoadReader,
    pub built: &'a BuiltFoundation,
}

impl LoadedStructure<'_> {
    /// Loads on the structure at an output time.
    pub fn on(&self, row: usize) -> Vec<WheelLoad> {
        let all = self.loads.at(self.history.sample(row)).into_iter();
        all.filter(|load| load.structure == self.s).collect()
    }

    /// Whether the displacements can be computed: the structure is flexible, and its degrees of freedom, if any, were
    /// recorded.
    pub fn is_known(&self) -> bool {
        let foundation = &self.built.foundation;
        match foundation.structure {
            Some(_) => self.start().is_some(),
            None => foundation.compliance.is_some(),
        }
    }

    /// Displacements at the probes at output time `row` under the loads `on` the structure at that time; `None` if
    /// the structure is unrestrained in the direction of a probe.
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

    /// Channel of the first degree of freedom of the structure.
    fn start(&self) -> Option<usize> {
        self.history.channels().iter().position(|c| *c == Channel::Coordinate(self.s, 0))
    }
}

/// At most `most` of `count` indices, evenly distributed from the first to the last.
pub(crate) fn spread(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let chosen = count.min(most);
    (0..chosen).map(move |k| k * (count - 1) / (chosen - 1).max(1))
}

/// Displacements u = G F + Phi q at the probes; G: compliance, F: loads, q: degrees of freedom, Phi: their shape
/// functions.
pub(crate) fn displacements(
    foundation: &Foundation,
    probes: &[Probe],
    loads: &[WheelLoad],
    q: &[f64],
) -> Result<Vec<f64>, Error> {
    let mut out = vec![0.0; probes.len()];
    if let Some(compliance) = &foundation.compliance {
        let mut forces = Vec::new();
        for load in loads {
            for (axis, force) in
                [Axis::Longitudinal, Axis::Vertical, Axis::Lateral].into_iter().zip(load.force)
            {
                if force != 0.0 && (axis != Axis::Longitudinal || foundation.is_loaded_along) {
                    forces.push((Probe { rail: load.rail, x: load.x, axis }, force));
                }
            }
        }
        compliance.displacements(probes, &forces, &mut out)?;
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
