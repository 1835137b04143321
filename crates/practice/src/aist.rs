//! Values of AIST Technical Report 13.

use crate::Error;
use crate::cmaa::FOOT;
use crate::crane::Crane;
use crate::error::{Argument, least_zero, positive};

/// Kind of crane. Cab-operated and radio-operated cranes alike; pendant-operated ones have rules of their own
/// that are not here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Mill cranes.
    Mill,
    /// Ladle cranes; the row is *not confirmed*.
    Ladle,
    /// Clamshell-bucket and magnet cranes; the row is that of a public program by the draft of 2020.
    Bucket,
    /// Soaking-pit cranes; the row is *not confirmed*.
    SoakingPit,
    /// Stripping cranes, the share being of ingot and mould; the row is *not confirmed*.
    Stripping,
    /// Motor-room maintenance cranes and the like.
    MotorRoom,
    /// Cab-operated stacker cranes; the row is that of a public program by the draft of 2020.
    Stacker,
}

/// Shares of loads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shares {
    /// Vertical impact, of the largest wheel loads.
    pub impact: f64,
    /// Total side thrust, of the lifted load.
    pub lifted: f64,
    /// Total side thrust, of lifted load and trolley together.
    pub trolley: f64,
    /// Total side thrust, of lifted load and the whole crane together.
    pub crane: f64,
    /// Tractive force, of the largest loads of the driven wheels.
    pub traction: f64,
}

impl Kind {
    /// The row of the table, and the other two shares of the side thrust.
    ///
    /// # Source
    /// AIST TR-13 (2021), 3.7.2 with Table 3.2 (3.6.2 in the draft of 2020).
    #[must_use]
    pub fn shares(self) -> Shares {
        let usual = Shares { impact: 0.25, lifted: 0.4, trolley: 0.2, crane: 0.1, traction: 0.2 };
        match self {
            Kind::Mill | Kind::Ladle => usual,
            Kind::Bucket | Kind::SoakingPit | Kind::Stripping => Shares { lifted: 1.0, ..usual },
            Kind::MotorRoom => Shares { impact: 0.2, lifted: 0.3, ..usual },
            Kind::Stacker => Shares { lifted: 2.0, trolley: 0.4, crane: 0.15, ..usual },
        }
    }
}

/// The three side thrusts, of both rails together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thrusts {
    /// By the lifted load.
    pub lifted: f64,
    /// By lifted load and trolley.
    pub trolley: f64,
    /// By lifted load and the whole crane.
    pub crane: f64,
}

impl Thrusts {
    /// The largest, which counts; to be shared by the rails as their lateral stiffness demands.
    #[must_use]
    pub fn governing(&self) -> f64 {
        self.lifted.max(self.trolley).max(self.crane)
    }
}

/// Total side thrust of a crane, by all three rules.
///
/// # Errors
/// A weight that is negative or not finite.
///
/// # Source
/// AIST TR-13 (2021), 3.7.2.
pub fn side_thrust(kind: Kind, crane: &Crane) -> Result<Thrusts, Error> {
    let shares = kind.shares();
    let lifted = least_zero(Argument::Force, crane.lifted)?;
    let moving = lifted + least_zero(Argument::Force, crane.trolley)?;
    let all = moving + least_zero(Argument::Force, crane.bridge)?;
    Ok(Thrusts {
        lifted: shares.lifted * lifted,
        trolley: shares.trolley * moving,
        crane: shares.crane * all,
    })
}

/// Wheel load with impact.
///
/// # Errors
/// A load that is negative or not finite.
///
/// # Source
/// AIST TR-13 (2021), 3.7.2.
pub fn with_impact(kind: Kind, load: f64) -> Result<f64, Error> {
    Ok((1.0 + kind.shares().impact) * least_zero(Argument::Force, load)?)
}

/// Tractive force by the loads of the driven wheels, without impact.
///
/// # Errors
/// A load that is negative or not finite.
///
/// # Source
/// AIST TR-13 (2021), 3.7.2.
pub fn tractive_force(kind: Kind, driven: &[f64]) -> Result<f64, Error> {
    let share = kind.shares().traction;
    driven.iter().try_fold(0.0, |sum, load| Ok(sum + share * least_zero(Argument::Force, *load)?))
}

/// Class of a mill building by how often its members are loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Building {
    /// More than 500 000 times.
    A,
    /// 100 000 to 500 000 times.
    B,
    /// 20 000 to 100 000 times.
    C,
    /// Fewer.
    D,
}

/// Runway spans over vertical deflection: one crane, static, without impact.
///
/// # Source
/// AIST TR-13 (draft of 2020), 5.8.7.
#[must_use]
pub fn runway_vertical(building: Building) -> f64 {
    match building {
        Building::A | Building::B => 1000.0,
        Building::C | Building::D => 600.0,
    }
}

/// Runway spans over lateral deflection.
///
/// # Source
/// AIST TR-13 (draft of 2020), 5.8.7.
pub const RUNWAY_LATERAL: f64 = 400.0;

/// Sideways displacement of the frame at the runway that is accepted, in m: 1/400 of the `height` above the
/// base of the column, in m, or 2 in.
///
/// # Errors
/// A height that is not positive.
///
/// # Source
/// AIST TR-13 (2021), 5.3.
pub fn drift(height: f64) -> Result<f64, Error> {
    Ok((positive(Argument::Length, height)? / 400.0).min(FOOT / 6.0))
}
