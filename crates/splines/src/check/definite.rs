//! Whether a structure can give back more than was put in.

use nalgebra::DMatrix;

use super::Strip;
use crate::{Error, Table};

/// Ends of the spectrum of a matrix's symmetric part, length/force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spectrum {
    /// Smallest eigenvalue: negative where some loads do negative work.
    pub smallest: f64,
    /// Largest eigenvalue.
    pub largest: f64,
}

impl Spectrum {
    /// Of the symmetric part of a square matrix; zeros where it is empty.
    #[must_use]
    pub fn of(matrix: &DMatrix<f64>) -> Spectrum {
        if matrix.is_empty() || !matrix.is_square() {
            return Spectrum::default();
        }
        let values = (0.5 * (matrix + matrix.transpose())).symmetric_eigenvalues();
        Spectrum { smallest: values.min(), largest: values.max() }
    }
}

/// Spectrum of a table; `None` where its stations along z are not those along x.
#[must_use]
pub fn station_spectrum(table: &Table) -> Option<Spectrum> {
    (table.z() == table.x()).then(|| Spectrum::of(table.values()))
}

/// Spectrum of a direct strip on `places`: one wheel at each of them.
///
/// # Errors
/// What the compliance refuses.
pub fn spectrum(strip: &Strip<'_>, places: &[f64]) -> Result<Spectrum, Error> {
    Ok(Spectrum::of(&strip.block(places, places)?))
}
