//! Dynamic factors of EN 1991-3.

use crate::Error;
use crate::error::{Argument, non_negative, positive, within};

/// The dynamic factor phi1 on the dead weight of the crane when the load leaves the ground: lower and upper
/// value.
///
/// # Source
/// EN 1991-3:2006, Table 2.4: 0.9 < phi1 < 1.1, of which both limits are used.
pub const PHI1: [f64; 2] = [0.9, 1.1];

/// The dynamic factor phi4 on dead weight and lifted load while the crane travels, on rails within the
/// tolerances of EN 1993-6.
///
/// # Source
/// EN 1991-3:2006, Table 2.4.
pub const PHI4: f64 = 1.0;

/// The hoisting class, by how smoothly a load leaves the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum HoistingClass {
    /// HC1, the smoothest.
    Hc1,
    /// HC2.
    Hc2,
    /// HC3.
    Hc3,
    /// HC4, the most abrupt.
    Hc4,
}

impl HoistingClass {
    /// All classes in order.
    pub const ALL: [HoistingClass; 4] = [
        HoistingClass::Hc1,
        HoistingClass::Hc2,
        HoistingClass::Hc3,
        HoistingClass::Hc4,
    ];

    /// phi2,min, and beta2 in s/m.
    ///
    /// # Source
    /// EN 1991-3:2006, Table 2.5.
    #[must_use]
    pub fn values(self) -> [f64; 2] {
        match self {
            HoistingClass::Hc1 => [1.05, 0.17],
            HoistingClass::Hc2 => [1.10, 0.34],
            HoistingClass::Hc3 => [1.15, 0.51],
            HoistingClass::Hc4 => [1.20, 0.68],
        }
    }
}

/// The dynamic factor phi2 = phi2,min + beta2 v on the lifted load when it leaves the ground. `speed` is the
/// steady hoisting speed v, in m/s.
///
/// # Errors
/// [`Error::Range`] for a speed that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, Table 2.4 with Table 2.5.
///
/// ```
/// use practice::factor::{HoistingClass, phi2};
///
/// assert!((phi2(HoistingClass::Hc2, 0.2)? - 1.168).abs() < 1e-12);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn phi2(class: HoistingClass, speed: f64) -> Result<f64, Error> {
    let [least, slope] = class.values();
    Ok(least + slope * non_negative(Argument::Speed, speed)?)
}

/// How fast a part of the payload is released.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Release {
    /// Grabs and similar devices, beta3 = 0.5.
    Slow,
    /// Magnets and similar devices, beta3 = 1.
    Rapid,
}

/// The dynamic factor phi3 = 1 - (dm/m) (1 + beta3) on the lifted load when the part dm of its mass m is
/// released.
///
/// It is negative where the released rope would lift the hook.
///
/// # Errors
/// [`Error::Range`] for a `total` mass m that is not positive, or a `released` mass dm that is negative or
/// above m.
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
pub enum DriveOnset {
    /// No change, as for centrifugal forces.
    Steady,
    /// A smooth change.
    Smooth,
    /// A sudden change.
    Sudden,
    /// A change through considerable backlash.
    Backlash,
}

/// The dynamic factor phi5 on the forces of drives: the smallest and largest value.
///
/// The numbers are *not confirmed*, except the 1.5 of smooth drives.
///
/// # Source
/// EN 1991-3:2006, Table 2.6.
#[must_use]
pub fn phi5(onset: DriveOnset) -> [f64; 2] {
    match onset {
        DriveOnset::Steady => [1.0, 1.0],
        DriveOnset::Smooth => [1.0, 1.5],
        DriveOnset::Sudden => [1.5, 2.0],
        DriveOnset::Backlash => [3.0, 3.0],
    }
}

/// Smallest static test load as a multiple of the rated load; its dynamic factor phi6 is 1.
///
/// # Source
/// EN 1991-3:2006, 2.10, as used by a public program.
pub const STATIC_TEST: f64 = 1.25;

/// Smallest dynamic test load as a multiple of the rated load; its dynamic factor is [`phi6`].
///
/// # Source
/// EN 1991-3:2006, 2.10, as used by a public program.
pub const DYNAMIC_TEST: f64 = 1.1;

/// The larger of the static test load 1.25 Q and the dynamic one phi6 1.1 Q, as a multiple of the rated load Q.
///
/// # Errors
/// [`Error::Range`] for a factor phi2 below one or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.10.
///
/// ```
/// use practice::factor::test_load;
///
/// assert_eq!(test_load(1.168)?, 1.25, "the static test governs up to phi2 = 1.2727");
/// assert!((test_load(1.4)? - 1.2 * 1.1).abs() < 1e-12);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn test_load(phi2: f64) -> Result<f64, Error> {
    Ok((DYNAMIC_TEST * phi6(phi2)?).max(STATIC_TEST))
}

/// The dynamic factor phi6 = (1 + phi2)/2 on a dynamic test load of at least 110 % of the rated load.
///
/// On a static test load of at least 125 % phi6 is 1. The formula is that of a public program.
///
/// # Errors
/// [`Error::Range`] for a factor below one or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.10.
pub fn phi6(phi2: f64) -> Result<f64, Error> {
    Ok(0.5 * (1.0 + within(Argument::Factor, phi2, 1.0, 1e3)?))
}
