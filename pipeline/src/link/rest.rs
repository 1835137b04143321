//! What natural modes leave of a structure's static give.

use std::sync::Arc;

use nalgebra::DMatrix;
use splines::{Compliance, Error, Influence, Line, Probe, Row, Surface};

/// G(p, q) - sum phi_r(p) phi_r(q) / omega_r^2, G exact and phi on members cut for the modes.
///
/// The cuts do not enter G: a beam's static give is the same with and without them, so that a few places of the rails say it, where
/// all ends of the cut members would need a matrix a thousand times as large.
pub(super) struct Rest {
    exact: Surface,
    line: Arc<Line>,
    /// phi_r / omega_r at the ends of the cut cells: freedoms x modes.
    states: DMatrix<f64>,
}

impl Rest {
    /// What `modes` on `line` leave of `exact`.
    pub fn new(exact: Surface, line: Arc<Line>, modes: &[fea::Mode]) -> Rest {
        let states = DMatrix::from_fn(6 * line.states(), modes.len(), |k, r| {
            modes[r].states[k / 6][k % 6] / modes[r].omega
        });
        Rest { exact, line, states }
    }

    /// All modes at a probe, and their slopes, as two columns one below the other.
    fn shapes(&self, row: &Row, out: &mut [f64]) {
        let count = self.states.ncols();
        let (value, slope) = out.split_at_mut(count);
        for r in 0..count {
            let column = self.states.column(r);
            (value[r], slope[r]) = (0.0, 0.0);
            for (&k, (share, share_slope)) in row.indices().iter().zip(row.values().iter().zip(row.slopes()))
            {
                value[r] += share * column[k];
                slope[r] += share_slope * column[k];
            }
        }
    }
}

impl Compliance for Rest {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        self.exact.fill(at, out)?;
        let count = self.states.ncols();
        let mut all = vec![0.0; 2 * count * at.len()];
        for (probe, own) in at.iter().zip(all.chunks_exact_mut((2 * count).max(1))) {
            self.shapes(&self.line.row(*probe)?, own);
        }
        let of = |i: usize| all[2 * count * i..2 * count * (i + 1)].split_at(count);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for j in 0..at.len() {
            let (other, _) = of(j);
            for i in 0..at.len() {
                let (value, slope) = of(i);
                // by the same sum on either side of the diagonal
                out.value[(i, j)] -= dot(value, other);
                out.slope[(i, j)] -= dot(slope, other);
            }
        }
        Ok(())
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.exact.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.exact.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}
