//! Local stresses in the web of a runway girder under a wheel.
//!
//! A wheel load spreads through rail and flange into the web over the effective length l. With the thickness t_w of
//! the web the local vertical stress is sigma_oz = F/(l t_w), and the local shear stress next to the wheel is 0.2 of
//! it, on either side of the load, in addition to the shear stress of the girder as a whole.

use crate::Error;
use crate::error::{Argument, non_negative, positive};

/// Ratio of the local shear stress to the local vertical stress.
///
/// # Source
/// EN 1993-6:2007, 5.7.2. *Not confirmed.*
pub const LOCAL_SHEAR: f64 = 0.2;

/// How a rail is connected to the flange, which determines the effective length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RailFixing {
    /// Welded or otherwise rigidly connected: rail and flange bend as one section.
    Rigid,
    /// Held by clamps, without a pad: rail and flange bend beside each other.
    Loose,
    /// On an elastic pad at least 6 mm thick, with the inertia of rail and flange as for a loose rail.
    ElasticPad,
}

/// Rail and top flange of a girder, in any consistent unit of length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailSeat {
    /// How the rail is connected.
    pub fixing: RailFixing,
    /// Second moment of area about the horizontal axis: of rail and effective flange as one section I_rf for
    /// [`RailFixing::Rigid`], of the rail alone I_r for the others; for a worn rail that of the worn section.
    pub inertia: f64,
    /// Width b of the flange.
    pub flange_width: f64,
    /// Thickness t_f of the flange.
    pub flange: f64,
    /// Thickness t_w of the web.
    pub web: f64,
    /// Height h_r of the rail.
    pub rail_height: f64,
    /// Width b_fr of the foot of the rail.
    pub rail_foot: f64,
}

impl RailSeat {
    /// The effective width of the flange, b_eff = b_fr + h_r + t_f, at most b.
    ///
    /// # Errors
    /// [`Error::Range`] for a length that is not positive.
    ///
    /// # Source
    /// EN 1993-6:2007, 5.7.1, equation (5.2).
    pub fn effective_width(&self) -> Result<f64, Error> {
        let spread = positive(Argument::Length, self.rail_foot)?
            + positive(Argument::Length, self.rail_height)?
            + positive(Argument::Length, self.flange)?;
        Ok(spread.min(positive(Argument::Length, self.flange_width)?))
    }

    /// The effective length over which a wheel load acts on the web, at the lower face of the flange:
    ///
    /// - rigid: 3.25 (I_rf/t_w)^(1/3);
    /// - loose: 3.25 ((I_r + I_f,eff)/t_w)^(1/3) with I_f,eff = b_eff t_f^3/12;
    /// - elastic pad: 4.25 ((I_r + I_f,eff)/t_w)^(1/3); the factor 4.25 is *not confirmed*.
    ///
    /// # Errors
    /// [`Error::Range`] for a length or a second moment of area that is not positive.
    ///
    /// # Source
    /// EN 1993-6:2007, 5.7.1, Table 5.1.
    ///
    /// ```
    /// use practice::local_stress::{RailFixing, RailSeat};
    ///
    /// // rail and flange of 86.4 cm4 as one section on a web of 13.5 mm, in mm
    /// let seat = RailSeat {
    ///     fixing: RailFixing::Rigid,
    ///     inertia: 864_000.0,
    ///     flange_width: 300.0,
    ///     flange: 24.0,
    ///     web: 13.5,
    ///     rail_height: 30.0,
    ///     rail_foot: 50.0,
    /// };
    /// assert!((seat.effective_length()? - 130.0).abs() < 1e-9, "3.25 times the cube root of 64000");
    /// # Ok::<(), practice::Error>(())
    /// ```
    pub fn effective_length(&self) -> Result<f64, Error> {
        let inertia = positive(Argument::Section, self.inertia)?;
        let web = positive(Argument::Length, self.web)?;
        let flange = positive(Argument::Length, self.flange)?;
        let beside = inertia + self.effective_width()? * flange.powi(3) / 12.0;
        let (factor, inertia) = match self.fixing {
            RailFixing::Rigid => (3.25, inertia),
            RailFixing::Loose => (3.25, beside),
            RailFixing::ElasticPad => (4.25, beside),
        };
        Ok(factor * (inertia / web).cbrt())
    }

    /// The local stresses under a wheel load `force`, in its unit over the square of the unit of length.
    ///
    /// # Errors
    /// [`Error::Range`] for a negative force, or a dimension that is not positive.
    ///
    /// # Source
    /// EN 1993-6:2007, 5.7.1 and 5.7.2.
    pub fn stresses(&self, force: f64) -> Result<LocalStresses, Error> {
        LocalStresses::over(force, self.effective_length()?, self.web)
    }
}

/// Local stresses in the web at the lower face of the flange.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalStresses {
    /// sigma_oz, the compressive vertical stress.
    pub vertical: f64,
    /// tau_oxz, the shear stress on either side of the wheel; it reverses with each passage.
    pub shear: f64,
}

impl LocalStresses {
    /// The stresses of a wheel load `force` spread over `length` of a web of thickness `web`.
    ///
    /// # Errors
    /// [`Error::Range`] for a negative force, or a length that is not positive.
    pub fn over(force: f64, length: f64, web: f64) -> Result<LocalStresses, Error> {
        let area = positive(Argument::Length, length)? * positive(Argument::Length, web)?;
        let vertical = non_negative(Argument::Force, force)? / area;
        Ok(LocalStresses {
            vertical,
            shear: LOCAL_SHEAR * vertical,
        })
    }

    /// The shear stress with that of the girder as a whole, `global`, of either sign: |tau| + tau_oxz.
    #[must_use]
    pub fn total_shear(&self, global: f64) -> f64 {
        global.abs() + self.shear
    }
}

/// The length 2 H + 2 in over which a wheel load acts on the web of a bridge girder by CMAA 70, in m. `depth` H is
/// the distance from the top of the rail to the lower face of the flange, in m. *Not confirmed.*
///
/// # Errors
/// [`Error::Range`] for a depth that is negative or not finite.
///
/// # Source
/// CMAA 70, 3.5 (local bending and web crushing under wheels).
pub fn cmaa_bearing_length(depth: f64) -> Result<f64, Error> {
    Ok(2.0 * non_negative(Argument::Length, depth)? + 2.0 * super::cmaa::FOOT / 12.0)
}
