//! Positions and forces of the wheels of a run between its samples.
//!
//! Between two samples a wheel moves steadily and each of its forces is the cubic polynomial with the values and rates at
//! both. A rate at a sample is that of the parabola through it and its neighbours. Where the force bends there much more
//! than at one of the neighbours, because the wheel meets its rail, leaves it or passes a corner of it, it is the difference
//! of values on either side. Two things happen between samples:
//!
//! - the slope of the shapes of the modes jumps where a wheel passes a hinge, a support of a shear-flexible beam or another
//!   break of its rail;
//! - the force jumps where a wheel passes a step of its rail, or meets it with a damper, of which the instant is not known.
//!   Before and after that it changes as in the intervals beside. A damper between wheel and rail gives the rail an impulse
//!   c dh at a step of the height dh as well.

use crate::mechanics::wheels::Wheels;
use crate::numerics::cubic::{cubic, value_and_slope};
use crate::{Channel, Damper, Error, Foundation, History, Irregularity, Scene};

/// Largest ratio of the bends of a force at two neighbouring samples between which it is smooth.
const SMOOTH: f64 = 3.0;
/// Least distance of corners from both ends of an interval and from each other, relative to the interval.
pub(super) const CORNER: f64 = 1e-6;
/// Distance of the places on the two sides of a corner from it, relative to the interval.
const BESIDE: f64 = 1e-9;

/// A wheel on the structure, with the positions of its values in a sample.
pub(super) struct LoadedWheel {
    /// Places at which the height of its rail steps, and by how much: there its force jumps.
    steps: Vec<[f64; 2]>,
    /// Places at which the slope of the shapes may jump.
    breaks: Vec<f64>,
    /// Whether its force jumps where it meets the rail: its damper acts at once.
    is_damped: bool,
    /// Its number in the scene.
    pub index: usize,
    pub body: usize,
    pub rail: usize,
    /// First of four consecutive channels: position, vertical, lateral, traction.
    pub first: usize,
    /// Stiffness and damping of its contact at rest, the damping only of a damper between wheel and rail.
    pub contact: [f64; 2],
    /// |k + i omega c| for the frequency omega of each mode.
    pub at_modes: Vec<f64>,
}

/// The wheels on a structure that the samples of a run contain. `frequencies` are those of the modes.
///
/// # Errors
/// A wheel beyond its rail.
pub(super) fn loaded_wheels(
    scene: &Scene,
    foundations: &[Foundation],
    structure: usize,
    history: &History,
    frequencies: &[f64],
) -> Result<Vec<LoadedWheel>, Error> {
    let foundation = &foundations[structure];
    let mut wheels = Vec::new();
    for (index, point) in Wheels::new(scene, foundations, || 0)?
        .points
        .iter()
        .enumerate()
    {
        let contact = &scene.contacts[point.contact];
        let Some(first) = history.position(Channel::Position(index)) else {
            continue;
        };
        if contact.structure != structure {
            continue;
        }
        let law = &scene.wheels[contact.wheel].normal;
        let rest = history.sample(0)[first + 1].max(0.0);
        let at = law.at(law.penetration(rest), 0.0);
        let (k, c) = (
            at.by_penetration,
            if law.damper == Damper::Rail {
                at.by_rate
            } else {
                0.0
            },
        );
        let rail = contact.rail;
        wheels.push(LoadedWheel {
            steps: foundation
                .irregularities
                .get(rail)
                .into_iter()
                .flat_map(Irregularity::steps)
                .collect(),
            breaks: foundation
                .rails
                .get(rail)
                .map_or(Vec::new(), |extent| extent.breaks.clone()),
            is_damped: law.damping > 0.0 && law.depth == 0.0,
            index,
            body: contact.body,
            rail,
            first,
            contact: [k, c],
            at_modes: frequencies.iter().map(|omega| k.hypot(omega * c)).collect(),
        });
    }
    Ok(wheels)
}

/// A wheel at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WheelInstant {
    pub x: f64,
    pub speed: f64,
    /// Forces on the rail along x, across it and upwards.
    pub forces: [f64; 3],
    /// Rates of these forces.
    pub rates: [f64; 3],
}

/// A wheel between two samples.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Interval {
    h: f64,
    x: [f64; 2],
    /// Of each force the values and the rates at both samples.
    forces: [[f64; 2]; 3],
    rates: [[f64; 2]; 3],
    /// Share of the interval after which the forces jump.
    jump: Option<f64>,
    /// Upward impulse on the rail at that instant.
    impulse: f64,
    /// Shares after which the slopes of the shapes jump.
    breaks: Vec<f64>,
}

impl LoadedWheel {
    /// The motion after sample `i`; at the last sample, that before it ends in it.
    pub fn interval(&self, history: &History, i: usize) -> Interval {
        let last = history.len() - 1;
        let next = (i + 1).min(last);
        let [a, b] = [i, next].map(|at| history.sample(at));
        let h = b[0] - a[0];
        let x = [a[self.first], b[self.first]];
        let (jump, impulse) = if h > 0.0 { self.jump(a, b) } else { None }.unzip();
        // traction and lateral force act on the rail as they are given, the vertical one downwards
        let channels = [
            (self.first + 3, 1.0),
            (self.first + 2, 1.0),
            (self.first + 1, -1.0),
        ];
        let forces = channels.map(|(k, sign)| [sign * a[k], sign * b[k]]);
        let rates = channels.map(|(k, sign)| {
            let beside = |at: usize| {
                if a[k] == 0.0 && at < i {
                    0.0
                } else {
                    sign * difference(history, at, k)
                }
            };
            match jump {
                Some(_) => [
                    if i == 0 { 0.0 } else { beside(i - 1) },
                    if next == last { 0.0 } else { beside(next) },
                ],
                None => [
                    sign * rates_at(history, i, k)[1],
                    sign * rates_at(history, next, k)[0],
                ],
            }
        });
        let within = |at: &f64| (*at - x[0]) * (*at - x[1]) < 0.0;
        let share = |at: f64| ((at - x[0]) / (x[1] - x[0])).clamp(CORNER, 1.0 - CORNER);
        let breaks = self
            .breaks
            .iter()
            .copied()
            .filter(within)
            .map(share)
            .collect();
        Interval {
            h,
            x,
            forces,
            rates,
            jump,
            impulse: impulse.unwrap_or(0.0),
            breaks,
        }
    }

    /// Share of the interval between two samples after which the forces jump first, and the upward impulse on the rail there.
    fn jump(&self, before: &[f64], after: &[f64]) -> Option<(f64, f64)> {
        let [from, to] = [before, after].map(|sample| sample[self.first]);
        let [force, later] = [before, after].map(|sample| sample[self.first + 1]);
        let passed = self
            .steps
            .iter()
            .filter(|[x, _]| (x - from) * (x - to) < 0.0)
            .map(|[x, height]| {
                let raised = if force > 0.0 {
                    height * (to - from).signum()
                } else {
                    0.0
                };
                ((x - from) / (to - from), -self.contact[1] * raised)
            });
        let landing = (self.is_damped && force == 0.0 && later > 0.0).then_some((0.5, 0.0));
        let first = passed.chain(landing).min_by(|a, b| a.0.total_cmp(&b.0));
        first.map(|(share, impulse)| (share.clamp(CORNER, 1.0 - CORNER), impulse))
    }
}

impl Interval {
    /// Shares of the interval after which the load of the wheel on a mode is not smooth.
    pub fn corners(&self) -> impl Iterator<Item = f64> + '_ {
        self.breaks.iter().copied().chain(self.jump)
    }

    /// Upward impulse of the wheel on the rail after a share of the interval.
    pub fn impulse(&self, share: f64) -> f64 {
        if self.jump == Some(share) {
            self.impulse
        } else {
            0.0
        }
    }

    /// The wheel after a share of the interval, just before this instant if `side` is -1 and just after it if it is 1.
    pub fn at(&self, share: f64, side: f64) -> WheelInstant {
        let Interval {
            h,
            x: [from, to],
            forces,
            rates,
            ..
        } = self;
        let is_inside = share > 0.0 && share < 1.0;
        let speed = if *h > 0.0 { (to - from) / h } else { 0.0 };
        let share_of_x = if is_inside {
            share + side * BESIDE
        } else {
            share
        };
        let is_after = self.jump.map(|jump| {
            if side < 0.0 {
                share > jump
            } else {
                share >= jump
            }
        });
        let values = std::array::from_fn::<_, 3, _>(|k| {
            let ([a, b], [rate, rate_b]) = (forces[k], rates[k]);
            match is_after {
                Some(false) => [a + share * h * rate, rate],
                Some(true) => [b - (1.0 - share) * h * rate_b, rate_b],
                None if share <= 0.0 => [a, rate],
                None if share >= 1.0 => [b, rate_b],
                None => {
                    let [value, slope] =
                        value_and_slope(cubic([a, b], [h * rate, h * rate_b]), share);
                    [value, slope / h]
                }
            }
        });
        // exactly the sample at its ends
        let x = if share >= 1.0 {
            *to
        } else {
            from + share_of_x * (to - from)
        };
        WheelInstant {
            x,
            speed,
            forces: values.map(|own| own[0]),
            rates: values.map(|own| own[1]),
        }
    }
}

/// Difference quotient of channel `k` after sample `i`.
fn difference(history: &History, i: usize, k: usize) -> f64 {
    let [a, b] = [i, i + 1].map(|at| history.sample(at));
    if b[0] > a[0] {
        (b[k] - a[k]) / (b[0] - a[0])
    } else {
        0.0
    }
}

/// Rates of channel `k` just before and just after sample `i`, see the head of this module.
fn rates_at(history: &History, i: usize, k: usize) -> [f64; 2] {
    let last = history.len() - 1;
    if last == 0 {
        return [0.0; 2];
    }
    if i == 0 || i == last {
        return [difference(history, i.min(last - 1), k); 2];
    }
    let [before, after] = [difference(history, i - 1, k), difference(history, i, k)];
    let bend = |at: usize| (difference(history, at, k) - difference(history, at - 1, k)).abs();
    let neighbours = [i - 1, i + 1]
        .into_iter()
        .filter(|at| *at > 0 && *at < last);
    let least = neighbours.map(bend).fold(f64::INFINITY, f64::min);
    if (after - before).abs() > SMOOTH * least {
        return [before, after];
    }
    let [h_before, h_after] =
        [[i - 1, i], [i, i + 1]].map(|[a, b]| history.sample(b)[0] - history.sample(a)[0]);
    [(before * h_after + after * h_before) / (h_before + h_after); 2]
}

#[cfg(test)]
mod tests;
