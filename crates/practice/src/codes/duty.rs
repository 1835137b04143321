//! Damage-equivalent fatigue loads of EN 1991-3.

use crate::Error;
use crate::error::{Argument, non_negative};

/// A class of fatigue actions, S0 to S9.
///
/// ```
/// use practice::duty::{FatigueClass, equivalent_load, fatigue_factor};
///
/// let class = FatigueClass::new(5).expect("S5");
/// let load = equivalent_load(160.0, class.normal(), fatigue_factor(1.1)?)?;
/// assert!((load - 105.84).abs() < 1e-9);
/// # Ok::<(), practice::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FatigueClass(u8);

/// Damage-equivalent factors lambda of S0 to S9 for normal stresses.
const NORMAL: [f64; 10] = [
    0.198, 0.250, 0.315, 0.397, 0.500, 0.630, 0.794, 1.000, 1.260, 1.587,
];

/// Damage-equivalent factors lambda of S0 to S9 for shear stresses.
const SHEAR: [f64; 10] = [
    0.379, 0.436, 0.500, 0.575, 0.660, 0.758, 0.871, 1.000, 1.149, 1.320,
];

impl FatigueClass {
    /// The class S`index`; `None` beyond S9.
    #[must_use]
    pub fn new(index: u8) -> Option<FatigueClass> {
        (usize::from(index) < NORMAL.len()).then_some(FatigueClass(index))
    }

    /// The damage-equivalent factor lambda for normal stresses.
    ///
    /// # Source
    /// EN 1991-3:2006, Table 2.12.
    #[must_use]
    pub fn normal(self) -> f64 {
        NORMAL[usize::from(self.0)]
    }

    /// The damage-equivalent factor lambda for shear stresses.
    ///
    /// # Source
    /// EN 1991-3:2006, Table 2.12.
    #[must_use]
    pub fn shear(self) -> f64 {
        SHEAR[usize::from(self.0)]
    }
}

/// The dynamic factor of fatigue phi_fat = (1 + phi)/2, with phi1 for the dead weight and phi2 for the lifted
/// load.
///
/// # Errors
/// [`Error::Range`] for a factor that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.12.1.
pub fn fatigue_factor(phi: f64) -> Result<f64, Error> {
    Ok(0.5 * (1.0 + non_negative(Argument::Factor, phi)?))
}

/// The damage-equivalent load Q_e = phi_fat lambda Q_max: 2 million cycles of it do the same damage as the
/// service of the class. `most` is Q_max in any unit of force, `lambda` the factor of the class, `factor` is
/// phi_fat.
///
/// # Errors
/// [`Error::Range`] for a number that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.12.1.
pub fn equivalent_load(most: f64, lambda: f64, factor: f64) -> Result<f64, Error> {
    Ok(non_negative(Argument::Factor, factor)?
        * non_negative(Argument::Factor, lambda)?
        * non_negative(Argument::Force, most)?)
}
