//! Dynamic factors of EN 1991-3.

use crate::Error;
use crate::error::{Argument, least_zero, positive, within};

/// phi1 on the dead weight of the crane when the load leaves the ground: the lower and the upper value.
///
/// # Source
/// EN 1991-3:2006, Table 2.4: 0.9 < phi1 < 1.1, both ends to be taken.
pub const PHI1: [f64; 2] = [0.9, 1.1];

/// phi4 on dead weight and lifted load while the crane travels, where the rails keep the tolerances of EN 1993-6.
///
/// # Source
/// EN 1991-3:2006, Table 2.4.
pub const PHI4: f64 = 1.0;

/// Hoisting class: how gently a load leaves the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Hoisting {
    /// Gentlest.
    Hc1,
    /// Medium.
    Hc2,
    /// Hard.
    Hc3,
    /// Hardest.
    Hc4,
}

impl Hoisting {
    /// All four, in order.
    pub const ALL: [Hoisting; 4] = [Hoisting::Hc1, Hoisting::Hc2, Hoisting::Hc3, Hoisting::Hc4];

    /// phi2,min and beta2 in s/m.
    ///
    /// # Source
    /// EN 1991-3:2006, Table 2.5.
    #[must_use]
    pub fn values(self) -> [f64; 2] {
        match self {
            Hoisting::Hc1 => [1.05, 0.17],
            Hoisting::Hc2 => [1.10, 0.34],
            Hoisting::Hc3 => [1.15, 0.51],
            Hoisting::Hc4 => [1.20, 0.68],
        }
    }
}

/// phi2 = phi2,min + beta2 v on the lifted load when it leaves the ground; v, steady hoisting speed, in m/s.
///
/// # Errors
/// A speed that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, Table 2.4 with Table 2.5.
pub fn phi2(class: Hoisting, speed: f64) -> Result<f64, Error> {
    let [least, slope] = class.values();
    Ok(least + slope * least_zero(Argument::Speed, speed)?)
}

/// How fast a part of the payload lets go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Release {
    /// Grabs and the like, beta3 = 0.5.
    Slow,
    /// Magnets and the like, beta3 = 1.
    Rapid,
}

/// phi3 = 1 - (dm/m) (1 + beta3) on the lifted load when the part dm of its mass m is let go.
///
/// Negative where the rope would throw the hook up. The formula is *not confirmed*.
///
/// # Errors
/// A total mass that is not positive; a part that is negative or more than the whole.
///
/// # Source
/// EN 1991-3:2006, Table 2.4.
pub fn phi3(released: f64, total: f64, release: Release) -> Result<f64, Error> {
    let total = positive(Argument::Mass, total)?;
    let released = within(Argument::Mass, released, 0.0, total)?;
    let beta = match release {
        Release::Slow => 0.5,
        Release::Rapid => 1.0,
    };
    Ok(1.0 - released / total * (1.0 + beta))
}

/// How the forces of a drive change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Onset {
    /// Not at all: centrifugal forces.
    Steady,
    /// Smoothly.
    Smooth,
    /// Suddenly.
    Sudden,
    /// Through much backlash.
    Backlash,
}

/// phi5 on forces of drives: the least and the most to be taken.
///
/// The numbers are *not confirmed*, but for the 1.5 of smooth drives.
///
/// # Source
/// EN 1991-3:2006, Table 2.6.
#[must_use]
pub fn phi5(onset: Onset) -> [f64; 2] {
    match onset {
        Onset::Steady => [1.0, 1.0],
        Onset::Smooth => [1.0, 1.5],
        Onset::Sudden => [1.5, 2.0],
        Onset::Backlash => [3.0, 3.0],
    }
}

/// phi6 = (1 + phi2)/2 on a dynamic test load of at least 110 % of the rated load. On a static one, of at least
/// 125 %, phi6 is 1. The formula is as a public program has it.
///
/// # Errors
/// A factor below one or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.10.
pub fn phi6(phi2: f64) -> Result<f64, Error> {
    Ok(0.5 * (1.0 + within(Argument::Factor, phi2, 1.0, 1e3)?))
}
