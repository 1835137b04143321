//! Orders of convergence through the whole chain.

use std::ops::ControlFlow;

use fea::{Girder, Theory};
use girderway::link::parts_of;
use sim::{
    Analysis, Body, Channel, Contact, Damper, Foundation, Freedom, Given, NormalLaw, Profile, Scene, Wheel,
};

const WEIGHT: f64 = 4.8e6;
const GRAVITY: f64 = 32.174;

fn girder() -> Girder {
    Girder {
        spans: vec![60.0],
        overhangs: [15.0, 15.0],
        e: 4.32e9,
        i_vertical: 9.528,
        theory: Theory::EulerBernoulli,
        stations: vec![0.0, 60.0],
        ..Girder::default()
    }
}

/// The paper's bogie at 150 places of a quasi-static crossing.
fn crossing(foundation: Foundation) -> Vec<f64> {
    let mass = WEIGHT / GRAVITY;
    let scene = Scene {
        gravity: GRAVITY,
        bodies: vec![Body {
            mass,
            inertia: [0.0, 0.0, mass],
            cg: [0.0; 3],
            free: [false, true, false, false, false, true],
            start: [0.0; 6],
            start_speed: [0.0; 6],
            motion: Some(Profile::new(Given::Speed, &[[0.0, 5.0]], 0.0, 0.0).expect("a valid table")),
        }],
        wheels: vec![Wheel {
            radius: 1.25,
            normal: NormalLaw::linear(1e8, 0.0, Damper::Rail),
            flange: None,
            friction: None,
            spin_inertia: None,
        }],
        contacts: [-4.0 / 3.0, 4.0 / 3.0]
            .map(|offset| Contact {
                body: 0,
                structure: 0,
                rail: 0,
                at: [0.0; 3],
                offsets: vec![offset],
                wheel: 0,
            })
            .to_vec(),
        analysis: Analysis::QuasiStatic,
        end: 12.0,
        output_dt: 0.08,
        accuracy: 1e-6,
    };
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(()))
        .expect("a bogie on two wheels stands");
    run.history.column(Channel::Displacement(0, Freedom::Y))
}

#[test]
fn parts_converge_with_the_square_of_their_number() {
    let (model, rail) = girder().frame().expect("a girder on two supports");
    let exact = fea::surface(&model, &[rail]).expect("it stands");
    let wanted = crossing(Foundation::influence(Box::new(exact.surface), 1));
    let mut errors = Vec::new();
    for count in [6, 12, 24, 48, 96, 192] {
        let found = crossing(parts_of(&girder(), count, None).expect("parts of a girder"));
        errors.push(found.iter().zip(&wanted).fold(0.0_f64, |max, (a, b)| max.max((a - b).abs())));
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
    assert!((order - 2.0).abs() < 0.15, "order {order}, errors {errors:?}");
}
