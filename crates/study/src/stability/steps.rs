//! Step times frequency against speed: a wheel on a spring that crosses equal spans without end.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use nalgebra::DMatrix;
use sim::{Channel, Freedom, Method, Stepping};

use super::map::{Layer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steppers::{Oscillator, STEPPERS, StepMethod, monodromy, radius};
use super::subject::MapSubject;
use formats::scene::stepper_word;
use formats::units::Dimension;
use results::warning::RESIDUAL;

/// Steps over a span by which the physical motion is known.
const FINE: f64 = 4000.0;
/// Excess of a spectral radius that is growth.
const GROWTH: f64 = 1e-6;
/// Relative error of the spectral radius of the motion.
const KNOWN: f64 = 1e-6;
/// Growth a span of a motion that plainly decays.
const DECAYS: f64 = 0.95;
/// How much more a motion that grows may grow.
const ALIKE: f64 = 1.02;
/// Growth a span that nobody overlooks.
const OBVIOUS: f64 = 100.0;

/// The crossing of one span by one wheel.
struct Crossing<'s, 'a> {
    subject: &'s MapSubject<'a>,
    /// Frequency of the wheel on its spring alone.
    omega: f64,
    /// Its damping by 2 m.
    damping: f64,
    /// k G at even places of the span.
    give: Vec<f64>,
}

impl Crossing<'_, '_> {
    /// By how much the rail's give softens the wheel at a share of the span.
    fn softened(&self, share: f64) -> f64 {
        let at = share.clamp(0.0, 1.0) * (self.give.len() - 1) as f64;
        let low = (at as usize).min(self.give.len() - 2);
        let part = at - low as f64;
        let give = self.give[low] * (1.0 - part) + self.give[low + 1] * part;
        1.0 / (1.0 + give)
    }

    /// Spectral radius by a stepper, `count` steps a span.
    fn radius(&self, (size, step): (usize, StepMethod), period: f64, count: usize) -> f64 {
        let stiffness = |t: f64| self.omega * self.omega * self.softened(t / period);
        let damping = |t: f64| self.damping * self.softened(t / period);
        let of = Oscillator { damping: &damping, stiffness: &stiffness };
        monodromy(&of, step, size, period, count)
    }

    /// That of the motion where the damper's force goes past the rail.
    fn beside(&self, period: f64) -> f64 {
        let stiffness = |t: f64| self.omega * self.omega * self.softened(t / period);
        let of = Oscillator { damping: &|_| self.damping, stiffness: &stiffness };
        monodromy(&of, STEPPERS[2].2, 2, period, self.fine(period))
    }

    /// Steps a span by which the motion is known.
    fn fine(&self, period: f64) -> usize {
        FINE.max(60.0 * period * self.omega / (2.0 * PI)).ceil() as usize
    }

    /// That of the motion itself.
    fn physical(&self, period: f64) -> f64 {
        self.radius((2, STEPPERS[2].2), period, self.fine(period))
    }

    /// By the program itself, with its energy residual; the message where it refuses.
    fn ours(&self, stepping: Stepping, speed: f64, accuracy: f64) -> Result<(f64, f64), String> {
        let subject = self.subject;
        let law = subject.linear(subject.stiffness, subject.damping);
        let end = subject.length() / speed;
        let mut out = DMatrix::zeros(2, 2);
        let mut residual = 0.0_f64;
        for column in 0..2 {
            let scene = subject.crossing(subject.mass(), &[0.0], law.clone(), [subject.span[0], speed, end]);
            let mut scene = scene.map_err(|error| error.to_string())?;
            // free oscillation: nothing but the start drives it
            scene.gravity = 0.0;
            scene.accuracy = accuracy;
            let unit = 1e-2 * subject.length() / 60.0;
            if column == 0 {
                scene.bodies[0].start[1] = unit;
            } else {
                scene.bodies[0].start_speed[1] = unit * self.omega;
            }
            let run =
                sim::run_by(stepping, &scene, &[subject.foundation()], &mut |_| ControlFlow::Continue(()));
            let run = run.map_err(|error| error.to_string())?;
            if !run.status.is_complete() {
                return Err(results::run_error::status(&run.status).1.unwrap_or_default());
            }
            residual = residual.max(run.audit.residual());
            for (row, (channel, scale)) in [
                (Channel::Displacement(0, Freedom::Y), unit),
                (Channel::Speed(0, Freedom::Y), unit * self.omega),
            ]
            .into_iter()
            .enumerate()
            {
                let last = run.history.column(channel).last().copied();
                out[(row, column)] = last.unwrap_or(f64::NAN) / scale;
            }
        }
        Ok((radius(&out), residual))
    }
}

/// The maps: steps of one length, and those by accuracy.
#[must_use]
pub fn maps(subject: &MapSubject<'_>, points: usize) -> Vec<StabilityMap> {
    let omega = (subject.stiffness / subject.mass()).sqrt();
    let count = 8000;
    let place = |i: usize| subject.span[0] + subject.length() * i as f64 / f64::from(count);
    let give = (0..=count as usize).map(|i| subject.stiffness * subject.at(place(i))).collect();
    let crossing = Crossing { subject, omega, damping: subject.damping / subject.mass(), give };
    let axes = [
        MapScale::new("speed", &subject.unit(Dimension::SPEED), true),
        MapScale::new("step x frequency of the wheel on its spring", "", true),
    ];
    let mut map = StabilityMap::new(
        "steps",
        "Steps that keep a wheel on equal spans stable",
        axes,
        "A wheel on spring and damper, whose force the rail carries, crosses the longest span again and again. Wrong where the \
         spectral radius of a span's steps exceeds 1 and that of the motion (by 2 % where that itself grows).",
    );
    map.find("frequency of the wheel on its spring, radian/s", omega);
    map.find("share of critical damping", 0.5 * crossing.damping / omega);
    let most = 12.0;
    // from quasi-static to where a span passes in a fifth of a wave
    let fastest = omega * subject.length() / (2.0 * PI) * 0.86;
    let speeds: Vec<f64> = spread(fastest / 300.0, fastest, points);
    let steps: Vec<f64> = spread(0.2, most, points);
    let physical: Vec<f64> = speeds.iter().map(|speed| crossing.physical(subject.length() / speed)).collect();
    let beside = crossing.beside(subject.length() / fastest);
    map.find("growth a span at the highest speed, the damper's force past the rail", beside);
    for (speed, physical) in speeds.iter().zip(&physical) {
        if *physical > 1.0 + GROWTH {
            map.find(
                format!("growth a span of the motion itself at {speed:.4} {}", map.axes[0].unit),
                *physical,
            );
        }
    }
    let judge = |found: f64, physical: f64| {
        // a motion that grows is to grow alike; one that does not is not to
        let allowed = if physical > 1.0 { ALIKE * physical } else { 1.0 + GROWTH };
        MapVerdict::of(found, allowed, OBVIOUS * allowed)
    };
    let counted = |speed: f64, step: f64| {
        let period = subject.length() / speed;
        let count = (period * omega / step).ceil().max(1.0);
        (period, count as usize, period / count * omega)
    };
    for (name, size, step) in STEPPERS {
        let mut cells = Vec::new();
        let mut first = f64::INFINITY;
        for (speed, physical) in speeds.iter().zip(&physical) {
            for wanted in &steps {
                let (period, count, real) = counted(*speed, *wanted);
                // few steps a span: the step asked for does not divide it
                if real < 0.8 * wanted {
                    continue;
                }
                let value = crossing.radius((size, step), period, count);
                let verdict = judge(value, *physical);
                if verdict != MapVerdict::Right && *physical < DECAYS {
                    first = first.min(real);
                }
                cells.push(MapPoint { at: [*speed, real], value: finite(value), verdict });
            }
        }
        if first.is_finite() {
            map.find(format!("{name}: first unstable step x frequency of a motion that decays"), first);
        }
        map.layers.push(Layer::new(name, false).with(cells));
    }
    for method in [Method::Sdirk4, Method::Radau, Method::Gauss2, Method::Gauss3] {
        let mut cells = Vec::new();
        for (speed, physical) in speeds.iter().zip(&physical).filter(|(speed, _)| **speed > fastest / 60.0) {
            for wanted in &steps {
                let (period, count, real) = counted(*speed, *wanted);
                if real < 0.8 * wanted {
                    continue;
                }
                let stepping = Stepping { method, step: Some(period / count as f64) };
                let (value, verdict) = match crossing.ours(stepping, *speed, 1e-4) {
                    Ok((value, residual)) => match judge(value, *physical) {
                        MapVerdict::Right => (value, MapVerdict::Right),
                        _ if residual > RESIDUAL => (value, MapVerdict::Warned),
                        other => (value, other),
                    },
                    Err(why) => (0.0, MapVerdict::Refused(why)),
                };
                cells.push(MapPoint { at: [*speed, real], value: finite(value), verdict });
            }
        }
        let word = stepper_word(method);
        map.layers.push(Layer::new(format!("girderway, {word}, equal steps"), true).with(cells));
    }
    vec![map, by_accuracy(&crossing, &speeds, &physical, points)]
}

/// Steps that the program chooses itself, by the accuracy it is asked for.
fn by_accuracy(crossing: &Crossing<'_, '_>, speeds: &[f64], physical: &[f64], points: usize) -> StabilityMap {
    let axes = [
        MapScale::new("speed", &crossing.subject.unit(Dimension::SPEED), true),
        MapScale::new("accuracy asked for", "", true),
    ];
    let mut map = StabilityMap::new(
        "accuracies",
        "Accuracies that keep a wheel on equal spans stable",
        axes,
        "The same crossing by steps that follow the accuracy; wrong where the spectral radius of a span exceeds 1 and that of the motion \
         by more than the accuracy, relatively.",
    );
    let mut cells = Vec::new();
    for (speed, physical) in speeds.iter().zip(physical) {
        for accuracy in spread(1e-7, 1e-1, points.min(13)) {
            let (value, verdict) = match crossing.ours(Stepping::default(), *speed, accuracy) {
                Ok((value, _)) => {
                    (value, MapVerdict::of(value / physical.max(1.0) - 1.0, accuracy + KNOWN, OBVIOUS))
                }
                Err(why) => (0.0, MapVerdict::Refused(why)),
            };
            cells.push(MapPoint { at: [*speed, accuracy], value: finite(value), verdict });
        }
    }
    map.layers.push(Layer::new("girderway", true).with(cells));
    map
}

/// `count` values from `low` to `high`, evenly in their logarithms.
#[must_use]
pub fn spread(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| low * (high / low).powf(i as f64 / (count - 1).max(1) as f64)).collect()
}

/// A number that a file can hold.
#[must_use]
pub fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::MAX }
}
