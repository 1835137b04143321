//! Error that the evaluation of a grid in doubles adds to that of the factor.

use std::collections::BTreeMap;

use splines::Probe;

use crate::assembly::Combination;
use crate::error::Error;
use crate::factor::{ForwardSolution, Solver};
use crate::influence::frame::FactoredFrame;

/// Largest relative error of one rounding: half the spacing of doubles at one.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// Roundings in an entry of a load, relative to the magnitudes that it is added up from: cubic, place, arms.
const LOAD: f64 = 12.0;
/// Roundings in the Green's function of the fixed rail element.
const ELEMENT: f64 = 16.0;
/// Roundings in products and reciprocals of the sections, and in the last sum.
const SECTION: f64 = 4.0;
/// Roundings in the four lanes of a product, beside one for every fourth term.
const LANES: f64 = 8.0;

impl FactoredFrame {
    /// Bound of |error of G_ij| / sqrt(G_ii G_jj) from the rounding of loads, products and rail elements, for
    /// the probes `at` with L^-1 p = `solutions` and G_ii = `diagonal`.
    ///
    /// With w = L^-1 p an error dp changes w by |L^-1 dp| <= sum |dp_k| |L^-1 e_k|, and G_ij by that times
    /// |w_j|. A place whose compliance is itself only rounding does not count. The norms |L^-1 e_k| are at
    /// first bounded by sqrt(|K^-1|); only if that bound does not meet the accuracy are they computed.
    ///
    /// # Source
    /// Higham, Accuracy and Stability of Numerical Algorithms (2002), sections 3.1 and 5.1.
    pub(crate) fn rounding(
        &self,
        at: &[Probe],
        solutions: &[ForwardSolution],
        diagonal: &[f64],
    ) -> Result<f64, Error> {
        let bound = match self.solver() {
            Solver::Double(_) => Some(self.inverse_norm().sqrt()),
            Solver::Extended(_) => None,
        };
        let rough = self.rounding_with(&mut UnitNorms::new(self, bound), at, solutions, diagonal)?;
        if bound.is_none() || self.certificate().error_bound + rough <= self.accuracy() {
            return Ok(rough);
        }
        self.rounding_with(&mut UnitNorms::new(self, None), at, solutions, diagonal)
    }

    fn rounding_with(
        &self,
        norms: &mut UnitNorms,
        at: &[Probe],
        solutions: &[ForwardSolution],
        diagonal: &[f64],
    ) -> Result<f64, Error> {
        let mut worst = 0.0_f64;
        let mut longest = 0;
        for ((&probe, solution), &own) in at.iter().zip(solutions).zip(diagonal) {
            longest = longest.max(solution.values.len());
            let (row, magnitudes, element) = self.line()?.rounding_magnitudes(probe)?;
            let mut moved = 0.0;
            for (&index, magnitude) in row.indices().iter().zip(magnitudes) {
                let state = &self.states()[index / 6][index % 6];
                moved += magnitude * self.load_norm(state, norms);
            }
            let moved = LOAD * UNIT * moved;
            let size = own.sqrt();
            if own > 0.0 && moved < 0.5 * size {
                worst = worst.max(2.0 * moved / size + ELEMENT * UNIT * element / own);
            }
        }
        Ok(worst + UNIT * (SECTION + 0.25 * longest as f64 + LANES))
    }

    /// Sum of |p_k| |L^-1 e_k| over the unknowns of a load with the magnitudes of `row`.
    fn load_norm(&self, row: &Combination, norms: &mut UnitNorms) -> f64 {
        let mut total = 0.0;
        for (column, size) in row.magnitudes() {
            let (body, own) = (&self.bodies.list[column / 6], column % 6);
            for k in 0..6 {
                let part = size * body.basis[(own, k)].abs();
                if part > 0.0
                    && let Some(unknown) = self.unknown(column - own + k)
                {
                    total += part * self.scale(unknown) * norms.of(unknown);
                }
            }
        }
        total
    }
}

/// |L^-1 e_k|: one bound for all, or computed for each unknown that is asked for.
struct UnitNorms<'a> {
    frame: &'a FactoredFrame,
    bound: Option<f64>,
    computed: BTreeMap<usize, f64>,
}

impl UnitNorms<'_> {
    fn new(frame: &FactoredFrame, bound: Option<f64>) -> UnitNorms<'_> {
        UnitNorms { frame, bound, computed: BTreeMap::new() }
    }

    fn of(&mut self, unknown: usize) -> f64 {
        let compute = || {
            let solutions = self.frame.forward(&[vec![(unknown, 1.0)]]);
            solutions.iter().flat_map(|solution| &solution.values).map(|w| w * w).sum::<f64>().sqrt()
        };
        self.bound.unwrap_or_else(|| *self.computed.entry(unknown).or_insert_with(compute))
    }
}
