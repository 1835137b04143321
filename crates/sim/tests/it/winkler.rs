//! A load that moves along a beam on a bed of springs. Units: beta = (u / 4 EI)^(1/4) = 1, u = 1, mass per length 1,
//! so that the critical speed (4 u EI)^(1/4) and the frequency of the bed are 1 too.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::single;
use sim::{
    Actuators, Analysis, Body, Channel, Damper, Dynamics, Extent, Foundation, Gauge, MotionKind,
    NormalLaw, Profile, Scene, Shapes, Status, Structure, Wheel, run,
};
use splines::{Axis, Compliance, Error, Influence, Probe};

/// A simply supported beam, `modes` of its modes kept.
#[derive(Clone, Copy)]
struct Bed {
    length: f64,
    modes: usize,
}

impl Bed {
    fn wave(&self, r: usize) -> f64 {
        r as f64 * PI / self.length
    }

    /// omega_r^2 = u + EI k^4.
    fn square(&self, r: usize) -> f64 {
        1.0 + 0.25 * self.wave(r).powi(4)
    }

    fn shape(&self, r: usize, x: f64) -> (f64, f64) {
        let (wave, size) = (self.wave(r), (2.0 / self.length).sqrt());
        let (sin, cos) = (wave * x).sin_cos();
        (size * sin, size * wave * cos)
    }

    /// Static deflection at x under a unit load at z, and its slope: the endless beam's, and its images that hold the
    /// ends (Hetenyi, Beams on Elastic Foundation, 1946).
    fn give(&self, x: f64, z: f64) -> (f64, f64) {
        let endless = |r: f64| {
            let (s, fall) = (r.abs(), 0.5 * (-r.abs()).exp());
            (
                fall * (s.cos() + s.sin()),
                -2.0 * fall * r.signum() * s.sin(),
            )
        };
        let (direct, left, right) = (
            endless(x - z),
            endless(x + z),
            endless(x + z - 2.0 * self.length),
        );
        (direct.0 - left.0 - right.0, direct.1 - left.1 - right.1)
    }
}

impl Shapes for Bed {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        for (k, (value, slope)) in value.iter_mut().zip(slope).enumerate() {
            (*value, *slope) = self.shape(k + 1, at.x);
        }
        Ok(())
    }
}

/// What the kept modes leave of the static give.
impl Compliance for Bed {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        for (i, p) in at.iter().enumerate() {
            for (j, q) in at.iter().enumerate() {
                let (mut value, mut slope) = self.give(p.x, q.x);
                for r in 1..=self.modes {
                    let ((a, da), (b, _)) = (self.shape(r, p.x), self.shape(r, q.x));
                    value -= a * b / self.square(r);
                    slope -= da * b / self.square(r);
                }
                (out.value[(i, j)], out.slope[(i, j)]) = (value, slope);
            }
        }
        Ok(())
    }

    fn breaks(&self, _: usize) -> Vec<f64> {
        Vec::new()
    }

    fn range(&self, _: usize) -> Option<[f64; 2]> {
        Some([0.0, self.length])
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

/// From 0 to 1 with five derivatives zero at both ends.
fn ramp(s: f64) -> f64 {
    (0..6)
        .scan(1.0, |binomial, k| {
            let k = f64::from(k);
            let term = *binomial * (1.0 - s).powf(k);
            *binomial *= (6.0 + k) / (k + 1.0);
            Some(term)
        })
        .sum::<f64>()
        * s.powi(6)
}

/// The wave number up to which modes have mass. Leaving out the mass of those beyond costs 16 v^2 / (5 pi K^5) of the
/// deflection at the speed v: 4e-5 near the critical speed, 1e-5 at half of it.
const WAVES: f64 = 8.0;

/// A sprung mass of weight 1 that rests on the bed, gains the speed `theta` over `rise` and keeps it for 10, with a
/// gauge at rest where it starts.
fn crossing(theta: f64, rise: f64) -> (Scene, Foundation) {
    let (start, held) = (16.0, 10.0);
    let length = 2.0 * start + theta * (0.5 * rise + held);
    let bed = Bed {
        length,
        modes: (WAVES * length / PI) as usize,
    };
    let table: Vec<[f64; 2]> = (0..=400)
        .map(|i| f64::from(i) / 400.0)
        .map(|s| [rise * s, theta * ramp(s)])
        .collect();
    let mass = 0.1;
    let scene = Scene {
        gravity: 1.0 / mass,
        bodies: vec![Body {
            mass,
            inertia: [0.0; 3],
            cg: [0.0; 3],
            free: [false, true, false, false, false, false],
            start: [start, 0.0, 0.0, 0.0, 0.0, 0.0],
            start_speed: [0.0; 6],
            motion: Some(
                Profile::new(MotionKind::Speed, &table, start, 0.0).expect("a valid table"),
            ),
            pinned: None,
        }],
        wheels: vec![Wheel {
            radius: 1.0,
            normal: NormalLaw {
                bilateral: true,
                ..NormalLaw::linear(10.0, 1.0, Damper::Rail)
            },
            flange: None,
            friction: None,
            spin_inertia: None,
        }],
        contacts: vec![single()],
        gauges: vec![Gauge {
            structure: 0,
            probe: Probe {
                rail: 0,
                x: start + 1.0,
                axis: Axis::Vertical,
            },
        }],
        actuators: Actuators::default(),
        analysis: Analysis::Dynamic,
        end: rise + held,
        output_dt: 0.05,
        output_parts: 1,
        accuracy: 1e-6,
    };
    let foundation = Foundation {
        compliance: Some(Box::new(bed)),
        structure: Some(Structure {
            dynamics: Dynamics::Modes {
                omega: (1..=bed.modes).map(|r| bed.square(r).sqrt()).collect(),
                ratio: vec![0.0; bed.modes],
            },
            shapes: Box::new(bed),
        }),
        rails: vec![Extent {
            range: Some([0.0, length]),
            breaks: Vec::new(),
        }],
        ..Foundation::default()
    };
    (scene, foundation)
}

/// Largest and least deflection under the load once its speed is steady, by the static one of an endless beam.
fn amplification(theta: f64, rise: f64) -> [f64; 2] {
    let (scene, foundation) = crossing(theta, rise);
    let run =
        run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    let [time, give, gauge] = [Channel::Time, Channel::Deflection(0), Channel::Gauge(0)]
        .map(|channel| run.history.column(channel));
    // At rest: u w'' ... = 1/2 under the load, and the endless beam's curve beside it.
    let beside = 0.5 * (-1.0_f64).exp() * (1.0_f64.cos() + 1.0_f64.sin());
    println!(
        "static: {:.1e} {:.1e}",
        give[0] / 0.5 - 1.0,
        -gauge[0] / beside - 1.0
    );
    assert!((give[0] / 0.5 - 1.0).abs() < 1e-9 && (-gauge[0] / beside - 1.0).abs() < 1e-9);
    println!(
        "theta {theta}: {:?}, energy to {:.1e}",
        run.counts,
        run.audit.residual()
    );
    let held = time
        .iter()
        .zip(give)
        .filter(|(t, _)| **t >= rise)
        .map(|(_, give)| give / 0.5);
    held.fold([0.0, f64::INFINITY], |[most, least], value| {
        [f64::max(most, value), f64::min(least, value)]
    })
}

fn steady(theta: f64, rise: f64) {
    let wanted = 1.0 / (1.0 - theta * theta).sqrt();
    let found = amplification(theta, rise);
    println!(
        "theta {theta}: {found:?} for {wanted:.6}: {:.1e} {:.1e}",
        found[0] / wanted - 1.0,
        found[1] / wanted - 1.0
    );
    assert!(
        found
            .iter()
            .all(|factor| (factor / wanted - 1.0).abs() < 1e-4),
        "{found:?} for {wanted}"
    );
}

/// Analytic: 1/sqrt(1 - theta^2) under a load that moves steadily along an endless beam (Timoshenko 1926; Fryba,
/// Vibration of Solids and Structures under Moving Loads, 1972).
#[test]
fn moving_load_meets_the_steady_amplification_up_to_half_the_critical_speed() {
    for theta in [0.1, 0.5] {
        steady(theta, 60.0);
    }
}

/// The same, near the critical speed.
#[test]
#[cfg_attr(
    not(feature = "nightly"),
    ignore = "slow: waves that run with the load take long to die, so its speed comes on slowly, over 700 modes"
)]
fn moving_load_meets_the_steady_amplification_near_the_critical_speed() {
    steady(0.9, 600.0);
}
