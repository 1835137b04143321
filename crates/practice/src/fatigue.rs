//! Fatigue strength and accumulated damage, EN 1993-1-9.

use crate::Error;
use crate::error::{Argument, least_zero, positive};
use crate::rainflow::Cycle;

/// Cycles at which the reference strength is given.
pub const REFERENCE: f64 = 2e6;

/// Cycles at the constant-amplitude limit.
pub const KNEE: f64 = 5e6;

/// Cycles at the cut-off.
pub const END: f64 = 1e8;

/// Detail categories for direct stress, N/mm2.
///
/// # Source
/// EN 1993-1-9:2005, Figure 7.1.
pub const CATEGORIES: [f64; 14] =
    [36.0, 40.0, 45.0, 50.0, 56.0, 63.0, 71.0, 80.0, 90.0, 100.0, 112.0, 125.0, 140.0, 160.0];

/// Which stress a detail category is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stress {
    /// Slope 3 to 5 million cycles, 5 to 100 million, none beyond.
    Direct,
    /// Slope 5 to 100 million cycles, none beyond.
    Shear,
}

/// A fatigue strength curve: ranges of nominal stress and the cycles that they are borne.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength {
    stress: Stress,
    reference: f64,
}

impl Strength {
    /// The curve of a detail category, divided by both partial factors, gamma_Ff of the ranges and gamma_Mf of
    /// the strength; so ranges come to it as they are. Category and ranges in any one unit of stress.
    ///
    /// # Errors
    /// A category or factor that is not positive.
    ///
    /// # Source
    /// EN 1993-1-9:2005, 7.1 and A.5.
    pub fn new(stress: Stress, category: f64, loads: f64, material: f64) -> Result<Strength, Error> {
        let category = positive(Argument::Range, category)?;
        let loads = positive(Argument::Partial, loads)?;
        let material = positive(Argument::Partial, material)?;
        let reference = positive(Argument::Range, category / loads / material)?;
        Ok(Strength { stress, reference })
    }

    /// The range that is borne [`REFERENCE`] times.
    #[must_use]
    pub fn reference(&self) -> f64 {
        self.reference
    }

    /// The largest range that does no damage if none is larger: (2/5)^(1/3) = 0.737 of the reference for direct
    /// stress; the cut-off for shear.
    #[must_use]
    pub fn limit(&self) -> f64 {
        match self.stress {
            Stress::Direct => self.reference * (REFERENCE / KNEE).cbrt(),
            Stress::Shear => self.cut_off(),
        }
    }

    /// The largest range that never counts: (5/100)^(1/5) = 0.549 of the limit for direct stress,
    /// (2/100)^(1/5) = 0.457 of the reference for shear.
    #[must_use]
    pub fn cut_off(&self) -> f64 {
        match self.stress {
            Stress::Direct => self.limit() * (KNEE / END).powf(0.2),
            Stress::Shear => self.reference * (REFERENCE / END).powf(0.2),
        }
    }

    /// Damage of one cycle, 1/N; zero at and below the cut-off.
    ///
    /// N = 2e6 (reference/range)^3 down to the limit, 5e6 (limit/range)^5 below; for shear
    /// 2e6 (reference/range)^5. The curves are drawn from 1e4 cycles on; above, this is their extension.
    ///
    /// # Errors
    /// A range that is negative or not finite.
    ///
    /// # Source
    /// EN 1993-1-9:2005, 7.1.
    pub fn damage(&self, range: f64) -> Result<f64, Error> {
        let range = least_zero(Argument::Range, range)?;
        let limit = self.limit();
        Ok(if range <= self.cut_off() {
            0.0
        } else if self.stress == Stress::Shear {
            (range / self.reference).powi(5) / REFERENCE
        } else if range < limit {
            (range / limit).powi(5) / KNEE
        } else {
            (range / self.reference).powi(3) / REFERENCE
        })
    }

    /// D = sum n/N over the cycles of a history.
    ///
    /// # Errors
    /// A cycle whose range or count is negative or not finite.
    ///
    /// # Source
    /// EN 1993-1-9:2005, A.5 (Palmgren and Miner).
    pub fn miner(&self, cycles: &[Cycle]) -> Result<Damage, Error> {
        Damage::of(cycles, self.limit(), |range| self.damage(range))
    }

    /// The constant range that does the damage `sum` in [`REFERENCE`] cycles: reference sum^(1/3), or
    /// sum^(1/5) for shear. At most the reference exactly when the sum is at most one.
    ///
    /// # Errors
    /// A sum that is negative or not finite.
    ///
    /// # Source
    /// EN 1993-1-9:2005, 1.3 and A.6: the equivalent range related to 2 million cycles.
    pub fn equivalent(&self, sum: f64) -> Result<f64, Error> {
        let sum = least_zero(Argument::Factor, sum)?;
        Ok(self.reference
            * match self.stress {
                Stress::Direct => sum.cbrt(),
                Stress::Shear => sum.powf(0.2),
            })
    }
}

/// What the cycles of a history do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damage {
    /// Miner's sum; 1 is failure.
    pub sum: f64,
    /// The largest range.
    pub most: f64,
    /// Whether no range is above the limit, so that the sum, though not zero, may be taken as zero.
    pub endures: bool,
}

impl Damage {
    /// The sum over `cycles` of their counts times `by` of their ranges; nothing fails at ranges up to `limit`.
    pub(crate) fn of(
        cycles: &[Cycle],
        limit: f64,
        by: impl Fn(f64) -> Result<f64, Error>,
    ) -> Result<Damage, Error> {
        let mut damage = Damage { sum: 0.0, most: 0.0, endures: true };
        for cycle in cycles {
            let range = cycle.range();
            damage.sum += least_zero(Argument::Count, cycle.count)? * by(range)?;
            damage.most = damage.most.max(range);
        }
        damage.endures = damage.most <= limit;
        least_zero(Argument::Factor, damage.sum)?;
        Ok(damage)
    }

    /// How often the history is borne; none if it does no damage.
    #[must_use]
    pub fn repeats(&self) -> Option<f64> {
        let repeats = 1.0 / self.sum;
        repeats.is_finite().then_some(repeats)
    }
}
