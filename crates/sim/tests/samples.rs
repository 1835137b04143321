//! Samples inside long steps.

#![allow(clippy::print_stdout, reason = "the figures measured belong beside the claims")]

mod common;

use std::ops::ControlFlow;

use common::{bogie, girder};
use sim::{Channel, Damper, Method, Run, run_by};

fn run(accuracy: f64) -> Run {
    let mut scene = bogie(20.0, 1.0, Damper::Rail);
    scene.accuracy = accuracy;
    run_by(Method::Sdirk4, &scene, &[girder()], &mut |_| ControlFlow::Continue(())).expect("a valid scene")
}

/// Independent: the same run in steps a tenth as long. A spring of 1e8 between wheel and rail makes 1e-4 of a penetration
/// 1e4 of force; forces inside steps are those of the rail that gives.
#[test]
fn forces_inside_steps_err_as_little_as_the_places() {
    let (coarse, fine) = (run(1e-3), run(1e-8));
    let apart = |channel| {
        let (a, b) = (coarse.history.column(channel), fine.history.column(channel));
        let size = b.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        a.iter().zip(&b).fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())) / size
    };
    let [force, give] = [Channel::Vertical(0), Channel::Give(0)].map(apart);
    let (samples, steps) = (fine.history.column(Channel::Time).len(), coarse.counts.steps);
    println!("{samples} samples in {steps} steps: force {force:.1e}, give {give:.1e}");
    assert!(samples > steps && force < 2.0 * give && give < 2e-3, "{force} {give}");
}
