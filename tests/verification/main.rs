//! Orders of convergence and converged references through the whole chain.

#[path = "../../crates/sim/tests/common/mod.rs"]
mod common;

use std::ops::ControlFlow;

use common::bogie;
use fea::{Girder, Theory};
use girderway::link::{full_of, parts_of, solve};
use girderway::source::Source;
use girderway::spec::Spec;
use sim::{Analysis, Channel, Damper, Foundation, Freedom, Gauge, Status};
use splines::{Axis, Probe};

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
    let mut scene = bogie(5.0, 12.0, Damper::Rail);
    scene.analysis = Analysis::QuasiStatic;
    scene.output_dt = 0.08;
    let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("the bogie stands");
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

/// External: finite elements with Newmark steps, converged: the bogie over the girder with 15.2 slug/ft, dampers on
/// the rate of the gap. Peaks of the bogie and of midspan at 5 and at 100 ft/s.
#[test]
fn bogie_over_the_girder_with_mass_meets_the_reference() {
    let text = r#"{"format": "girderway-beam/1", "name": "bridge", "units": {"length": "ft", "force": "lbf", "time": "s"},
        "theory": "euler-bernoulli",
        "girder": {"spans": [60], "overhangs": [15, 15], "E": 4.32e9, "I_vertical": 9.528, "mass_per_length": 15.2},
        "stations": [-15, 0, 30, 60, 75]}"#;
    let source = Source { name: "spec.json".to_owned(), text: text.to_owned() };
    let spec = Spec::read(&source, None).expect("a girder");
    let solved = solve(&spec).expect("it stands");
    for (speed, end, peak, middle) in [(5.0, 12.0, 0.547_17, 0.5247), (100.0, 0.55, 0.912_60, 1.0777)] {
        let mut scene = bogie(speed, end, Damper::Rail);
        scene.output_dt = end / 1000.0;
        scene.accuracy = 1e-5;
        let probe = Probe { rail: 0, x: 30.0, axis: Axis::Vertical };
        scene.gauges = vec![Gauge { structure: 0, probe }];
        let foundation = full_of(&solved, 8).expect("it has mass");
        let run = sim::run(&scene, &[foundation], &mut |_| ControlFlow::Continue(())).expect("a valid scene");
        assert_eq!(run.status, Status::Done);
        let largest = |channel| run.history.column(channel).iter().fold(0.0_f64, |max, y| max.max(-y));
        let found = [largest(Channel::Displacement(0, Freedom::Y)), largest(Channel::Gauge(0))];
        println!("{speed} ft/s: {found:?}, energy to {:.1e}", run.audit.residual());
        assert!((found[0] - peak).abs() < 1e-5 && (found[1] - middle).abs() < 1e-4, "{found:?}");
        assert!(run.audit.residual() < 1e-6);
    }
}
