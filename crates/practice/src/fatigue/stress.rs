//! Direct stress at points of a section.

use crate::Error;
use crate::error::{Argument, positive, signed};

/// The properties of a section about its principal axes y and z through the centroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionProperties {
    /// Area A.
    pub area: f64,
    /// Second moment of area I_y, the integral of z^2, for bending in the x-z plane.
    pub iy: f64,
    /// Second moment of area I_z, the integral of y^2, for bending in the x-y plane.
    pub iz: f64,
}

/// A point of a section, measured from its centroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SectionPoint {
    /// Coordinate along the local y axis.
    pub y: f64,
    /// Coordinate along the local z axis.
    pub z: f64,
}

/// The direct stress at a point per unit of N, Vy, Vz, Mx, My and Mz: 1/A, 0, 0, 0, z/Iy, -y/Iz.
///
/// Internal forces act on the face with normal +x and are positive along the local axes and right-handed
/// about them: N is tension, a positive My causes tension at +z, a positive Mz tension at -y. Tension is
/// positive. Shear forces and torsion cause no direct stress; warping is not included. The stress is sigma =
/// N/A + My z/Iy - Mz y/Iz, so that its influence line is the same combination of the influence lines of N,
/// My and Mz. Any consistent units.
///
/// # Errors
/// [`Error::Range`] for an area or second moment that is not positive, or a coordinate that is not finite.
///
/// # Source
/// Timoshenko and Goodier, Theory of Elasticity (1970), article 102.
pub fn weights(section: &SectionProperties, point: SectionPoint) -> Result<[f64; 6], Error> {
    Ok([
        1.0 / positive(Argument::Section, section.area)?,
        0.0,
        0.0,
        0.0,
        signed(Argument::Length, point.z)? / positive(Argument::Section, section.iy)?,
        -signed(Argument::Length, point.y)? / positive(Argument::Section, section.iz)?,
    ])
}

/// The direct stress sigma = N/A + My z/Iy - Mz y/Iz at a point, from internal forces in the order N, Vy, Vz,
/// Mx, My, Mz.
///
/// # Errors
/// Those of [`weights`]; [`Error::Range`] for a force that is not finite.
///
/// # Source
/// That of [`weights`].
///
/// ```
/// use practice::{SectionPoint, SectionProperties, stress};
///
/// let section = SectionProperties { area: 0.02, iy: 5.8e-4, iz: 1.0e-4 };
/// let top = SectionPoint { y: 0.0, z: 0.2 };
/// let sigma = stress::direct(&section, top, [100.0, 0.0, 0.0, 0.0, 29.0, 0.0])?;
/// assert!((sigma - 15_000.0).abs() < 1e-9);
/// # Ok::<(), practice::Error>(())
/// ```
pub fn direct(
    section: &SectionProperties,
    point: SectionPoint,
    forces: [f64; 6],
) -> Result<f64, Error> {
    let weights = weights(section, point)?;
    forces
        .iter()
        .zip(weights)
        .try_fold(0.0, |sum, (force, weight)| {
            Ok(sum + weight * signed(Argument::Force, *force)?)
        })
}
