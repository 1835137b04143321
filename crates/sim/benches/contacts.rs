//! Contact forces of n wheels of 1e8 lb/ft on the paper's girder: influence assembled and solved.

#[path = "../tests/it/common/mod.rs"]
mod common;
#[allow(dead_code, unused_imports)]
#[path = "../src/numerics/complementarity.rs"]
mod complementarity;
#[allow(dead_code, unused_imports)]
#[path = "../src/numerics/dense.rs"]
mod dense;

use common::{SPAN, surface};
use divan::{Bencher, black_box};
use nalgebra::{DMatrix, DVector};
use splines::{Axis, Compliance, Influence, Probe};

const STIFFNESS: f64 = 1e8;

fn main() {
    divan::main();
}

fn places(count: usize) -> Vec<Probe> {
    let at = |k: usize| SPAN * (k as f64 + 0.5) / count as f64;
    (0..count)
        .map(|k| Probe {
            rail: 0,
            x: at(k),
            axis: Axis::Vertical,
        })
        .collect()
}

/// Depths under which every wheel presses alike.
fn depths(give: &DMatrix<f64>) -> DVector<f64> {
    let forces = DVector::from_element(give.nrows(), 4.8e6 / give.nrows() as f64);
    give * &forces + forces / STIFFNESS
}

/// Assembly, Cholesky's factors and the forces, all wheels pressing.
#[divan::bench(consts = [2, 8, 32, 100], sample_size = 100)]
fn direct<const N: usize>(bencher: Bencher<'_, '_>) {
    let (rail, at) = (surface(), places(N));
    let mut influence = Influence::zeros(N);
    rail.fill(&at, &mut influence).expect("on the rail");
    let depth = depths(&influence.value);
    let (mut matrix, mut forces) = (DMatrix::zeros(N, N), depth.clone());
    bencher.bench_local(|| {
        let done = rail.fill(black_box(&at), &mut influence);
        matrix.copy_from(&influence.value);
        (0..N).for_each(|i| matrix[(i, i)] += 1.0 / STIFFNESS);
        let factors = std::mem::replace(&mut matrix, DMatrix::zeros(0, 0)).cholesky();
        if let Some(factors) = factors {
            forces.copy_from(&depth);
            factors.solve_mut(&mut forces);
            matrix = factors.unpack_dirty();
        }
        black_box(&forces);
        done
    });
}

/// The same with wheels that may lift off: the active set from all that press, as the simulator has it.
#[divan::bench(consts = [2, 8, 32, 100], sample_size = 100)]
fn active<const N: usize>(bencher: Bencher<'_, '_>) {
    let (rail, at) = (surface(), places(N));
    let mut influence = Influence::zeros(N);
    rail.fill(&at, &mut influence).expect("on the rail");
    let depth = depths(&influence.value);
    let mut matrix = influence.value.clone();
    let mut forces = vec![1.0; N];
    bencher.bench_local(|| {
        let done = rail.fill(black_box(&at), &mut influence);
        matrix.copy_from(&influence.value);
        (0..N).for_each(|i| matrix[(i, i)] += 1.0 / STIFFNESS);
        forces.fill(1.0);
        let sweeps =
            complementarity::complementarity(matrix.as_slice(), depth.as_slice(), &mut forces);
        black_box(&forces);
        (done, sweeps)
    });
}
