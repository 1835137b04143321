//! Flanges, IMPACT and equalisers on a rail whose vertical and lateral give are coupled, each against a reference of
//! other make.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::kutta::{Kernel, rk4};
use common::{GRAVITY, bogie};
use nalgebra::{DMatrix, DVector};
use sim::{
    Analysis, BodyDof, Channel, Damper, Flange, Foundation, MotionKind, Profile, Run, Scene, Status,
};
use splines::{Axis, Probe};

const MASS: f64 = 4.0;
const WEIGHT: f64 = MASS * GRAVITY;
const K: f64 = 6000.0;
const FLANGE: f64 = 5000.0;
/// Give up by a force up, to the right by one to the right, up by one to the right.
const G: [f64; 3] = [2e-4, 5e-4, 2e-4];
const Y: Channel = Channel::Displacement(0, BodyDof::Y);
const Z: Channel = Channel::Displacement(0, BodyDof::Z);

/// G at two places: what it is at zero, and more with both.
fn give(which: usize, x: f64, z: f64) -> f64 {
    G[which] * (1.0 + 0.3 * x * z)
}

/// The rail with these G, coupled.
fn rail() -> Foundation {
    let kernel = Kernel(|p: Probe, q: Probe| {
        let which = match (p.axis, q.axis) {
            (Axis::Vertical, Axis::Vertical) => 0,
            (Axis::Lateral, Axis::Lateral) => 1,
            (Axis::Vertical, Axis::Lateral) | (Axis::Lateral, Axis::Vertical) => 2,
            _ => return [0.0; 2],
        };
        [give(which, p.x, q.x), 0.3 * G[which] * q.x]
    });
    Foundation::massless(Box::new(kernel), 1)
}

/// One contact of these wheels under a body free in y and z, with a flange.
fn scene(offsets: &[f64], clearance: f64, speed: f64, end: f64) -> Scene {
    let mut scene = bogie(0.0, end, Damper::Rail);
    let body = &mut scene.bodies[0];
    (body.mass, body.inertia) = (MASS, [MASS; 3]);
    body.free = [false, true, true, false, false, false];
    body.motion = Some(Profile::new(MotionKind::Speed, &[[0.0, speed]], 0.0, 0.0).expect("a row"));
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = offsets.to_vec();
    let wheel = &mut scene.wheels[0];
    (wheel.normal.stiffness, wheel.normal.damping) = (K, 0.0);
    wheel.flange = Some(Flange {
        stiffness: FLANGE,
        clearance,
        release: None,
    });
    scene.accuracy = 1e-8;
    scene
}

fn run(scene: &Scene) -> Run {
    let run =
        sim::run(scene, &[rail()], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

fn last(run: &Run, channel: Channel) -> f64 {
    run.history
        .column(channel)
        .last()
        .copied()
        .expect("a run has rows")
}

fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    println!(
        "{what}: {found} of {expected}, {:.1e}",
        (found - expected).abs()
    );
    assert!(
        (found - expected).abs() < tolerance,
        "{what}: {found} is not {expected}"
    );
}

/// Vertical force down and lateral force to the right on the rail of one wheel at x = 0, in contact to the right or to the
/// left (`side`) or free of the flange (0).
fn forces(y: f64, z: f64, clearance: f64) -> [f64; 2] {
    let free = -y / (1.0 / K + G[0]);
    for side in [1.0, -1.0] {
        // N/k + Gyy N - Gyz L = -y, L/kl + Gzz L - Gyz N = z - side clearance.
        let (a, b, e) = (1.0 / K + G[0], -G[2], z - side * clearance);
        let d = 1.0 / FLANGE + G[1];
        let det = a * d - b * b;
        let lateral = (a * e + b * y) / det;
        if lateral * side > 0.0 {
            return [(-y * d - b * e) / det, lateral];
        }
    }
    [free, 0.0]
}

#[test]
fn wheel_that_bounces_between_its_flanges_moves_a_coupled_rail_up_and_down() {
    let (clearance, speed, end) = (0.03, 1.0, 0.6);
    let mut scene = scene(&[0.0], clearance, 0.0, end);
    scene.bodies[0].start_speed[2] = speed;
    let found = run(&scene);
    // External: forces of two linear equations, by Runge-Kutta in steps short beside the contacts.
    let start = [-WEIGHT * (1.0 / K + G[0]), 0.0, 0.0, speed];
    let reference = |steps| {
        rk4(start, end, steps, |_, [y, vy, z, vz]| {
            let [vertical, lateral] = forces(y, z, clearance);
            [vy, vertical / MASS - GRAVITY, vz, -lateral / MASS]
        })
    };
    let ([y, vy, z, _], [coarse, ..]) = (reference(400_000), reference(200_000));
    assert!((y - coarse).abs() < 1e-9, "the reference has converged");
    assert!(vy.abs() > 1e-3, "the coupling makes the body bounce");
    close("height", last(&found, Y), y, 1e-7);
    close("side", last(&found, Z), z, 1e-6);
    assert!(
        found.audit.residual() < 1e-7,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn impact_law_with_a_damper_and_flanges_follow_an_independent_integration() {
    let (exponent, c, depth, end) = (1.5, 60.0, 0.02, 0.4);
    let mut scene = scene(&[0.0], 0.0, 0.0, end);
    let law = &mut scene.wheels[0].normal;
    (law.stiffness, law.exponent, law.damping, law.depth) = (2e4, exponent, c, depth);
    scene.bodies[0].start_speed[2] = 0.5;
    let found = run(&scene);
    // External: the penetration is a state: p + Gyy N - Gyz L = -y and the flange give N, N = k p^e + c S(p) p' gives p'.
    let ramp = |p: f64| {
        let d = (p / depth).clamp(0.0, 1.0);
        d * d * (3.0 - 2.0 * d)
    };
    // At rest the flange holds what the coupling pulls: z = 0, L = Gyz N / (1/kl + Gzz), N = W.
    let side = G[2] * WEIGHT / (1.0 / FLANGE + G[1]);
    let p0 = (WEIGHT / 2e4).powf(1.0 / exponent);
    let start = [-p0 - G[0] * WEIGHT + G[2] * side, 0.0, 0.0, 0.5, p0];
    let [y, _, z, _, p] = rk4(start, end, 400_000, |_, [y, vy, z, vz, p]| {
        let (b, d) = (G[2], 1.0 / FLANGE + G[1]);
        let det = G[0] * d - b * b;
        let (e, f) = (-y - p, z);
        let (vertical, lateral) = ((e * d + b * f) / det, (G[0] * f + b * e) / det);
        let rate = (vertical - 2e4 * p.powf(exponent)) / (c * ramp(p));
        [vy, vertical / MASS - GRAVITY, vz, -lateral / MASS, rate]
    });
    close("height", last(&found, Y), y, 1e-7);
    close("side", last(&found, Z), z, 1e-7);
    close(
        "penetration",
        last(&found, Channel::Penetration(0)),
        p,
        1e-7,
    );
    assert!(
        found.audit.residual() < 1e-6,
        "{:e}",
        found.audit.residual()
    );
}

/// Compliance of one vertical force shared by two wheels and of their two flanges at `x`, with the springs' own.
fn shared(x: [f64; 2]) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(3, 3);
    for i in 0..2 {
        for j in 0..2 {
            all[(0, 0)] += 0.25 * give(0, x[i], x[j]);
            all[(0, 1 + j)] -= 0.5 * give(2, x[i], x[j]);
            all[(1 + j, 0)] -= 0.5 * give(2, x[i], x[j]);
            all[(1 + i, 1 + j)] += give(1, x[i], x[j]);
        }
        all[(1 + i, 1 + i)] += 1.0 / FLANGE;
    }
    all[(0, 0)] += 0.5 / K;
    all
}

#[test]
fn equaliser_that_travels_over_a_coupled_rail_shares_its_force() {
    let (speed, end) = (2.0, 0.5);
    let mut scene = scene(&[-0.4, 0.4], 0.0, speed, end);
    scene.bodies[0].start_speed[2] = 0.4;
    let found = run(&scene);
    let at = |t: f64| [speed * t - 0.4, speed * t + 0.4];
    // At rest: N = W, the flanges by two equations, y from the first.
    let all = shared(at(0.0));
    let rest = all.view((1, 1), (2, 2)).into_owned().lu();
    let pull = -all.view((1, 0), (2, 1)) * WEIGHT;
    let sides = rest.solve(&pull).expect("a positive matrix");
    let y0 = -(all[(0, 0)] * WEIGHT + all[(0, 1)] * sides[0] + all[(0, 2)] * sides[1]);
    close("height at rest", found.history.column(Y)[0], y0, 1e-12);
    let [y, _, z, _] = rk4([y0, 0.0, 0.0, 0.4], end, 4000, |t, [y, vy, z, vz]| {
        let forces = shared(at(t))
            .lu()
            .solve(&DVector::from_row_slice(&[-y, z, z]));
        let forces = forces.expect("a positive matrix");
        [
            vy,
            forces[0] / MASS - GRAVITY,
            vz,
            -(forces[1] + forces[2]) / MASS,
        ]
    });
    close("height", last(&found, Y), y, 1e-7);
    close("side", last(&found, Z), z, 1e-7);
    let [left, right] = [0, 1].map(|w| last(&found, Channel::Vertical(w)));
    assert!(
        (left - right).abs() < 1e-12 * WEIGHT,
        "an equaliser shares evenly"
    );
    assert!(
        found.audit.residual() < 1e-7,
        "{:e}",
        found.audit.residual()
    );
}

#[test]
fn flanges_that_hold_a_body_aside_lift_it_on_a_coupled_rail_at_rest() {
    let mut scene = scene(&[-0.4, 0.4], 0.01, 2.0, 1.0);
    scene.bodies[0].free[2] = false;
    scene.bodies[0].start[2] = 0.05;
    scene.analysis = Analysis::QuasiStatic;
    let found = run(&scene);
    let (t, y) = (found.history.column(Channel::Time), found.history.column(Y));
    let mut worst = 0.0_f64;
    for (t, y) in t.iter().zip(&y) {
        // Analytic: N = W; both flanges press to the right.
        let all = shared([2.0 * t - 0.4, 2.0 * t + 0.4]);
        let pressed = DVector::from_element(2, 0.05 - 0.01) - all.view((1, 0), (2, 1)) * WEIGHT;
        let sides = all
            .view((1, 1), (2, 2))
            .into_owned()
            .lu()
            .solve(&pressed)
            .expect("a positive matrix");
        assert!(sides.min() > 0.0);
        let expected = -(all[(0, 0)] * WEIGHT + all[(0, 1)] * sides[0] + all[(0, 2)] * sides[1]);
        worst = worst.max((y - expected).abs() / expected.abs());
    }
    println!("at rest: {worst:.1e}");
    assert!(worst < 1e-11);
    let vertical = found.history.column(Channel::Vertical(0));
    assert!(
        vertical
            .iter()
            .all(|force| (force - 0.5 * WEIGHT).abs() < 1e-11 * WEIGHT)
    );
}
