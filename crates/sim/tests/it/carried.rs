//! Structures with mass on bodies: beams on sprung carriers against their transcendental equations.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::bogie;
use common::crane::body;
use sim::{
    BodyDof, CarriedRail, Carrier, Channel, Contact, Damper, Dynamics, Error, Foundation, Method,
    Scene, Shapes, Status, Structure,
};
use splines::Probe;

const SPAN: f64 = 20.0;
const EI: f64 = 2.1e11 * 2e-3;
/// Mass per length of the beam, mass and inertia of its carrier, stiffness of one of its two wheels.
const LINE: f64 = 300.0;
const MASS: f64 = 2000.0;
const INERTIA: f64 = 8e4;
const WHEEL: f64 = 4e5;
/// Height of the beam over the carrier's origin.
const HEIGHT: f64 = 1.5;
const MODES: usize = 24;

/// Modes of the pinned beam of mass 1: sqrt(2 / m L) sin(n pi x / L). Analytic.
struct Sines;

impl Shapes for Sines {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error> {
        let size = (2.0 / (LINE * SPAN)).sqrt();
        for (k, (value, slope)) in value.iter_mut().zip(slope).enumerate() {
            let wave = (k + 1) as f64 * PI / SPAN;
            (*value, *slope) = (
                size * (wave * at.x).sin(),
                size * wave * (wave * at.x).cos(),
            );
        }
        Ok(())
    }
}

/// The beam on body 0, its middle above the body's origin.
fn beam() -> Foundation {
    let omega = |n: usize| (n as f64 * PI / SPAN).powi(2) * (EI / LINE).sqrt();
    let dynamics = Dynamics::Modes {
        omega: (1..=MODES).map(omega).collect(),
        ratio: vec![0.0; MODES],
    };
    let whole = LINE * SPAN;
    // Analytic: about the first support.
    let mut mass = [[0.0; 6]; 6];
    (0..3).for_each(|i| mass[i][i] = whole);
    (4..6).for_each(|i| mass[i][i] = whole * SPAN * SPAN / 3.0);
    (mass[1][5], mass[5][1]) = (whole * SPAN / 2.0, whole * SPAN / 2.0);
    (mass[2][4], mass[4][2]) = (-whole * SPAN / 2.0, -whole * SPAN / 2.0);
    let at = [-0.5 * SPAN, HEIGHT, 0.0];
    let coupling = |n: usize| {
        let size = (2.0 / whole).sqrt() * whole / (n as f64 * PI);
        let sign = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
        Carrier::load_about_origin(
            &[0.0, size * (1.0 - sign), 0.0, 0.0, 0.0, -size * SPAN * sign],
            at,
        )
    };
    let mount = Carrier {
        body: 0,
        rails: vec![CarriedRail {
            origin: at,
            along: [1.0, 0.0, 0.0],
        }],
        mass: Carrier::mass_about_origin(&mass, at),
        coupling: (1..=MODES).map(coupling).collect(),
    };
    Foundation {
        structure: Some(Structure {
            dynamics,
            shapes: Box::new(Sines),
        }),
        carrier: Some(mount),
        ..Foundation::rigid()
    }
}

/// The carrier on two sprung wheels below the beam's ends.
fn scene(free: &[BodyDof], end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    scene.gravity = 0.0;
    let law = &mut scene.wheels[0].normal;
    (law.stiffness, law.damping, law.bilateral) = (WHEEL, 0.0, true);
    let contact = |x: f64| Contact {
        body: 0,
        structure: 0,
        rail: 0,
        at: [x, 0.0, 0.0],
        offsets: vec![0.0],
        wheel: 0,
    };
    scene.contacts = vec![contact(-0.5 * SPAN), contact(0.5 * SPAN)];
    scene.bodies = vec![body(MASS, [0.0, 0.0, INERTIA], free)];
    (scene.accuracy, scene.output_dt) = (1e-6, end / 100.0);
    scene
}

/// Squares of the natural frequencies below the carrier's `mode`-th and the shares of the carrier's release:
/// `stiffness` = w^2 `dynamic`(a), with a = L/2 (m w^2 / EI)^(1/4); the derivative by w^2 is the mode's mass.
fn series(
    stiffness: f64,
    dynamic: impl Fn(f64) -> f64,
    mass: impl Fn(f64) -> f64,
    poles: [f64; 2],
) -> Vec<[f64; 2]> {
    let square = |a: f64| 16.0 * EI * a.powi(4) / (LINE * SPAN.powi(4));
    let miss = |a: f64| square(a) * dynamic(a) - stiffness;
    (0..12)
        .map(|k| {
            // between two poles the function grows
            let pole = |k: f64| poles[0] + poles[1] * k;
            let mut ends = [
                if k == 0 {
                    1e-3
                } else {
                    pole(f64::from(k) - 1.0) + 1e-12
                },
                pole(f64::from(k)) - 1e-12,
            ];
            for _ in 0..200 {
                let middle = 0.5 * (ends[0] + ends[1]);
                ends[usize::from(miss(middle) > 0.0)] = middle;
            }
            let a = ends[0];
            [square(a).sqrt(), stiffness / square(a) / mass(a)]
        })
        .collect()
}

/// Analytic: ends that move by U e^(iwt) feel the beam as the mass m L (tan a + tanh a) / 2a where they move alike, and as the
/// inertia m L^3 (coth a - cot a) / 8a where they move against each other; the release follows from the modes' masses.
#[test]
fn a_beam_on_a_sprung_carrier_swings_as_its_transcendental_equations_say() {
    let mut scene = scene(&[BodyDof::Y, BodyDof::Pitch], 0.8);
    (scene.bodies[0].start[1], scene.bodies[0].start[5]) = (0.01, 0.001);
    let run = sim::run(&scene, &[Foundation::rigid(), beam()], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    let whole = LINE * SPAN;
    let level = series(
        2.0 * WHEEL,
        |a| MASS + whole * (a.tan() + a.tanh()) / (2.0 * a),
        |a| {
            MASS + whole / 8.0
                * (3.0 * (a.tan() + a.tanh()) / a + a.cos().powi(-2) + a.cosh().powi(-2))
        },
        [0.5 * PI, PI],
    );
    let inertia = INERTIA + whole * HEIGHT * HEIGHT;
    let bar = whole * SPAN * SPAN;
    let nods = series(
        2.0 * WHEEL * (0.5 * SPAN).powi(2),
        |a| inertia + bar * (1.0 / a.tanh() - 1.0 / a.tan()) / (8.0 * a),
        |a| {
            let (cot, coth) = (1.0 / a.tan(), 1.0 / a.tanh());
            inertia + bar / 32.0 * (3.0 * (coth - cot) / a + a.sin().powi(-2) - a.sinh().powi(-2))
        },
        [PI, PI],
    );
    let time = run.history.column(Channel::Time);
    for (freedom, series, start) in [(BodyDof::Y, level, 0.01), (BodyDof::Pitch, nods, 0.001)] {
        let sum: f64 = series.iter().map(|[_, share]| share).sum();
        let found = run.history.column(Channel::Displacement(0, freedom));
        let mut worst = 0.0_f64;
        for (t, found) in time.iter().zip(found) {
            let wanted: f64 = series
                .iter()
                .map(|[omega, share]| share * (omega * t).cos())
                .sum();
            worst = worst.max((found / start - wanted).abs());
        }
        println!(
            "{freedom:?}: {worst:.1e}; shares {sum:.8}, frequencies {:?}",
            &series[..3]
        );
        assert!(
            (sum - 1.0).abs() < 1e-5,
            "the shares of all modes add up to {sum}"
        );
        assert!(worst < 1e-6, "{freedom:?} errs by {worst}");
    }
    println!("energy {:.1e}, {:?}", run.audit.residual(), run.counts);
    assert!(
        run.audit.residual() < 1e-7,
        "energy residual {}",
        run.audit.residual()
    );
}

#[test]
fn collocation_and_wrong_couplings_are_refused() {
    let scene = scene(&[BodyDof::Y], 1.0);
    let refused = |girder: Foundation, method| {
        sim::run_by(method, &scene, &[Foundation::rigid(), girder], &mut |_| {
            ControlFlow::Continue(())
        })
        .err()
    };
    assert!(matches!(
        refused(beam(), Method::Radau),
        Some(Error::Method { .. })
    ));
    let mut short = beam();
    short
        .carrier
        .iter_mut()
        .for_each(|mount| mount.coupling.truncate(3));
    assert!(matches!(
        refused(short, Method::Sdirk4),
        Some(Error::NoSuch { .. })
    ));
    let mut heavy = beam();
    heavy
        .carrier
        .iter_mut()
        .flat_map(|mount| &mut mount.coupling)
        .for_each(|line| line[1] *= 3.0);
    assert!(
        matches!(refused(heavy, Method::Sdirk4), Some(Error::Number { .. })),
        "more momentum than mass"
    );
}
