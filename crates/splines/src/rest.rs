//! Shapes along rails, and what a sum of their products leaves of a surface.

use std::sync::{Arc, OnceLock};

use nalgebra::DMatrix;

use crate::row::Fraction;
use crate::{Compliance, Error, Influence, Line, Probe, Surface};

/// Motions of a line by the motions of its states: phi_r(p) = N(p) s_r.
///
/// Along a cell each is a cubic, kept by its values and slopes at the cell's ends, from the first time that a probe stands
/// on the cell: four numbers a shape where N has up to twelve entries.
#[derive(Clone, Debug)]
pub struct Shapes {
    line: Arc<Line>,
    /// Shapes x freedoms of the states: what a place needs of all shapes lies together.
    motions: DMatrix<f64>,
    /// By cell and axis: of all shapes the value at the first end, then the slope there by the share of the cell, then both
    /// at the last end.
    ends: Vec<[OnceLock<Vec<f64>>; 3]>,
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
        let ends = line.cells().iter().map(|_| Default::default()).collect();
        Ok(Shapes { line, motions: states.transpose(), ends })
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
        let (cell, place, scale) = self.line.place(at)?;
        let count = self.count();
        if count == 0 {
            return Ok(());
        }
        let axis = at.axis.component();
        let ends = self.ends[cell][axis].get_or_init(|| self.ends(cell, axis));
        let ([p, q, r, s], [dp, dq, dr, ds]) = hermite(place, scale);
        let (first, last) = ends.split_at(2 * count);
        let ((a, b), (c, d)) = (first.split_at(count), last.split_at(count));
        let data = a.iter().zip(b).zip(c.iter().zip(d));
        for ((value, slope), ((a, b), (c, d))) in value.iter_mut().zip(slope).zip(data) {
            *value = p * a + q * b + r * c + s * d;
            *slope = dp * a + dq * b + dr * c + ds * d;
        }
        Ok(())
    }

    fn ends(&self, cell: usize, axis: usize) -> Vec<f64> {
        let rows = self.line.end_rows(cell, axis);
        let parts = rows.iter().flat_map(|row| [(row, row.values()), (row, row.slopes())]);
        let sum = |indices: &[usize], shares: &[f64], shape: usize| -> f64 {
            indices.iter().zip(shares).map(|(&k, share)| share * self.motions[(shape, k)]).sum()
        };
        parts
            .flat_map(|(row, shares)| (0..self.count()).map(move |shape| sum(row.indices(), shares, shape)))
            .collect()
    }
}

/// Shares of the value and slope at the first end of a cell and of those at its last in the value at a place; and their
/// derivatives by x. `scale`: 1/(extent in x). By the distance from the nearer end, so that what vanishes there does.
fn hermite(Fraction { end, r }: Fraction, scale: f64) -> ([f64; 4], [f64; 4]) {
    let far = r * r * (3.0 - 2.0 * r);
    let [value, slope, value_far, slope_far] =
        [1.0 - far, r * (1.0 - r) * (1.0 - r), far, -r * r * (1.0 - r)];
    let steep = 6.0 * r * (1.0 - r);
    let by = [-steep, (1.0 - r) * (1.0 - 3.0 * r), steep, r * (3.0 * r - 2.0)].map(|share| share * scale);
    if end == 0 {
        ([value, slope, value_far, slope_far], by)
    } else {
        // seen from the last end x runs backwards
        ([value_far, -slope_far, value, -slope], [-by[2], by[3], -by[0], by[1]])
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
