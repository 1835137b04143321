//! Orders of convergence and converged references through the whole chain.

use crate::common;
mod crossings;
mod rails;
mod sheared;

use std::ops::ControlFlow;

use common::bogie;
use fea::{BeamTheory, Girder};
use foundations::rigid_parts_foundation;
use sim::{Analysis, BodyDof, Channel, Damper, Foundation};

fn girder() -> Girder {
    Girder {
        spans: vec![60.0],
        overhangs: [15.0, 15.0],
        e: 4.32e9,
        i_vertical: 9.528,
        theory: BeamTheory::EulerBernoulli,
        stations: vec![0.0, 60.0],
        ..Girder::default()
    }
}

/// The paper's bogie at 150 places of a quasi-static crossing.
fn crossing(foundation: Foundation) -> Vec<f64> {
    let mut scene = bogie(5.0, 12.0, Damper::Rail);
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = 0.08;
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(()))
        .expect("the bogie stands");
    run.history.column(Channel::Displacement(0, BodyDof::Y))
}

#[test]
fn parts_converge_with_the_square_of_their_number() {
    let (model, rail) = girder().model_and_rail().expect("a girder on two supports");
    let exact = fea::surface(&model, &[rail]).expect("it stands");
    let wanted = crossing(Foundation::massless(Box::new(exact.surface), 1));
    let mut errors = Vec::new();
    for count in [6, 12, 24, 48, 96, 192] {
        let found =
            crossing(rigid_parts_foundation(&girder(), count, None).expect("parts of a girder"));
        errors.push(
            found
                .iter()
                .zip(&wanted)
                .fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())),
        );
    }
    // Least squares of log2(error) over log2(count).
    let n = errors.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / n;
    let x: Vec<f64> = (0..errors.len()).map(|i| i as f64).collect();
    let y: Vec<f64> = errors.iter().map(|error| error.log2()).collect();
    let (mx, my) = (mean(&x), mean(&y));
    let covariance: f64 = x.iter().zip(&y).map(|(x, y)| (x - mx) * (y - my)).sum();
    let order = -covariance / x.iter().map(|x| (x - mx) * (x - mx)).sum::<f64>();
    println!("errors {errors:?} ft, order {order:.2}");
    assert!(
        (order - 2.0).abs() < 0.15,
        "order {order}, errors {errors:?}"
    );
}
