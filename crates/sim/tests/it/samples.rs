//! Samples inside long steps.

#![allow(
    clippy::print_stdout,
    reason = "the figures measured belong beside the claims"
)]

use crate::common;

use std::ops::ControlFlow;

use common::{bogie, girder};
use sim::{Channel, Damper, Method, Run, run_by};

fn run(accuracy: f64) -> Run {
    let mut scene = bogie(20.0, 1.0, Damper::Rail);
    scene.accuracy = accuracy;
    run_by(Method::Sdirk4, &scene, &[girder()], &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene")
}

/// Independent: the same run in shorter steps. Penetrations inside a step are those of a rail that gives, not those of the
/// polynomial through its ends, which err by 7.6e-5 here.
#[test]
fn give_of_the_rail_inside_long_steps_errs_by_a_thirtieth_of_the_accuracy() {
    let accuracy = 1e-3;
    let (coarse, fine) = (run(accuracy), run(1e-8));
    let apart = |channel| {
        let (a, b) = (coarse.history.column(channel), fine.history.column(channel));
        let size = b.iter().fold(0.0_f64, |max, x| max.max(x.abs()));
        a.iter()
            .zip(&b)
            .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs()))
            / size
    };
    let [force, give] = [Channel::Vertical(0), Channel::Deflection(0)].map(apart);
    let (samples, steps) = (
        fine.history.column(Channel::Time).len(),
        coarse.counts.steps,
    );
    println!("{samples} samples in {steps} steps: force {force:.1e}, give {give:.1e}");
    assert!(
        2 * samples > 3 * steps && give < accuracy / 30.0 && force < 2.0 * accuracy,
        "{force} {give}"
    );
}
