//! Horizontal forces from acceleration of the crane, EN 1991-3.

use crate::Error;
use crate::error::{Argument, count, least_zero, positive, within};

/// Friction of steel on steel, and of steel on rubber; the latter is *not confirmed*.
///
/// # Source
/// EN 1991-3:2006, 2.7.3.
pub const FRICTION: [f64; 2] = [0.2, 0.5];

/// K = mu sum Q*, the drive force before wheels slip.
///
/// `wheels` Q*: the loads of the driven wheels of the crane without load: each driven wheel's own where they are
/// driven alone, those of both rails where a shaft drives them together.
///
/// # Errors
/// A friction or load that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.7.3.
pub fn drive_force(friction: f64, wheels: &[f64]) -> Result<f64, Error> {
    let friction = least_zero(Argument::Friction, friction)?;
    wheels.iter().try_fold(0.0, |sum, load| Ok(sum + friction * least_zero(Argument::Force, *load)?))
}

/// A crane that speeds up or brakes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Travel {
    /// From rail to rail, l.
    pub span: f64,
    /// Between the guides of the crane: guide rollers or outer flanged wheels, a.
    pub guides: f64,
    /// Sum of the vertical loads of the rail that carries more.
    pub heavy: f64,
    /// Sum of the vertical loads of the other rail.
    pub light: f64,
    /// Drive force K.
    pub drive: f64,
    /// phi5.
    pub factor: f64,
    /// How many runway beams, n_r.
    pub rails: u32,
}

/// What the runway gets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Traction {
    /// xi1, the heavy rail's share of the loads.
    pub share: f64,
    /// Along each runway beam, H_L.
    pub along: f64,
    /// M = K l_s, the moment of the drive about the centre of mass.
    pub moment: f64,
    /// Across the heavy rail, H_T,1: a pair of these, at the two guides, against each other.
    pub heavy: f64,
    /// Across the light rail, H_T,2, likewise.
    pub light: f64,
}

/// H_L = phi5 K/n_r; H_T,1 = phi5 xi2 M/a, H_T,2 = phi5 xi1 M/a with M = K l_s, l_s = (xi1 - 0.5) l.
///
/// # Errors
/// A length that is not positive, a load, drive force or factor that is negative, loads that are all zero, a
/// heavy rail that carries less than the light one, no rail.
///
/// # Source
/// EN 1991-3:2006, 2.7.2.
pub fn traction(travel: &Travel) -> Result<Traction, Error> {
    let span = positive(Argument::Length, travel.span)?;
    let guides = positive(Argument::Length, travel.guides)?;
    let heavy = positive(Argument::Force, travel.heavy)?;
    let light = within(Argument::Force, travel.light, 0.0, heavy)?;
    let drive = least_zero(Argument::Force, travel.drive)?;
    let factor = least_zero(Argument::Factor, travel.factor)?;
    let rails = count(travel.rails)?;
    let share = heavy / (heavy + light);
    let moment = drive * (share - 0.5) * span;
    let couple = factor * moment / guides;
    Ok(Traction {
        share,
        along: factor * drive / rails,
        moment,
        heavy: (1.0 - share) * couple,
        light: share * couple,
    })
}
