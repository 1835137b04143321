//! Crane loads of ASCE/SEI 7, section 4.9.

use crate::Error;
use crate::error::{Argument, non_negative};

/// How a crane is operated, by which ASCE 7 chooses the vertical impact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CraneOperation {
    /// Powered monorail cranes.
    Monorail,
    /// Powered bridge cranes that are operated from a cab or by remote control.
    Cab,
    /// Powered bridge cranes that are operated from a pendant.
    Pendant,
    /// Bridge or monorail cranes with hand-geared bridge, trolley and hoist.
    HandGeared,
}

impl CraneOperation {
    /// Vertical impact, as a fraction of the largest wheel loads: 0.25, 0.25, 0.10 and 0.
    ///
    /// # Source
    /// ASCE/SEI 7-16, 4.9.3; the same in ASCE/SEI 7-22.
    #[must_use]
    pub fn impact(self) -> f64 {
        match self {
            CraneOperation::Monorail | CraneOperation::Cab => 0.25,
            CraneOperation::Pendant => 0.10,
            CraneOperation::HandGeared => 0.0,
        }
    }
}

/// The lateral force 0.2 (Q + T) of a crane with a powered trolley, on both rails together.
///
/// `lifted` is the rated capacity Q, `trolley` the weight T of hoist and trolley, in any unit of force. It acts
/// at the traction surface of the runway beams, and the rails share it according to their lateral stiffness.
///
/// # Errors
/// [`Error::Range`] for a weight that is negative or not finite.
///
/// # Source
/// ASCE/SEI 7-16, 4.9.4.
pub fn lateral_force(lifted: f64, trolley: f64) -> Result<f64, Error> {
    Ok(0.2 * (non_negative(Argument::Force, lifted)? + non_negative(Argument::Force, trolley)?))
}

/// The longitudinal force of a crane with a powered bridge: 0.1 of the largest `wheels` loads of a rail without
/// impact, in their unit. It acts at the traction surface, in either direction.
///
/// # Errors
/// [`Error::Range`] for a load that is negative or not finite.
///
/// # Source
/// ASCE/SEI 7-16, 4.9.5.
pub fn longitudinal_force(wheels: &[f64]) -> Result<f64, Error> {
    wheels.iter().try_fold(0.0, |sum, load| {
        Ok(sum + 0.1 * non_negative(Argument::Force, *load)?)
    })
}
