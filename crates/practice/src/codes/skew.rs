//! Skewing of a crane by EN 1991-3, and the coefficient of FEM 1.001.

use crate::Error;
use crate::error::{Argument, non_negative, positive, within};

/// The largest permitted skewing angle, in rad.
///
/// # Source
/// EN 1991-3:2006, 2.7.4.
pub const MAX_ANGLE: f64 = 0.015;

/// alpha_0, the part of the skewing angle from tolerances of wheels and rails, in rad.
///
/// # Source
/// EN 1991-3:2006, Table 2.7.
pub const TOLERANCE_ANGLE: f64 = 0.001;

/// The guides of a crane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guide {
    /// Guide rollers.
    Rollers,
    /// Flanges of wheels.
    Flanges,
}

/// The skewing angle alpha = alpha_F + alpha_V + alpha_0, in rad, at most [`MAX_ANGLE`], which a crane must not exceed.
///
/// alpha_F = 0.75 x/a, where 0.75 x is at least 5 mm for rollers and 10 mm for flanges. alpha_V = y/a with
/// the wear y = 0.03 b for rollers and 0.10 b for flanges. `slack` is the clearance x between rail and guide,
/// `head` the width b of the rail head, `spacing` the distance a of the outer guides, all in m.
///
/// A public source applies the least value of 10 mm to x in place of 0.75 x, which gives up to 2.5 mm/a less; the
/// larger angle is computed here. The values for rollers are *not confirmed*.
///
/// # Errors
/// [`Error::Range`] for a slack or head that is negative, or a spacing that is not positive.
///
/// # Source
/// EN 1991-3:2006, 2.7.4, Table 2.7.
pub fn angle(guide: Guide, slack: f64, head: f64, spacing: f64) -> Result<f64, Error> {
    let [least, wear] = match guide {
        Guide::Rollers => [0.005, 0.03],
        Guide::Flanges => [0.010, 0.10],
    };
    let slack = (0.75 * non_negative(Argument::Length, slack)?).max(least);
    let wear = wear * non_negative(Argument::Length, head)?;
    Ok(((slack + wear) / positive(Argument::Length, spacing)? + TOLERANCE_ANGLE).min(MAX_ANGLE))
}

/// The coefficient of friction f = 0.3 (1 - exp(-250 alpha)) of a wheel at the skewing angle alpha, in rad.
///
/// # Errors
/// [`Error::Range`] for an angle that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.7.4.
pub fn friction(angle: f64) -> Result<f64, Error> {
    Ok(-0.3 * (-250.0 * non_negative(Argument::Angle, angle)?).exp_m1())
}

/// How the wheels of both rails are driven, and whether they are fixed laterally.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum WheelPairs {
    /// Driven separately, fixed laterally on both rails (IFF).
    AloneFixed,
    /// Driven separately, fixed on one rail and free on the other (IFM).
    AloneFree,
    /// Coupled by a shaft, fixed on both rails (CFF).
    CoupledFixed,
    /// Coupled by a shaft, fixed on one rail and free on the other (CFM).
    CoupledFree,
}

/// The coefficients of the skewing forces, which are to be multiplied by f sum Q_r.
#[derive(Clone, Debug, PartialEq)]
pub struct Skewing {
    /// h, the distance from the guide back to the centre of rotation of the crane.
    pub rotation_distance: f64,
    /// lambda_S, of the guide force S.
    pub guide: f64,
    /// lambda_S,i,j,L, of the longitudinal forces of every wheel pair; those of the two rails are opposite.
    pub along: Vec<f64>,
    /// lambda_S,i,j,T, of the lateral forces of every wheel pair: on rail 1, where the guide is, and on rail
    /// 2.
    pub across: Vec<[f64; 2]>,
}

impl Skewing {
    /// The coefficient lambda_S - lambda_S,1,1,T of the force S - H_S,1,1,T that the rail receives at the front wheel
    /// where the guides are flanges: guide force and lateral force of that wheel act on the rail at the same place
    /// in opposite directions.
    ///
    /// # Source
    /// EN 1991-3:2006, 2.7.4, as used by a public program.
    #[must_use]
    pub fn net_on_rail(&self) -> f64 {
        self.guide - self.across.first().map_or(0.0, |pair| pair[0])
    }
}

/// The coefficients of the skewing forces of a crane.
///
/// h = (m c l^2 + sum e_j^2)/sum e_j with c = xi1 xi2 (fixed) or xi1 (free) for m coupled pairs;
/// lambda_S = (1 - sum e_j/(n h)) or xi2 times that; lambda_S,i,j,L = xi1 xi2 l/(n h) for coupled pairs;
/// lambda_S,1,j,T = (xi2/n)(1 - e_j/h), lambda_S,2,j,T = (xi1/n)(1 - e_j/h), the latter zero where free.
///
/// `span` is l; `heavy` is xi1, the fraction of the loads on the rail that carries more, and xi2 = 1 - xi1;
/// `pairs` are the distances e_j of the n wheel pairs from the front guide, of which all or none are coupled.
///
/// Guarantee: the lateral forces and the moments about the guide are in equilibrium.
///
/// # Errors
/// [`Error::Range`] for a span that is not positive, a fraction outside 0 to 1, or a negative distance;
/// [`Error::NoRotationCentre`] for no pair, or all pairs at the guide.
///
/// # Source
/// EN 1991-3:2006, 2.7.4, Tables 2.8 and 2.9.
pub fn skewing(kind: WheelPairs, span: f64, heavy: f64, pairs: &[f64]) -> Result<Skewing, Error> {
    let span = positive(Argument::Length, span)?;
    let heavy = within(Argument::Fraction, heavy, 0.0, 1.0)?;
    let light = 1.0 - heavy;
    let (mut first, mut second) = (0.0, 0.0);
    for &pair in pairs {
        first += non_negative(Argument::Length, pair)?;
        second += pair * pair;
    }
    let count = pairs.len() as f64;
    let (coupled, free) = match kind {
        WheelPairs::AloneFixed => (0.0, false),
        WheelPairs::AloneFree => (0.0, true),
        WheelPairs::CoupledFixed => (count, false),
        WheelPairs::CoupledFree => (count, true),
    };
    let lever = if free { heavy } else { heavy * light };
    let reach = (coupled * lever * span * span + second) / first;
    if first <= 0.0 || reach <= 0.0 || !reach.is_finite() {
        return Err(Error::NoRotationCentre);
    }
    let side = |pair: f64| (1.0 - pair / reach) / count;
    let along = if coupled > 0.0 {
        heavy * light * span / (count * reach)
    } else {
        0.0
    };
    Ok(Skewing {
        rotation_distance: reach,
        guide: (if free { light } else { 1.0 }) * (1.0 - first / (count * reach)),
        along: vec![along; pairs.len()],
        across: pairs
            .iter()
            .map(|&e| [light * side(e), if free { 0.0 } else { heavy * side(e) }])
            .collect(),
    })
}

/// The ratio of the lateral force of a wheel to its vertical load, 0.025 p/a within 0.05 and 0.2, with the
/// `span` p and the wheel base a (`base`).
///
/// # Errors
/// [`Error::Range`] for a length that is not positive.
///
/// # Source
/// FEM 1.001, booklet 2, 2.2.3.3: 0.05 at p/a = 2 and 0.2 at 8; the chart between them is taken as a straight
/// line.
pub fn fem_coefficient(span: f64, base: f64) -> Result<f64, Error> {
    let ratio = positive(Argument::Length, span)? / positive(Argument::Length, base)?;
    Ok((0.025 * ratio).clamp(0.05, 0.2))
}
