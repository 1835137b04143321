//! Fatigue strength curves and accumulated damage by EN 1993-1-9.

use super::rainflow::Cycle;
use crate::Error;
use crate::error::{Argument, non_negative, positive};

/// The number of cycles at which the reference strength is given.
pub const REFERENCE_CYCLES: f64 = 2e6;

/// The number of cycles at the constant-amplitude fatigue limit.
pub const LIMIT_CYCLES: f64 = 5e6;

/// The number of cycles at the cut-off limit.
pub const CUT_OFF_CYCLES: f64 = 1e8;

/// The detail categories for direct stress, in N/mm2.
///
/// # Source
/// EN 1993-1-9:2005, Figure 7.1.
pub const CATEGORIES: [f64; 14] = [
    36.0, 40.0, 45.0, 50.0, 56.0, 63.0, 71.0, 80.0, 90.0, 100.0, 112.0, 125.0, 140.0, 160.0,
];

/// The kind of stress of a detail category.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stress {
    /// Direct stress: slope 3 up to 5 million cycles, slope 5 up to 100 million, no damage below the cut-off.
    Direct,
    /// Shear stress: slope 5 up to 100 million cycles, no damage below the cut-off.
    Shear,
}

/// A fatigue strength curve: the number of cycles to failure by the range of nominal stress.
///
/// ```
/// use practice::fatigue::{REFERENCE_CYCLES, Strength, Stress};
///
/// let strength = Strength::new(Stress::Direct, 80.0, 1.0, 1.0)?;
/// assert!((strength.damage(80.0)? * REFERENCE_CYCLES - 1.0).abs() < 1e-12);
/// assert_eq!(strength.damage(30.0)?, 0.0);
/// # Ok::<(), practice::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength {
    stress: Stress,
    reference: f64,
}

impl Strength {
    /// The curve of a detail category, divided by the partial factors gamma_Ff (`loads`) and gamma_Mf
    /// (`material`), so that stress ranges are compared with it without factors. `category` and ranges are in
    /// the same unit of stress.
    ///
    /// # Errors
    /// [`Error::Range`] for a category or factor that is not positive.
    ///
    /// # Source
    /// EN 1993-1-9:2005, 7.1 and A.5.
    pub fn new(
        stress: Stress,
        category: f64,
        loads: f64,
        material: f64,
    ) -> Result<Strength, Error> {
        let category = positive(Argument::Range, category)?;
        let loads = positive(Argument::Partial, loads)?;
        let material = positive(Argument::Partial, material)?;
        let reference = positive(Argument::Range, category / loads / material)?;
        Ok(Strength { stress, reference })
    }

    /// The reference strength: the range whose life is [`REFERENCE_CYCLES`] cycles.
    #[must_use]
    pub fn reference(&self) -> f64 {
        self.reference
    }

    /// The range below which a history does no damage if none of its ranges is larger: (2/5)^(1/3) = 0.737 of
    /// the reference strength for direct stress, the cut-off limit for shear.
    #[must_use]
    pub fn fatigue_limit(&self) -> f64 {
        match self.stress {
            Stress::Direct => self.reference * (REFERENCE_CYCLES / LIMIT_CYCLES).cbrt(),
            Stress::Shear => self.cut_off(),
        }
    }

    /// The cut-off limit, up to which a range does no damage: (5/100)^(1/5) = 0.549 of the fatigue limit for
    /// direct stress, (2/100)^(1/5) = 0.457 of the reference strength for shear.
    #[must_use]
    pub fn cut_off(&self) -> f64 {
        match self.stress {
            Stress::Direct => self.fatigue_limit() * (LIMIT_CYCLES / CUT_OFF_CYCLES).powf(0.2),
            Stress::Shear => self.reference * (REFERENCE_CYCLES / CUT_OFF_CYCLES).powf(0.2),
        }
    }

    /// The damage 1/N of one cycle; zero at and below the cut-off limit.
    ///
    /// For direct stress N = 2e6 (reference/range)^3 down to the fatigue limit and 5e6 (limit/range)^5 below
    /// it; for shear N = 2e6 (reference/range)^5. The standard gives the curves from 1e4 cycles on; for fewer
    /// cycles they are extended.
    ///
    /// # Errors
    /// [`Error::Range`] for a range that is negative or not finite.
    ///
    /// # Source
    /// EN 1993-1-9:2005, 7.1.
    pub fn damage(&self, range: f64) -> Result<f64, Error> {
        let range = non_negative(Argument::Range, range)?;
        let limit = self.fatigue_limit();
        Ok(if range <= self.cut_off() {
            0.0
        } else if self.stress == Stress::Shear {
            (range / self.reference).powi(5) / REFERENCE_CYCLES
        } else if range < limit {
            (range / limit).powi(5) / LIMIT_CYCLES
        } else {
            (range / self.reference).powi(3) / REFERENCE_CYCLES
        })
    }

    /// Miner's sum D = sum n/N over the cycles of a history.
    ///
    /// # Errors
    /// [`Error::Range`] for a cycle whose range or count is negative or not finite.
    ///
    /// # Source
    /// EN 1993-1-9:2005, A.5 (Palmgren and Miner).
    pub fn miner(&self, cycles: &[Cycle]) -> Result<Damage, Error> {
        Damage::of(cycles, self.fatigue_limit(), |range| self.damage(range))
    }

    /// The equivalent constant range, which does the damage `sum` in [`REFERENCE_CYCLES`] cycles: the reference
    /// strength times sum^(1/3), or sum^(1/5) for shear. It is at most the reference strength exactly when
    /// the sum is at most one.
    ///
    /// # Errors
    /// [`Error::Range`] for a sum that is negative or not finite.
    ///
    /// # Source
    /// EN 1993-1-9:2005, 1.3 and A.6: the equivalent range related to 2 million cycles.
    pub fn equivalent(&self, sum: f64) -> Result<f64, Error> {
        let sum = non_negative(Argument::Factor, sum)?;
        Ok(self.reference
            * match self.stress {
                Stress::Direct => sum.cbrt(),
                Stress::Shear => sum.powf(0.2),
            })
    }
}

/// The damage of the cycles of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Damage {
    /// Miner's sum; failure is predicted at one.
    pub sum: f64,
    /// The largest range of the history.
    pub largest_range: f64,
    /// Whether no range is above the fatigue limit. The damage may then be taken as zero although the sum is
    /// not.
    pub below_limit: bool,
}

impl Damage {
    /// The sum of count times `by(range)` over all cycles, with the fatigue limit `limit`.
    pub(crate) fn of(
        cycles: &[Cycle],
        limit: f64,
        by: impl Fn(f64) -> Result<f64, Error>,
    ) -> Result<Damage, Error> {
        let mut damage = Damage {
            sum: 0.0,
            largest_range: 0.0,
            below_limit: true,
        };
        for cycle in cycles {
            let range = cycle.range();
            damage.sum += non_negative(Argument::Count, cycle.count)? * by(range)?;
            damage.largest_range = damage.largest_range.max(range);
        }
        damage.below_limit = damage.largest_range <= limit;
        non_negative(Argument::Factor, damage.sum)?;
        Ok(damage)
    }

    /// The number of repetitions of the history to failure, 1/sum; `None` if it does no damage.
    #[must_use]
    pub fn repeats(&self) -> Option<f64> {
        let repeats = 1.0 / self.sum;
        repeats.is_finite().then_some(repeats)
    }
}
