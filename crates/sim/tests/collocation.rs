//! Collocation with exact modes against the diagonally implicit method.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;

use std::ops::ControlFlow;
use std::time::Instant;

use common::modes::{beam, oscillator};
use common::{bogie, girder};
use sim::{Channel, Damper, Error, Foundation, Method, Run, Scene, Status, run_by};

fn solved(method: Method, scene: &Scene, foundation: Foundation) -> Run {
    let begun = Instant::now();
    let run =
        run_by(method, scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
    println!(
        "{method:?}: {:?}, {} steps, {} rejected, {:.0?}, audit {:.1e}",
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
    a.iter().zip(&b).fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())) / size
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

#[test]
fn gauss_refuses_a_damper_between_wheel_and_rail() {
    let scene = bogie(20.0, 1.0, Damper::Rail);
    let found = run_by(Method::Gauss3, &scene, &[girder()], &mut |_| ControlFlow::Continue(()));
    assert!(matches!(found, Err(Error::Method { method: Method::Gauss3, .. })));
}
