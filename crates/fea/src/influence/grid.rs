//! Influence coefficients between chosen places of the rails.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{DMatrix, Matrix3};
use splines::{Compliance, ExactSurface, Influence, Probe, RailElement, Rails};

use crate::assembly::{Matrix12, diagonal_blocks};
use crate::error::{EntryAttribute, Error};
use crate::factor::{Certificate, ForwardSolution, allow_square, dot_products};
use crate::influence::frame::FactoredFrame;
use crate::model::{Model, Rail};

/// Influence coefficients of a list of probes, with their certificate.
///
/// # Example
/// ```
/// use fea::{Girder, grid};
/// use splines::{Axis, Probe};
///
/// let girder = Girder { spans: vec![60.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let at = [15.0, 30.0].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
/// let grid = grid(&model, &[rail], &at)?;
/// assert_eq!(grid.value[(0, 1)], grid.value[(1, 0)]);
/// let midspan = 60.0_f64.powi(3) / (48.0 * 4.32e9 * 9.528);
/// assert!((grid.value[(1, 1)] / midspan - 1.0).abs() < grid.certificate.error_bound);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct InfluenceGrid {
    /// n x n for n probes; `value[(i, j)]` is the displacement at probe i along its axis per unit force at
    /// probe j along its axis, length/force.
    pub value: DMatrix<f64>,
    /// Bound of the error of the coefficients.
    pub certificate: Certificate,
}

/// Influence coefficients of the probes `at`, in any directions, on any of the rails.
///
/// G_ij = w_i . w_j + \[same member\] b(x_i, x_j), w = L^-1 N(x)^T, with the Cholesky factor L of the
/// stiffness and the Green's function b of the member between fixed ends. No nodes are needed at the probes.
///
/// Guarantee: symmetric to the last bit, positive semi-definite up to rounding.
///
/// # Errors
/// As [`FactoredFrame::new`] and [`FactoredFrame::grid`].
pub fn grid(m: &Model, rails: &[Rail], at: &[Probe]) -> Result<InfluenceGrid, Error> {
    FactoredFrame::new(m, rails)?.grid(at)
}

impl FactoredFrame {
    /// [`grid`] of a frame that is already factored.
    ///
    /// # Errors
    /// [`Error::Rail`] for a probe beyond its rail, or in a direction that nothing resists; [`Error::IllConditioned`]
    /// for a bound above the accuracy; [`Error::Memory`] for too many probes.
    pub fn grid(&self, at: &[Probe]) -> Result<InfluenceGrid, Error> {
        allow_square(EntryAttribute::Grid, at.len())?;
        let mut loads = Vec::with_capacity(at.len());
        // Member, rail element and index of each probe on a member.
        let mut places = Vec::with_capacity(at.len());
        for (k, &probe) in at.iter().enumerate() {
            let (load, cell) = self.load(probe)?;
            loads.push(load);
            if let Some(carrier) = self.line()?.elements()[cell].member {
                places.push((carrier.id, cell, k));
            }
        }
        let solutions = self.forward(&loads);
        let mut value = self.gram(&solutions);
        places.sort_unstable();
        // Places on the same member also act on each other between its fixed ends.
        for same in places.chunk_by(|a, b| a.0 == b.0) {
            let probes: Vec<(Probe, usize)> = same.iter().map(|&(_, cell, k)| (at[k], cell)).collect();
            let local = self.clamped(&probes)?;
            for (i, &(_, _, a)) in same.iter().enumerate() {
                for (j, &(_, _, b)) in same.iter().enumerate() {
                    value[(a, b)] += local[(i, j)];
                }
            }
        }
        let diagonal: Vec<f64> = (0..at.len()).map(|k| value[(k, k)]).collect();
        let mut certificate = self.certificate();
        certificate.error_bound += self.rounding(at, &solutions, &diagonal)?;
        Ok(InfluenceGrid { value, certificate: self.require(certificate)? })
    }

    /// Products of all pairs of forward solutions.
    pub(crate) fn gram(&self, solutions: &[ForwardSolution]) -> DMatrix<f64> {
        let n = solutions.len();
        let mut value = DMatrix::zeros(n, n);
        let mut scratch = vec![0.0; self.unknowns()];
        for (i, solution) in solutions.iter().enumerate() {
            let mut j = 0;
            dot_products(&mut scratch, solution, solutions[..=i].iter(), |product| {
                value[(i, j)] = product;
                value[(j, i)] = product;
                j += 1;
            });
        }
        value
    }

    /// b: influence coefficients of places on one member, each with its rail element, while the tips of the
    /// rigid offsets at both ends of the member are fixed.
    fn clamped(&self, at: &[(Probe, usize)]) -> Result<DMatrix<f64>, Error> {
        let mut distinct: Vec<usize> = at.iter().map(|&(_, cell)| cell).collect();
        distinct.dedup();
        let cells = self.line()?.elements();
        // Each rail element becomes a rail of its own with two states of its own.
        let alone: Vec<RailElement> = distinct
            .iter()
            .enumerate()
            .map(|(k, &cell)| RailElement { rail: k, ends: [2 * k, 2 * k + 1], ..cells[cell].clone() })
            .collect();
        let mut nodal = DMatrix::zeros(12 * alone.len(), 12 * alone.len());
        for (a, b) in self.released_pairs(&alone) {
            let compliance = self.release_compliance(&alone[a], &alone[b]);
            nodal.view_mut((12 * a, 12 * b), (12, 12)).copy_from(&compliance);
        }
        let probes = at.iter().map(|&(probe, cell)| {
            let rail = distinct.iter().position(|&other| other == cell).unwrap_or_default();
            Probe { rail, ..probe }
        });
        let probes: Vec<Probe> = probes.collect();
        let mut out = Influence::zeros(probes.len());
        ExactSurface::new(Arc::new(Rails::new(alone)?), nodal)?.fill(&probes, &mut out)?;
        Ok(out.value)
    }

    /// Pairs of rail elements, each with itself too, on the same member with releases.
    pub(crate) fn released_pairs(&self, cells: &[RailElement]) -> Vec<(usize, usize)> {
        let mut by_member: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (index, cell) in cells.iter().enumerate() {
            if let Some(carrier) = cell.member.filter(|carrier| self.elements[carrier.id].released.is_some())
            {
                by_member.entry(carrier.id).or_default().push(index);
            }
        }
        let pairs = |same: &Vec<usize>| {
            same.iter().flat_map(|&a| same.iter().map(move |&b| (a, b))).collect::<Vec<_>>()
        };
        by_member.values().flat_map(pairs).collect()
    }

    /// Displacement of the end states of rail element `a` per unit load on those of `b`, both on one member,
    /// while the tips of its rigid offsets are fixed: the compliance K_rr^-1 of its releases, in rail axes.
    pub(crate) fn release_compliance(&self, a: &RailElement, b: &RailElement) -> Matrix12 {
        let Some(carrier) = a.member else { return Matrix12::zeros() };
        let Some(released) = &self.elements[carrier.id].released else { return Matrix12::zeros() };
        to_rail_axes(a) * released.compliance * to_rail_axes(b).transpose()
    }
}

/// From the flexible ends of a member, local axes, to the ends of a rail element on it, rail axes.
fn to_rail_axes(cell: &RailElement) -> Matrix12 {
    let axes = cell.member_axes();
    let back = Matrix3::from_fn(|i, j| axes[j][i]);
    let mut out = Matrix12::zeros();
    for end in 0..2 {
        let own = if cell.is_reversed() { 1 - end } else { end };
        out.fixed_view_mut::<6, 6>(6 * end, 6 * own).copy_from(&diagonal_blocks(&back));
    }
    out
}
