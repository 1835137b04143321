//! A rigid mass over a beam without mass (Willis, Stokes 1849).

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;

use common::modes::{beam, omega, oscillator};
use common::{EI, SPAN};
use sim::{Channel, Run, Scene, Status};

/// The mass at beta = g L^2 / (16 v^2 S), S its static deflection; the wheel's spring gives 1e-5 of S.
fn scene(beta: f64) -> Scene {
    let mass = 0.5;
    let weight = mass * common::modes::MASS * SPAN * 32.174;
    let sag = weight * SPAN.powi(3) / (48.0 * EI);
    let speed = (32.174 * SPAN * SPAN / (16.0 * beta * sag)).sqrt();
    let mut scene = oscillator(mass, 1.0, speed * PI / (SPAN * omega(1)));
    scene.wheels[0].normal.stiffness = weight / (1e-5 * sag);
    scene.accuracy = 1e-7;
    scene
}

fn run(scene: &Scene) -> Run {
    let run = sim::run(scene, &[beam(0, true)], &mut |_| ControlFlow::Continue(()))
        .expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// External: converged reference; midspan deflection by S, and where the force first turns negative.
#[test]
fn mass_on_a_beam_without_mass_meets_the_reference() {
    for (beta, factor, pulls) in [
        (100.0, 1.0103, None),
        (25.0, 1.0454, None),
        (10.0, 1.1416, Some(0.967)),
        (5.0, 1.3227, Some(0.869)),
        (2.0, 1.7799, Some(0.919)),
    ] {
        let scene = scene(beta);
        let run = run(&scene);
        let weight = scene.bodies[0].mass * scene.gravity;
        let sag = weight * SPAN.powi(3) / (48.0 * EI);
        let force = run.history.column(Channel::Vertical(0));
        let place = run.history.column(Channel::Position(0));
        // In the last 0.2 % of the span the spring gives as much as the beam.
        let first = force
            .iter()
            .position(|f| *f < 0.0)
            .map(|i| place[i] / SPAN)
            .filter(|x| *x < 0.998);
        // Beyond, towards the support, the wheel is pulled down and thrown up in turns.
        let until = first.map_or(f64::INFINITY, |x| x * SPAN);
        let samples = run
            .history
            .column(Channel::Gauge(0))
            .into_iter()
            .zip(&place);
        let pressed = samples.filter(|(_, x)| **x <= until);
        let middle = pressed.fold(0.0_f64, |max, (y, _)| max.max(-y / sag));
        println!("beta {beta}: factor {middle:.5} for {factor}, pulls at {first:?} for {pulls:?}");
        assert!((middle / factor - 1.0).abs() < 1e-3);
        if let (Some(first), Some(pulls)) = (first, pulls) {
            assert!((first - pulls).abs() < 1e-3);
        }
        assert_eq!(first.is_some(), pulls.is_some());
    }
}

/// Where the bilateral wheel pulls, the one-sided one leaves the rail, and lands again or ends in the air.
#[test]
fn one_sided_wheel_leaves_where_the_other_would_pull() {
    for (beta, pulls) in [(10.0, 0.967), (5.0, 0.869), (2.0, 0.919)] {
        let mut scene = scene(beta);
        scene.wheels[0].normal.bilateral = false;
        let run = run(&scene);
        let (force, place) = (
            run.history.column(Channel::Vertical(0)),
            run.history.column(Channel::Position(0)),
        );
        let gap = run.history.column(Channel::Penetration(0));
        let off = force
            .iter()
            .zip(&place)
            .position(|(f, x)| *f == 0.0 && *x > 0.0)
            .expect("it leaves");
        println!(
            "beta {beta}: leaves at {:.4}, {} events",
            place[off] / SPAN,
            run.counts.events
        );
        assert!((place[off] / SPAN - pulls).abs() < 1e-3);
        assert!(force.iter().all(|f| *f >= 0.0) && gap[off + 1] < 0.0);
    }
}
