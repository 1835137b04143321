//! Cross sections.

use splines::Flexibility;

use crate::error::{Fault, Quantity};

/// Beam theory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theory {
    /// Plane sections stay normal to the axis; shear areas count for nothing.
    #[default]
    EulerBernoulli,
    /// Sections shear by V/(G As).
    Timoshenko,
}

/// A uniform cross section and its material.
///
/// Zero for `area`, `iy`, `iz`, `j` or `g`: nothing resists there (`e` must be positive).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Section {
    /// Young's modulus, force/length^2.
    pub e: f64,
    /// Shear modulus, force/length^2.
    pub g: f64,
    /// Area, length^2.
    pub area: f64,
    /// Second moment of area about local y (bends in the local x-z plane), length^4.
    pub iy: f64,
    /// Second moment of area about local z (bends in the local x-y plane), length^4.
    pub iz: f64,
    /// Torsion constant, length^4.
    pub j: f64,
    /// Effective shear area along local y, length^2; `None` is rigid in shear.
    pub shear_y: Option<f64>,
    /// Effective shear area along local z, length^2; `None` is rigid in shear.
    pub shear_z: Option<f64>,
    /// Mass per length.
    pub mass: f64,
}

impl Section {
    /// Reciprocal stiffnesses 1/EA, 1/GJ, 1/EI, 1/GAs under a theory; `INFINITY` where nothing resists.
    #[must_use]
    pub fn flexibility(&self, theory: Theory) -> Flexibility {
        let shear = |area: Option<f64>| match (theory, area) {
            (Theory::Timoshenko, Some(area)) => inverse(self.g * area),
            _ => 0.0,
        };
        Flexibility {
            axial: inverse(self.e * self.area),
            torsion: inverse(self.g * self.j),
            bending_y: inverse(self.e * self.iy),
            bending_z: inverse(self.e * self.iz),
            shear_y: shear(self.shear_y),
            shear_z: shear(self.shear_z),
        }
    }

    /// Finds the first number that cannot be used.
    pub(crate) fn check(&self, theory: Theory) -> Result<(), Fault> {
        positive(Quantity::E, self.e)?;
        let plain = [
            (Quantity::G, self.g),
            (Quantity::Area, self.area),
            (Quantity::Iy, self.iy),
            (Quantity::Iz, self.iz),
            (Quantity::J, self.j),
            (Quantity::Mass, self.mass),
        ];
        for (quantity, value) in plain {
            not_negative(quantity, value)?;
        }
        for (quantity, area) in [(Quantity::ShearY, self.shear_y), (Quantity::ShearZ, self.shear_z)] {
            let Some(area) = area else { continue };
            positive(quantity, area)?;
            if theory == Theory::Timoshenko && self.g == 0.0 {
                return Err(Fault::NoShearModulus);
            }
        }
        Ok(())
    }
}

fn inverse(stiffness: f64) -> f64 {
    if stiffness > 0.0 { 1.0 / stiffness } else { f64::INFINITY }
}

pub(crate) fn finite(quantity: Quantity, values: &[f64]) -> Result<(), Fault> {
    if values.iter().all(|x| x.is_finite()) { Ok(()) } else { Err(Fault::NotFinite { quantity }) }
}

pub(crate) fn positive(quantity: Quantity, value: f64) -> Result<(), Fault> {
    finite(quantity, &[value])?;
    if value > 0.0 { Ok(()) } else { Err(Fault::NotPositive { quantity, value }) }
}

pub(crate) fn not_negative(quantity: Quantity, value: f64) -> Result<(), Fault> {
    finite(quantity, &[value])?;
    if value >= 0.0 { Ok(()) } else { Err(Fault::Negative { quantity, value }) }
}
