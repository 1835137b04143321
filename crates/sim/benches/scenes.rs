//! The paper's bogie over its girder: time of a solve at the loosest setting that reaches an error.

#[path = "../tests/it/common/mod.rs"]
mod common;

use std::ops::ControlFlow;

use common::{bogie, reference, surface};
use divan::{Bencher, black_box};
use sim::{BodyDof, Channel, Damper, Foundation, Method, Run, Scene};

const SLOW: &str = include_str!("../../../fea/reference/bogie_s1.json");
const FAST: &str = include_str!("../../../fea/reference/bogie_s2.json");

/// Method and relative error of the deflection.
const CASES: [(Method, f64); 4] = [
    (Method::Sdirk4, 1e-3),
    (Method::Sdirk4, 1e-4),
    (Method::Radau, 1e-3),
    (Method::Radau, 1e-4),
];

fn main() {
    divan::main();
}

/// 5 ft/s over 60 ft, to a relative error of the deflection.
#[divan::bench(args = CASES)]
fn slow(bencher: Bencher<'_, '_>, case: (Method, f64)) {
    crossing(bencher, bogie(5.0, 12.0, Damper::Ground), SLOW, case);
}

/// 100 ft/s over 55 ft.
#[divan::bench(args = CASES)]
fn fast(bencher: Bencher<'_, '_>, case: (Method, f64)) {
    crossing(bencher, bogie(100.0, 0.55, Damper::Ground), FAST, case);
}

fn crossing(
    bencher: Bencher<'_, '_>,
    mut scene: Scene,
    text: &str,
    (method, error): (Method, f64),
) {
    let foundations = [Foundation::massless(Box::new(surface()), 1)];
    let wanted = reference(text);
    let peak = wanted.iter().fold(0.0_f64, |max, row| max.max(row[1]));
    scene.accuracy = 1e-1;
    while error_of(&solve(method, &scene, &foundations), &wanted) > error * peak {
        scene.accuracy *= 0.9;
    }
    scene.output_dt = scene.end;
    bencher.bench_local(|| solve(method, black_box(&scene), &foundations));
}

fn solve(method: Method, scene: &Scene, foundations: &[Foundation]) -> Run {
    sim::run_by(method, scene, foundations, &mut |_| {
        ControlFlow::Continue(())
    })
    .expect("a valid scene")
}

/// Largest error of the deflection.
fn error_of(run: &Run, wanted: &[[f64; 5]]) -> f64 {
    let y = run.history.column(Channel::Displacement(0, BodyDof::Y));
    wanted
        .iter()
        .zip(y)
        .fold(0.0, |max, (row, y)| max.max((y + row[1]).abs()))
}
