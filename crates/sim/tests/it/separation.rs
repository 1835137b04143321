//! A wheel leaves the rail and lands again: where, as steps shrink.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::modes::{MASS, beam, omega, oscillator};
use common::near::assert_near;
use common::{EI, SPAN};
use sim::{Channel, Dynamics, Method, Scene, Status, Stepping, run_by};

/// A one-sided wheel under a mass over a beam without mass, beta = g L^2 / (16 v^2 S) = 5.
fn scene() -> Scene {
    let (mass, beta) = (0.5, 5.0);
    let weight = mass * MASS * SPAN * 32.174;
    let sag = weight * SPAN.powi(3) / (48.0 * EI);
    let speed = (32.174 * SPAN * SPAN / (16.0 * beta * sag)).sqrt();
    let mut scene = oscillator(mass, 1.0, speed * PI / (SPAN * omega(1)));
    // A wheel with a twentieth of the give of the beam: soft, so that steps are long and the error is that of the motion.
    scene.wheels[0].normal.stiffness = 20.0 * weight / sag;
    scene.wheels[0].normal.bilateral = false;
    scene.output_dt = scene.end / 20_000.0;
    scene
}

/// Places at which the force meets zero: leaves, lands, x / L, by linear interpolation of the gap between outputs; steps.
fn places(stepping: Stepping, accuracy: f64) -> ([f64; 2], usize) {
    let mut scene = scene();
    scene.accuracy = accuracy;
    let run = run_by(stepping, &scene, &[beam(0, true)], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    let [gap, place, force] = [
        Channel::Penetration(0),
        Channel::Position(0),
        Channel::Vertical(0),
    ]
    .map(|channel| run.history.column(channel));
    assert!(
        force.iter().all(|f| *f >= 0.0),
        "a one-sided wheel never pulls"
    );
    let off = (2..gap.len())
        .find(|&i| gap[i - 1] >= 0.0 && gap[i] < 0.0)
        .expect("it leaves");
    let on = (off + 1..gap.len())
        .find(|&i| gap[i - 1] < 0.0 && gap[i] >= 0.0)
        .expect("it lands");
    let at = |i: usize| {
        let share = gap[i - 1] / (gap[i - 1] - gap[i]);
        (place[i - 1] + share * (place[i] - place[i - 1])) / SPAN
    };
    ([at(off), at(on)], run.counts.steps)
}

/// Slope of ln(error) by ln(steps) through all points, by least squares, negated.
fn order(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<(f64, f64)> = points
        .iter()
        .map(|(steps, error)| (steps.ln(), error.ln()))
        .collect();
    let (x, y) = logs
        .iter()
        .fold((0.0, 0.0), |(x, y), (a, b)| (x + a / n, y + b / n));
    let (above, below) = logs.iter().fold((0.0, 0.0), |(u, v), (a, b)| {
        (u + (a - x) * (b - y), v + (a - x).powi(2))
    });
    -above / below
}

/// Orders of both places over `runs`, by their distance from the last of them.
fn orders(runs: &[([f64; 2], usize)]) -> [f64; 2] {
    let Some((last, rest)) = runs.split_last() else {
        return [0.0; 2];
    };
    [0, 1].map(|k| {
        let points: Vec<(f64, f64)> = rest
            .iter()
            .map(|(places, steps)| (*steps as f64, (places[k] - last.0[k]).abs()))
            .collect();
        for pair in points.windows(2) {
            let local = (pair[0].1 / pair[1].1).ln() / (pair[1].0 / pair[0].0).ln();
            println!(
                "{} {:.0} steps: {:.2e} L, order {local:.2}",
                ["leaves", "lands"][k],
                pair[1].0,
                pair[1].1
            );
        }
        order(&points)
    })
}

/// Self-convergence with fixed steps, 100 to 800 a crossing, fewer by Radau, against 6,400.
#[test]
fn places_at_which_the_wheel_leaves_and_lands_converge_with_the_order_of_the_stepper() {
    let many = [100, 200, 400, 800, 6400];
    for (method, wanted, counts) in [
        (Method::Sdirk4, 4.0, many),
        (Method::Gauss2, 4.0, many),
        (Method::Radau, 9.0, [18, 26, 36, 52, 6400]),
    ] {
        let runs: Vec<([f64; 2], usize)> = counts
            .into_iter()
            .map(|count: u32| {
                let step = Some(scene().end / f64::from(count));
                places(Stepping { method, step }, 1e-9)
            })
            .collect();
        let found = orders(&runs);
        println!(
            "{method:?}: leaves and lands at {:?} L, orders {found:.2?}",
            runs[4].0
        );
        for (what, order) in ["leaves", "lands"].iter().zip(found) {
            let what = format!("place at which a wheel {what}, {method:?}: order in the steps");
            // few steps a crossing, whose errors of order 9 depend on where the last one begins
            let within = if method == Method::Radau { 1.0 } else { 0.15 };
            assert_near(what, "theory", wanted, order, within / wanted);
        }
    }
}

/// The same places by adaptive steps: within 1e-8 L at accuracy 1e-8.
#[test]
fn adaptive_steps_find_the_same_places() {
    let fine = places(
        Stepping {
            method: Method::Sdirk4,
            step: Some(scene().end / 6400.0),
        },
        1e-9,
    )
    .0;
    for accuracy in [1e-5, 1e-6, 1e-7, 1e-8] {
        let (found, steps) = places(Stepping::default(), accuracy);
        let errors = [0, 1].map(|k| (found[k] - fine[k]).abs());
        println!(
            "{accuracy:.0e}: {steps} steps, errors {:.1e} and {:.1e} L",
            errors[0], errors[1]
        );
        assert!(
            errors.iter().all(|error| *error < accuracy),
            "{accuracy:e}: {errors:?}"
        );
    }
}

/// Self-consistent: a wheel that bounces on a beam with mass leaves it, and meets it, for times that are short beside the steps
/// as well. A run that passed one of them would differ from the run with fine steps by what it missed.
#[test]
fn short_flights_and_touches_are_not_passed() {
    let mut damped = beam(10, false);
    if let Some(structure) = &mut damped.structure {
        let omega = (1..=10).map(omega).collect();
        structure.dynamics = Dynamics::Modes {
            omega,
            ratio: vec![0.08; 10],
        };
    }
    let mut worst = 0.0_f64;
    for k in 0..60 {
        let frequency = 0.7 + 0.2 * f64::from(k % 6);
        let mut scene = oscillator(0.02, frequency, 0.01);
        scene.wheels[0].normal.bilateral = false;
        // The wheel bounces by little more than its penetration at rest.
        let over = 0.002 + 0.004 * f64::from(k / 6);
        scene.bodies[0].start_speed[1] = (1.0 + over) * 32.174 / (frequency * omega(1));
        let column = |accuracy: f64| {
            let scene = Scene {
                accuracy,
                ..scene.clone()
            };
            let run = run_by(
                Method::Radau,
                &scene,
                std::slice::from_ref(&damped),
                &mut |_| ControlFlow::Continue(()),
            )
            .expect("a valid scene");
            assert_eq!(run.status, Status::Done);
            let apart = run.history.column(Channel::Penetration(0));
            let flights = apart
                .windows(2)
                .filter(|pair| pair[0] >= 0.0 && pair[1] < 0.0)
                .count();
            (run.history.column(Channel::Gauge(0)), flights)
        };
        let ((found, _), (fine, flights)) = (column(1e-6), column(1e-10));
        let size = fine.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        let apart = found
            .iter()
            .zip(&fine)
            .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
            / size;
        println!("{k}: {flights} flights, {apart:.1e}");
        worst = worst.max(apart);
    }
    assert!(worst < 2e-5, "{worst}");
}
