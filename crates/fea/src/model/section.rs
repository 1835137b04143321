//! Cross sections of members and the beam theory that uses them.

use splines::Flexibility;

use crate::error::{EntryAttribute, EntryFault, not_negative, positive};

/// Beam theory of all members of a model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BeamTheory {
    /// Plane sections stay normal to the axis; shear areas are ignored.
    #[default]
    EulerBernoulli,
    /// Sections shear by V/(G As); an absent shear area is rigid in shear.
    Timoshenko,
}

/// A uniform cross section and its material.
///
/// The Young's modulus must be positive. A zero for `area`, `iy`, `iz`, `j` or `g` means that the section
/// has no stiffness there; loads that need this stiffness are refused.
///
/// # Example
/// ```
/// use fea::{CrossSection, BeamTheory};
///
/// // A steel section that bends in the vertical plane only; newtons and metres.
/// let section = CrossSection { e: 2.1e11, iz: 4e-4, ..CrossSection::default() };
/// let flexibility = section.flexibility(BeamTheory::EulerBernoulli);
/// assert_eq!(flexibility.bending_z, 1.0 / (2.1e11 * 4e-4));
/// assert_eq!(flexibility.axial, f64::INFINITY);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CrossSection {
    /// Young's modulus, force/length^2, positive.
    pub e: f64,
    /// Shear modulus, force/length^2.
    pub g: f64,
    /// Area, length^2.
    pub area: f64,
    /// Second moment of area about local y (bending in the local x-z plane), length^4.
    pub iy: f64,
    /// Second moment of area about local z (bending in the local x-y plane), length^4.
    pub iz: f64,
    /// Torsion constant, length^4.
    pub j: f64,
    /// Effective shear area along local y, length^2; `None` is rigid in shear.
    pub shear_y: Option<f64>,
    /// Effective shear area along local z, length^2; `None` is rigid in shear.
    pub shear_z: Option<f64>,
    /// Mass per length, force time^2/length^2.
    pub mass: f64,
}

impl CrossSection {
    /// Reciprocal stiffnesses 1/EA, 1/GJ, 1/EI and 1/GAs under a beam theory.
    ///
    /// `INFINITY` where the section has no stiffness, 0 where it is rigid in shear.
    #[must_use]
    pub fn flexibility(&self, theory: BeamTheory) -> Flexibility {
        let shear = |area: Option<f64>| match (theory, area) {
            (BeamTheory::Timoshenko, Some(area)) => reciprocal(self.g * area),
            _ => 0.0,
        };
        Flexibility {
            axial: reciprocal(self.e * self.area),
            torsion: reciprocal(self.g * self.j),
            bending_y: reciprocal(self.e * self.iy),
            bending_z: reciprocal(self.e * self.iz),
            shear_y: shear(self.shear_y),
            shear_z: shear(self.shear_z),
            tension: 0.0,
        }
    }

    /// Squared radius of gyration of a second moment of area, length^2; 0 for a section without area.
    pub(crate) fn gyration_squared(&self, second_moment: f64) -> f64 {
        if self.area > 0.0 {
            second_moment / self.area
        } else {
            0.0
        }
    }

    /// Checks every number; returns the first that cannot be used.
    pub(crate) fn check(&self, theory: BeamTheory) -> Result<(), EntryFault> {
        positive(EntryAttribute::E, self.e)?;
        let plain = [
            (EntryAttribute::G, self.g),
            (EntryAttribute::Area, self.area),
            (EntryAttribute::Iy, self.iy),
            (EntryAttribute::Iz, self.iz),
            (EntryAttribute::J, self.j),
            (EntryAttribute::Mass, self.mass),
        ];
        for (quantity, value) in plain {
            not_negative(quantity, value)?;
        }
        for (quantity, area) in [
            (EntryAttribute::ShearY, self.shear_y),
            (EntryAttribute::ShearZ, self.shear_z),
        ] {
            let Some(area) = area else { continue };
            positive(quantity, area)?;
            if theory == BeamTheory::Timoshenko && self.g == 0.0 {
                return Err(EntryFault::NoShearModulus);
            }
        }
        Ok(())
    }
}

fn reciprocal(stiffness: f64) -> f64 {
    if stiffness > 0.0 {
        1.0 / stiffness
    } else {
        f64::INFINITY
    }
}
