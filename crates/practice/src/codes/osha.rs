//! Values of 29 CFR 1910.179 (OSHA), with arguments in SI.

use crate::Error;
use crate::error::{Argument, non_negative};

/// Fraction of the rated speed at which bumpers must be able to stop a crane.
///
/// # Source
/// 29 CFR 1910.179(e)(2).
pub const BUMPER_SPEED: f64 = 0.4;

/// The largest distance, in m, within which brakes must stop a bridge or trolley from its full-load `speed`
/// in m/s.
///
/// The rule gives the distance in feet as 10 % of the speed in feet per minute. This is the distance covered
/// in 6 s at that speed, and corresponds to a mean deceleration of at least v/(12 s).
///
/// # Errors
/// [`Error::Range`] for a speed that is negative or not finite.
///
/// # Source
/// 29 CFR 1910.179(f)(4)(vii); the same in CMAA 70-1983, 4.9.3 and 4.9.4.
pub fn brake_distance(speed: f64) -> Result<f64, Error> {
    Ok(6.0 * non_negative(Argument::Speed, speed)?)
}
