//! Skewing of a crane, EN 1991-3.

use crate::Error;
use crate::error::{Argument, least_zero, positive, within};

/// The largest skewing angle that is accepted, rad.
///
/// # Source
/// EN 1991-3:2006, 2.7.4.
pub const MOST: f64 = 0.015;

/// alpha0, what tolerances of wheels and rails add, rad. *Not confirmed.*
///
/// # Source
/// EN 1991-3:2006, Table 2.7.
pub const TOLERANCE: f64 = 0.001;

/// What guides a crane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guide {
    /// Guide rollers.
    Rollers,
    /// Flanges of wheels.
    Flanges,
}

/// alpha = alpha_F + alpha_V + alpha_0 in rad; compare with [`MOST`].
///
/// alpha_F = 0.75 x/a with 0.75 x at least 5 mm (rollers) or 10 mm (flanges); alpha_V = y/a with the wear y of
/// 0.03 b (rollers) or 0.10 b (flanges); `slack` x between rail and guide, `head` width b of the rail's head,
/// `spacing` a of the outer guides, all in m. The parts are *not confirmed*.
///
/// # Errors
/// A slack or head that is negative, a spacing that is not positive.
///
/// # Source
/// EN 1991-3:2006, 2.7.4, Table 2.7.
pub fn angle(guide: Guide, slack: f64, head: f64, spacing: f64) -> Result<f64, Error> {
    let [least, wear] = match guide {
        Guide::Rollers => [0.005, 0.03],
        Guide::Flanges => [0.010, 0.10],
    };
    let slack = (0.75 * least_zero(Argument::Length, slack)?).max(least);
    let wear = wear * least_zero(Argument::Length, head)?;
    Ok((slack + wear) / positive(Argument::Length, spacing)? + TOLERANCE)
}

/// f = 0.3 (1 - exp(-250 alpha)), the friction that a wheel at the angle alpha feels.
///
/// # Errors
/// An angle that is negative or not finite.
///
/// # Source
/// EN 1991-3:2006, 2.7.4.
pub fn friction(angle: f64) -> Result<f64, Error> {
    Ok(-0.3 * (-250.0 * least_zero(Argument::Angle, angle)?).exp_m1())
}

/// How the wheels of both rails are driven and held sideways.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pairs {
    /// Driven alone, fixed sideways on both rails (IFF).
    AloneFixed,
    /// Driven alone, fixed on one rail and free on the other (IFM).
    AloneFree,
    /// Coupled by a shaft, fixed on both (CFF).
    CoupledFixed,
    /// Coupled by a shaft, fixed on one and free on the other (CFM).
    CoupledFree,
}

/// Forces of skewing per f sum Q_r.
#[derive(Clone, Debug, PartialEq)]
pub struct Skewing {
    /// h, how far behind the guide the centre lies that the crane turns about.
    pub reach: f64,
    /// lambda_S of the guide force S.
    pub guide: f64,
    /// lambda_S,i,j,L of every wheel pair, alike on both rails, against each other.
    pub along: Vec<f64>,
    /// lambda_S,i,j,T of every wheel pair: on rail 1, where the guide is, and on rail 2.
    pub across: Vec<[f64; 2]>,
}

/// Coefficients of the forces of skewing.
///
/// h = (m c l^2 + sum e_j^2)/sum e_j with c = xi1 xi2 (fixed) or xi1 (free) for m coupled pairs;
/// lambda_S = (1 - sum e_j/(n h)) or xi2 times that; lambda_S,i,j,L = xi1 xi2 l/(n h) for coupled pairs;
/// lambda_S,1,j,T = (xi2/n)(1 - e_j/h), lambda_S,2,j,T = (xi1/n)(1 - e_j/h), the latter zero where free.
///
/// `span` l; `share` xi1 of the loads on the rail that carries more, xi2 = 1 - xi1; `pairs` e_j, distances of
/// the n wheel pairs from the front guide, all coupled or none.
///
/// Guarantees: the forces balance, across and about the guide.
///
/// # Errors
/// A span that is not positive, a share outside 0..=1, a negative distance; no pair, or all at the guide.
///
/// # Source
/// EN 1991-3:2006, 2.7.4, Tables 2.8 and 2.9.
pub fn skewing(kind: Pairs, span: f64, share: f64, pairs: &[f64]) -> Result<Skewing, Error> {
    let span = positive(Argument::Length, span)?;
    let heavy = within(Argument::Share, share, 0.0, 1.0)?;
    let light = 1.0 - heavy;
    let (mut first, mut second) = (0.0, 0.0);
    for &pair in pairs {
        first += least_zero(Argument::Length, pair)?;
        second += pair * pair;
    }
    let count = pairs.len() as f64;
    let (coupled, free) = match kind {
        Pairs::AloneFixed => (0.0, false),
        Pairs::AloneFree => (0.0, true),
        Pairs::CoupledFixed => (count, false),
        Pairs::CoupledFree => (count, true),
    };
    let lever = if free { heavy } else { heavy * light };
    let reach = (coupled * lever * span * span + second) / first;
    if first <= 0.0 || reach <= 0.0 || !reach.is_finite() {
        return Err(Error::NoReach);
    }
    let side = |pair: f64| (1.0 - pair / reach) / count;
    let along = if coupled > 0.0 { heavy * light * span / (count * reach) } else { 0.0 };
    Ok(Skewing {
        reach,
        guide: (if free { light } else { 1.0 }) * (1.0 - first / (count * reach)),
        along: vec![along; pairs.len()],
        across: pairs.iter().map(|&e| [light * side(e), if free { 0.0 } else { heavy * side(e) }]).collect(),
    })
}

/// 0.025 p/a within 0.05..=0.2: sideways force of a wheel per its vertical load, by the span p over the wheel
/// base a.
///
/// # Errors
/// A length that is not positive.
///
/// # Source
/// FEM 1.001, booklet 2, 2.2.3.3: 0.05 at p/a = 2, 0.2 at 8; the chart between them as a straight line.
pub fn fem_coefficient(span: f64, base: f64) -> Result<f64, Error> {
    let ratio = positive(Argument::Length, span)? / positive(Argument::Length, base)?;
    Ok((0.025 * ratio).clamp(0.05, 0.2))
}
