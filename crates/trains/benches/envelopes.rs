//! Cost of envelopes: time and memory of whole calculations, structure included.

use fea::{BeamTheory, Girder};
use trains::{DeadLoads, Request, Structure, Train, TrainCase, TrainWheel, envelopes};

#[global_allocator]
static ALLOCATIONS: divan::AllocProfiler = divan::AllocProfiler::system();

fn main() {
    divan::main();
}

fn girder(spans: usize) -> Girder {
    Girder {
        spans: vec![7.5; spans],
        e: 2.1e8,
        g: Some(8.1e7),
        area: Some(0.02),
        i_vertical: 5.8e-4,
        i_lateral: Some(1e-4),
        j: Some(4e-6),
        ka_vertical: Some(0.005),
        ka_lateral: Some(0.012),
        theory: BeamTheory::Timoshenko,
        ..Girder::default()
    }
}

fn train(wheels: usize) -> Train {
    let wheel = |k: usize| TrainWheel {
        rail: 0,
        x: 1.2 * k as f64,
        vertical: 150.0,
        lateral: 0.0,
        longitudinal: 0.0,
        eccentricity: 0.0,
    };
    Train {
        wheels: (0..wheels).map(wheel).collect(),
        ends: [0.5; 2],
        turned: true,
        reverses: true,
        enters: false,
    }
}

/// Envelopes at twentieths of all spans, extremes, and all reactions.
fn calculate(spans: usize, wheels: usize, trains: usize) -> usize {
    let girder = girder(spans);
    let (model, rail) = girder.model_and_rail().expect("the girder is valid");
    let structure = Structure::new(&model, &[rail], false).expect("the girder is stable");
    let holds = structure.frame().restraints(&model);
    let effects = holds
        .into_iter()
        .map(|hold| vec![fea::Effect::Reaction(hold)])
        .collect();
    let ends: Vec<f64> = (0..=spans).map(|k| 7.5 * k as f64).collect();
    let places = (0..=20 * spans).map(|k| 7.5 * k as f64 / 20.0).collect();
    let request = Request {
        spans: vec![ends],
        places: vec![places],
        effects,
        ..Request::default()
    };
    let trains = (0..trains).map(|_| train(wheels)).collect();
    let case = TrainCase {
        trains,
        gap: 0.5,
        ..TrainCase::default()
    };
    let found =
        envelopes(&structure, &DeadLoads::default(), &[case], &request).expect("the train fits");
    found[0].extremes.len()
}

#[divan::bench]
fn three_spans_two_wheels() -> usize {
    calculate(3, 2, 1)
}

#[divan::bench]
fn ten_spans_sixteen_wheels() -> usize {
    calculate(10, 16, 1)
}

#[divan::bench(sample_count = 5)]
fn three_spans_two_trains_of_two_wheels() -> usize {
    calculate(3, 2, 2)
}

#[divan::bench(sample_count = 3)]
fn ten_spans_two_trains_of_eight_wheels() -> usize {
    calculate(10, 8, 2)
}
