//! Influence coefficients between chosen places of the rails.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{DMatrix, Matrix3};
use splines::{Cell, Compliance, Influence, Line, Probe, Surface};

use crate::certificate::Certificate;
use crate::element::{Matrix12, blocks};
use crate::error::{Error, Quantity};
use crate::factor::{Tail, dots};
use crate::frame::Frame;
use crate::memory::square;
use crate::model::Model;
use crate::rail::Rail;

/// Influence coefficients of a list of probes.
#[derive(Clone, Debug)]
pub struct Grid {
    /// `value[(i, j)]`: displacement at probe i along its axis per unit force at probe j along its axis.
    pub value: DMatrix<f64>,
    /// How far to trust it.
    pub certificate: Certificate,
}

/// Influence coefficients of the probes `at`, in any directions, on any of the rails.
///
/// G_ij = w_i w_j + \[same member\] b(x_i, x_j), w = L^-1 N(x)^T with the Cholesky factor L of the
/// stiffness: loads inside members need no nodes there.
///
/// Guarantee: symmetric to the last bit, positive semi-definite up to rounding.
///
/// # Errors
/// As [`Frame::new`]; a probe beyond its rail, or in a direction that nothing resists.
pub fn grid(m: &Model, rails: &[Rail], at: &[Probe]) -> Result<Grid, Error> {
    Frame::new(m, rails)?.grid(at)
}

impl Frame {
    /// [`grid`] of a frame that is already factored.
    ///
    /// # Errors
    /// A probe beyond its rail, or in a direction that nothing resists; a bound worse than asked.
    pub fn grid(&self, at: &[Probe]) -> Result<Grid, Error> {
        square(Quantity::Grid, at.len())?;
        let mut loads = Vec::with_capacity(at.len());
        let mut cells = Vec::with_capacity(at.len());
        for (k, &probe) in at.iter().enumerate() {
            let (load, cell) = self.load(probe)?;
            loads.push(load);
            if let Some(carrier) = self.line()?.cells()[cell].carrier {
                cells.push((carrier.member, cell, k));
            }
        }
        let tails = self.forward(&loads);
        let mut value = self.gram(&tails);
        cells.sort_unstable();
        for same in cells.chunk_by(|a, b| a.0 == b.0) {
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
        certificate.error_bound += self.rounding(at, &tails, &diagonal)?;
        Ok(Grid { value, certificate: self.meets(certificate)? })
    }

    /// Products of all pairs of forward solves.
    pub(crate) fn gram(&self, tails: &[Tail]) -> DMatrix<f64> {
        let n = tails.len();
        let mut value = DMatrix::zeros(n, n);
        let mut scratch = vec![0.0; self.unknowns()];
        for (i, tail) in tails.iter().enumerate() {
            let mut j = 0;
            dots(&mut scratch, tail, tails[..=i].iter(), |product| {
                value[(i, j)] = product;
                value[(j, i)] = product;
                j += 1;
            });
        }
        value
    }

    /// Influence coefficients of places on one member alone, each with its cell, the tips of the arms at
    /// both its ends held.
    fn clamped(&self, at: &[(Probe, usize)]) -> Result<DMatrix<f64>, Error> {
        let mut known: Vec<usize> = at.iter().map(|&(_, cell)| cell).collect();
        known.dedup();
        let cells = self.line()?.cells();
        let alone: Vec<Cell> = known
            .iter()
            .enumerate()
            .map(|(k, &cell)| Cell { rail: k, ends: [2 * k, 2 * k + 1], ..cells[cell].clone() })
            .collect();
        let mut nodal = DMatrix::zeros(12 * alone.len(), 12 * alone.len());
        for (a, b) in self.released(&alone) {
            nodal.view_mut((12 * a, 12 * b), (12, 12)).copy_from(&self.slack(&alone[a], &alone[b]));
        }
        let probes = at.iter().map(|&(probe, cell)| {
            let rail = known.iter().position(|&other| other == cell).unwrap_or_default();
            Probe { rail, ..probe }
        });
        let probes: Vec<Probe> = probes.collect();
        let mut out = Influence::zeros(probes.len());
        Surface::new(Arc::new(Line::new(alone)?), nodal)?.fill(&probes, &mut out)?;
        Ok(out.value)
    }

    /// Pairs of cells, each with itself too, that stand on one member with releases.
    pub(crate) fn released(&self, cells: &[Cell]) -> Vec<(usize, usize)> {
        let mut by_member: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (index, cell) in cells.iter().enumerate() {
            if let Some(carrier) =
                cell.carrier.filter(|carrier| self.elements[carrier.member].released.is_some())
            {
                by_member.entry(carrier.member).or_default().push(index);
            }
        }
        let pairs = |same: &Vec<usize>| {
            same.iter().flat_map(|&a| same.iter().map(move |&b| (a, b))).collect::<Vec<_>>()
        };
        by_member.values().flat_map(pairs).collect()
    }

    /// Displacement of the end states of cell `a` per unit load on those of `b`, both on one member, the
    /// tips of whose arms are held: what its releases give.
    pub(crate) fn slack(&self, a: &Cell, b: &Cell) -> Matrix12 {
        let Some(carrier) = a.carrier else { return Matrix12::zeros() };
        let Some(released) = &self.elements[carrier.member].released else { return Matrix12::zeros() };
        turn(a) * released.slack * turn(b).transpose()
    }
}

/// From the flexible ends of a member, local axes, to the ends of a cell on it, rail frame.
fn turn(cell: &Cell) -> Matrix12 {
    let axes = cell.axes();
    let back = Matrix3::from_fn(|i, j| axes[j][i]);
    let mut out = Matrix12::zeros();
    for end in 0..2 {
        let own = if cell.is_reversed() { 1 - end } else { end };
        out.fixed_view_mut::<6, 6>(6 * end, 6 * own).copy_from(&blocks(&back));
    }
    out
}
