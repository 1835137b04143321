//! Time from a model to its influence grid.

use fea::{Girder, Theory, grid, surface};
use splines::{Axis, Probe};

fn main() {
    divan::main();
}

/// Sixty feet simply supported, two overhangs of fifteen.
fn girder() -> Girder {
    Girder {
        spans: vec![60.0],
        overhangs: [15.0; 2],
        e: 4.32e9,
        g: Some(1.661_538e9),
        area: Some(1.0),
        i_vertical: 9.528,
        i_lateral: Some(0.874_97),
        j: Some(0.6552),
        rail_height: 3.6615,
        theory: Theory::EulerBernoulli,
        ..Girder::default()
    }
}

fn probes(axis: Axis, count: usize) -> Vec<Probe> {
    let step = 90.0 / (count - 1) as f64;
    (0..count).map(|k| Probe { rail: 0, x: -15.0 + step * k as f64, axis }).collect()
}

#[divan::bench(args = [7, 61, 400])]
fn vertical_grid(bencher: divan::Bencher, loads: usize) {
    let (model, rail) = girder().frame().expect("the numbers are sound");
    let rails = [rail];
    let at = probes(Axis::Vertical, loads);
    bencher.bench(|| grid(&model, &rails, &at));
}

#[divan::bench]
fn paper_surface(bencher: divan::Bencher) {
    let (model, rail) = girder().frame().expect("the numbers are sound");
    let rails = [rail];
    bencher.bench(|| surface(&model, &rails));
}
