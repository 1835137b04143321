//! Steps of one length that others take: where they grow, at rest and over spans without end.

use crate::common;
#[allow(dead_code)]
#[path = "../../../study/src/stability/steppers.rs"]
mod stability;

use common::near::{assert_at_most, assert_near};
use common::{GRAVITY, SPAN, give};
use nalgebra::{Matrix4, Vector4};
use stability::{Oscillator, OscillatorState, STEPPERS, StepMethod, monodromy};

/// Excess of a spectral radius that is growth.
const GROWTH: f64 = 1e-6;

/// Radau IIA of two stages, order 3, of z'' + d z' + s z = 0.
///
/// # Source
/// Hairer, Wanner, Solving Ordinary Differential Equations II, section IV.5.
fn radau3(of: &Oscillator<'_>, t: f64, h: f64, [z, v, ..]: OscillatorState) -> OscillatorState {
    let a = [[5.0 / 12.0, -1.0 / 12.0], [0.75, 0.25]];
    let nodes = [1.0 / 3.0, 1.0];
    // k_i = A(t + c_i h) (y + h sum a_ij k_j), A = [[0, 1], [-s, -d]]
    let mut system = Matrix4::<f64>::identity();
    let mut right = Vector4::zeros();
    for i in 0..2 {
        let at = t + nodes[i] * h;
        let (s, d) = ((of.stiffness)(at), (of.damping)(at));
        let slope = [[0.0, 1.0], [-s, -d]];
        for row in 0..2 {
            right[2 * i + row] = slope[row][0] * z + slope[row][1] * v;
            for j in 0..2 {
                for column in 0..2 {
                    system[(2 * i + row, 2 * j + column)] -= h * a[i][j] * slope[row][column];
                }
            }
        }
    }
    let k = system.lu().solve(&right).unwrap_or_default();
    let end = |row: usize| h * (0.75 * k[row] + 0.25 * k[2 + row]);
    [z + end(0), v + end(1), 0.0, 0.0]
}

fn all() -> Vec<(&'static str, usize, StepMethod)> {
    let mut out = STEPPERS.to_vec();
    out.push(("Radau IIA 3", 2, radau3));
    out
}

/// Longest step times frequency up to which z'' + 2 zeta z' + z = 0 does not grow; none below 50.
fn limit(stepper: (usize, StepMethod), zeta: f64) -> Option<f64> {
    let of = Oscillator {
        damping: &|_| 2.0 * zeta,
        stiffness: &|_| 1.0,
    };
    let grows = |h: f64| monodromy(&of, stepper.1, stepper.0, h, 1) > 1.0 + GROWTH;
    let first = (1..5000).map(|i| 0.01 * f64::from(i)).find(|h| grows(*h))?;
    let (mut low, mut high) = (first - 0.01, first);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if grows(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    Some(low)
}

#[test]
fn steppers_have_their_limits_at_rest() {
    let zetas = [0.0, 0.0183, 0.2, 1.0];
    let explicit: [(&str, [f64; 4]); 3] = [
        ("semi-implicit Euler", [2.0, 1.96, 1.64, 0.83]),
        ("Runge-Kutta 4", [2.82, 2.86, 2.93, 2.78]),
        ("Dormand-Prince 5", [0.99, 2.04, 2.99, 3.30]),
    ];
    for (name, size, step) in all() {
        let found = zetas.map(|zeta| limit((size, step), zeta));
        match explicit.iter().find(|(own, _)| *own == name) {
            Some((_, known)) => {
                for ((zeta, known), found) in zetas.iter().zip(known).zip(found) {
                    let found = found.expect("explicit");
                    assert_near(
                        format!("{name}, damping {zeta}: longest stable step x frequency"),
                        "prototype",
                        *known,
                        found,
                        0.01,
                    );
                }
            }
            None => assert_eq!(found, [None; 4], "{name}"),
        }
    }
}

/// A wheel of 2.4e6 lb on spring and damper, the damper's force past the rail, that crosses spans without end.
struct Crossing {
    speed: f64,
    omega: f64,
    damping: f64,
}

impl Crossing {
    fn at(speed: f64) -> Crossing {
        let mass = 2.4e6 / GRAVITY;
        Crossing {
            speed,
            omega: (1e8 / mass).sqrt(),
            damping: 1e5 / mass,
        }
    }

    /// Time of a span by the wheel's on its spring, times 2 pi.
    fn turns(&self) -> f64 {
        SPAN / self.speed * self.omega
    }

    fn radius(&self, stepper: (usize, StepMethod), count: usize) -> f64 {
        let stiffness = |t: f64| {
            let x = self.speed * t;
            self.omega * self.omega / (1.0 + 1e8 * give(x, x).0)
        };
        let of = Oscillator {
            damping: &|_| self.damping,
            stiffness: &stiffness,
        };
        monodromy(&of, stepper.1, stepper.0, SPAN / self.speed, count)
    }

    fn physical(&self) -> f64 {
        self.radius(
            (2, STEPPERS[2].2),
            (40.0 * self.turns()).max(400.0) as usize,
        )
    }
}

/// Shortest step times frequency, from 0.2 to 12, at which equal steps grow though the motion does not.
fn first(stepper: (usize, StepMethod), speed: f64) -> Option<f64> {
    let crossing = Crossing::at(speed);
    let physical = crossing.physical();
    let [least, most] =
        [12.0, 0.2].map(|step: f64| (crossing.turns() / step).ceil().max(1.0) as usize);
    let mut counts = (least..=most).rev();
    let found = counts.find(|count| crossing.radius(stepper, *count) > physical.max(1.0) + GROWTH);
    found.map(|count| crossing.turns() / count as f64)
}

/// Whether `known`, step times frequency, is among those that grow at `speed`.
fn grows(stepper: (usize, StepMethod), speed: f64, known: f64) -> bool {
    let crossing = Crossing::at(speed);
    let count = (crossing.turns() / known).round() as usize;
    crossing.radius(stepper, count) > crossing.physical().max(1.0) + GROWTH
}

/// Speed, the prototype's value, and ours where it is another.
type Case = (f64, f64, Option<f64>);

#[test]
fn steppers_that_are_stable_at_rest_grow_over_spans() {
    // The prototype did not try every number of steps a span; this test does, and what the prototype gives grows here too.
    let cases: [(&str, &[Case]); 7] = [
        ("semi-implicit Euler", &[(300.0, 0.49, Some(0.4308))]),
        ("Dormand-Prince 5", &[(300.0, 0.31, Some(0.2362))]),
        (
            "midpoint",
            &[
                (30.0, 8.14, None),
                (50.0, 10.98, None),
                (80.0, 4.58, None),
                (100.0, 7.32, None),
            ],
        ),
        (
            "trapezoid (Newmark 1/4)",
            &[
                (30.0, 8.14, None),
                (50.0, 10.98, None),
                (80.0, 4.58, None),
                (100.0, 7.32, None),
                (300.0, 0.73, Some(0.6657)),
            ],
        ),
        (
            "generalised-alpha 0.8",
            &[
                (30.0, 10.5, None),
                (80.0, 9.2, Some(4.577)),
                (200.0, 5.5, None),
            ],
        ),
        ("generalised-alpha 0.5", &[(200.0, 5.5, Some(3.661))]),
        ("BDF2", &[(200.0, 3.66, None)]),
    ];
    for (name, size, step) in all() {
        let Some((_, own)) = cases.iter().find(|(known, _)| *known == name) else {
            continue;
        };
        for (speed, known, ours) in *own {
            let found = first((size, step), *speed).expect("it grows somewhere");
            let what = format!("{name}, {speed} ft/s: first growing step x frequency");
            match ours {
                Some(ours) => {
                    assert!(grows((size, step), *speed, *known), "{name} {speed}");
                    assert_near(what, "regression", *ours, found, 1e-3);
                }
                None => assert_near(what, "prototype", *known, found, 5e-3),
            }
        }
    }
    let range = |name: &str, speeds: &[f64]| {
        let (_, size, step) = all()
            .into_iter()
            .find(|(own, ..)| *own == name)
            .expect("known");
        let found: Vec<f64> = speeds
            .iter()
            .filter_map(|speed| first((size, step), *speed))
            .collect();
        [
            found.iter().copied().fold(f64::INFINITY, f64::min),
            found.iter().copied().fold(0.0, f64::max),
        ]
    };
    let speeds = [5.0, 10.0, 20.0, 30.0, 50.0, 80.0, 100.0];
    for (name, until, known) in [
        ("semi-implicit Euler", 7, [2.1, 2.3]),
        ("Runge-Kutta 4", 7, [3.4, 4.4]),
        ("Dormand-Prince 5", 6, [3.3, 3.9]),
    ] {
        let found = range(name, &speeds[..until]);
        for (word, (known, found)) in ["least", "most"].iter().zip(known.iter().zip(found)) {
            let what = format!(
                "{name}, 5 to {} ft/s: first growing step x frequency, {word}",
                speeds[until - 1]
            );
            assert_near(what, "prototype", *known, found, 0.02);
        }
    }
    let (_, size, step) = all()[STEPPERS.len()];
    for speed in [10.0, 30.0, 50.0, 80.0, 100.0, 200.0, 300.0] {
        assert_eq!(
            first((size, step), speed),
            None,
            "Radau IIA 3 grows nowhere"
        );
    }
    assert_near(
        "growth of the motion itself over a span at 300 ft/s",
        "prototype",
        2.24,
        Crossing::at(300.0).physical(),
        2e-3,
    );
    let calm = [1.0, 5.0, 20.0, 80.0, 200.0].map(|speed| Crossing::at(speed).physical());
    assert_at_most(
        "the same, most from 1 to 200 ft/s",
        "prototype",
        1.0,
        calm.into_iter().fold(0.0, f64::max),
    );
}
