//! Stability of time steppers for a wheel on a spring that crosses equal spans one after the other.
//!
//! The rail compliance G(x) softens the spring k of the wheel: with s(t) = 1 / (1 + k G(v t)), the wheel obeys z'' +
//! 2 d s(t) z' + omega^2 s(t) z = 0, whose coefficients have the period L/v of a span. By Floquet's theorem the
//! motion decays where the spectral radius of the matrix that maps (z, z') over one period (the monodromy matrix) is
//! less than 1. The same holds for the solution of a stepper and its matrix: the stepper is wrong where its spectral
//! radius exceeds 1 and that of the exact motion, which is computed by a fine Dormand-Prince integration. One map
//! varies the step length over speed, the other the accuracy of adaptive steps.

use std::f64::consts::PI;
use std::ops::ControlFlow;

use nalgebra::DMatrix;
use sim::{BodyDof, Channel, Method, Stepping};

use super::map::{MapLayer, MapPoint, MapScale, MapVerdict, StabilityMap};
use super::steppers::{Oscillator, STEPPERS, StepMethod, monodromy, radius};
use super::subject::MapSubject;
use formats::scene::stepper_word;
use formats::units::Dimension;
use results::warning::RESIDUAL;

/// Smallest number of steps in a span for the integration that is taken as exact.
const FINE: f64 = 4000.0;
/// Excess of a spectral radius over 1 above which a motion counts as growing.
const GROWTH: f64 = 1e-6;
/// Relative error of the spectral radius of the exact motion.
const RADIUS_ERROR: f64 = 1e-6;
/// Spectral radius below which a motion clearly decays.
const DECAYS: f64 = 0.95;
/// Factor by which a stepper may exceed the spectral radius of a motion that grows.
const TOLERATED: f64 = 1.02;
/// Spectral radius, relative to the allowed one, that a user certainly notices.
const OBVIOUS: f64 = 100.0;

/// The crossing of one span by one wheel.
struct Crossing<'s, 'a> {
    subject: &'s MapSubject<'a>,
    /// Frequency of the wheel on its spring alone, radian/s.
    omega: f64,
    /// Its damper divided by its mass, 1/s.
    damping: f64,
    /// k G at equally spaced positions of the span.
    softness: Vec<f64>,
}

impl Crossing<'_, '_> {
    /// 1 / (1 + k G) at a `fraction` of the span, 0 to 1: the factor by which the rail softens spring and damper.
    fn softening(&self, fraction: f64) -> f64 {
        let at = fraction.clamp(0.0, 1.0) * (self.softness.len() - 1) as f64;
        let low = (at as usize).min(self.softness.len() - 2);
        let part = at - low as f64;
        let softness = self.softness[low] * (1.0 - part) + self.softness[low + 1] * part;
        1.0 / (1.0 + softness)
    }

    /// Spectral radius of the monodromy matrix of a stepper with `count` steps over a span, which takes the time
    /// `period`.
    fn radius(&self, (size, step): (usize, StepMethod), period: f64, count: usize) -> f64 {
        let stiffness = |t: f64| self.omega * self.omega * self.softening(t / period);
        let damping = |t: f64| self.damping * self.softening(t / period);
        let of = Oscillator {
            damping: &damping,
            stiffness: &stiffness,
        };
        monodromy(&of, step, size, period, count)
    }

    /// Spectral radius of the exact motion where the damper acts against the ground instead of the rail.
    fn physical_with_ground_damper(&self, period: f64) -> f64 {
        let stiffness = |t: f64| self.omega * self.omega * self.softening(t / period);
        let of = Oscillator {
            damping: &|_| self.damping,
            stiffness: &stiffness,
        };
        monodromy(&of, STEPPERS[2].2, 2, period, self.fine(period))
    }

    /// Number of steps in a span for the integration that is taken as exact: at least 60 in a period of the wheel.
    fn fine(&self, period: f64) -> usize {
        FINE.max(60.0 * period * self.omega / (2.0 * PI)).ceil() as usize
    }

    /// Equal steps of about `wanted` / omega over a span at `speed`: the duration of the span, the number of steps
    /// and the step x frequency that results. `None` where so few steps fit into the span that this differs by more
    /// than 20 %.
    fn equal_steps(&self, speed: f64, wanted: f64) -> Option<(f64, usize, f64)> {
        let period = self.subject.length() / speed;
        let count = (period * self.omega / wanted).ceil().max(1.0);
        let real = period / count * self.omega;
        (real >= 0.8 * wanted).then_some((period, count as usize, real))
    }

    /// Spectral radius of the exact motion.
    fn physical(&self, period: f64) -> f64 {
        self.radius((2, STEPPERS[2].2), period, self.fine(period))
    }

    /// Spectral radius of one crossing by the simulator, and the larger energy residual of its two runs: each run
    /// starts with a unit value of z or z' and yields a column of the monodromy matrix. The error is the message of
    /// the simulator.
    fn simulated(
        &self,
        stepping: Stepping,
        speed: f64,
        accuracy: f64,
    ) -> Result<(f64, f64), String> {
        let subject = self.subject;
        let law = subject.linear(subject.stiffness, subject.damping);
        let end = subject.length() / speed;
        let mut out = DMatrix::zeros(2, 2);
        let mut residual = 0.0_f64;
        for column in 0..2 {
            let scene = subject.crossing(
                subject.mass(),
                &[0.0],
                law.clone(),
                [subject.span[0], speed, end],
            );
            let mut scene = scene.map_err(|error| error.to_string())?;
            // free oscillation: nothing drives it but its initial state
            scene.gravity = 0.0;
            scene.accuracy = accuracy;
            let unit = 1e-2 * subject.length() / 60.0;
            if column == 0 {
                scene.bodies[0].start[1] = unit;
            } else {
                scene.bodies[0].start_speed[1] = unit * self.omega;
            }
            let run = sim::run_by(stepping, &scene, &[subject.foundation()], &mut |_| {
                ControlFlow::Continue(())
            });
            let run = run.map_err(|error| error.to_string())?;
            if !run.status.is_complete() {
                return Err(results::run_error::status(&run.status)
                    .1
                    .unwrap_or_default());
            }
            residual = residual.max(run.audit.residual());
            for (row, (channel, scale)) in [
                (Channel::Displacement(0, BodyDof::Y), unit),
                (Channel::Speed(0, BodyDof::Y), unit * self.omega),
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

/// The maps: one over equal steps, one over the accuracy of adaptive steps.
#[must_use]
pub fn maps(subject: &MapSubject<'_>, points: usize) -> Vec<StabilityMap> {
    let omega = (subject.stiffness / subject.mass()).sqrt();
    let count = 8000;
    let place = |i: usize| subject.span[0] + subject.length() * i as f64 / f64::from(count);
    let softness = (0..=count as usize)
        .map(|i| subject.stiffness * subject.flexibility(place(i)))
        .collect();
    let crossing = Crossing {
        subject,
        omega,
        damping: subject.damping / subject.mass(),
        softness,
    };
    // from quasi-static to the speed at which a span passes in about a period of the wheel on its spring
    let fastest = omega * subject.length() / (2.0 * PI) * 0.86;
    let speeds = spread(fastest / 300.0, fastest, points);
    let physical = speeds
        .iter()
        .map(|speed| crossing.physical(subject.length() / speed))
        .collect();
    let motion = Motions { speeds, physical };
    vec![
        by_step(&crossing, &motion, fastest, points),
        by_accuracy(&crossing, &motion, points),
    ]
}

/// The speeds of a map, and the spectral radius of the exact motion at each.
struct Motions {
    speeds: Vec<f64>,
    physical: Vec<f64>,
}

impl Motions {
    /// Speed and spectral radius of the exact motion.
    fn each(&self) -> impl Iterator<Item = (f64, f64)> {
        self.speeds
            .iter()
            .copied()
            .zip(self.physical.iter().copied())
    }
}

/// Verdict on the spectral radius of a stepper where that of the exact motion is `physical`. If the exact motion
/// grows, the stepper may exceed its spectral radius by 2 %; otherwise the motion of the stepper must not grow.
fn judge(radius: f64, physical: f64) -> MapVerdict {
    let allowed = if physical > 1.0 {
        TOLERATED * physical
    } else {
        1.0 + GROWTH
    };
    MapVerdict::of(radius, allowed, OBVIOUS * allowed)
}

/// The map of step length against speed.
fn by_step(
    crossing: &Crossing<'_, '_>,
    motions: &Motions,
    fastest: f64,
    points: usize,
) -> StabilityMap {
    let (subject, omega) = (crossing.subject, crossing.omega);
    let axes = [
        MapScale::new("speed", &subject.unit(Dimension::SPEED), true),
        MapScale::new("step x frequency of the wheel on its spring", "", true),
    ];
    let mut map = StabilityMap::new(
        "steps",
        "Stability of a wheel on equal spans over the step length",
        axes,
        "A wheel on a spring and a damper, whose force acts on the rail, crosses the longest span repeatedly. Wrong \
         where the spectral radius of the steps over a span exceeds 1 and that of the exact motion (by 2 % where \
         that motion grows).",
    );
    map.note("frequency of the wheel on its spring, radian/s", omega);
    map.note(
        "fraction of critical damping",
        0.5 * crossing.damping / omega,
    );
    let ground = crossing.physical_with_ground_damper(subject.length() / fastest);
    map.note(
        "growth over a span at the highest speed with the damper to the ground",
        ground,
    );
    for (speed, physical) in motions.each() {
        if physical > 1.0 + GROWTH {
            map.note(
                format!(
                    "growth of the exact motion over a span at {speed:.4} {}",
                    map.axes[0].unit
                ),
                physical,
            );
        }
    }
    let steps = spread(0.2, 12.0, points);
    for (name, size, step) in STEPPERS {
        let (map_points, first) = other_stepper(crossing, motions, &steps, (size, step));
        if first.is_finite() {
            map.note(
                format!("{name}: first unstable step x frequency of a motion that decays"),
                first,
            );
        }
        map.layers.push(MapLayer::new(name, false).with(map_points));
    }
    for method in [
        Method::Sdirk4,
        Method::Radau,
        Method::Gauss2,
        Method::Gauss3,
    ] {
        let map_points = simulator_by_step(crossing, motions, &steps, fastest, method);
        let word = stepper_word(method);
        map.layers
            .push(MapLayer::new(format!("girderway, {word}, equal steps"), true).with(map_points));
    }
    map
}

/// The points of one of [`STEPPERS`], and its shortest unstable step x frequency among motions that plainly decay
/// (infinite where there is none).
fn other_stepper(
    crossing: &Crossing<'_, '_>,
    motions: &Motions,
    steps: &[f64],
    stepper: (usize, StepMethod),
) -> (Vec<MapPoint>, f64) {
    let mut map_points = Vec::new();
    let mut first = f64::INFINITY;
    for (speed, physical) in motions.each() {
        for &wanted in steps {
            let Some((period, count, real)) = crossing.equal_steps(speed, wanted) else {
                continue;
            };
            let value = crossing.radius(stepper, period, count);
            let verdict = judge(value, physical);
            if verdict != MapVerdict::Right && physical < DECAYS {
                first = first.min(real);
            }
            map_points.push(MapPoint {
                at: [speed, real],
                value: finite(value),
                verdict,
            });
        }
    }
    (map_points, first)
}

/// The points of a `method` of the simulator with equal steps; speeds below a sixtieth of the highest are left out.
fn simulator_by_step(
    crossing: &Crossing<'_, '_>,
    motions: &Motions,
    steps: &[f64],
    fastest: f64,
    method: Method,
) -> Vec<MapPoint> {
    let mut map_points = Vec::new();
    for (speed, physical) in motions.each().filter(|(speed, _)| *speed > fastest / 60.0) {
        for &wanted in steps {
            let Some((period, count, real)) = crossing.equal_steps(speed, wanted) else {
                continue;
            };
            let stepping = Stepping {
                method,
                step: Some(period / count as f64),
            };
            let (value, verdict) = match crossing.simulated(stepping, speed, 1e-4) {
                Ok((value, residual)) => match judge(value, physical) {
                    MapVerdict::Right => (value, MapVerdict::Right),
                    _ if residual > RESIDUAL => (value, MapVerdict::Warned),
                    other => (value, other),
                },
                Err(why) => (0.0, MapVerdict::Refused(why)),
            };
            map_points.push(MapPoint {
                at: [speed, real],
                value: finite(value),
                verdict,
            });
        }
    }
    map_points
}

/// The map of the accuracy that the simulator is asked for against speed, with adaptive steps.
fn by_accuracy(crossing: &Crossing<'_, '_>, motions: &Motions, points: usize) -> StabilityMap {
    let axes = [
        MapScale::new("speed", &crossing.subject.unit(Dimension::SPEED), true),
        MapScale::new("requested accuracy", "", true),
    ];
    let mut map = StabilityMap::new(
        "accuracies",
        "Stability of a wheel on equal spans over the accuracy",
        axes,
        "The same crossing with adaptive steps of the requested accuracy; wrong where the spectral radius over a \
         span exceeds 1 and that of the exact motion by a relative difference larger than the accuracy.",
    );
    let mut map_points = Vec::new();
    for (speed, physical) in motions.each() {
        for accuracy in spread(1e-7, 1e-1, points.min(13)) {
            let (value, verdict) = match crossing.simulated(Stepping::default(), speed, accuracy) {
                Ok((value, _)) => (
                    value,
                    MapVerdict::of(
                        value / physical.max(1.0) - 1.0,
                        accuracy + RADIUS_ERROR,
                        OBVIOUS,
                    ),
                ),
                Err(why) => (0.0, MapVerdict::Refused(why)),
            };
            map_points.push(MapPoint {
                at: [speed, accuracy],
                value: finite(value),
                verdict,
            });
        }
    }
    map.layers
        .push(MapLayer::new("girderway", true).with(map_points));
    map
}

/// `count` values from `low` to `high`, equally spaced in their logarithms.
#[must_use]
pub fn spread(low: f64, high: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|i| low * (high / low).powf(i as f64 / (count - 1).max(1) as f64))
        .collect()
}

/// The value, or the largest finite number where it is infinite or not a number: files contain finite numbers only.
#[must_use]
pub fn finite(value: f64) -> f64 {
    if value.is_finite() { value } else { f64::MAX }
}
