//! Values of CMAA 70, arguments in SI.
//!
//! Clauses by the edition of 2010 where known, else by that of 1983.

use crate::Error;
use crate::error::{Argument, least_zero, positive};

/// Metres in a foot.
pub(crate) const FOOT: f64 = 0.3048;

/// Feet per minute of a speed in m/s.
pub(crate) fn feet_per_minute(speed: f64) -> f64 {
    speed * 60.0 / FOOT
}

/// Runway spans over vertical deflection under the largest wheel loads without impact.
///
/// # Source
/// CMAA 70-2010, 1.4.6.
pub const RUNWAY_VERTICAL: f64 = 600.0;

/// Runway spans over lateral deflection under [`RUNWAY_SIDE`] of the largest wheel loads without impact.
///
/// # Source
/// CMAA 70-2010, 1.4.6.
pub const RUNWAY_LATERAL: f64 = 400.0;

/// Share of the largest wheel loads that acts sideways when the lateral deflection is judged.
///
/// # Source
/// CMAA 70-2010, 1.4.6.
pub const RUNWAY_SIDE: f64 = 0.1;

/// Deflection of a bridge girder over its span under trolley and rated load, without impact.
///
/// # Source
/// CMAA 70-1983, 3.5.5.
pub const BRIDGE: f64 = 0.001125;

/// Hoist load factor of bucket and magnet cranes.
///
/// # Source
/// CMAA 70-1983, 3.3.2.1.1.4.2.
pub const BUCKET: f64 = 0.5;

/// Share of the rated speed at which cranes and trolleys meet their bumpers.
///
/// # Source
/// CMAA 70-1983, 3.3.2.1.3.2.
pub const COLLISION_SPEED: f64 = 0.4;

/// HLF: 0.5 % per ft/min of hoisting speed, 15 to 50 %; the lifted load acts as 1 + HLF. `speed` in m/s.
///
/// # Errors
/// A speed that is negative or not finite.
///
/// # Source
/// CMAA 70-2010, 3.3.2.1.4.2.
pub fn hoist_load_factor(speed: f64) -> Result<f64, Error> {
    Ok((0.005 * feet_per_minute(least_zero(Argument::Speed, speed)?)).clamp(0.15, 0.5))
}

/// DLF = 1.05 + v/2000, v in ft/min, 1.1 to 1.2, on the dead weight of bridge or trolley. `speed` in m/s.
///
/// The edition of 1983 has a table, 1.1 up to 200 ft/min, else 1.2 (3.3.2.1.1.4.1); that 1.2 bounds the later
/// formula too is *not confirmed*.
///
/// # Errors
/// A speed that is negative or not finite.
///
/// # Source
/// CMAA 70-2010, 3.3.2.1.4.1.
pub fn dead_load_factor(speed: f64) -> Result<f64, Error> {
    Ok((1.05 + feet_per_minute(least_zero(Argument::Speed, speed)?) / 2000.0).clamp(1.1, 1.2))
}

/// Lateral load over vertical load from drives: 7.8 % per ft/s2, at least 2.5 %. `acceleration` in m/s2.
///
/// On dead and lifted load of bridge and trolley, without end trucks and end ties.
///
/// # Errors
/// An acceleration that is negative or not finite.
///
/// # Source
/// CMAA 70-1983, 3.3.2.1.1.5.
pub fn drive_inertia(acceleration: f64) -> Result<f64, Error> {
    Ok((0.078 * least_zero(Argument::Acceleration, acceleration)? / FOOT).max(0.025))
}

/// S_sk, sideways force of a wheel over its vertical load: a line from 0.05 at 3 spans over wheel base to 0.15
/// at 8, level beyond.
///
/// The standard has a chart; its axes are these, its line is *not confirmed*.
///
/// # Errors
/// A length that is not positive.
///
/// # Source
/// CMAA 70-2010, 3.3.2.2.2.
pub fn skew_coefficient(span: f64, base: f64) -> Result<f64, Error> {
    let ratio = positive(Argument::Length, span)? / positive(Argument::Length, base)?;
    Ok((0.05 + 0.02 * (ratio - 3.0)).clamp(0.05, 0.15))
}

/// E = m1 m2 (0.4 v1 + 0.4 v2)^2/(2 (m1 + m2)), what two cranes set free that run into each other at the shares
/// [`COLLISION_SPEED`] of their rated speeds. Any consistent units.
///
/// # Errors
/// A mass that is not positive, a speed that is negative.
///
/// # Source
/// CMAA 70-1983, 3.3.2.1.3.2.
pub fn collision_energy(masses: [f64; 2], speeds: [f64; 2]) -> Result<f64, Error> {
    let [first, second] = masses.map(|mass| positive(Argument::Mass, mass));
    let (first, second) = (first?, second?);
    let mut closing = 0.0;
    for speed in speeds {
        closing += COLLISION_SPEED * least_zero(Argument::Speed, speed)?;
    }
    Ok(first * (second / (first + second)) * closing * closing / 2.0)
}
