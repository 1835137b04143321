//! Loads on rails by wheels and end stops, read from the rows of a run.

use std::ops::Range;

use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use sim::{Channel, History};
use trains::RailLoad;

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
    sources: Vec<LoadSource>,
}

/// Where the load of a wheel or of an end stop is read from.
#[derive(Clone, Debug)]
pub(crate) struct LoadSource {
    structure: usize,
    rail: usize,
    /// Consecutive channels: position, vertical, lateral and traction of a wheel, or the force of a stop.
    channels: Range<usize>,
    /// Coordinate of a stop, and 1 where the body approaches from smaller x, -1 from larger x; `None` for a wheel.
    stop: Option<[f64; 2]>,
}

impl LoadSource {
    /// The load in a sample of the history.
    pub fn load_in(&self, sample: &[f64]) -> RailLoad {
        self.load(&sample[self.channels.clone()])
    }

    /// The load by the values of its channels.
    pub fn load(&self, values: &[f64]) -> RailLoad {
        let (x, force) = match self.stop {
            Some([x, side]) => (x, [side * values[0], 0.0, 0.0]),
            None => (values[0], [values[3], 0.0 - values[1], values[2]]),
        };
        RailLoad {
            rail: self.rail,
            x,
            force,
        }
    }
}

impl WheelLoadReader {
    /// A reader for every wheel of `input`, in its order, and for the end stops of `scene` that stand on rails.
    #[must_use]
    pub fn new(scene: &Scene, input: &SimulationInput, history: &History) -> WheelLoadReader {
        let wheels = input.wheels.iter().enumerate().map(|(w, wheel)| {
            let rail = &scene.rails[wheel.rail];
            let first = history.position(Channel::Position(w)).unwrap_or_default();
            LoadSource {
                structure: rail.structure,
                rail: rail.rail,
                channels: first..first + 4,
                stop: None,
            }
        });
        let meetings = scene
            .stops
            .iter()
            .flat_map(|stop| stop.points.iter().map(move |meeting| (stop, meeting)));
        let stops = meetings.enumerate().filter_map(|(index, (stop, meeting))| {
            let rail = &scene.rails[stop.rail?];
            let channel = history.position(Channel::Stop(index))?;
            Some(LoadSource {
                structure: rail.structure,
                rail: rail.rail,
                channels: channel..channel + 1,
                stop: Some([stop.place.clamp(rail.range[0], rail.range[1]), meeting.side]),
            })
        });
        WheelLoadReader {
            sources: wheels.chain(stops).collect(),
        }
    }

    /// Where the loads on a structure are read from, in their order.
    pub(crate) fn on(&self, structure: usize) -> impl Iterator<Item = &LoadSource> + Clone {
        self.sources
            .iter()
            .filter(move |source| source.structure == structure)
    }

    /// Rail coordinates of the loads of [`WheelLoadReader::at`].
    pub(crate) fn places(&self, sample: &[f64]) -> impl Iterator<Item = f64> {
        self.sources.iter().map(|source| source.load_in(sample).x)
    }

    /// Loads of all wheels at a sample of the history, in their order, then those of the end stops.
    #[must_use]
    pub fn at(&self, sample: &[f64]) -> Vec<WheelLoad> {
        let load = |source: &LoadSource| {
            let RailLoad { rail, x, force } = source.load_in(sample);
            WheelLoad {
                structure: source.structure,
                rail,
                x,
                force,
            }
        };
        self.sources.iter().map(load).collect()
    }
}
