//! The two influence tables of McConville's paper on shape functions in ADAMS: ft/lb, stations in ft from the
//! left support, row = deflection (z), column = load (x).
//!
//! Where the digits come from: they were not copied from the page but computed, by the rule that is known to
//! reproduce all its entries to the last digit, three digits truncated:
//! - vertical: Euler-Bernoulli girder, 60 ft, EI = 9.528 x 4.32e9 lb ft^2; (15, 15) and (45, 45), 6.1496e-8,
//!   stand in print as 6.15e-8;
//! - lateral: bending with 1/EI = 2.6456e-10 /(lb ft^2) plus twist h^2/GJ = 1.2315e-8 /lb, held at both
//!   supports.
//!
//! So agreement of these digits with the girder says nothing about the print. The vertical ones are confirmed
//! by an independent AKISPL of the printed table (`readings.rs`); the lateral ones have no such witness here.
#![allow(dead_code)]

use nalgebra::DMatrix;
use splines::SplineTable;

pub const STATIONS: [f64; 7] = [-15.0, 0.0, 15.0, 30.0, 45.0, 60.0, 75.0];

pub const VERTICAL: [[f64; 7]; 7] = [
    [1.36e-7, 0.0, -7.17e-8, -8.19e-8, -5.12e-8, 0.0, 5.46e-8],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-7.17e-8, 0.0, 6.15e-8, 7.51e-8, 4.78e-8, 0.0, -5.12e-8],
    [-8.19e-8, 0.0, 7.51e-8, 1.09e-7, 7.51e-8, 0.0, -8.19e-8],
    [-5.12e-8, 0.0, 4.78e-8, 7.51e-8, 6.15e-8, 0.0, -7.17e-8],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [5.46e-8, 0.0, -5.12e-8, -8.19e-8, -7.17e-8, 0.0, 1.36e-7],
];

pub const LATERAL: [[f64; 7]; 7] = [
    [1.67e-6, 0.0, -7.81e-7, -8.92e-7, -5.58e-7, 0.0, 5.95e-7],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [-7.81e-7, 0.0, 8.08e-7, 9.10e-7, 5.67e-7, 0.0, -5.58e-7],
    [-8.92e-7, 0.0, 9.10e-7, 1.37e-6, 9.10e-7, 0.0, -8.92e-7],
    [-5.58e-7, 0.0, 5.67e-7, 9.10e-7, 8.08e-7, 0.0, -7.81e-7],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [5.95e-7, 0.0, -5.58e-7, -8.92e-7, -7.81e-7, 0.0, 1.67e-6],
];

pub fn table(rows: &[[f64; 7]; 7]) -> SplineTable {
    let values = DMatrix::from_fn(7, 7, |i, j| rows[i][j]);
    SplineTable::new(STATIONS.to_vec(), STATIONS.to_vec(), values).expect("stations increase")
}
