//! Buffer forces of EN 1991-3, and the work of a bumper.

use crate::Error;
use crate::error::{Argument, non_negative, positive, within};

/// Fraction of the rated speed v at which a crane is assumed to meet its end stops: v1 = 0.7 v.
///
/// # Source
/// EN 1991-3:2006, 2.11.1.
pub const END_STOP_SPEED: f64 = 0.7;

/// The dynamic factor phi7 by the buffer characteristic xi: 1.25 up to 0.5, then 1.25 + 0.7 (xi - 0.5).
///
/// xi is the work of the buffer over its stroke u, divided by F u with the force F at the end of the stroke:
/// 0.5 for a spring, 1 for a constant force. The line above 0.5 is *not confirmed*.
///
/// # Errors
/// [`Error::Range`] for a characteristic outside 0 to 1.
///
/// # Source
/// EN 1991-3:2006, 2.11.1, Table 2.10.
pub fn phi7(characteristic: f64) -> Result<f64, Error> {
    let beyond = (within(Argument::Fraction, characteristic, 0.0, 1.0)? - 0.5).max(0.0);
    Ok(1.25 + 0.7 * beyond)
}

/// The buffer force H = phi7 v1 sqrt(m S) on both end stops together.
///
/// `factor` is phi7; `speed` is v1, at which the crane meets the end stops; `mass` m is that of the crane,
/// with the load only if it cannot swing; `stiffness` S is that of all buffers together. Any consistent
/// units. With a factor of one it is the peak force of a rigid mass against a spring.
///
/// # Errors
/// [`Error::Range`] for a number that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.11.1.
pub fn buffer_force(factor: f64, speed: f64, mass: f64, stiffness: f64) -> Result<f64, Error> {
    let mass = non_negative(Argument::Mass, mass)?;
    let stiffness = non_negative(Argument::Stiffness, stiffness)?;
    let speed = non_negative(Argument::Speed, speed)?;
    Ok(non_negative(Argument::Factor, factor)? * speed * (mass * stiffness).sqrt())
}

/// The buffer force H_B,2 = 0.1 (Q + T) of a trolley whose load can swing.
///
/// `lifted` is Q and `trolley` is T with its lifting attachment, in any unit of force. By 2.7.5 the same force
/// covers the acceleration and braking of the trolley.
///
/// # Errors
/// [`Error::Range`] for a weight that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.11.2.
pub fn trolley_force(lifted: f64, trolley: f64) -> Result<f64, Error> {
    Ok(0.1 * (non_negative(Argument::Force, lifted)? + non_negative(Argument::Force, trolley)?))
}

/// The largest force F = m v^2/(2 eta s) of a bumper that stops a mass within its stroke.
///
/// `mass` m is without a load that can swing; `speed` v is that at contact; `stroke` s; `efficiency` eta is
/// the ratio of the mean force to the largest force: 0.5 for a spring, about 0.8 for a hydraulic bumper. Any
/// consistent units.
///
/// # Errors
/// [`Error::Range`] for a mass or speed that is negative, a stroke that is not positive, or an efficiency
/// outside 0.001 to 1.
///
/// # Source
/// Balance of work and energy, as in AISC Design Guide 7 and, by reference to it, in AIST TR-13. The fraction
/// of the rated speed that TR-13 takes is *not confirmed*; OSHA and CMAA take [`crate::osha::BUMPER_SPEED`].
pub fn stopping_force(mass: f64, speed: f64, stroke: f64, efficiency: f64) -> Result<f64, Error> {
    let mass = non_negative(Argument::Mass, mass)?;
    let speed = non_negative(Argument::Speed, speed)?;
    let stroke = positive(Argument::Length, stroke)?;
    let efficiency = within(Argument::Fraction, efficiency, 1e-3, 1.0)?;
    Ok(mass * speed * speed / (2.0 * efficiency * stroke))
}
