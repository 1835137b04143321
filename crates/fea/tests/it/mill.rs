//! A real crane girder in the general form, against grids of independent codes (external).

use crate::common;

use common::{mill, probes};
use fea::{BeamTheory, grid, surface};
use nalgebra::DMatrix;
use serde_json::Value;
use splines::{Axis, Compliance, Influence, Probe};

const EULER: &str = include_str!("data/mill_girderway.eb.expected.json");
const TIMOSHENKO: &str = include_str!("data/mill_girderway.timoshenko.expected.json");

fn block(value: &DMatrix<f64>, row: usize, column: usize) -> DMatrix<f64> {
    let n = value.nrows() / 3;
    value.view((row * n, column * n), (n, n)).into_owned()
}

/// Largest difference from the expected grids, relative to sqrt(Gii Gjj).
fn worst(theory: BeamTheory, expected: &str) -> f64 {
    let (model, rail) = mill(theory);
    let at: Vec<Probe> = Axis::ALL
        .iter()
        .flat_map(|&axis| probes(axis, &rail.stations))
        .collect();
    let value = grid(&model, &[rail], &at).expect("solvable").value;
    let expected: Value = serde_json::from_str(expected).expect("valid");
    let names = [
        ("longitudinal", 0, 0),
        ("vertical", 1, 1),
        ("lateral", 2, 2),
        ("vertical_lateral", 1, 2),
        ("vertical_longitudinal", 1, 0),
        ("lateral_longitudinal", 2, 0),
    ];
    let mut worst = 0.0_f64;
    for (name, row, column) in names {
        let found = block(&value, row, column);
        let (rows, columns) = (block(&value, row, row), block(&value, column, column));
        let mut part = 0.0_f64;
        for i in 0..found.nrows() {
            for j in 0..found.ncols() {
                let entry = expected["influence"][name][i][j]
                    .as_f64()
                    .expect("a number");
                let scale = (rows[(i, i)] * columns[(j, j)]).sqrt();
                part = part.max((found[(i, j)] - entry).abs() / scale);
            }
        }
        worst = worst.max(part);
    }
    worst
}

#[test]
fn euler_bernoulli_grids_agree_with_independent_codes() {
    assert!(worst(BeamTheory::EulerBernoulli, EULER) < 2e-7);
}

#[test]
fn timoshenko_grids_agree_with_independent_codes() {
    assert!(worst(BeamTheory::Timoshenko, TIMOSHENKO) < 2e-7);
}

#[test]
fn surface_and_grid_are_the_same_function() {
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let rails = [rail];
    let exact = surface(&model, &rails).expect("solvable");
    // Places inside members, at their ends, and in the gaps over columns.
    let places = [
        0.75, 3.3, 39.25, 39.7, 40.0, 40.4, 41.0, 169.5, 170.0, 170.5, 171.0, 324.25,
    ];
    let at: Vec<Probe> = Axis::ALL
        .iter()
        .flat_map(|&axis| probes(axis, &places))
        .collect();
    let value = grid(&model, &rails, &at).expect("solvable").value;
    let mut out = Influence::zeros(at.len());
    exact.surface.fill(&at, &mut out).expect("on the rail");
    for i in 0..at.len() {
        for j in 0..at.len() {
            let scale = (value[(i, i)] * value[(j, j)]).sqrt();
            let error = (value[(i, j)] - out.value[(i, j)]).abs() / scale;
            assert!(error < 1e-10, "{:?} {:?}: {error:.1e}", at[i], at[j]);
        }
    }
}

#[test]
fn certificate_of_a_real_structure_leaves_seven_digits() {
    let (model, rail) = mill(BeamTheory::Timoshenko);
    let certificate = surface(&model, &[rail]).expect("solvable").certificate;
    assert!(certificate.error_bound < 1e-7, "{certificate:?}");
}
