//! Damage-equivalent wheel loads of EN 1991-3.

use crate::Error;
use crate::error::{Argument, least_zero};

/// Class of fatigue actions, S0 to S9.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Duty(u8);

/// lambda of S0 to S9 for normal stresses.
const NORMAL: [f64; 10] = [0.198, 0.250, 0.315, 0.397, 0.500, 0.630, 0.794, 1.000, 1.260, 1.587];

/// lambda of S0 to S9 for shear stresses.
const SHEAR: [f64; 10] = [0.379, 0.436, 0.500, 0.575, 0.660, 0.758, 0.871, 1.000, 1.149, 1.320];

impl Duty {
    /// The class S`index`; none beyond S9.
    #[must_use]
    pub fn new(index: u8) -> Option<Duty> {
        (usize::from(index) < NORMAL.len()).then_some(Duty(index))
    }

    /// lambda for normal stresses.
    ///
    /// # Source
    /// EN 1991-3:2006, Table 2.12.
    #[must_use]
    pub fn normal(self) -> f64 {
        NORMAL[usize::from(self.0)]
    }

    /// lambda for shear stresses.
    ///
    /// # Source
    /// EN 1991-3:2006, Table 2.12.
    #[must_use]
    pub fn shear(self) -> f64 {
        SHEAR[usize::from(self.0)]
    }
}

/// phi_fat = (1 + phi)/2, with phi1 for the dead weight, phi2 for the lifted load.
///
/// # Errors
/// A factor that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.12.1.
pub fn fatigue_factor(phi: f64) -> Result<f64, Error> {
    Ok(0.5 * (1.0 + least_zero(Argument::Factor, phi)?))
}

/// Q_e = phi_fat lambda Q_max, the load that does at 2 million cycles what the service of its class does.
///
/// # Errors
/// A number that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.12.1.
pub fn equivalent_load(most: f64, lambda: f64, factor: f64) -> Result<f64, Error> {
    Ok(least_zero(Argument::Factor, factor)?
        * least_zero(Argument::Factor, lambda)?
        * least_zero(Argument::Force, most)?)
}
