//! Tensor product of natural splines, as an exact surface of elements without flexibility.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::block::{InfluenceBlock, Pairs, common_stations};
use crate::curve::values_and_slopes;
use crate::error::Error;
use crate::rail::{Flexibility, IDENTITY, RailElement, Rails};
use crate::surface::ExactSurface;

/// The tensor spline W T W^T of tables T with the cardinal natural splines W.
///
/// Rail elements without flexibility between the stations have cubic Hermite shapes, and Green's function of
/// the clamped element vanishes. With B the matrix that takes values to the values and slopes of their
/// natural spline, the nodal compliance B T B^T therefore makes their exact surface the tensor spline. Every
/// direction is a rail of its own.
pub(super) fn tensor(pairs: &Pairs, blocks: &[InfluenceBlock]) -> Result<ExactSurface, Error> {
    let own = common_stations(pairs, blocks)?;
    let mut cells = Vec::new();
    let mut first = Vec::new();
    let mut states = 0;
    for (i, x) in own.iter().enumerate() {
        first.push(states);
        cells.extend(chain(i, states, x, Flexibility::default()));
        states += x.len();
    }
    let mut nodal = DMatrix::zeros(6 * states, 6 * states);
    for (i, row) in pairs.iter().enumerate() {
        for (j, index) in row.iter().enumerate() {
            let Some(index) = *index else { continue };
            let [left, right] = [i, j].map(|k| values_and_slopes(own[k], [false; 2]));
            let block = left * blocks[index].table.values() * right.transpose();
            let block = if i == j {
                0.5 * (&block + block.transpose())
            } else {
                block
            };
            scatter(&mut nodal, [first[i], first[j]], &block);
            if i != j {
                scatter(&mut nodal, [first[j], first[i]], &block.transpose());
            }
        }
    }
    ExactSurface::new(Arc::new(Rails::new(cells)?), nodal)
}

/// Elements from station to station, their node states numbered from `first`.
pub(super) fn chain(
    rail: usize,
    first: usize,
    x: &[f64],
    flexibility: Flexibility,
) -> Vec<RailElement> {
    let cell = |(k, pair): (usize, &[f64])| RailElement {
        rail,
        x: [pair[0], pair[1]],
        ends: [first + k, first + k + 1],
        length: pair[1] - pair[0],
        frame: IDENTITY,
        offset: [0.0; 3],
        flexibility,
        member: None,
    };
    x.windows(2).enumerate().map(cell).collect()
}

/// Copies a block whose rows and columns are (v, theta_z) of successive node states, the first of which are
/// `first`, to the degrees of freedom of these states.
pub(super) fn scatter(nodal: &mut DMatrix<f64>, first: [usize; 2], block: &DMatrix<f64>) {
    let dof =
        |first: usize, k: usize| 6 * (first + k / 2) + if k.is_multiple_of(2) { 1 } else { 5 };
    for i in 0..block.nrows() {
        for j in 0..block.ncols() {
            nodal[(dof(first[0], i), dof(first[1], j))] = block[(i, j)];
        }
    }
}
