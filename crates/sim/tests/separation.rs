//! A wheel leaves the rail: when, as the accuracy asked is tightened.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::modes::{MASS, beam, omega, oscillator};
use common::{EI, SPAN};
use sim::{Channel, Scene, Status};

/// A one-sided wheel under a mass over a beam without mass, beta = g L^2 / (16 v^2 S) = 5.
fn scene(accuracy: f64) -> Scene {
    let (mass, beta) = (0.5, 5.0);
    let weight = mass * MASS * SPAN * 32.174;
    let sag = weight * SPAN.powi(3) / (48.0 * EI);
    let speed = (32.174 * SPAN * SPAN / (16.0 * beta * sag)).sqrt();
    let mut scene = oscillator(mass, 1.0, speed * PI / (SPAN * omega(1)));
    // A wheel with a twentieth of the give of the beam: soft, so that steps are long and the error is that of the motion.
    scene.wheels[0].normal.stiffness = 20.0 * weight / sag;
    scene.wheels[0].normal.bilateral = false;
    scene.accuracy = accuracy;
    scene.output_dt = scene.end / 20_000.0;
    scene
}

/// Places at which the force meets zero: (leaves, lands), x / L, by linear interpolation of the gap.
fn places(accuracy: f64) -> (f64, Option<f64>, usize) {
    let scene = scene(accuracy);
    let run = sim::run(&scene, &[beam(0, true)], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    let (gap, place, force) = (
        run.history.column(Channel::Penetration(0)),
        run.history.column(Channel::Place(0)),
        run.history.column(Channel::Vertical(0)),
    );
    assert!(force.iter().all(|f| *f >= 0.0), "a one-sided wheel never pulls");
    let crossing = |from: usize, down: bool| {
        (from + 1..gap.len()).find(|&i| {
            if down { gap[i - 1] >= 0.0 && gap[i] < 0.0 } else { gap[i - 1] < 0.0 && gap[i] >= 0.0 }
        })
    };
    let at = |i: usize| {
        let share = gap[i - 1] / (gap[i - 1] - gap[i]);
        (place[i - 1] + share * (place[i] - place[i - 1])) / SPAN
    };
    let off = crossing(1, true).expect("it leaves");
    (at(off), crossing(off, false).map(at), run.counts.steps)
}

/// Order 4 of the stepper in the steps taken, or better: adaptive steps shrink most where the wheel leaves and lands.
#[test]
fn places_at_which_the_wheel_leaves_and_lands_converge_with_the_order_of_the_stepper() {
    let (off, on, _) = places(1e-10);
    let on = on.expect("it lands");
    println!("leaves at {off:.9} L, lands at {on:.9} L");
    let rows: Vec<(f64, f64, f64)> = [1e-5, 1e-6, 1e-7, 1e-8]
        .into_iter()
        .map(|accuracy| {
            let (leaves, lands, steps) = places(accuracy);
            let errors = ((leaves - off).abs(), (lands.expect("it lands") - on).abs());
            println!("{accuracy:.0e}: {steps} steps, errors {:.2e} and {:.2e} L", errors.0, errors.1);
            (steps as f64, errors.0, errors.1)
        })
        .collect();
    let (first, last) = (rows[0], rows[3]);
    let steps = (last.0 / first.0).ln();
    let orders = ((first.1 / last.1).ln() / steps, (first.2 / last.2).ln() / steps);
    println!("orders {:.2} and {:.2}", orders.0, orders.1);
    assert!(orders.0 > 3.8 && orders.1 > 3.8 && last.1 < 1e-8 && last.2 < 1e-8);
}
