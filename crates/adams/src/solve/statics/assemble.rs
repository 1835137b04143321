//! What is solved before the equations of statics are solved together: the constraints alone, and the loops and
//! differentials alone.

use super::iterate::{Iterate, Unknown};
use super::search::Search;
use crate::solve::newton;
use nalgebra::{DMatrix, DVector};

/// Largest number of iterations on the constraints alone.
const ASSEMBLIES: usize = 40;
/// Largest scaled gap of constraints that are satisfied.
const ASSEMBLED: f64 = 1e-13;
/// Singular values of the constraints below this fraction of the largest one count as zero.
const SINGULAR: f64 = 1e-11;

impl Search<'_> {
    /// The iterate with its parts moved by the smallest displacements that satisfy the constraints and motions;
    /// unchanged if these are not found. Translations are measured in the size of the model, rotations in radians.
    ///
    /// A wheel that a motion brings to another place of its rail keeps its height here, and with it its contact. A
    /// step of Newton's method along the rail would extrapolate the deflection of the rail linearly, with an error
    /// larger than the penetration of a stiff wheel.
    pub fn assembled(&self, start: Iterate) -> Iterate {
        let is_position =
            |unknown: &Unknown| matches!(unknown, Unknown::Translation(..) | Unknown::Rotation(..));
        let numbers = |is: &dyn Fn(&Unknown) -> bool| -> Vec<usize> {
            (0..self.unknowns.len())
                .filter(|k| is(&self.unknowns[*k]))
                .collect()
        };
        let columns = numbers(&is_position);
        let rows = numbers(&|unknown| matches!(unknown, Unknown::Reaction(..)));
        let (gap_scales, scales) = (
            self.residual_scales(&start),
            self.step_scales(&start, &vec![0.0; self.unknowns.len()]),
        );
        if rows.is_empty() {
            return start;
        }
        let mut at = start.clone();
        for _ in 0..ASSEMBLIES {
            let Ok((residual, matrix)) = self.linearize(&at, &self.unknowns) else {
                return start;
            };
            let gaps = DVector::from_iterator(
                rows.len(),
                rows.iter().map(|&r| residual[r] / gap_scales[r]),
            );
            if gaps.amax() <= ASSEMBLED {
                return at;
            }
            let scaled = DMatrix::from_fn(rows.len(), columns.len(), |r, c| {
                matrix[(rows[r], columns[c])] * scales[columns[c]] / gap_scales[rows[r]]
            });
            let Some(svd) = scaled.try_svd(true, true, f64::EPSILON, 10_000) else {
                return start;
            };
            let least = SINGULAR * svd.singular_values.max();
            let Ok(solved) = svd.solve(&gaps, least) else {
                return start;
            };
            let mut step = vec![0.0; self.unknowns.len()];
            columns
                .iter()
                .zip(solved.iter())
                .for_each(|(&c, d)| step[c] = -d * scales[c]);
            let fraction = 0.5 / self.largest_angle(&step).max(0.5);
            at = at.after(&self.unknowns, &step, fraction);
        }
        start
    }

    /// The iterate with its loops and differentials solved for the parts where they stand; unchanged if that fails.
    pub fn closed(&self, at: Iterate) -> Iterate {
        if self.inner.is_empty() {
            return at;
        }
        let value = |unknown: &Unknown| match *unknown {
            Unknown::Slot(slot) => at.values[slot],
            Unknown::Differential(diff) => at.differentials[diff],
            _ => 0.0,
        };
        let start: Vec<f64> = self.inner.iter().map(value).collect();
        let with = |x: &[f64]| {
            let step: Vec<f64> = x.iter().zip(&start).map(|(x, start)| x - start).collect();
            at.after(&self.inner, &step, 1.0)
        };
        // The equation of a differential, DIF1 = 0, has the sign of its derivative.
        let continued: Vec<bool> = self
            .inner
            .iter()
            .map(|unknown| matches!(unknown, Unknown::Slot(_)))
            .collect();
        let linearize = |x: &[f64]| self.linearize(&with(x), &self.inner);
        let residual = |x: &[f64]| Ok(self.balanced(&with(x), &self.inner)?.0);
        match newton::solve(start.clone(), &continued, linearize, residual) {
            Ok(Ok((x, _))) => with(&x),
            Ok(Err(_)) | Err(_) => at,
        }
    }
}
