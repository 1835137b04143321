//! Collocation with exact modes against the diagonally implicit method.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::time::Instant;

use common::modes::{self, beam, oscillator};
use common::{bogie, girder};
use sim::{Channel, Damper, Error, Foundation, Method, Run, Scene, Status, Stepping, run_by};

fn solved(stepping: impl Into<Stepping>, scene: &Scene, foundation: Foundation) -> Run {
    let (begun, stepping) = (Instant::now(), stepping.into());
    let run = run_by(stepping, scene, &[foundation], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene");
    println!(
        "{stepping:?}: {:?}, {} steps, {} rejected, {:.0?}, audit {:.1e}",
        run.status,
        run.counts.steps,
        run.counts.rejected,
        begun.elapsed(),
        run.audit.residual()
    );
    assert_eq!(run.status, Status::Done);
    run
}

/// Largest difference of a column, by its largest entry.
fn apart(a: &Run, b: &Run, channel: Channel) -> f64 {
    let (a, b) = (a.history.column(channel), b.history.column(channel));
    let size = b.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
    a.iter()
        .zip(&b)
        .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()))
        / size
}

/// Independent: the same scene by SDIRK4 at accuracy 1e-9.
#[test]
fn radau_meets_sdirk_on_rigid_and_influence_rails_with_both_dampers() {
    for damper in [Damper::Rail, Damper::Ground] {
        for foundation in [girder, Foundation::rigid] {
            let mut scene = bogie(20.0, 1.0, damper);
            scene.accuracy = 1e-9;
            let reference = solved(Method::Sdirk4, &scene, foundation());
            scene.accuracy = 1e-5;
            let found = solved(Method::Radau, &scene, foundation());
            let off = apart(&found, &reference, Channel::Vertical(0));
            println!("{damper:?}: {off:.1e}");
            assert!(off < 1e-4, "{damper:?}: {off}");
        }
    }
}

/// Independent: SDIRK4 at a tighter accuracy. With so many wheels on so few degrees of freedom collocation eliminates the
/// forces node by node; from 64 on in blocks.
#[test]
fn radau_meets_sdirk_with_many_wheels() {
    for (count, damping) in [(20, 2e5), (20, 0.0), (70, 2e5)] {
        let mut scene = bogie(20.0, 0.3, Damper::Ground);
        let share = f64::from(count);
        scene.bodies[0].start[0] = 25.0;
        (
            scene.wheels[0].normal.stiffness,
            scene.wheels[0].normal.damping,
        ) = (2e8 / share, damping / share);
        let pattern = scene.contacts[0].clone();
        scene.contacts = (0..count)
            .map(|i| {
                let mut contact = pattern.clone();
                contact.offsets = vec![20.0 * ((f64::from(i) + 0.5) / share - 0.5)];
                contact
            })
            .collect();
        scene.accuracy = 1e-8;
        let reference = solved(Method::Sdirk4, &scene, girder());
        scene.accuracy = 1e-5;
        let found = solved(Method::Radau, &scene, girder());
        for wheel in [0, count as usize / 2] {
            let off = apart(&found, &reference, Channel::Vertical(wheel));
            println!("{count} wheels, damping {damping}: {off:.1e}");
            assert!(off < 1e-4, "{count} wheels: {off}");
        }
    }
}

/// Independent: SDIRK4 at a tighter accuracy; a beam of many modes.
#[test]
fn radau_meets_sdirk_on_modes() {
    let mut scene = oscillator(0.5, 0.5, 0.25);
    scene.accuracy = 1e-8;
    let reference = solved(Method::Sdirk4, &scene, beam(20, true));
    scene.accuracy = 1e-6;
    solved(Method::Sdirk4, &scene, beam(20, true));
    let found = solved(Method::Radau, &scene, beam(20, true));
    let off = apart(&found, &reference, Channel::Vertical(0));
    println!("{off:.1e}");
    assert!(off < 1e-4, "{off}");
}

/// Independent: short fixed steps, at the end of one of which every sample lies. The steps compared are a thousand periods of
/// the highest mode long: a polynomial through their ends errs by 6e-2 here.
#[test]
fn samples_inside_a_step_have_the_modes_where_they_are() {
    let mut scene = oscillator(1.0, 1.0, 0.01);
    scene.output_dt = scene.end / 1000.0;
    let fine = Stepping {
        method: Method::Radau,
        step: Some(scene.output_dt / 2.0),
    };
    let reference = solved(fine, &scene, beam(120, false));
    scene.accuracy = 1e-3;
    let found = solved(Method::Radau, &scene, beam(120, false));
    let periods = modes::omega(120) / (2.0 * PI) * scene.end / found.counts.steps as f64;
    let off = apart(&found, &reference, Channel::Vertical(0));
    println!("{periods:.1} periods of the highest mode a step: {off:.1e}");
    assert!(periods > 1000.0 && off < 1e-3, "{periods} {off}");
}

#[test]
fn gauss_refuses_a_damper_between_wheel_and_rail() {
    let scene = bogie(20.0, 1.0, Damper::Rail);
    let found = run_by(Method::Gauss3, &scene, &[girder()], &mut |_| {
        ControlFlow::Continue(())
    });
    assert!(matches!(
        found,
        Err(Error::Method {
            method: Method::Gauss3,
            ..
        })
    ));
}
