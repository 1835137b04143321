//! Forces of buffers.

use crate::Error;
use crate::error::{Argument, least_zero, positive, within};

/// Share of the rated speed at which a crane is taken to meet its end stops, v1 = 0.7 v.
///
/// # Source
/// EN 1991-3:2006, 2.11.1.
pub const SPEED: f64 = 0.7;

/// phi7 by the buffer characteristic xi: 1.25 up to 0.5, then 1.25 + 0.7 (xi - 0.5).
///
/// xi = (1/(F u)) times the work of the buffer over its stroke u with the end force F: 0.5 for a spring, 1 for a
/// constant force. The line above 0.5 is *not confirmed*.
///
/// # Errors
/// A characteristic outside 0..=1.
///
/// # Source
/// EN 1991-3:2006, 2.11.1, Table 2.10.
pub fn phi7(characteristic: f64) -> Result<f64, Error> {
    let beyond = (within(Argument::Share, characteristic, 0.0, 1.0)? - 0.5).max(0.0);
    Ok(1.25 + 0.7 * beyond)
}

/// H = phi7 v1 sqrt(m S) of both end stops together.
///
/// `factor` phi7; `speed` at which the crane meets them, v1; `mass` m of crane and load, the load only if it
/// cannot swing; `stiffness` S of all buffers that are met. Any consistent units. With `factor` = 1 the peak
/// force of a rigid mass against a spring.
///
/// # Errors
/// A number that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.11.1.
pub fn buffer_force(factor: f64, speed: f64, mass: f64, stiffness: f64) -> Result<f64, Error> {
    let mass = least_zero(Argument::Mass, mass)?;
    let stiffness = least_zero(Argument::Stiffness, stiffness)?;
    let speed = least_zero(Argument::Speed, speed)?;
    Ok(least_zero(Argument::Factor, factor)? * speed * (mass * stiffness).sqrt())
}

/// H = 0.1 (Q + T), buffers of a trolley whose load can swing. *Not confirmed.*
///
/// # Errors
/// A weight that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.11.2.
pub fn trolley_force(lifted: f64, trolley: f64) -> Result<f64, Error> {
    Ok(0.1 * (least_zero(Argument::Force, lifted)? + least_zero(Argument::Force, trolley)?))
}

/// F = m v^2/(2 eta s), the even share of a bumper's work over its stroke.
///
/// `mass` m without a load that can swing; `speed` v at contact; `stroke` s; `efficiency` eta, the mean force
/// over the end force: 0.5 for a spring, near 0.8 for a hydraulic bumper. Any consistent units.
///
/// # Errors
/// A mass or speed that is negative, a stroke that is not positive, an efficiency outside 0.001..=1.
///
/// # Source
/// Work and energy; so in AISC Design Guide 7 and, by it, AIST TR-13. Which share of the rated speed TR-13
/// takes is *not confirmed*; OSHA and CMAA take [`crate::osha::BUMPER_SPEED`].
pub fn stopping_force(mass: f64, speed: f64, stroke: f64, efficiency: f64) -> Result<f64, Error> {
    let mass = least_zero(Argument::Mass, mass)?;
    let speed = least_zero(Argument::Speed, speed)?;
    let stroke = positive(Argument::Length, stroke)?;
    let efficiency = within(Argument::Share, efficiency, 1e-3, 1.0)?;
    Ok(mass * speed * speed / (2.0 * efficiency * stroke))
}
