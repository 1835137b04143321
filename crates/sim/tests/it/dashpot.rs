//! A damper between wheel and rail that others eliminate within the step: G (k p + c p') = d - p along a wheel's known path.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::kutta::rk4;
use common::near::assert_near;
use common::{EI, GRAVITY, SPAN, bogie, girder, single};
use sim::{Channel, Damper, MotionKind, Profile, Scene, Status};

/// Stiffness and damping of the wheel, lb/ft and lb s/ft; its load, lb.
const K: f64 = 1e8;
const C: f64 = 1e5;
const LOAD: f64 = 2.4e6;
/// Speed, ft/s, of a wheel that begins at the quarter point at rest, and the time to the other one.
const SPEED: f64 = 100.0;
const END: f64 = 0.3;

fn place(t: f64) -> f64 {
    15.0 + SPEED * t
}

/// G(x, x) = x^2 (L - x)^2 / (3 EI L).
fn give(x: f64) -> f64 {
    (x * (SPAN - x)).powi(2) / (3.0 * EI * SPAN)
}

/// d, d' and p in static equilibrium at the start.
fn rest() -> [f64; 3] {
    [LOAD * (1.0 / K + give(place(0.0))), 0.0, LOAD / K]
}

fn force(t: f64, [d, _, p]: [f64; 3]) -> f64 {
    (d - p) / give(place(t))
}

fn rate(t: f64, y: [f64; 3]) -> [f64; 3] {
    let force = force(t, y);
    [y[1], GRAVITY * (1.0 - force / LOAD), (force - K * y[2]) / C]
}

/// d and the force at the ends of `count` steps, by the classical Runge-Kutta method in steps of at most 1e-5 s.
fn path(count: u32) -> Vec<[f64; 2]> {
    let h = END / f64::from(count);
    let mut y = rest();
    let mut out = vec![[y[0], force(0.0, y)]];
    for i in 0..count {
        let begin = h * f64::from(i);
        y = rk4(y, h, (h / 1e-5).ceil() as u32, |t, y| rate(begin + t, y));
        out.push([y[0], force(begin + h, y)]);
    }
    out
}

/// Largest error of the force by its largest value, the penetration eliminated from each of `count` steps of
/// p_1 - p_0 = h ((1 - theta) p'_0 + theta p'_1): theta = 1 is backward Euler, 1/2 the trapezoid.
fn eliminated(theta: f64, count: u32) -> f64 {
    let h = END / f64::from(count);
    let along = path(count);
    let most = along
        .iter()
        .fold(0.0, |most, [_, force]| f64::max(most, *force));
    let [mut p, mut speed] = [rest()[2], 0.0];
    let mut worst = 0.0_f64;
    for (i, [d, wanted]) in along.iter().enumerate().skip(1) {
        // F = s p_1 + r
        let s = K + C / (theta * h);
        let r = -C / (theta * h) * (p + h * (1.0 - theta) * speed);
        let force = (d + r / s) / (1.0 / s + give(place(h * i as f64)));
        p = (force - r) / s;
        speed = (force - K * p) / C;
        worst = worst.max((force - wanted).abs() / most);
    }
    worst
}

/// Slope of ln(error) by ln(step) over halved steps.
fn order(errors: &[f64]) -> f64 {
    (errors[0] / errors[errors.len() - 1]).ln() / (2.0_f64.ln() * (errors.len() - 1) as f64)
}

fn steps(milliseconds: f64) -> u32 {
    (1e3 * END / milliseconds).round() as u32
}

/// The same wheel in the simulator.
fn scene() -> Scene {
    let mut scene = bogie(0.0, END, Damper::Rail);
    let body = &mut scene.bodies[0];
    body.mass = LOAD / GRAVITY;
    body.free = [false, true, false, false, false, false];
    body.motion = Some(
        Profile::new(MotionKind::Speed, &[[0.0, SPEED]], place(0.0), SPEED).expect("a valid table"),
    );
    scene.contacts = vec![single()];
    scene.output_dt = 1e-3;
    scene
}

#[test]
fn a_damper_on_the_rail_eliminated_from_steps_errs_by_their_order() {
    let wheel = "damper on the rail, wheel of 2.4e6 lb at 100 ft/s from 15 to 45 ft";
    for (name, theta, wanted) in [("backward Euler", 1.0, 1.0), ("trapezoid", 0.5, 2.0)] {
        let fine: Vec<f64> = (3..7).map(|i| eliminated(theta, steps(1.0) << i)).collect();
        println!("{name}: {fine:?} at 1/8 to 1/64 ms");
        assert_near(
            format!("{wheel}, {name}: order in the steps"),
            "theory",
            wanted,
            order(&fine),
            0.05 / wanted,
        );
    }
    let coarse = [4.0, 2.0, 1.0].map(|step| eliminated(1.0, steps(step)));
    println!("backward Euler: {coarse:?} at 4, 2 and 1 ms");
    assert_near(
        format!("{wheel}, backward Euler, 4 to 1 ms: largest error of the force by its largest"),
        "prototype",
        1e-4,
        coarse.into_iter().fold(0.0, f64::max),
        0.1,
    );
    assert_near(
        format!("{wheel}, trapezoid, 1 ms: the same"),
        "prototype",
        2.7e-5,
        eliminated(0.5, steps(1.0)),
        0.1,
    );
    for accuracy in [1e-4, 1e-5, 1e-6] {
        let mut scene = scene();
        scene.accuracy = accuracy;
        let run = sim::run(&scene, &[girder()], &mut |_| ControlFlow::Continue(()))
            .expect("a valid scene");
        assert_eq!(run.status, Status::Done);
        let wanted = path(steps(1.0));
        let most = wanted
            .iter()
            .fold(0.0, |most, [_, force]| f64::max(most, *force));
        let found = run.history.column(Channel::Vertical(0));
        let apart = found
            .iter()
            .zip(&wanted)
            .map(|(a, b)| (a - b[1]).abs() / most)
            .fold(0.0, f64::max);
        println!(
            "ours, accuracy {accuracy:e}: {apart:.1e} in {} steps, {:?}",
            run.counts.steps, run.method
        );
        assert!(apart < 5.0 * accuracy, "{accuracy:e}: {apart:e}");
    }
}
