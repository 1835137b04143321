//! Shapes along rails, and what a sum of their products leaves of a surface.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::{Compliance, Error, Influence, Line, Probe, Surface};

/// Motions of a line by the motions of its states: phi_r(p) = N(p) s_r.
#[derive(Clone, Debug)]
pub struct Shapes {
    line: Arc<Line>,
    /// Shapes x freedoms of the states: what a place needs of all shapes lies together.
    motions: DMatrix<f64>,
}

impl Shapes {
    /// Shapes of `line`; `states`: six freedoms a state x shapes.
    ///
    /// # Errors
    /// Another number of rows than freedoms.
    pub fn new(line: Arc<Line>, states: DMatrix<f64>) -> Result<Shapes, Error> {
        let expected = 6 * line.states();
        let (rows, columns) = states.shape();
        if rows != expected {
            return Err(Error::NodalShape { rows, columns, expected });
        }
        Ok(Shapes { line, motions: states.transpose() })
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.motions.nrows()
    }

    /// Displacement at `at` along its axis of each shape, and its derivative along the rail, into `value` and `slope` of one entry
    /// a shape.
    ///
    /// # Errors
    /// A probe beyond its rail, or in a direction that nothing resists.
    pub fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), Error> {
        let row = self.line.row(at)?;
        value.fill(0.0);
        slope.fill(0.0);
        for ((&k, share), share_slope) in row.indices().iter().zip(row.values()).zip(row.slopes()) {
            let motions = self.motions.column(k);
            for ((value, slope), motion) in value.iter_mut().zip(&mut *slope).zip(&motions) {
                *value += share * motion;
                *slope += share_slope * motion;
            }
        }
        Ok(())
    }
}

/// A surface without what shapes take of it:
///
/// G'(p, q) = G(p, q) - sum phi_r(p) phi_r(q)
///
/// The shapes may stand on a finer line of the same rails. A beam's static give does not depend on where it is cut: a few
/// states say G where all ends of the cut members would need a matrix a thousand times as large.
///
/// Guarantee: where the shapes are those of natural modes of the same structure, divided by their frequencies, G' is
/// positive semidefinite up to the rounding of G.
#[derive(Clone, Debug)]
pub struct Rest {
    whole: Surface,
    taken: Shapes,
}

impl Rest {
    /// What `taken` leaves of `whole`.
    #[must_use]
    pub const fn new(whole: Surface, taken: Shapes) -> Rest {
        Rest { whole, taken }
    }
}

impl Compliance for Rest {
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        self.whole.fill(at, out)?;
        let (n, count) = (at.len(), self.taken.count());
        if count == 0 {
            return Ok(());
        }
        let mut all = vec![0.0; 2 * count * n];
        let (values, slopes) = all.split_at_mut(count * n);
        let rows = values.chunks_exact_mut(count).zip(slopes.chunks_exact_mut(count));
        for (probe, (value, slope)) in at.iter().zip(rows) {
            self.taken.row(*probe, value, slope)?;
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        for (j, other) in values.chunks_exact(count).enumerate() {
            let rows = values.chunks_exact(count).zip(slopes.chunks_exact(count));
            for (i, (value, slope)) in rows.enumerate() {
                out.value[(i, j)] -= dot(value, other);
                out.slope[(i, j)] -= dot(slope, other);
            }
        }
        Ok(())
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.whole.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.whole.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        self.whole.is_symmetric()
    }
}
