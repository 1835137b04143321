//! Values of AIST Technical Report 13.

use super::cmaa::FOOT;
use super::crane::Crane;
use crate::Error;
use crate::error::{Argument, non_negative, positive};

/// The kind of a crane: one of the rows of the table, cab-operated or radio-operated, or pendant-operated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CraneKind {
    /// Mill cranes.
    Mill,
    /// Ladle cranes; the row is *not confirmed*.
    Ladle,
    /// Clamshell-bucket and magnet cranes; the row is that of a public program for the draft of 2020.
    Bucket,
    /// Soaking-pit cranes; the row is *not confirmed*.
    SoakingPit,
    /// Stripping cranes, whose lifted load is ingot and mould; the row is *not confirmed*.
    Stripping,
    /// Motor-room maintenance cranes and the like.
    MotorRoom,
    /// Cab-operated stacker cranes; the row is that of a public program for the draft of 2020.
    Stacker,
    /// Pendant-operated cranes of any service: impact 10 %, side thrust 10 % of lifted load, trolley and bridge
    /// together, traction 20 %.
    Pendant,
}

/// The fractions of loads that give impact, side thrust and traction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadFractions {
    /// Vertical impact, as a fraction of the largest wheel loads.
    pub impact: f64,
    /// Total side thrust, as a fraction of the lifted load.
    pub lifted: f64,
    /// Total side thrust, as a fraction of the lifted load and the trolley together.
    pub trolley: f64,
    /// Total side thrust, as a fraction of the lifted load and the whole crane together.
    pub crane: f64,
    /// Tractive force, as a fraction of the largest loads of the driven wheels.
    pub traction: f64,
}

impl CraneKind {
    /// The row of the table for this kind, with the other two fractions of the side thrust.
    ///
    /// # Source
    /// AIST TR-13 (2021), 3.7.2 with Table 3.2 (3.6.2 in the draft of 2020).
    #[must_use]
    pub fn fractions(self) -> LoadFractions {
        let usual = LoadFractions {
            impact: 0.25,
            lifted: 0.4,
            trolley: 0.2,
            crane: 0.1,
            traction: 0.2,
        };
        match self {
            CraneKind::Mill | CraneKind::Ladle => usual,
            CraneKind::Bucket | CraneKind::SoakingPit | CraneKind::Stripping => LoadFractions {
                lifted: 1.0,
                ..usual
            },
            CraneKind::MotorRoom => LoadFractions {
                impact: 0.2,
                lifted: 0.3,
                ..usual
            },
            CraneKind::Stacker => LoadFractions {
                lifted: 2.0,
                trolley: 0.4,
                crane: 0.15,
                ..usual
            },
            CraneKind::Pendant => LoadFractions {
                impact: 0.1,
                lifted: 0.0,
                trolley: 0.0,
                ..usual
            },
        }
    }
}

/// The total side thrust by each of the three rules, on both rails together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thrusts {
    /// By the rule for the lifted load.
    pub lifted: f64,
    /// By the rule for lifted load and trolley.
    pub trolley: f64,
    /// By the rule for lifted load and the whole crane.
    pub crane: f64,
}

impl Thrusts {
    /// The largest of the three, which governs. The rails share it according to their lateral stiffness.
    #[must_use]
    pub fn governing(&self) -> f64 {
        self.lifted.max(self.trolley).max(self.crane)
    }
}

/// The total side thrust of a crane by all three rules, in the unit of its weights.
///
/// # Errors
/// [`Error::Range`] for a weight that is negative or not finite.
///
/// # Source
/// AIST TR-13 (2021), 3.7.2.
pub fn side_thrust(kind: CraneKind, crane: &Crane) -> Result<Thrusts, Error> {
    let fractions = kind.fractions();
    let lifted = non_negative(Argument::Force, crane.lifted)?;
    let moving = lifted + non_negative(Argument::Force, crane.trolley)?;
    let all = moving + non_negative(Argument::Force, crane.bridge)?;
    Ok(Thrusts {
        lifted: fractions.lifted * lifted,
        trolley: fractions.trolley * moving,
        crane: fractions.crane * all,
    })
}

/// The wheel load with vertical impact, in the unit of `load`.
///
/// # Errors
/// [`Error::Range`] for a load that is negative or not finite.
///
/// # Source
/// AIST TR-13 (2021), 3.7.2.
pub fn with_impact(kind: CraneKind, load: f64) -> Result<f64, Error> {
    Ok((1.0 + kind.fractions().impact) * non_negative(Argument::Force, load)?)
}

/// The tractive force from the loads of the driven wheels without impact, in their unit.
///
/// # Errors
/// [`Error::Range`] for a load that is negative or not finite.
///
/// # Source
/// AIST TR-13 (2021), 3.7.2.
pub fn tractive_force(kind: CraneKind, driven: &[f64]) -> Result<f64, Error> {
    let fraction = kind.fractions().traction;
    driven.iter().try_fold(0.0, |sum, load| {
        Ok(sum + fraction * non_negative(Argument::Force, *load)?)
    })
}

/// The class of a mill building, by the number of load cycles of its members.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum BuildingClass {
    /// More than 500 000 cycles.
    A,
    /// 100 000 to 500 000 cycles.
    B,
    /// 20 000 to 100 000 cycles.
    C,
    /// Fewer than 20 000 cycles.
    D,
}

/// Smallest ratio of the runway span to its vertical deflection under one crane, static and without impact.
///
/// # Source
/// AIST TR-13 (draft of 2020), 5.8.7.
#[must_use]
pub fn runway_vertical(building: BuildingClass) -> f64 {
    match building {
        BuildingClass::A | BuildingClass::B => 1000.0,
        BuildingClass::C | BuildingClass::D => 600.0,
    }
}

/// Smallest ratio of the runway span to its lateral deflection.
///
/// # Source
/// AIST TR-13 (draft of 2020), 5.8.7.
pub const RUNWAY_LATERAL: f64 = 400.0;

/// The largest lateral displacement of the building frame at the runway, in m: 1/400 of the `height` above
/// the base of the column, in m, and at most 2 in.
///
/// # Errors
/// [`Error::Range`] for a height that is not positive.
///
/// # Source
/// AIST TR-13 (2021), 5.3.
pub fn drift(height: f64) -> Result<f64, Error> {
    Ok((positive(Argument::Length, height)? / 400.0).min(FOOT / 6.0))
}
