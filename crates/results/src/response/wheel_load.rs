//! What wheels and end stops do to rails at one output time.

use sim::{Channel, History};

use formats::motion::Cast;
use formats::scene::Scene;

/// The force of one wheel, or of one end stop, on its rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WheelLoadHistory {
    /// Index of the structure.
    pub structure: usize,
    /// Rail within the structure.
    pub rail: usize,
    /// Rail coordinate.
    pub x: f64,
    /// Along +x, up, +z of the rail.
    pub force: [f64; 3],
}

/// Reads wheel loads off samples of a history.
///
/// The force that a prescribed motion needs comes from nowhere on the rails.
pub struct WheelLoadHistories {
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
    /// First channel of the wheel: place, vertical, lateral, traction.
    first: usize,
}

impl WheelLoadHistories {
    /// Of every wheel of `cast`, in its order.
    #[must_use]
    pub fn new(scene: &Scene, cast: &Cast, history: &History) -> WheelLoadHistories {
        let channel = |wanted: Channel| history.channels().iter().position(|c| *c == wanted);
        let wheels = cast.wheels.iter().enumerate().map(|(w, wheel)| {
            let rail = &scene.rails[wheel.rail];
            Wheel {
                structure: rail.structure,
                rail: rail.rail,
                first: channel(Channel::Place(w)).unwrap_or_default(),
            }
        });
        let met =
            scene.stops.iter().flat_map(|stop| stop.meetings.iter().map(move |meeting| (stop, meeting)));
        let stops = met.enumerate().filter_map(|(index, (stop, meeting))| {
            let rail = &scene.rails[stop.rail?];
            Some(Stop {
                channel: channel(Channel::Stop(index))?,
                structure: rail.structure,
                rail: rail.rail,
                x: stop.place.clamp(rail.range[0], rail.range[1]),
                side: meeting.side,
            })
        });
        WheelLoadHistories { wheels: wheels.collect(), stops: stops.collect() }
    }

    /// Loads of all wheels at a sample, in their order, then of the end stops.
    #[must_use]
    pub fn at(&self, sample: &[f64]) -> Vec<WheelLoadHistory> {
        let mut loads: Vec<WheelLoadHistory> = self
            .wheels
            .iter()
            .map(|wheel| {
                let [x, vertical, lateral, traction] = std::array::from_fn(|k| sample[wheel.first + k]);
                let force = [traction, 0.0 - vertical, lateral];
                WheelLoadHistory { structure: wheel.structure, rail: wheel.rail, x, force }
            })
            .collect();
        loads.extend(self.stops.iter().map(|stop| {
            let force = [stop.side * sample[stop.channel], 0.0, 0.0];
            WheelLoadHistory { structure: stop.structure, rail: stop.rail, x: stop.x, force }
        }));
        loads
    }
}
