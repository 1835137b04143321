//! Fatigue strength of AISC 360, Appendix 3, which AIST TR-13 refers to.

use super::rainflow::Cycle;
use super::strength::{Damage, REFERENCE_CYCLES};
use crate::Error;
use crate::error::{Argument, non_negative, positive};

/// The stress category of a detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AiscCategory {
    /// Plain material.
    A,
    /// Built-up members with continuous welds.
    B,
    /// Category B'.
    BPrime,
    /// Stiffeners and short attachments.
    C,
    /// Attachments of medium length.
    D,
    /// Long attachments, ends of cover plates.
    E,
    /// Category E'.
    EPrime,
}

impl AiscCategory {
    /// All categories with their names.
    pub const ALL: [(&'static str, AiscCategory); 7] = [
        ("A", AiscCategory::A),
        ("B", AiscCategory::B),
        ("B'", AiscCategory::BPrime),
        ("C", AiscCategory::C),
        ("D", AiscCategory::D),
        ("E", AiscCategory::E),
        ("E'", AiscCategory::EPrime),
    ];

    /// The constant C_f, and the threshold F_TH in ksi. The values of E and E' are those of a public program:
    /// 11e8 and
    /// 3.9e8, 31 and 18 N/mm2.
    ///
    /// # Source
    /// AISC 360-16, Table A-3.1.
    #[must_use]
    pub fn values(self) -> [f64; 2] {
        match self {
            AiscCategory::A => [25.0, 24.0],
            AiscCategory::B => [12.0, 16.0],
            AiscCategory::BPrime => [6.1, 12.0],
            AiscCategory::C => [4.4, 10.0],
            AiscCategory::D => [2.2, 7.0],
            AiscCategory::E => [1.1, 4.5],
            AiscCategory::EPrime => [0.39, 2.6],
        }
    }
}

/// A fatigue strength curve of AISC 360: N = 1e9 C_f/F^3 cycles of the range F in ksi.
///
/// ```
/// use practice::aisc::{AiscCategory, AiscCurve};
///
/// // Ranges in N/mm2; 1 ksi is 6.894757 N/mm2.
/// let curve = AiscCurve::new(AiscCategory::C, 6.894757)?;
/// assert!((curve.damage(curve.limit())? * 4.4e6 - 1.0).abs() < 1e-12);
/// # Ok::<(), practice::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AiscCurve {
    category: AiscCategory,
    /// One ksi in the unit of stress of the ranges.
    ksi: f64,
}

impl AiscCurve {
    /// The curve of a category. `ksi` is one ksi in the unit of stress of the ranges, above zero.
    ///
    /// # Errors
    /// [`Error::Range`] for a `ksi` that is not positive.
    pub fn new(category: AiscCategory, ksi: f64) -> Result<AiscCurve, Error> {
        Ok(AiscCurve {
            category,
            ksi: positive(Argument::Range, ksi)?,
        })
    }

    /// The range whose life on the sloping line is [`REFERENCE_CYCLES`] cycles; the threshold is disregarded.
    #[must_use]
    pub fn reference(&self) -> f64 {
        (self.category.values()[0] * 1e9 / REFERENCE_CYCLES).cbrt() * self.ksi
    }

    /// F_TH: if no range of a history is larger, the history does no damage.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.category.values()[1] * self.ksi
    }

    /// The damage 1/N of one cycle on the sloping line, N = 1e9 C_f/F^3 with F in ksi, which is
    /// F_SR = 1000 (C_f/n)^(1/3).
    ///
    /// # Errors
    /// [`Error::Range`] for a range that is negative or not finite.
    ///
    /// # Source
    /// AISC 360-16, equation A-3-1, whose exponent 0.333 is taken as 1/3.
    pub fn damage(&self, range: f64) -> Result<f64, Error> {
        let range = non_negative(Argument::Range, range)? / self.ksi;
        Ok(range.powi(3) / (self.category.values()[0] * 1e9))
    }

    /// Miner's sum of a history. The sloping line continues below the threshold, because larger ranges may
    /// occur too.
    ///
    /// # Errors
    /// [`Error::Range`] for a cycle whose range or count is negative or not finite.
    pub fn miner(&self, cycles: &[Cycle]) -> Result<Damage, Error> {
        Damage::of(cycles, self.limit(), |range| self.damage(range))
    }

    /// The constant range that does the damage `sum` in [`REFERENCE_CYCLES`] cycles.
    ///
    /// # Errors
    /// [`Error::Range`] for a sum that is negative or not finite.
    pub fn equivalent(&self, sum: f64) -> Result<f64, Error> {
        Ok(self.reference() * non_negative(Argument::Factor, sum)?.cbrt())
    }
}
