//! What evaluation in doubles adds to the error of the factor.

use std::collections::BTreeMap;

use splines::Probe;

use crate::error::Error;
use crate::factor::Tail;
use crate::frame::Frame;
use crate::freedoms::Sum;
use crate::solver::Solver;

/// Half the spacing of doubles at one: the largest relative error of one rounding.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// Roundings of an entry of a load, relative to the magnitudes that it is added up from: cubic, place, arms.
const LOAD: f64 = 12.0;
/// Roundings of the clamped cell's own give.
const CELL: f64 = 16.0;
/// Roundings of the sections' products and reciprocals, and of the last sum.
const SECTION: f64 = 4.0;

impl Frame {
    /// Bound on |error of G_ij| / sqrt(G_ii G_jj) from rounding of loads, products and cells, for the probes `at`
    /// with L^-1 p = `tails` and G_ii = `diagonal`.
    ///
    /// With w = L^-1 p an error dp moves w by |L^-1 dp| <= sum |dp_k| |L^-1 e_k|, and G_ij by that times |w_j|.
    /// Places that do not move but for rounding do not count.
    ///
    /// # Source
    /// Higham, Accuracy and Stability of Numerical Algorithms (2002), sections 3.1 and 5.1.
    pub(crate) fn rounding(&self, at: &[Probe], tails: &[Tail], diagonal: &[f64]) -> Result<f64, Error> {
        let estimate = match self.solver {
            Solver::Double(_) => Some(self.inverse.sqrt()),
            Solver::Extended(_) => None,
        };
        let rough = self.rounding_by(
            &mut Lengths { frame: self, estimate, known: BTreeMap::new() },
            at,
            tails,
            diagonal,
        )?;
        if estimate.is_none() || self.certificate().error_bound + rough <= self.accuracy {
            return Ok(rough);
        }
        self.rounding_by(
            &mut Lengths { frame: self, estimate: None, known: BTreeMap::new() },
            at,
            tails,
            diagonal,
        )
    }

    fn rounding_by(
        &self,
        lengths: &mut Lengths,
        at: &[Probe],
        tails: &[Tail],
        diagonal: &[f64],
    ) -> Result<f64, Error> {
        let mut worst = 0.0_f64;
        let mut longest = 0;
        for ((&probe, tail), &own) in at.iter().zip(tails).zip(diagonal) {
            longest = longest.max(tail.values.len());
            let (row, magnitudes, cell) = self.line()?.magnitudes(probe)?;
            let mut moved = 0.0;
            for (&index, magnitude) in row.indices().iter().zip(magnitudes) {
                let sum = &self.states()[index / 6][index % 6];
                moved += magnitude * self.length_of(sum, lengths);
            }
            let moved = LOAD * UNIT * moved;
            let size = own.sqrt();
            if own > 0.0 && moved < 0.5 * size {
                worst = worst.max(2.0 * moved / size + CELL * UNIT * cell / own);
            }
        }
        Ok(worst + UNIT * (SECTION + 0.25 * longest as f64 + 8.0))
    }

    /// Sum of |p_k| |L^-1 e_k| over the unknowns of a load with the magnitudes of `sum`.
    fn length_of(&self, sum: &Sum, lengths: &mut Lengths) -> f64 {
        let mut total = 0.0;
        for (column, size) in sum.magnitudes() {
            let (body, row) = (&self.freedoms.bodies[column / 6], column % 6);
            for k in 0..6 {
                let share = size * body.basis[(row, k)].abs();
                if share > 0.0
                    && let Some(unknown) = self.unknown(column - row + k)
                {
                    total += share * self.scale(unknown) * lengths.of(unknown);
                }
            }
        }
        total
    }
}

/// |L^-1 e_k|: a bound for all, or worked out for each.
struct Lengths<'a> {
    frame: &'a Frame,
    estimate: Option<f64>,
    known: BTreeMap<usize, f64>,
}

impl Lengths<'_> {
    fn of(&mut self, unknown: usize) -> f64 {
        let work = || {
            let tails = self.frame.forward(&[vec![(unknown, 1.0)]]);
            tails.iter().flat_map(|tail| &tail.values).map(|w| w * w).sum::<f64>().sqrt()
        };
        self.estimate.unwrap_or_else(|| *self.known.entry(unknown).or_insert_with(work))
    }
}
