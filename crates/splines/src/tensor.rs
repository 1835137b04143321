//! Natural splines along both directions, as a surface of cells that resist nothing of their own.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::cubic::interleaved;
use crate::sheet::{Pairs, Sheet, square};
use crate::{Cell, Error, Flexibility, Line, Surface};

/// Cells without flexibility between stations have Hermite shapes and no kernel of their own; with the
/// values and slopes of natural splines at their ends they make the tensor spline. Every direction is a rail
/// of its own.
pub(crate) fn tensor(pairs: &Pairs, sheets: &[Sheet]) -> Result<Surface, Error> {
    let own = square(pairs, sheets)?;
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
            let [left, right] = [i, j].map(|k| interleaved(own[k], [false; 2]));
            let block = left * sheets[index].table.values() * right.transpose();
            let block = if i == j { 0.5 * (&block + block.transpose()) } else { block };
            scatter(&mut nodal, [first[i], first[j]], &block);
            if i != j {
                scatter(&mut nodal, [first[j], first[i]], &block.transpose());
            }
        }
    }
    Surface::new(Arc::new(Line::new(cells)?), nodal)
}

/// Cells from station to station, their states numbered from `first`.
pub(crate) fn chain(rail: usize, first: usize, x: &[f64], flexibility: Flexibility) -> Vec<Cell> {
    let cell = |(k, pair): (usize, &[f64])| Cell {
        rail,
        x: [pair[0], pair[1]],
        ends: [first + k, first + k + 1],
        length: pair[1] - pair[0],
        frame: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        offset: [0.0; 3],
        flexibility,
        carrier: None,
    };
    x.windows(2).enumerate().map(cell).collect()
}

/// Puts a block over interleaved (v, theta z) into the freedoms of states.
pub(crate) fn scatter(nodal: &mut DMatrix<f64>, first: [usize; 2], block: &DMatrix<f64>) {
    let freedom = |first: usize, k: usize| 6 * (first + k / 2) + if k.is_multiple_of(2) { 1 } else { 5 };
    for i in 0..block.nrows() {
        for j in 0..block.ncols() {
            nodal[(freedom(first[0], i), freedom(first[1], j))] = block[(i, j)];
        }
    }
}
