//! A table of values alone, raised to the exact surface.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::cubic::interleaved;
use crate::tensor::{chain, scatter};
use crate::{Error, Flexibility, Line, Surface, Table};

/// A row that small beside the table's largest entry is a support's.
const ZERO: f64 = 1e-12;

/// An exact surface found behind a table.
#[derive(Clone, Debug)]
pub struct Lift {
    /// Vertical give of the rail; nothing else moves.
    pub surface: Surface,
    /// 1/EI, per force length^2.
    pub bending: f64,
    /// Largest difference between the table and the beam of that bending, of the table's largest entry.
    pub misfit: f64,
}

/// Raises a vertical table of a uniform Euler-Bernoulli beam to the exact surface of `rail`.
///
/// The beam lies on knife edges at those stations whose rows are zero (below 1e-12 of the largest entry), at least two of them; its ends are
/// free or supported. Between stations every column is then a natural cubic spline, so slopes follow from
/// values by theta = D w; with B = \[I; D\] interleaved, the compliance of the stations is
///
/// C = B T B^T + C_pin,
///
/// C_pin that of the beam pinned at every station. 1/EI makes the beam's own table fit T best, by least
/// squares over all entries. A table with all digits is raised without loss; one with three digits keeps the
/// error of its rounding, which `misfit` shows.
///
/// # Errors
/// Stations along z that differ from those along x; fewer than two zero rows; or a table that no such beam
/// can have.
pub fn lift(rail: usize, table: &Table) -> Result<Lift, Error> {
    let x = table.x();
    if table.z() != x {
        return Err(Error::SheetStations { sheet: 0 });
    }
    let n = x.len();
    let values = 0.5 * (table.values() + table.values().transpose());
    let zero = ZERO * values.amax();
    let moving: Vec<usize> = (0..n).filter(|&i| values.row(i).amax() > zero).collect();
    let b = interleaved(x);
    let stiffness = stiffness(x);
    let held = (b.transpose() * &stiffness * &b).select_rows(&moving).select_columns(&moving);
    let given = values.select_rows(&moving).select_columns(&moving);
    let unit = match held.cholesky() {
        Some(factor) if n - moving.len() >= 2 => factor.inverse(),
        _ => return Err(Error::Unliftable),
    };
    let bending = given.dot(&unit) / unit.dot(&unit);
    if !(bending > 0.0 && bending.is_finite()) {
        return Err(Error::Unliftable);
    }
    let misfit = (&given - bending * &unit).amax() / given.amax();
    let rotations: Vec<usize> = (0..n).map(|i| 2 * i + 1).collect();
    let pinned = stiffness.select_rows(&rotations).select_columns(&rotations).cholesky();
    let pinned = bending * pinned.ok_or(Error::Unliftable)?.inverse();
    let mut compliance = &b * &values * b.transpose();
    for i in 0..n {
        for j in 0..n {
            compliance[(2 * i + 1, 2 * j + 1)] += pinned[(i, j)];
        }
    }
    let mut nodal = DMatrix::zeros(6 * n, 6 * n);
    scatter(&mut nodal, [0, 0], &compliance);
    let flexibility = Flexibility { bending_z: bending, ..Flexibility::default() };
    let line = Line::new(chain(rail, 0, x, flexibility))?;
    Ok(Lift { surface: Surface::new(Arc::new(line), nodal)?, bending, misfit })
}

/// Stiffness of (w, theta) at the stations of a beam with EI = 1.
fn stiffness(x: &[f64]) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(2 * x.len(), 2 * x.len());
    for (e, pair) in x.windows(2).enumerate() {
        let h = pair[1] - pair[0];
        let (a, b) = (12.0 / (h * h * h), 6.0 / (h * h));
        let (c, d) = (4.0 / h, 2.0 / h);
        let block = [[a, b, -a, b], [b, c, -b, d], [-a, -b, a, -b], [b, d, -b, c]];
        for (i, row) in block.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                out[(2 * e + i, 2 * e + j)] += entry;
            }
        }
    }
    out
}
