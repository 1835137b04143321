//! Termination of the passes of a stage.

use nalgebra::DVector;

/// Iteration error allowed in a stage, per unit of the step tolerance.
const LEFT: f64 = 1e-6;

/// Multiple of it that is allowed after the first correction of a stage. With four times as much, the energy of some runs
/// closes twice as badly.
const EASE: f64 = 100.0;

/// Step tolerance above which the contraction ratio of another stage justifies the full allowed error; below it the
/// allowed error is reduced by the square of tolerance/LOOSE.
const LOOSE: f64 = 1e-4;

/// Safety factors on the contraction ratio of another stage, used while that of the present stage is unknown: of passes with
/// new matrices, which contract the more the nearer they are to the solution, and of corrections, which contract alike.
const MARGIN: [f64; 2] = [100.0, 4.0];

/// Least contraction ratio of another stage for the first correction of a stage: the ratio of a full pass and the correction
/// that follows it is smaller.
const USUAL: f64 = 1e-3;

/// Lower bound of the contraction ratio; smaller values are due to rounding.
const LEAST: f64 = 1e-7;

/// Contraction ratio of the fixed-point iteration above which the Jacobian is rebuilt.
const POOR: f64 = 0.2;

/// Contraction of the fixed-point iteration of a stage, and the error that may remain.
///
/// If one pass changes the stage by d and the next one by r d, the error that remains after a change d is at most d
/// r/(1 - r).
///
/// # Source
/// Hairer, Wanner, Solving Ordinary Differential Equations II (1996), section IV.8: stopping criterion of simplified
/// Newton iterations.
pub(crate) struct Convergence {
    /// Scales of displacements and speeds; without them the passes end at rounding.
    scales: Option<[DVector<f64>; 2]>,
    /// Allowed errors: for the contraction ratio of the stage itself, and for that of another stage.
    allowed: [f64; 2],
    /// Contraction ratio r from stages of the same step; infinite if it is unknown.
    ratio: f64,
}

impl Default for Convergence {
    fn default() -> Self {
        Convergence {
            scales: None,
            allowed: [0.0; 2],
            ratio: f64::INFINITY,
        }
    }
}

/// Assessment of a pass.
pub(crate) struct Verdict {
    /// The remaining error is within the allowed error.
    pub has_ended: bool,
    /// The matrices must be rebuilt.
    pub is_poor: bool,
}

impl Convergence {
    /// Allows the passes to end within a fraction of the step error `tolerance`, relative to the scales of
    /// displacements and speeds.
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

    /// Discards the contraction ratio of the last step.
    pub fn begin_step(&mut self) {
        self.ratio = f64::INFINITY;
    }

    /// Whether a contraction ratio is known, without which the first pass of a stage is not the last.
    pub fn knows_ratio(&self) -> bool {
        self.ratio.is_finite()
    }

    /// The smaller of the two allowed errors; `None` if the passes end at rounding.
    pub fn allowed(&self) -> Option<f64> {
        self.scales.as_ref().map(|_| self.allowed[1])
    }

    /// Changes `dq` and `dv` of degree of freedom `k` relative to its scales; `q` and `v` are its new values.
    #[inline]
    pub fn weigh(&self, k: usize, [dq, dv]: [f64; 2], [q, v]: [f64; 2]) -> f64 {
        self.scales.as_ref().map_or(0.0, |[scale, rate_scale]| {
            let by_place = dq / scale[k].max(q.abs());
            by_place.max(dv / rate_scale[k].max(v.abs()))
        })
    }

    /// Evaluates a pass, or a correction, that changed the stage by `change` after a pass that changed it by `last`, which is
    /// infinite for the first pass.
    pub fn judge(&mut self, change: f64, last: f64, is_correction: bool) -> Verdict {
        let is_own = last.is_finite();
        if is_own {
            self.ratio = (change / last).max(LEAST);
        }
        let ratio = match (is_own, is_correction) {
            (true, _) => self.ratio,
            (false, false) => MARGIN[0] * self.ratio,
            (false, true) => MARGIN[1] * self.ratio.max(USUAL),
        };
        let left = if ratio < 1.0 {
            change * ratio / (1.0 - ratio)
        } else {
            f64::INFINITY
        };
        let ease = if is_correction && !is_own { EASE } else { 1.0 };
        Verdict {
            has_ended: self.scales.is_some() && left < ease * self.allowed[usize::from(!is_own)],
            is_poor: is_own && self.ratio > POOR,
        }
    }
}
