//! Three crossings over the girder with and without its mass: the paper's bogie at 5 (S1) and 100 ft/s (S2), and the
//! sprung mass of Yang and Yau's bridge (S4).

use std::ops::ControlFlow;

use formats::spec::Spec;
use formats::text::source::Source;
use foundations::{full_mesh_foundation, solve};
use sim::{BodyDof, Channel, Damper, Foundation, Gauge, Run, Scene, Status};
use splines::{Axis, Probe};

use crate::common::bogie;

const PAPER: &str = r#"{"format": "girderway-beam/1", "units": {"length": "ft", "force": "lbf", "time": "s"},
    "theory": "euler-bernoulli",
    "girder": {"spans": [60], "overhangs": [15, 15], "E": 4.32e9, "I_vertical": 9.528, "mass_per_length": 15.2},
    "stations": [-15, 0, 30, 60, 75]}"#;

const BRIDGE: &str = r#"{"format": "girderway-beam/1", "units": {"length": "m", "force": "N", "time": "s"},
    "theory": "euler-bernoulli",
    "girder": {"spans": [25], "E": 2.87e9, "I_vertical": 2.90, "mass_per_length": 2303}, "stations": [0, 12.5, 25]}"#;

const SPEED: f64 = 100.0 / 3.6;
const CAR: f64 = 5750.0;
const SPRING: f64 = 1595e3;
const G: f64 = 9.81;

/// The girder without mass, exact, or with the modes of a mesh of `elements`.
pub fn foundation(text: &str, elements: Option<usize>) -> Foundation {
    let source = Source {
        name: "spec.json".to_owned(),
        text: text.to_owned(),
    };
    let solved = solve(&Spec::read(&source, None).expect("a girder")).expect("it stands");
    match elements {
        None => Foundation::massless(Box::new(solved.surface.expect("it is small")), 1),
        Some(elements) => full_mesh_foundation(&solved, elements).expect("it has mass"),
    }
}

fn run(scene: &Scene, foundation: Foundation) -> Run {
    let run =
        sim::run(scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    assert!(
        run.audit.residual() < 1e-6,
        "energy to {:e}",
        run.audit.residual()
    );
    run
}

fn gauged(mut scene: Scene, x: f64, samples: f64, accuracy: f64) -> Scene {
    scene.output_dt = scene.end / samples;
    scene.accuracy = accuracy;
    scene.gauges = vec![Gauge {
        structure: 0,
        probe: Probe {
            rail: 0,
            x,
            axis: Axis::Vertical,
        },
    }];
    scene
}

fn bridge() -> Scene {
    let mut scene = bogie(SPEED, 0.9, Damper::Rail);
    scene.gravity = G;
    scene.bodies[0].mass = CAR;
    scene.bodies[0].inertia = [0.0; 3];
    scene.bodies[0].free[5] = false;
    scene.wheels[0].normal.stiffness = SPRING;
    scene.wheels[0].normal.damping = 0.0;
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    gauged(scene, 12.5, 3600.0, 1e-6)
}

fn extremes(values: &[f64]) -> [f64; 2] {
    values
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], v| {
            [least.min(*v), most.max(*v)]
        })
}

/// External, converged: another program's exact influence function (dampers on the wheels' own velocity), its finite
/// elements with Newmark steps (dampers on the rate of the gap). Peaks of the bogie and of midspan, ft.
#[test]
fn bogie_over_the_girder_without_and_with_mass_meets_the_references() {
    for (speed, end, light, heavy, middle) in [
        (5.0, 12.0, 0.547_09, 0.547_17, 0.5247),
        (100.0, 0.55, 0.908_68, 0.912_60, 1.0777),
    ] {
        let peaks = |damper, elements| {
            let scene = gauged(bogie(speed, end, damper), 30.0, 1000.0, 1e-5);
            let run = run(&scene, foundation(PAPER, elements));
            [Channel::Displacement(0, BodyDof::Y), Channel::Gauge(0)]
                .map(|channel| -extremes(&run.history.column(channel))[0])
        };
        let (massless, beam) = (peaks(Damper::Ground, None), peaks(Damper::Rail, Some(8)));
        println!("{speed} ft/s: massless {massless:?}, beam {beam:?}");
        assert!(
            (massless[0] - light).abs() < 1e-5,
            "{massless:?} for {light}"
        );
        assert!(
            (beam[0] - heavy).abs() < 1e-5 && (beam[1] - middle).abs() < 1e-4,
            "{beam:?}"
        );
    }
}

/// External, converged: Hermite elements with Newmark steps. The acceleration of the car is that of its speed by
/// differences, apart from the force on it.
#[test]
fn sprung_mass_over_yang_and_yaus_bridge_meets_the_reference() {
    let scene = bridge();
    let run = run(&scene, foundation(BRIDGE, Some(32)));
    let [time, middle, force, rate] = [
        Channel::Time,
        Channel::Gauge(0),
        Channel::Vertical(0),
        Channel::Speed(0, BodyDof::Y),
    ]
    .map(|channel| run.history.column(channel));
    let least = (0..middle.len())
        .min_by(|&i, &j| middle[i].total_cmp(&middle[j]))
        .unwrap_or(0);
    let force = extremes(&force);
    // downwards; forces begin anew at no place of the crossing
    let turns: Vec<f64> = (2..rate.len() - 2)
        .map(|i| {
            -(8.0 * (rate[i + 1] - rate[i - 1]) - (rate[i + 2] - rate[i - 2]))
                / (12.0 * scene.output_dt)
        })
        .collect();
    let acceleration = extremes(&turns);
    println!(
        "midspan {} m at {} s, force {force:?} N, acceleration {acceleration:?} m/s2",
        middle[least], time[least]
    );
    assert!(
        (-middle[least] / 2.407_316e-3 - 1.0).abs() < 1e-5 && (time[least] - 0.3710).abs() < 2e-4
    );
    assert!(
        (force[0] - 55_590.0).abs() < 0.1 && (force[1] - 57_258.3).abs() < 0.1,
        "{force:?}"
    );
    assert!((acceleration[0] + 0.147_97).abs() < 1e-5 && (acceleration[1] - 0.142_18).abs() < 1e-5);
}

/// Independent: m z'' = m g - z / (1/k + x^2 (L - x)^2 / 3EIL), by Runge and Kutta's rule in small steps.
#[test]
fn sprung_mass_over_the_bridge_without_mass_meets_its_own_equation() {
    let (length, bending) = (25.0, 2.87e9 * 2.90);
    let force = |t: f64, z: f64| {
        let x = SPEED * t;
        z / (1.0 / SPRING + (x * (length - x)).powi(2) / (3.0 * bending * length))
    };
    let rate = |t: f64, [z, v]: [f64; 2]| [v, G - force(t, z) / CAR];
    let (steps, end) = (90_000_u32, 0.9);
    let h = end / f64::from(steps);
    let mut state = [CAR * G / SPRING, 0.0];
    let mut wanted = vec![(state[0], CAR * G)];
    for n in 0..steps {
        let t = h * f64::from(n);
        let ahead = |k: [f64; 2], s: f64| [state[0] + s * k[0], state[1] + s * k[1]];
        let a = rate(t, state);
        let b = rate(t + 0.5 * h, ahead(a, 0.5 * h));
        let c = rate(t + 0.5 * h, ahead(b, 0.5 * h));
        let d = rate(t + h, ahead(c, h));
        let mean = |i: usize| h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]);
        state = [state[0] + mean(0), state[1] + mean(1)];
        if (n + 1) % 25 == 0 {
            wanted.push((state[0], force(t + h, state[0])));
        }
    }
    let run = run(&bridge(), foundation(BRIDGE, None));
    let [y, vertical] =
        [Channel::Displacement(0, BodyDof::Y), Channel::Vertical(0)].map(|c| run.history.column(c));
    assert_eq!(y.len(), wanted.len());
    let (mut error, mut peaks) = ([0.0_f64; 2], [0.0_f64; 2]);
    for ((y, vertical), (z, force)) in y.iter().zip(&vertical).zip(&wanted) {
        error = [
            error[0].max((y + z).abs()),
            error[1].max((vertical - force).abs()),
        ];
        peaks = [peaks[0].max(*z), peaks[1].max(*force)];
    }
    println!(
        "peaks {peaks:?}, errors {:.1e} {:.1e} of them",
        error[0] / peaks[0],
        error[1] / peaks[1]
    );
    assert!(error[0] < 1e-6 * peaks[0] && error[1] < 1e-6 * peaks[1]);
}
