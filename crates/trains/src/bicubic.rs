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

/// Bounds of plus and minus the second derivative of the deflection of one carrier per unit load: by rail and component.
#[derive(Clone, Debug)]
pub(crate) struct SecondDerivatives {
    rails: Vec<[[f64; 2]; COMPONENTS]>,
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
        let mut rails = vec![[[0.0_f64; 2]; COMPONENTS]; structure.rail_count()];
        for (bounds, cells) in rails.iter_mut().zip(&lines.rails) {
            for cell in cells {
                let h = cell.x[1] - cell.x[0];
                let on = loads
                    .iter()
                    .find(|(on, _)| Some(on.other.stretch) == cell.stretch);
                for (component, bound) in bounds.iter_mut().enumerate() {
                    let ahead = of_cell(cell, component);
                    let mut offer =
                        |found: [f64; 2]| (0..2).for_each(|k| bound[k] = bound[k].max(found[k]));
                    offer(ahead.second(width, h));
                    let Some((on, kernels)) = on else { continue };
                    let first = on.start + on.rate * (cell.x[0] - on.other.x[0]);
                    let kernel = Bicubic::new(NODES.map(|node| {
                        in_fractions(
                            kernels[component].passing(node * carrier.length - first, on.rate),
                            h,
                        )
                    }));
                    offer(ahead.plus(&kernel).second(width, h));
                }
            }
        }
        Ok(SecondDerivatives { rails })
    }

    /// The bound of minus the second derivative of sign times the deflection for all wheels of a train together.
    pub fn of_train(&self, train: &PlacedTrain, sign: f64) -> f64 {
        let wheels = train.wheels.iter().map(|wheel| {
            let bounds = wheel.load.iter().zip(&self.rails[wheel.rail]);
            bounds
                .map(|(load, [above, below])| {
                    load.abs() * if sign * load > 0.0 { *below } else { *above }
                })
                .sum::<f64>()
        });
        wheels.sum()
    }
}

/// The deflection with the load in a cell, not passed.
fn of_cell(cell: &LineCell<POWERS>, component: usize) -> Bicubic {
    Bicubic {
        c: cell.cubics[component].map(|cubic| in_fractions(cubic, cell.x[1] - cell.x[0])),
    }
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
        Bicubic {
            c: std::array::from_fn(|i| std::array::from_fn(|j| self.c[i][j] + other.c[i][j])),
        }
    }

    /// Bounds over both fractions from 0 to 1 of plus and minus the second derivative by u, and of those along u and v
    /// together, for lengths `hu` and `hv` of the two stretches.
    fn second(&self, hu: f64, hv: f64) -> [f64; 2] {
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
        [own, along]
            .iter()
            .map(bernstein)
            .fold([f64::NEG_INFINITY; 2], |a, b| {
                [a[0].max(b[0]), a[1].max(b[1])]
            })
    }
}

/// Bounds of plus and minus a polynomial of degree three in two fractions: its largest and smallest Bernstein coefficient.
///
/// # Source
/// Farouki, The Bernstein polynomial basis: a centennial retrospective, CAGD 29 (2012), section 3.
fn bernstein(powers: &[[f64; 4]; 4]) -> [f64; 2] {
    let convert = |[a, b, c, d]: [f64; 4]| [a, a + b / 3.0, a + (2.0 * b + c) / 3.0, a + b + c + d];
    let rows = powers.map(convert);
    let columns: [[f64; 4]; 4] = std::array::from_fn(|j| convert(rows.map(|row| row[j])));
    let all = columns.iter().flatten();
    all.fold([f64::NEG_INFINITY; 2], |bounds, c| {
        [bounds[0].max(*c), bounds[1].max(-c)]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u^2 v + 3 v^2 over lengths 2 and 5: G_uu = 2 v/4, along both 2 v/4 + 2 (2 u)/10 + 6/25.
    #[test]
    fn second_derivatives_of_a_polynomial() {
        let at_nodes = NODES.map(|u| [0.0, u * u, 3.0, 0.0]);
        let found = Bicubic::new(at_nodes).second(2.0, 5.0);
        // The second derivative by u alone is between 0 and 0.5.
        assert!(
            (found[0] - (0.5 + 0.4 + 0.24)).abs() < 1e-12 && found[1].abs() < 1e-12,
            "{found:?}"
        );
    }
}
