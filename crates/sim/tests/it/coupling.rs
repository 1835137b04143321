//! What couples and what does not: bodies side by side, friction on a rail that gives, a body on a girder with mass.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::parts::{inertia, massive};
use common::{EI, GRAVITY, WEIGHT, bogie, girder};
use sim::{
    Analysis, BodyDof, Channel, Damper, Foundation, Friction, FrictionLaw, MotionKind, Profile,
    Run, Scene, Status,
};

fn run(scene: &Scene, foundations: &[Foundation]) -> Run {
    let run =
        sim::run(scene, foundations, &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    assert_eq!(run.status, Status::Done);
    run
}

/// A bogie of half the weight at another speed, with grounded dampers.
fn light() -> Scene {
    let mut scene = bogie(30.0, 1.0, Damper::Ground);
    let body = &mut scene.bodies[0];
    body.mass *= 0.5;
    body.motion =
        Some(Profile::new(MotionKind::Speed, &[[0.0, 30.0]], 0.0, 10.0).expect("a valid table"));
    scene.wheels[0].normal.stiffness = 3e7;
    scene
}

/// Both scenes in one, each body on its own structure.
fn both(first: &Scene, second: &Scene) -> Scene {
    let mut scene = first.clone();
    scene.bodies.extend(second.bodies.iter().cloned());
    scene.wheels.extend(second.wheels.iter().cloned());
    scene.contacts.extend(second.contacts.iter().map(|contact| {
        let mut contact = contact.clone();
        (contact.body, contact.structure, contact.wheel) = (1, 1, 1);
        contact
    }));
    scene
}

/// Largest difference of the columns `ours` of one run from `theirs` of another, relative to their peaks.
fn difference(ours: (&Run, &[Channel]), theirs: (&Run, &[Channel])) -> f64 {
    let mut worst = 0.0_f64;
    for (&our, &their) in ours.1.iter().zip(theirs.1) {
        let (our, their) = (ours.0.history.column(our), theirs.0.history.column(their));
        assert_eq!(our.len(), their.len());
        let peak = their.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        assert!(peak > 0.0, "something happens");
        worst = our
            .iter()
            .zip(&their)
            .fold(worst, |max, (a, b)| max.max((a - b).abs() / peak));
    }
    worst
}

#[test]
fn bodies_on_two_structures_do_not_feel_each_other() {
    let displacements =
        |b| [BodyDof::Y, BodyDof::Pitch].map(|freedom| Channel::Displacement(b, freedom));
    let forces = |b| [0, 1].map(|w| Channel::Vertical(2 * b + w));
    let (mut heavy, mut light) = (bogie(50.0, 1.0, Damper::Rail), light());
    // Forces between the ends of steps are those of the interpolant, whose penetrations are cubic.
    for (analysis, bounds) in [
        (Analysis::QuasiStatic, [1e-14; 2]),
        (Analysis::Dynamic, [1e-8, 1e-5]),
    ] {
        for scene in [&mut heavy, &mut light] {
            scene.analysis = analysis;
            scene.accuracy = 1e-8;
        }
        let together = run(&both(&heavy, &light), &[girder(), massive(1.0)]);
        let alone = [run(&heavy, &[girder()]), run(&light, &[massive(1.0)])];
        for (b, alone) in alone.iter().enumerate() {
            let found = [
                difference((&together, &displacements(b)), (alone, &displacements(0))),
                difference((&together, &forces(b)), (alone, &forces(0))),
            ];
            println!("{analysis:?}, body {b}: {:.1e} {:.1e}", found[0], found[1]);
            assert!(
                found[0] < bounds[0] && found[1] < bounds[1],
                "{analysis:?}, body {b}: {found:?}"
            );
        }
        // Energies are sums over the bodies.
        for (what, of) in [
            (
                "stored",
                (|run: &Run| run.audit.end.total()) as fn(&Run) -> f64,
            ),
            ("lost in dampers", |run| run.audit.exchanged.dampers),
            ("put in", |run| run.audit.exchanged.drives),
        ] {
            let (sum, scale) = (of(&alone[0]) + of(&alone[1]), together.audit.peak_stored);
            assert!(
                (of(&together) - sum).abs() <= 1e-6 * scale,
                "{what}: {} for {sum}",
                of(&together)
            );
        }
    }
}

/// One wheel that slides onto the girder's sag and begins to roll.
fn sliding(accuracy: f64) -> Scene {
    let mut scene = bogie(0.0, 1.5, Damper::Rail);
    scene.contacts.truncate(1);
    scene.contacts[0].offsets = vec![0.0];
    scene.accuracy = accuracy;
    let body = &mut scene.bodies[0];
    body.free = [true, true, false, false, false, false];
    body.motion = None;
    body.start[0] = 15.0;
    body.start_speed[0] = 10.0;
    let inertia = 0.5 * body.mass * 1.25 * 1.25;
    let wheel = &mut scene.wheels[0];
    wheel.normal.damping = 0.0;
    wheel.friction = Some(Friction {
        law: FrictionLaw::Step,
        coefficient: 0.2,
        slip: 0.1,
    });
    wheel.spin_inertia = Some(inertia);
    scene
}

#[test]
fn energy_of_a_sliding_wheel_on_a_rail_that_gives_closes_with_the_accuracy() {
    let mut last = f64::INFINITY;
    for accuracy in [1e-3, 1e-5, 1e-7, 1e-9] {
        let run = run(&sliding(accuracy), &[girder()]);
        let residual = run.audit.residual();
        let friction = run.audit.exchanged.friction;
        println!(
            "asked {accuracy:.0e}: residual {residual:.1e}, friction {friction:.6e}, {:?}",
            run.counts
        );
        let spin = run.history.column(Channel::SpinSpeed(0));
        let speed = run.history.column(Channel::Speed(0, BodyDof::X));
        let end = spin.len() - 1;
        assert!(
            (speed[end] + 1.25 * spin[end]).abs() < 0.1 * speed[end],
            "the wheel rolls at the end"
        );
        // A disc that begins to roll loses a third of its energy, here more or less by what the sag does to it.
        let started = 0.5 * WEIGHT / GRAVITY * 100.0;
        assert!(
            (friction / started - 1.0 / 3.0).abs() < 0.1,
            "{friction} of {started}"
        );
        assert!(residual < last, "asked {accuracy}: {residual} after {last}");
        last = residual;
    }
    assert!(last < 1e-7, "{last}");
}

/// Angular frequencies of evenly spaced samples of two superposed oscillations, lower first.
///
/// # Source
/// Prony's method: y(t + 2 h) + y(t - 2 h) = alpha (y(t + h) + y(t - h)) + beta y(t) with
/// alpha = 2 (c + d), beta = -2 - 4 c d, c and d the cosines of both frequencies times h; least squares.
fn frequencies(y: &[f64], h: f64) -> [f64; 2] {
    let (mut uu, mut uv, mut vv, mut ur, mut vr) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for w in y.windows(5) {
        let (u, v, r) = (w[1] + w[3], w[2], w[0] + w[4]);
        (uu, uv, vv) = (uu + u * u, uv + u * v, vv + v * v);
        (ur, vr) = (ur + u * r, vr + v * r);
    }
    let determinant = uu * vv - uv * uv;
    let (alpha, beta) = (
        (ur * vv - vr * uv) / determinant,
        (vr * uu - ur * uv) / determinant,
    );
    let (half, product) = (0.25 * alpha, -0.25 * (beta + 2.0));
    let root = (half * half - product).sqrt();
    [half + root, half - root].map(|cosine| cosine.acos() / h)
}

#[test]
fn body_on_a_girder_with_mass_swings_at_the_natural_frequencies_of_the_pair() {
    for (factor, stiffness) in [(10.0, 1e7), (100.0, 1e7), (100.0, 1e8)] {
        let mut scene = bogie(0.0, 4.0, Damper::Rail);
        scene.contacts.truncate(1);
        scene.contacts[0].offsets = vec![0.0];
        scene.wheels[0].normal.stiffness = stiffness;
        scene.wheels[0].normal.damping = 0.0;
        scene.wheels[0].normal.bilateral = true;
        let body = &mut scene.bodies[0];
        body.free = [false, true, false, false, false, false];
        body.motion = None;
        body.start[0] = 30.0;
        body.start_speed[1] = 0.5;
        scene.accuracy = 1e-9;
        // Analytic: at midspan both halves turn alike, the beam of 45 ft between them bends uniformly:
        // m y'' = -k (y - 30 r), 2 I r'' = -(4 EI/45) r + 30 k (y - 30 r).
        let (mass, turning) = (WEIGHT / GRAVITY, 2.0 * inertia(factor));
        let held = 4.0 * EI / 45.0;
        let (a, b) = (stiffness / mass, (held + 900.0 * stiffness) / turning);
        let coupling = (30.0 * stiffness).powi(2) / (mass * turning);
        let root = (0.25 * (a - b).powi(2) + coupling).sqrt();
        let wanted = [0.5 * (a + b) - root, 0.5 * (a + b) + root].map(f64::sqrt);
        scene.output_dt = 1.0 / wanted[1];
        let run = run(&scene, &[massive(factor)]);
        let rest = -WEIGHT * (1.0 / stiffness + 900.0 / held);
        let y = run.history.column(Channel::Displacement(0, BodyDof::Y));
        assert!(
            (y[0] / rest - 1.0).abs() < 1e-12,
            "it starts at rest: {} for {rest}",
            y[0]
        );
        let swing: Vec<f64> = y.iter().map(|y| y - rest).collect();
        let found = frequencies(&swing, scene.output_dt);
        println!(
            "inertia {factor}, k {stiffness:.0e}: {found:?} for {wanted:?}, {:?}",
            run.counts
        );
        for (found, wanted) in found.into_iter().zip(wanted) {
            assert!((found / wanted - 1.0).abs() < 1e-6, "{found} for {wanted}");
        }
    }
}
