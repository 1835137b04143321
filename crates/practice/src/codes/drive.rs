//! Horizontal forces from acceleration of the crane, EN 1991-3.

use crate::Error;
use crate::error::{Argument, count, non_negative, positive, within};

/// Coefficient of friction of steel on steel, and of steel on rubber; the latter is *not confirmed*.
///
/// # Source
/// EN 1991-3:2006, 2.7.3.
pub const FRICTION: [f64; 2] = [0.2, 0.5];

/// The drive force K = mu sum Q*, at which the driven wheels begin to slip.
///
/// `friction` is mu. `wheels` are the loads Q* of the driven wheels of the crane without load: of each wheel
/// where the wheels are driven separately, of the wheels of both rails where a shaft drives them together.
///
/// # Errors
/// [`Error::Range`] for a friction or load that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.7.3.
pub fn drive_force(friction: f64, wheels: &[f64]) -> Result<f64, Error> {
    let friction = non_negative(Argument::Friction, friction)?;
    wheels.iter().try_fold(0.0, |sum, load| {
        Ok(sum + friction * non_negative(Argument::Force, *load)?)
    })
}

/// A crane that accelerates or brakes. Forces and lengths are in any consistent units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AcceleratingCrane {
    /// Distance l of the rails.
    pub span: f64,
    /// Distance a of the guides of the crane, which are guide rollers or the outer flanged wheels.
    pub guides: f64,
    /// Sum of the vertical wheel loads on the rail that carries more.
    pub heavy: f64,
    /// Sum of the vertical wheel loads on the other rail.
    pub light: f64,
    /// Drive force K.
    pub drive: f64,
    /// Dynamic factor phi5.
    pub factor: f64,
    /// Number n_r of runway beams.
    pub rails: u32,
}

/// The forces on the runway.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveForces {
    /// xi1, the fraction of the loads on the rail that carries more.
    pub fraction: f64,
    /// H_L, the force along each runway beam.
    pub along: f64,
    /// M = K l_s, the moment of the drive force about the centre of mass.
    pub moment: f64,
    /// H_T,1, across the rail that carries more: two opposite forces, one at either guide.
    pub heavy: f64,
    /// H_T,2, across the other rail, likewise.
    pub light: f64,
}

/// The longitudinal forces H_L = phi5 K/n_r and the lateral forces H_T,1 = phi5 xi2 M/a and H_T,2 = phi5 xi1
/// M/a of a crane that accelerates, with M = K l_s and l_s = (xi1 - 0.5) l.
///
/// # Errors
/// [`Error::Range`] for a length that is not positive, a load, drive force or factor that is negative, loads
/// that are all zero, `heavy` below `light`, or no rail.
///
/// # Source
/// EN 1991-3:2006, 2.7.2.
pub fn traction(travel: &AcceleratingCrane) -> Result<DriveForces, Error> {
    let span = positive(Argument::Length, travel.span)?;
    let guides = positive(Argument::Length, travel.guides)?;
    let heavy = positive(Argument::Force, travel.heavy)?;
    let light = within(Argument::Force, travel.light, 0.0, heavy)?;
    let drive = non_negative(Argument::Force, travel.drive)?;
    let factor = non_negative(Argument::Factor, travel.factor)?;
    let rails = count(travel.rails)?;
    let fraction = heavy / (heavy + light);
    let moment = drive * (fraction - 0.5) * span;
    let couple = factor * moment / guides;
    Ok(DriveForces {
        fraction,
        along: factor * drive / rails,
        moment,
        heavy: (1.0 - fraction) * couple,
        light: fraction * couple,
    })
}
