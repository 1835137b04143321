//! Direct stress at points of a section.

use crate::Error;
use crate::error::{Argument, positive, signed};

/// A section about its principal axes y and z through the centroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// A.
    pub area: f64,
    /// I_y, the integral of z^2: bending in the x-z plane.
    pub iy: f64,
    /// I_z, the integral of y^2: bending in the x-y plane.
    pub iz: f64,
}

/// A point of a section, from its centroid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Along the local y axis.
    pub y: f64,
    /// Along the local z axis.
    pub z: f64,
}

/// Direct stress per unit of N, Vy, Vz, Mx, My and Mz at a point: 1/A, 0, 0, 0, z/Iy, -y/Iz.
///
/// Internal forces act on the face with normal +x, positive along the local axes and right-handed about them:
/// N is tension, a positive My stretches the fibres at +z, a positive Mz those at -y. Tension is positive.
/// Shear forces and torsion give no direct stress here; warping is left out.
///
/// So sigma = N/A + My z/Iy - Mz y/Iz, and the influence line of a stress is this combination of those of
/// N, My and Mz. Any consistent units.
///
/// # Errors
/// An area or second moment that is not positive, a coordinate that is not finite.
///
/// # Source
/// Timoshenko and Goodier, Theory of Elasticity (1970), article 102.
pub fn weights(section: &Section, point: Point) -> Result<[f64; 6], Error> {
    Ok([
        1.0 / positive(Argument::Section, section.area)?,
        0.0,
        0.0,
        0.0,
        signed(Argument::Length, point.z)? / positive(Argument::Section, section.iy)?,
        -signed(Argument::Length, point.y)? / positive(Argument::Section, section.iz)?,
    ])
}

/// sigma = N/A + My z/Iy - Mz y/Iz of internal forces in the order N, Vy, Vz, Mx, My, Mz; see [`weights`].
///
/// # Errors
/// As of [`weights`]; a force that is not finite.
///
/// # Source
/// As of [`weights`].
pub fn direct(section: &Section, point: Point, forces: [f64; 6]) -> Result<f64, Error> {
    let weights = weights(section, point)?;
    forces
        .iter()
        .zip(weights)
        .try_fold(0.0, |sum, (force, weight)| Ok(sum + weight * signed(Argument::Force, *force)?))
}
