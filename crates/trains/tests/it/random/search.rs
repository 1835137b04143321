//! Random states of the trains of a case, as an engineer would try them.

use fastrand::Rng;
use trains::Orientation;

use super::reference::Reference;
use super::scene::Scene;

/// How far beyond its rails a train that enters is tried, length: more than trains take in a row.
const BEYOND: f64 = 150.0;

/// How each train stands.
pub type State = Vec<(f64, Orientation)>;

/// Draws states that are allowed: orders, stances, positions between limits, trains that touch, wheels beside cuts.
pub struct Draw<'a> {
    scene: &'a Scene,
    ranges: Vec<[f64; 2]>,
}

impl<'a> Draw<'a> {
    pub fn new(scene: &'a Scene, reference: &Reference<'_>) -> Draw<'a> {
        Draw {
            scene,
            ranges: reference.ranges.clone(),
        }
    }

    /// A random state; `cuts` are coordinates (rail, x) beside which wheels like to stand. `None` where the drawn order
    /// does not fit.
    pub fn state(&self, dice: &mut Rng, cuts: &[(usize, f64)]) -> Option<State> {
        let trains = &self.scene.case.trains;
        let mut order: Vec<usize> = (0..trains.len()).collect();
        if !self.scene.case.ordered {
            dice.shuffle(&mut order);
        }
        let stances: Vec<Orientation> = trains
            .iter()
            .map(|train| {
                let mut sign = || {
                    if train.reverses && dice.bool() {
                        -1.0
                    } else {
                        1.0
                    }
                };
                let signs = [sign(), sign(), sign()];
                Orientation {
                    turned: train.turned && dice.bool(),
                    signs,
                }
            })
            .collect();
        let limits: Vec<[f64; 2]> = (0..trains.len())
            .map(|t| self.limits(t, stances[t]))
            .collect();
        let extents: Vec<Vec<Option<[f64; 2]>>> = (0..trains.len())
            .map(|t| self.extents(t, stances[t]))
            .collect();
        let least = |a: usize, b: usize| {
            let shared = extents[a]
                .iter()
                .zip(&extents[b])
                .filter_map(|(a, b)| Some((*a)?[1] - (*b)?[0]));
            shared
                .map(|d| d + self.scene.case.gap)
                .fold(f64::NEG_INFINITY, f64::max)
        };
        // Latest positions, from the last train of the order back.
        let mut latest = vec![0.0; trains.len()];
        for k in (0..order.len()).rev() {
            let behind = order[k + 1..]
                .iter()
                .map(|&b| latest[b] - least(order[k], b));
            latest[order[k]] = behind.fold(limits[order[k]][1], f64::min);
        }
        let mut positions = vec![0.0; trains.len()];
        for k in 0..order.len() {
            let train = order[k];
            let before = order[..k].iter().map(|&a| positions[a] + least(a, train));
            let first = before.fold(limits[train][0], f64::max);
            let last = latest[train];
            if first > last {
                return None;
            }
            let near = |x: f64| x.clamp(first, last);
            let [first_on, last_on] = [first, last].map(|x| self.near_rails(train, x)).map(near);
            positions[train] = match dice.u8(..8) {
                0 => first,
                1 => last,
                2..=4 if !cuts.is_empty() => {
                    let (rail, x) = cuts[dice.usize(..cuts.len())];
                    let wheels = &trains[train].wheels;
                    let wheel = &wheels[dice.usize(..wheels.len())];
                    let offset = if stances[train].turned {
                        -wheel.x
                    } else {
                        wheel.x
                    };
                    let nudge = [-1e-9, 0.0, 1e-9][dice.usize(..3)];
                    let wanted = x - offset - self.shift(train, wheel.rail) + nudge;
                    if wheel.rail == rail && (first..=last).contains(&wanted) {
                        wanted
                    } else {
                        first
                    }
                }
                _ => first_on + (last_on - first_on) * dice.f64(),
            };
        }
        Some(positions.into_iter().zip(stances).collect())
    }

    /// The position nearest to one from which a train may reach its rails.
    fn near_rails(&self, train: usize, position: f64) -> f64 {
        let ranges = self.scene.case.trains[train].wheels.iter().map(|wheel| {
            let offset = wheel.x.abs();
            let [low, high] = self.ranges[wheel.rail].map(|x| x - self.shift(train, wheel.rail));
            [low - offset, high + offset]
        });
        let [low, high] = ranges.fold([f64::INFINITY, f64::NEG_INFINITY], |r, e| {
            [r[0].min(e[0]), r[1].max(e[1])]
        });
        position.clamp(low, high)
    }

    /// Rail coordinate less position of the train for a wheel of offset 0 on a rail.
    fn shift(&self, train: usize, rail: usize) -> f64 {
        let first = self.scene.case.trains[train].wheels[0].rail;
        self.scene.rails[first].origin[0] - self.scene.rails[rail].origin[0]
    }

    /// First and last position of a train.
    pub fn limits(&self, train: usize, stance: Orientation) -> [f64; 2] {
        let of = &self.scene.case.trains[train];
        let ends = of.wheels.iter().map(|wheel| {
            let offset =
                if stance.turned { -wheel.x } else { wheel.x } + self.shift(train, wheel.rail);
            self.ranges[wheel.rail].map(|end| end - offset)
        });
        if of.enters {
            let [first, last] = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |r, e| {
                [r[0].min(e[0]), r[1].max(e[1])]
            });
            // beyond its rails it may leave any room to others
            if self.scene.case.trains.len() > 1 {
                [first - BEYOND, last + BEYOND]
            } else {
                [first, last]
            }
        } else {
            ends.fold([f64::NEG_INFINITY, f64::INFINITY], |r, e| {
                [r[0].max(e[0]), r[1].min(e[1])]
            })
        }
    }

    /// What a train covers of each rail, ends included, less its position.
    fn extents(&self, train: usize, stance: Orientation) -> Vec<Option<[f64; 2]>> {
        let of = &self.scene.case.trains[train];
        let [before, behind] = if stance.turned {
            [of.ends[1], of.ends[0]]
        } else {
            of.ends
        };
        (0..self.scene.rails.len())
            .map(|rail| {
                let own = of.wheels.iter().filter(|wheel| wheel.rail == rail);
                let places =
                    own.map(|w| if stance.turned { -w.x } else { w.x } + self.shift(train, rail));
                let [low, high] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |r, x| {
                    [r[0].min(x), r[1].max(x)]
                });
                (low <= high).then_some([low - before, high + behind])
            })
            .collect()
    }
}
