//! Trains where they stand in a state: the loads on the rails, and where rails lie beside each other.

use fea::Rail;
use formats::vector::{cross, dot, minus};
use trains::{RailLoad, TrainCase, TrainPosition};

/// Directions and places of the rails of a structure.
#[derive(Clone, Debug)]
pub(crate) struct RailLines {
    lines: Vec<RailLine>,
}

#[derive(Clone, Copy, Debug)]
struct RailLine {
    origin: [f64; 3],
    /// Unit vectors along x, up and along z.
    axes: [[f64; 3]; 3],
    range: [f64; 2],
}

impl RailLines {
    /// The rails of a model, with the first and last coordinate of each; `up` is its vertical direction.
    pub fn new(rails: &[Rail], ranges: &[[f64; 2]], up: [f64; 3]) -> RailLines {
        let line = |(rail, range): (&Rail, &[f64; 2])| RailLine {
            origin: rail.origin,
            axes: rail_axes(rail, up),
            range: *range,
        };
        RailLines {
            lines: rails.iter().zip(ranges).map(line).collect(),
        }
    }

    /// Number of rails.
    pub fn count(&self) -> usize {
        self.lines.len()
    }

    /// Unit vectors along x, up and along z of a rail.
    pub fn axes(&self, rail: usize) -> [[f64; 3]; 3] {
        self.lines[rail].axes
    }

    /// Coordinate on rail `to` of the place opposite to coordinate x of rail `from`: x + (o_from - o_to) . axis.
    pub fn opposite(&self, from: usize, to: usize, x: f64) -> f64 {
        let (a, b) = (&self.lines[from], &self.lines[to]);
        x + dot(minus(a.origin, b.origin), b.axes[0])
    }

    /// Distance of rail `to` from rail `from` along +z of the first.
    pub fn distance(&self, from: usize, to: usize) -> f64 {
        dot(
            minus(self.lines[to].origin, self.lines[from].origin),
            self.lines[from].axes[2],
        )
    }

    /// Whether a coordinate is on a rail, and the coordinate without rounding beyond its ends.
    pub fn on(&self, rail: usize, x: f64) -> Option<f64> {
        let [low, high] = self.lines[rail].range;
        let slack = 1e-9 * (high - low);
        (x >= low - slack && x <= high + slack).then(|| x.clamp(low, high))
    }

    /// The loads of trains that stand at these positions. A force at a distance e beside its rail is 1 - e times the force on
    /// the rail and e times the force on its twin, one unit of length along +z, whose number is that of the rail and the number
    /// of rails. Wheels beyond the ends of their rails carry nothing.
    pub fn loads(&self, case: &TrainCase, positions: &[TrainPosition]) -> Vec<RailLoad> {
        let mut out = Vec::new();
        for (train, at) in case.trains.iter().zip(positions) {
            let Some(first) = train.wheels.first() else {
                continue;
            };
            let [lateral, longitudinal, side] = at.stance.signs;
            for wheel in &train.wheels {
                let ahead = if at.stance.turned { -wheel.x } else { wheel.x };
                let x = self.opposite(first.rail, wheel.rail, at.position) + ahead;
                let Some(x) = self.on(wheel.rail, x) else {
                    continue;
                };
                let along = longitudinal * wheel.longitudinal;
                let lever = side * wheel.eccentricity;
                let force = [along, -wheel.vertical, lateral * wheel.lateral];
                if lever == 0.0 {
                    out.push(RailLoad {
                        rail: wheel.rail,
                        x,
                        force,
                    });
                    continue;
                }
                let near = [(1.0 - lever) * force[0], (1.0 - lever) * force[1], force[2]];
                out.push(RailLoad {
                    rail: wheel.rail,
                    x,
                    force: near,
                });
                let far = [lever * force[0], lever * force[1], 0.0];
                out.push(RailLoad {
                    rail: wheel.rail + self.count(),
                    x,
                    force: far,
                });
            }
        }
        out
    }
}

/// Unit vectors along x, up and along z of a rail; `up` is the vertical direction.
pub(crate) fn rail_axes(rail: &Rail, up: [f64; 3]) -> [[f64; 3]; 3] {
    let x = unit(rail.axis);
    let rise = dot(up, x);
    let y = unit(std::array::from_fn(|k| up[k] - rise * x[k]));
    [x, y, cross(x, y)]
}

/// The rails, and where `eccentric` asks for it their twins one unit of length along +z.
pub(crate) fn with_twins(rails: &[Rail], lines: &RailLines, eccentric: bool) -> Vec<Rail> {
    let mut all = rails.to_vec();
    if eccentric {
        for (index, rail) in rails.iter().enumerate() {
            let z = lines.axes(index)[2];
            let mut twin = rail.clone();
            for segment in &mut twin.segments {
                segment.offset = std::array::from_fn(|k| segment.offset[k] + z[k]);
            }
            all.push(twin);
        }
    }
    all
}

/// The vector made a unit vector; readers refuse axes without a length.
pub(crate) fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|part| part / length)
}
