//! Deflections of a member under loads on another as polynomials of both places, and bounds of their second derivatives.
//!
//! The deflection G(x, p) at x of one member under a unit load at p of another is cubic in each. On the same member there is
//! one such polynomial on either side of the load, and their difference depends on x - p alone. So while load and place
//! move along together, the second derivative G_xx + 2 G_xp + G_pp is that of one polynomial, without a kink at the load.

use crate::error::Error;
use crate::line::{LineCell, Lines, NODES, in_powers};
use crate::rail_deflection::POWERS;
use crate::structure::{Carrier, Structure};
use crate::train::{COMPONENTS, PlacedTrain};

/// Bounds of the second derivative of the deflection of one carrier per unit load: by rail and component.
#[derive(Clone, Debug)]
pub(crate) struct SecondDerivatives {
    rails: Vec<[f64; COMPONENTS]>,
}

impl SecondDerivatives {
    /// Bounds the second derivatives of a deflection of a carrier, for loads that stay as for those that move along.
    pub fn new(
        structure: &Structure,
        carrier: &Carrier,
        direction: usize,
        lines: &Lines<POWERS>,
    ) -> Result<SecondDerivatives, Error> {
        let width = carrier.x[1] - carrier.x[0];
        let loads = structure.unit_kernels(carrier, direction)?;
        let mut rails = vec![[0.0_f64; COMPONENTS]; structure.rail_count()];
        for (bounds, cells) in rails.iter_mut().zip(&lines.rails) {
            for cell in cells {
                let h = cell.x[1] - cell.x[0];
                let on = loads.iter().find(|(on, _)| on.other.element == cell.element);
                for (component, bound) in bounds.iter_mut().enumerate() {
                    let ahead = of_cell(cell, component);
                    *bound = bound.max(ahead.second(width, h));
                    let Some((on, kernels)) = on else { continue };
                    let first = on.start + on.rate * (cell.x[0] - on.other.x[0]);
                    let kernel = Bicubic::new(NODES.map(|node| {
                        in_fractions(kernels[component].passing(node * carrier.length - first, on.rate), h)
                    }));
                    *bound = bound.max(ahead.plus(&kernel).second(width, h));
                }
            }
        }
        Ok(SecondDerivatives { rails })
    }

    /// The bound for all wheels of a train together.
    pub fn of_train(&self, train: &PlacedTrain) -> f64 {
        let wheels = train.wheels.iter().map(|wheel| {
            let bounds = wheel.load.iter().zip(&self.rails[wheel.rail]);
            bounds.map(|(load, bound)| load.abs() * bound).sum::<f64>()
        });
        wheels.sum()
    }
}

/// The deflection with the load in a cell, not passed.
fn of_cell(cell: &LineCell<POWERS>, component: usize) -> Bicubic {
    Bicubic { c: cell.cubics[component].map(|cubic| in_fractions(cubic, cell.x[1] - cell.x[0])) }
}

/// A cubic in the fraction of a length.
fn in_fractions([a, b, c, d]: [f64; 4], h: f64) -> [f64; 4] {
    [a, h * b, h * h * c, h * h * h * d]
}

/// A polynomial of degree three in two fractions u and v: coefficients by powers of u and v.
struct Bicubic {
    c: [[f64; 4]; 4],
}

impl Bicubic {
    /// From the cubics in v at the nodes of u.
    fn new(at_nodes: [[f64; 4]; 4]) -> Bicubic {
        let mut c = [[0.0; 4]; 4];
        for j in 0..4 {
            let in_u = in_powers([0, 1, 2, 3].map(|node| at_nodes[node][j]));
            (0..4).for_each(|i| c[i][j] = in_u[i]);
        }
        Bicubic { c }
    }

    fn plus(&self, other: &Bicubic) -> Bicubic {
        Bicubic { c: std::array::from_fn(|i| std::array::from_fn(|j| self.c[i][j] + other.c[i][j])) }
    }

    /// Bound over both fractions from 0 to 1 of the size of the second derivative by u, and of that along u and v together,
    /// for lengths `hu` and `hv` of the two stretches.
    fn second(&self, hu: f64, hv: f64) -> f64 {
        let (mut own, mut along) = ([[0.0; 4]; 4], [[0.0; 4]; 4]);
        for i in 0..4 {
            for j in 0..4 {
                let (p, q, c) = (i as f64, j as f64, self.c[i][j]);
                if i >= 2 {
                    own[i - 2][j] += p * (p - 1.0) * c / (hu * hu);
                    along[i - 2][j] += p * (p - 1.0) * c / (hu * hu);
                }
                if i >= 1 && j >= 1 {
                    along[i - 1][j - 1] += 2.0 * p * q * c / (hu * hv);
                }
                if j >= 2 {
                    along[i][j - 2] += q * (q - 1.0) * c / (hv * hv);
                }
            }
        }
        let size = |all: &[[f64; 4]; 4]| all.iter().flatten().map(|c| c.abs()).sum::<f64>();
        size(&own).max(size(&along))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u^2 v + 3 v^2 over lengths 2 and 5: G_uu = 2 v/4, along both 2 v/4 + 2 (2 u)/10 + 6/25.
    #[test]
    fn second_derivatives_of_a_polynomial() {
        let at_nodes = NODES.map(|u| [0.0, u * u, 3.0, 0.0]);
        let found = Bicubic::new(at_nodes).second(2.0, 5.0);
        assert!((found - (0.5 + 0.4 + 0.24)).abs() < 1e-12, "{found}");
    }
}
