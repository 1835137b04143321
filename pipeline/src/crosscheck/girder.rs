//! Straight girder as the scripts of the other codes read it.

use super::error::Error;
use serde::Serialize;

/// A straight uniform girder, continuous over its supports, in consistent units.
///
/// Every support restrains vertical and lateral displacement and twist, the first one also longitudinal displacement;
/// bending rotations are free. Grids that depend on an unknown stiffness are not computed. A beam without shear
/// stiffness is rigid in shear.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PlainGirder {
    /// Lengths between supports, first to last.
    pub spans: Vec<f64>,
    /// Lengths beyond the first and the last support.
    pub overhangs: [f64; 2],
    /// Coordinates along the rail, 0 at the first support, increasing.
    pub stations: Vec<f64>,
    /// Height of the rail above the elastic axis.
    pub rail_height: f64,
    /// Stiffness along the girder, force.
    #[serde(rename = "EA")]
    pub axial: Option<f64>,
    /// Bending stiffness under vertical loads, force length^2.
    #[serde(rename = "EI_vertical")]
    pub bending_vertical: Option<f64>,
    /// Bending stiffness under lateral loads, force length^2.
    #[serde(rename = "EI_lateral")]
    pub bending_lateral: Option<f64>,
    /// Torsional stiffness, force length^2.
    #[serde(rename = "GJ")]
    pub torsion: Option<f64>,
    /// Shear stiffness under vertical loads, force.
    #[serde(rename = "kGA_vertical")]
    pub shear_vertical: Option<f64>,
    /// Shear stiffness under lateral loads, force.
    #[serde(rename = "kGA_lateral")]
    pub shear_lateral: Option<f64>,
}

impl PlainGirder {
    /// Checks every number.
    ///
    /// # Errors
    /// The first number that is not valid.
    pub fn check(&self) -> Result<(), Error> {
        if self.spans.is_empty() {
            return Err(Error::NoSpan);
        }
        let good = |v: f64| v.is_finite() && v > 0.0;
        let last = self.spans.len() + 1;
        for (index, overhang) in [(0, self.overhangs[0]), (last, self.overhangs[1])] {
            if !(overhang.is_finite() && overhang >= 0.0) {
                return Err(Error::Length(index));
            }
        }
        if let Some(index) = self.spans.iter().position(|v| !good(*v)) {
            return Err(Error::Length(index + 1));
        }
        for (name, value) in [
            ("EA", self.axial),
            ("EI_vertical", self.bending_vertical),
            ("EI_lateral", self.bending_lateral),
            ("GJ", self.torsion),
            ("kGA_vertical", self.shear_vertical),
            ("kGA_lateral", self.shear_lateral),
        ] {
            if value.is_some_and(|v| !good(v)) {
                return Err(Error::Stiffness(name));
            }
        }
        if !self.rail_height.is_finite() {
            return Err(Error::Stiffness("rail_height"));
        }
        let (low, high) = (
            -self.overhangs[0],
            self.spans.iter().sum::<f64>() + self.overhangs[1],
        );
        let slack = 1e-12 * (high - low);
        for (i, x) in self.stations.iter().enumerate() {
            let on = (low - slack..=high + slack).contains(x);
            if !on || (i > 0 && self.stations[i - 1] >= *x) {
                return Err(Error::Station(i));
            }
        }
        Ok(())
    }
}
