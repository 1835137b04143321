//! Values of CMAA 70, with arguments in SI.
//!
//! Clauses are those of the edition of 2010 where they are known, otherwise those of 1983.

use crate::Error;
use crate::error::{Argument, non_negative, positive};

/// Metres in a foot.
pub(crate) const FOOT: f64 = 0.3048;

/// A speed in feet per minute, given in m/s.
pub(crate) fn feet_per_minute(speed: f64) -> f64 {
    speed * 60.0 / FOOT
}

/// Smallest ratio of the runway span to its vertical deflection under the largest wheel loads without impact.
///
/// # Source
/// CMAA 70-2010, 1.4.6.
pub const RUNWAY_VERTICAL: f64 = 600.0;

/// Smallest ratio of the runway span to its lateral deflection under a tenth of the largest wheel loads
/// without impact.
///
/// # Source
/// CMAA 70-2010, 1.4.6.
pub const RUNWAY_LATERAL: f64 = 400.0;

/// Ratio of lateral to vertical wheel loads for the limit of lateral deflections.
///
/// # Source
/// CMAA 70-2010, 1.4.6.
pub const LATERAL_FRACTION: f64 = 0.1;

/// Largest ratio of the deflection of a bridge girder to its span under trolley and rated load, without
/// impact.
///
/// # Source
/// CMAA 70-1983, 3.5.5.
pub const BRIDGE_DEFLECTION: f64 = 0.001125;

/// Fraction of the rated speed at which cranes and trolleys meet their bumpers.
///
/// # Source
/// CMAA 70-1983, 3.3.2.1.3.2.
pub const COLLISION_SPEED: f64 = 0.4;

/// The least hoist load factor, which applies up to 30 ft/min.
///
/// # Source
/// CMAA 70-2010, 3.3.2.1.4.2.
pub const LEAST_HOIST_LOAD_FACTOR: f64 = 0.15;

/// The least dead load factor, which applies up to 100 ft/min.
///
/// # Source
/// CMAA 70-2010, 3.3.2.1.4.1.
pub const LEAST_DEAD_LOAD_FACTOR: f64 = 1.1;

/// The hoist load factor HLF: 0.5 % per ft/min of hoisting speed, within 15 and 50 %. The lifted load is
/// multiplied by 1 + HLF. `speed` is in m/s.
///
/// # Errors
/// [`Error::Range`] for a speed that is negative or not finite.
///
/// # Source
/// CMAA 70-2010, 3.3.2.1.4.2.
pub fn hoist_load_factor(speed: f64) -> Result<f64, Error> {
    Ok(
        (0.005 * feet_per_minute(non_negative(Argument::Speed, speed)?))
            .clamp(LEAST_HOIST_LOAD_FACTOR, 0.5),
    )
}

/// The dead load factor DLF = 1.05 + v/2000, v in ft/min, within 1.1 and 1.2, on the dead weight of the
/// crane. `speed` is the travel speed of the bridge, in m/s; the code has one factor for bridge and trolley.
///
/// The edition of 1983 has a table instead: 1.1 up to 200 ft/min, otherwise 1.2 (3.3.2.1.1.4.1). It is *not
/// confirmed* that 1.2 is the upper bound of the later formula too.
///
/// # Errors
/// [`Error::Range`] for a speed that is negative or not finite.
///
/// # Source
/// CMAA 70-2010, 3.3.2.1.4.1.
pub fn dead_load_factor(speed: f64) -> Result<f64, Error> {
    Ok(
        (1.05 + feet_per_minute(non_negative(Argument::Speed, speed)?) / 2000.0)
            .clamp(LEAST_DEAD_LOAD_FACTOR, 1.2),
    )
}

/// The ratio of lateral to vertical load on the bridge girders from the acceleration of the bridge: 7.8 % per
/// ft/s2, at least 2.5 %. `acceleration` is in m/s2.
///
/// It applies to the dead and lifted loads of bridge and trolley, without end trucks and end ties, and bends the
/// bridge girders laterally. It is no load of the runway.
///
/// # Errors
/// [`Error::Range`] for an acceleration that is negative or not finite.
///
/// # Source
/// CMAA 70-1983, 3.3.2.1.1.5.
pub fn drive_inertia(acceleration: f64) -> Result<f64, Error> {
    Ok((0.078 * non_negative(Argument::Acceleration, acceleration)? / FOOT).max(0.025))
}

/// The skewing coefficient S_sk, the ratio of the lateral force of a wheel to its vertical load.
///
/// It rises linearly from 0.05 at a ratio of span to wheel base of 3 to 0.15 at a ratio of 8, and is constant
/// outside. The standard has a chart with these axes; the line is *not confirmed*.
///
/// # Errors
/// [`Error::Range`] for a length that is not positive.
///
/// # Source
/// CMAA 70-2010, 3.3.2.2.2.
pub fn skew_coefficient(span: f64, base: f64) -> Result<f64, Error> {
    let ratio = positive(Argument::Length, span)? / positive(Argument::Length, base)?;
    Ok((0.05 + 0.02 * (ratio - 3.0)).clamp(0.05, 0.15))
}

/// The energy E = m1 m2 (0.4 v1 + 0.4 v2)^2/(2 (m1 + m2)) that bumpers absorb when two cranes collide at the
/// fraction [`COLLISION_SPEED`] of their rated speeds `speeds`. Any consistent units.
///
/// # Errors
/// [`Error::Range`] for a mass that is not positive or a speed that is negative.
///
/// # Source
/// CMAA 70-1983, 3.3.2.1.3.2.
pub fn collision_energy(masses: [f64; 2], speeds: [f64; 2]) -> Result<f64, Error> {
    let [first, second] = masses.map(|mass| positive(Argument::Mass, mass));
    let (first, second) = (first?, second?);
    let mut closing = 0.0;
    for speed in speeds {
        closing += COLLISION_SPEED * non_negative(Argument::Speed, speed)?;
    }
    Ok(first * (second / (first + second)) * closing * closing / 2.0)
}
