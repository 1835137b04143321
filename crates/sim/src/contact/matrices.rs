//! The compliance of the rails between force elements.

use crate::numerics::dense::along;

/// Compliance matrices over all elements, row-major.
#[derive(Clone)]
pub(crate) struct RailMatrices {
    /// G: deflection of the rail at element i per unit of force j.
    pub value: Vec<f64>,
    /// d G(i, j)/d x_i, where x_i is the position of element i along its rail.
    pub slope: Vec<f64>,
    /// Derivative of G(i, j) with respect to the position of each tangential contact of element i, over elements j.
    pub tangential: Vec<f64>,
}

impl RailMatrices {
    /// Matrices of zeros for `elements` elements and `tangential` contacts along rails.
    pub fn zeros(elements: usize, tangential: usize) -> Self {
        RailMatrices {
            value: vec![0.0; elements * elements],
            slope: vec![0.0; elements * elements],
            tangential: vec![0.0; elements * tangential],
        }
    }

    /// Deflection of the rail at element `i` under the forces `force`.
    #[inline]
    pub fn deflection(&self, i: usize, force: &[f64]) -> f64 {
        along(&self.value, i, force)
    }
}
