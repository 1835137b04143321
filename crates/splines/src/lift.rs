//! A table of values alone, raised to the exact surface.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::cubic::interleaved;
use crate::tensor::{chain, scatter};
use crate::{Error, Flexibility, Line, Surface, Table};

/// A row that small beside the table's largest entry is a support's.
const ZERO: f64 = 1e-9;

/// A clamped end must fit that much better than a pinned one: by ten times, and by more than rounding.
const BETTER: f64 = 0.1;
const ROUNDING: f64 = 1e-9;

/// An exact surface found behind a table.
#[derive(Clone, Debug)]
pub struct Lift {
    /// Vertical give of the rail; nothing else moves.
    pub surface: Surface,
    /// 1/EI, per force length^2, that fits all entries best.
    pub bending: f64,
    /// 1/EI by each station's own column, where the rail moves: station and value. How far they scatter about
    /// `bending` shows what the table's digits are worth there, or that the beam is not uniform.
    pub local: Vec<(f64, f64)>,
    /// Whether the first and the last station are clamped: held in deflection and in slope.
    pub clamped: [bool; 2],
    /// Largest difference between the table and the beam of that bending, of the table's largest entry.
    pub misfit: f64,
}

/// Raises a vertical table of a uniform Euler-Bernoulli beam to the exact surface of `rail`.
///
/// The beam lies on knife edges at those stations whose rows are zero (below 1e-9 of the largest entry); its
/// ends are free, supported or clamped, and any number of spans lies between. Between stations every column is
/// then a cubic spline, without curvature at its ends or without slope where clamped, so slopes follow from values
/// by theta = D w; with B = \[I; D\] interleaved, the compliance of the stations is
///
/// C = B T B^T + C_pin,
///
/// C_pin that of the beam pinned at every station. A table with all digits is raised without loss; one with
/// three digits keeps the error of its rounding, which `misfit` shows: on the paper's girder 5e-15 of the largest
/// entry, and 4.7e-3 from the printed digits.
///
/// 1/EI makes the beam's own table fit T best, by least squares over all entries. Alone, the column of station j
/// says it by the jump of its third derivative there, w'''(x_j+) - w'''(x_j-) = 1/EI.
///
/// An end whose row is zero counts as clamped if the beam clamped there fits ten times better than the beam
/// supported there; with one moving station in all both fit, and it counts as supported.
///
/// # Errors
/// Stations along z that differ from those along x; no zero row, or one alone inside; or a table that no such
/// beam can have.
pub fn lift(rail: usize, table: &Table) -> Result<Lift, Error> {
    let x = table.x();
    if table.z() != x {
        return Err(Error::SheetStations { sheet: 0 });
    }
    let n = x.len();
    let values = 0.5 * (table.values() + table.values().transpose());
    let zero = ZERO * values.amax();
    let moving: Vec<usize> = (0..n).filter(|&i| values.row(i).amax() > zero).collect();
    let ends = [!moving.contains(&0), !moving.contains(&(n - 1))];
    let mut best: Option<Fit> = None;
    for clamped in [[false; 2], [true, false], [false, true], [true; 2]] {
        if (clamped[0] && !ends[0]) || (clamped[1] && !ends[1]) {
            continue;
        }
        let Some(fit) = Fit::new(x, &values, &moving, clamped) else { continue };
        if best.as_ref().is_none_or(|best| fit.misfit < BETTER * best.misfit && best.misfit > ROUNDING) {
            best = Some(fit);
        }
    }
    let Fit { clamped, bending, misfit } = best.ok_or(Error::Unliftable)?;
    let b = interleaved(x, clamped);
    let turning: Vec<usize> =
        (0..n).filter(|&i| !(i == 0 && clamped[0] || i == n - 1 && clamped[1])).collect();
    let rotations: Vec<usize> = turning.iter().map(|&i| 2 * i + 1).collect();
    let pinned = stiffness(x).select_rows(&rotations).select_columns(&rotations).cholesky();
    let pinned = bending * pinned.ok_or(Error::Unliftable)?.inverse();
    let mut compliance = &b * &values * b.transpose();
    for (i, &row) in rotations.iter().enumerate() {
        for (j, &column) in rotations.iter().enumerate() {
            compliance[(row, column)] += pinned[(i, j)];
        }
    }
    let mut nodal = DMatrix::zeros(6 * n, 6 * n);
    scatter(&mut nodal, [0, 0], &compliance);
    let flexibility = Flexibility { bending_z: bending, ..Flexibility::default() };
    let line = Line::new(chain(rail, 0, x, flexibility))?;
    let surface = Surface::new(Arc::new(line), nodal)?;
    let columns = &b * &values;
    let local = moving.iter().map(|&j| (x[j], jump(x, columns.column(j).as_slice(), j))).collect();
    Ok(Lift { surface, bending, local, clamped, misfit })
}

/// A beam of one kind of ends, and how well it fits.
struct Fit {
    clamped: [bool; 2],
    bending: f64,
    misfit: f64,
}

impl Fit {
    /// `None` where such a beam does not stand, or would need a negative EI.
    fn new(x: &[f64], values: &DMatrix<f64>, moving: &[usize], clamped: [bool; 2]) -> Option<Fit> {
        let fixed = x.len() - moving.len() + clamped.iter().filter(|&&end| end).count();
        if fixed < 2 {
            return None;
        }
        let b = interleaved(x, clamped);
        let held = (b.transpose() * stiffness(x) * &b).select_rows(moving).select_columns(moving);
        let given = values.select_rows(moving).select_columns(moving);
        let unit = held.cholesky()?.inverse();
        let bending = given.dot(&unit) / unit.dot(&unit);
        let misfit = (&given - bending * &unit).amax() / given.amax();
        (bending > 0.0 && bending.is_finite()).then_some(Fit { clamped, bending, misfit })
    }
}

/// Jump of the third derivative of a spline at station j, by its interleaved values and slopes; beyond the ends
/// there is nothing to bend.
fn jump(x: &[f64], column: &[f64], j: usize) -> f64 {
    let third = |k: usize| {
        let h = x[k + 1] - x[k];
        let [y0, t0, y1, t1] = std::array::from_fn(|i| column[2 * k + i]);
        6.0 * (t0 + t1 - 2.0 * (y1 - y0) / h) / (h * h)
    };
    let after = if j + 1 < x.len() { third(j) } else { 0.0 };
    let before = if j > 0 { third(j - 1) } else { 0.0 };
    after - before
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
