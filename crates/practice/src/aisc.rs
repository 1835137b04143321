//! Fatigue strength of AISC 360, Appendix 3, which AIST TR-13 refers to.

use crate::Error;
use crate::error::{Argument, least_zero, positive};
use crate::fatigue::{Damage, REFERENCE};
use crate::rainflow::Cycle;

/// Stress category of a detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Category {
    /// Plain material.
    A,
    /// Built-up members with continuous welds.
    B,
    /// B'.
    BPrime,
    /// Stiffeners and short attachments.
    C,
    /// Attachments of medium length.
    D,
    /// Long attachments, ends of cover plates.
    E,
    /// E'.
    EPrime,
}

impl Category {
    /// All, with their words.
    pub const ALL: [(&'static str, Category); 7] = [
        ("A", Category::A),
        ("B", Category::B),
        ("B'", Category::BPrime),
        ("C", Category::C),
        ("D", Category::D),
        ("E", Category::E),
        ("E'", Category::EPrime),
    ];

    /// C_f, and the threshold F_TH in ksi. Those of E and E' are as a public program has them: 11e8 and 3.9e8, 31 and
    /// 18 N/mm2.
    ///
    /// # Source
    /// AISC 360-16, Table.
    #[must_use]
    pub fn values(self) -> [f64; 2] {
        match self {
            Category::A => [25.0, 24.0],
            Category::B => [12.0, 16.0],
            Category::BPrime => [6.1, 12.0],
            Category::C => [4.4, 10.0],
            Category::D => [2.2, 7.0],
            Category::E => [1.1, 4.5],
            Category::EPrime => [0.39, 2.6],
        }
    }
}

/// A fatigue strength curve in any unit of stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    category: Category,
    /// One ksi in the unit of the ranges.
    ksi: f64,
}

impl Curve {
    /// The curve of a category, with one `ksi` in the unit of the ranges.
    ///
    /// # Errors
    /// A unit that is not positive.
    pub fn new(category: Category, ksi: f64) -> Result<Curve, Error> {
        Ok(Curve { category, ksi: positive(Argument::Range, ksi)? })
    }

    /// The range that is borne [`REFERENCE`] times on the sloping line, without the threshold.
    #[must_use]
    pub fn reference(&self) -> f64 {
        (self.category.values()[0] * 1e9 / REFERENCE).cbrt() * self.ksi
    }

    /// F_TH: if no range is larger, none does damage.
    #[must_use]
    pub fn limit(&self) -> f64 {
        self.category.values()[1] * self.ksi
    }

    /// Damage of one cycle on the sloping line, 1/N with N = 1e9 C_f/F^3, F in ksi: F_SR = 1000 (C_f/n)^(1/3).
    ///
    /// # Errors
    /// A range that is negative or not finite.
    ///
    /// # Source
    /// AISC 360-16, A-3-1 (the exponent 0.333 there taken as 1/3).
    pub fn damage(&self, range: f64) -> Result<f64, Error> {
        let range = least_zero(Argument::Range, range)? / self.ksi;
        Ok(range.powi(3) / (self.category.values()[0] * 1e9))
    }

    /// The sum of damages of a history; the sloping line goes on below the threshold, since larger ranges may be among them.
    ///
    /// # Errors
    /// A cycle whose range or count is negative or not finite.
    pub fn miner(&self, cycles: &[Cycle]) -> Result<Damage, Error> {
        Damage::of(cycles, self.limit(), |range| self.damage(range))
    }

    /// The constant range that does the damage `sum` in [`REFERENCE`] cycles.
    ///
    /// # Errors
    /// A sum that is negative or not finite.
    pub fn equivalent(&self, sum: f64) -> Result<f64, Error> {
        Ok(self.reference() * least_zero(Argument::Factor, sum)?.cbrt())
    }
}
