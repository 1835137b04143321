//! When the passes of a stage end.

use nalgebra::DVector;

/// Error that the passes of a stage may leave, by the error that a step may make.
const LEFT: f64 = 1e-6;

/// Error of a step above which the passes of one stage tell those of the next all they need to know.
const LOOSE: f64 = 1e-4;

/// Factor on the contraction ratio of another stage, where that of the stage itself is not known.
const MARGIN: f64 = 100.0;

/// The least contraction ratio that counts: less is rounding.
const LEAST: f64 = 1e-7;

/// Contraction ratio above which the matrices are formed again.
const POOR: f64 = 0.2;

/// The contraction of the fixed-point iteration of a stage, and the error that it may leave.
///
/// Where a pass changes the stage by d and the next one by r d, what is left after it is at most d r/(1 - r).
///
/// # Source
/// Hairer, Wanner, Solving Ordinary Differential Equations II (1996), section IV.8: stopping criterion of simplified
/// Newton iterations.
pub(crate) struct Convergence {
    /// Scales of displacements and speeds; without them passes end at rounding.
    scales: Option<[DVector<f64>; 2]>,
    /// Errors that may be left, judged by the passes of the stage itself and by those of another one.
    allowed: [f64; 2],
    /// Contraction ratio r from stages of the same step; infinite where it is not known.
    ratio: f64,
}

impl Default for Convergence {
    fn default() -> Self {
        Convergence { scales: None, allowed: [0.0; 2], ratio: f64::INFINITY }
    }
}

/// What follows from a pass.
pub(crate) struct Verdict {
    /// What is left is within what is allowed.
    pub has_ended: bool,
    /// The matrices must be formed again.
    pub is_poor: bool,
}

impl Convergence {
    /// Lets passes end within a fraction of the error `tolerance` of a step beside the scales of displacements and
    /// speeds.
    pub fn set_accuracy(&mut self, tolerance: f64, [scale, rate_scale]: [&DVector<f64>; 2]) {
        let by_others = (tolerance / LOOSE).min(1.0).powi(2);
        self.allowed = [1.0, by_others].map(|share| share * LEFT * tolerance);
        match &mut self.scales {
            Some([own, own_rate]) => {
                own.copy_from(scale);
                own_rate.copy_from(rate_scale);
            }
            none => *none = Some([scale.clone(), rate_scale.clone()]),
        }
    }

    /// Forgets the contraction of the last step.
    pub fn begin_step(&mut self) {
        self.ratio = f64::INFINITY;
    }

    /// Smallest error that is allowed; `None`: rounding.
    pub fn allowed(&self) -> Option<f64> {
        self.scales.as_ref().map(|_| self.allowed[1])
    }

    /// Changes `dq` and `dv` of degree of freedom `k` beside its scales, where it is `q` and `v` then.
    pub fn weigh(&self, k: usize, [dq, dv]: [f64; 2], [q, v]: [f64; 2]) -> f64 {
        self.scales.as_ref().map_or(0.0, |[scale, rate_scale]| {
            let by_place = dq / scale[k].max(q.abs());
            by_place.max(dv / rate_scale[k].max(v.abs()))
        })
    }

    /// Judges a pass that changed the stage by `change` after one that changed it by `last`, infinite for the first.
    pub fn judge(&mut self, change: f64, last: f64) -> Verdict {
        let is_own = last.is_finite();
        if is_own {
            self.ratio = (change / last).max(LEAST);
        }
        let ratio = if is_own { self.ratio } else { MARGIN * self.ratio };
        let left = if ratio < 1.0 { change * ratio / (1.0 - ratio) } else { f64::INFINITY };
        Verdict {
            has_ended: self.scales.is_some() && left < self.allowed[usize::from(!is_own)],
            is_poor: is_own && self.ratio > POOR,
        }
    }
}
