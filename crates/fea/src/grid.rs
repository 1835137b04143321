//! Influence coefficients between chosen places of the rails.

use std::sync::Arc;

use nalgebra::DMatrix;
use splines::{Cell, Compliance, Influence, Line, Probe, Surface};

use crate::certificate::Certificate;
use crate::error::Error;
use crate::factor::{Tail, dots};
use crate::frame::Frame;
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
/// G_ij = w_i w_j + \[same cell\] b(x_i, x_j), w = L^-1 N(x)^T with the Cholesky factor L of the
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
    /// A probe beyond its rail, or in a direction that nothing resists.
    pub fn grid(&self, at: &[Probe]) -> Result<Grid, Error> {
        let mut scratch = self.scratch();
        let mut tails = Vec::with_capacity(at.len());
        let mut cells = Vec::with_capacity(at.len());
        for (k, &probe) in at.iter().enumerate() {
            let (load, cell) = self.load(probe)?;
            tails.push(self.forward(&load, &mut scratch));
            cells.push((cell, k));
        }
        let mut value = self.gram(&tails);
        cells.sort_unstable();
        for same in cells.chunk_by(|a, b| a.0 == b.0) {
            let probes: Vec<Probe> = same.iter().map(|&(_, k)| at[k]).collect();
            let local = self.clamped(same[0].0, &probes)?;
            for (i, &(_, a)) in same.iter().enumerate() {
                for (j, &(_, b)) in same.iter().enumerate() {
                    value[(a, b)] += local[(i, j)];
                }
            }
        }
        let diagonal: Vec<f64> = (0..at.len()).map(|k| value[(k, k)]).collect();
        let mut certificate = self.certificate();
        certificate.error_bound += self.rounding(at, &tails, &diagonal)?;
        Ok(Grid { value, certificate })
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

    /// Influence coefficients of one cell alone, the tips of the arms at both its ends held.
    fn clamped(&self, cell: usize, probes: &[Probe]) -> Result<DMatrix<f64>, Error> {
        let given = &self.line()?.cells()[cell];
        let n = probes.len();
        if given.ends[0] == given.ends[1] {
            return Ok(DMatrix::zeros(n, n));
        }
        let alone = Line::new(vec![Cell { ends: [0, 1], ..given.clone() }])?;
        let slack = self.slack().get(&cell);
        let nodal = DMatrix::from_fn(12, 12, |i, j| slack.map_or(0.0, |slack| slack[(i, j)]));
        let mut out = Influence::zeros(n);
        Surface::new(Arc::new(alone), nodal)?.fill(probes, &mut out)?;
        Ok(out.value)
    }
}
