//! The exact surface of the uniform beam behind a table of values.

use std::sync::Arc;

use nalgebra::DMatrix;

use super::tensor::{chain, scatter};
use super::values::SplineTable;
use crate::curve::values_and_slopes;
use crate::error::Error;
use crate::rail::{Flexibility, Rails};
use crate::surface::ExactSurface;

/// Largest entry of a support's row, relative to the table's largest.
const ZERO: f64 = 1e-9;

/// Largest ratio of the errors of fit with clamped and with pinned ends at which the ends count as clamped.
const CLAMPED: f64 = 0.1;

/// Relative error of fit below which a beam explains a table completely.
const ROUNDING: f64 = 1e-9;

/// A uniform beam fitted to a table, with its exact surface.
#[derive(Clone, Debug)]
pub struct BeamFit {
    /// The exact surface: vertical compliance of the rail; nothing else moves.
    pub surface: ExactSurface,
    /// 1/EI that fits all entries best by least squares, 1/(force length^2).
    pub bending: f64,
    /// 1/EI from each column alone: station and value, for the stations at which the rail moves. Their
    /// scatter about `bending` shows the accuracy of the table's digits there, or that the beam is not
    /// uniform.
    pub local: Vec<(f64, f64)>,
    /// Whether the first and the last station are clamped: held in deflection and in slope.
    pub clamped: [bool; 2],
    /// Largest difference between the table and that of the fitted beam, relative to the table's largest
    /// entry.
    pub error: f64,
}

/// Fits a uniform Euler-Bernoulli beam to a table of vertical influence coefficients, and gives its exact
/// surface on `rail`.
///
/// The beam has rigid supports at the stations whose rows are zero (below 1e-9 of the largest entry). Its
/// ends are free, supported or clamped, and it may have any number of spans. If loads, supports and ends are
/// at stations, every column of the table is a cubic spline between them, without curvature at free or
/// supported ends and without slope at clamped ones. Slopes therefore follow from values by theta = D w, and
/// with B = \[I; D\] (values and slopes interleaved) the compliance of the node states at the stations is
///
/// C = B T B^T + C_pin,
///
/// where C_pin is the compliance of the rotations of the beam pinned at every station. 1/EI is that for which
/// the table of the beam fits T best, by least squares over all entries. The column of station j alone
/// determines it by the jump of the third derivative, w'''(x_j+) - w'''(x_j-) = 1/EI.
///
/// An end whose row is zero counts as clamped if the beam clamped there fits ten times better than the beam
/// supported there. Where a single station moves, both fit equally well and the end counts as supported.
///
/// Guarantee: a table with all its digits is reproduced without loss (5e-15 of the largest entry on the
/// paper's girder). A table of three digits keeps the error of its rounding (4.7e-3 there), which
/// [`BeamFit::error`] shows.
///
/// # Errors
/// Stations along z that differ from those along x; no zero row, or a single one that is not at a clamped
/// end; a table that no such beam can have.
///
/// ```
/// use nalgebra::DMatrix;
/// use splines::{SplineTable, fit_beam};
///
/// // A simply supported beam of length 4 with 1/EI = 1: G = a b (16 - a^2 - b^2)/24, a and b being the
/// // distances of the two places from the support on their own side.
/// let x: Vec<f64> = (0..5).map(f64::from).collect();
/// let exact = |z: f64, x: f64| {
///     let (a, b) = (z.min(x), 4.0 - z.max(x));
///     a * b * (16.0 - a * a - b * b) / 24.0
/// };
/// let values = DMatrix::from_fn(5, 5, |i, j| exact(x[i], x[j]));
/// let fit = fit_beam(0, &SplineTable::new(x.clone(), x, values)?)?;
/// assert!((fit.bending - 1.0).abs() < 1e-13 && fit.error < 1e-13);
/// assert_eq!(fit.clamped, [false, false]);
/// # Ok::<(), splines::Error>(())
/// ```
pub fn fit_beam(rail: usize, table: &SplineTable) -> Result<BeamFit, Error> {
    let x = table.x();
    if table.z() != x {
        return Err(Error::BlockStations { sheet: 0 });
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
        let Some(fit) = Fit::new(x, &values, &moving, clamped) else {
            continue;
        };
        if best
            .as_ref()
            .is_none_or(|best| fit.misfit < CLAMPED * best.misfit && best.misfit > ROUNDING)
        {
            best = Some(fit);
        }
    }
    let Fit {
        clamped,
        bending,
        misfit,
    } = best.ok_or(Error::NoBeamFit)?;
    let b = values_and_slopes(x, clamped);
    let turns = |i: &usize| !(*i == 0 && clamped[0] || *i == n - 1 && clamped[1]);
    let rotations: Vec<usize> = (0..n).filter(turns).map(|i| 2 * i + 1).collect();
    let pinned = stiffness(x)
        .select_rows(&rotations)
        .select_columns(&rotations)
        .cholesky();
    let pinned = bending * pinned.ok_or(Error::NoBeamFit)?.inverse();
    let mut compliance = &b * &values * b.transpose();
    for (i, &row) in rotations.iter().enumerate() {
        for (j, &column) in rotations.iter().enumerate() {
            compliance[(row, column)] += pinned[(i, j)];
        }
    }
    let mut nodal = DMatrix::zeros(6 * n, 6 * n);
    scatter(&mut nodal, [0, 0], &compliance);
    let flexibility = Flexibility {
        bending_z: bending,
        ..Flexibility::default()
    };
    let rails = Rails::new(chain(rail, 0, x, flexibility))?;
    let surface = ExactSurface::new(Arc::new(rails), nodal)?;
    let columns = &b * &values;
    let local = moving
        .iter()
        .map(|&j| (x[j], jump(x, columns.column(j).as_slice(), j)))
        .collect();
    Ok(BeamFit {
        surface,
        bending,
        local,
        clamped,
        error: misfit,
    })
}

/// A beam with given ends, and how well it fits.
struct Fit {
    clamped: [bool; 2],
    bending: f64,
    misfit: f64,
}

impl Fit {
    /// `None` where such a beam is unstable, or where EI would be negative.
    fn new(x: &[f64], values: &DMatrix<f64>, moving: &[usize], clamped: [bool; 2]) -> Option<Fit> {
        let fixed = x.len() - moving.len() + clamped.iter().filter(|&&end| end).count();
        if fixed < 2 {
            return None;
        }
        let b = values_and_slopes(x, clamped);
        let reduced = (b.transpose() * stiffness(x) * &b)
            .select_rows(moving)
            .select_columns(moving);
        let given = values.select_rows(moving).select_columns(moving);
        let unit = reduced.cholesky()?.inverse();
        let bending = given.dot(&unit) / unit.dot(&unit);
        let misfit = (&given - bending * &unit).amax() / given.amax();
        (bending > 0.0 && bending.is_finite()).then_some(Fit {
            clamped,
            bending,
            misfit,
        })
    }
}

/// Jump of the third derivative of a spline at station j, by its interleaved values and slopes. Beyond the
/// ends of the beam the derivative is zero.
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

/// Stiffness matrix of (w, theta), interleaved, at the stations of a beam with EI = 1.
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
