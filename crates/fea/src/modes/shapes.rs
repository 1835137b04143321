//! Shapes of a member in one plane of bending, as polynomials in the fraction of its length.

use nalgebra::SVector;

use crate::assembly::BendingPlane;

/// Twelve displacements and rotations of the ends of a member.
pub(super) type Vector12 = SVector<f64, 12>;

/// A cubic in the fraction of the length: the coefficient of each power.
pub(super) type Cubic = [f64; 4];

/// Coefficients of the longest polynomials whose products are integrated.
const LONGEST: usize = 9;

/// Integral over 0 to 1 of a product of two polynomials, given by their coefficients.
pub(super) fn integral_of_product(a: &[f64], b: &[f64]) -> f64 {
    let mut product = [0.0; 2 * LONGEST - 1];
    for (p, x) in a.iter().enumerate().filter(|(_, x)| **x != 0.0) {
        product[p..].iter_mut().zip(b).for_each(|(sum, y)| *sum += x * y);
    }
    product.iter().enumerate().map(|(power, c)| c / (power + 1) as f64).sum()
}

/// Deflection and rotation of the member without load, for a unit deflection and a unit rotation of its first
/// end, then of its last; phi = 12 EI / (G As L^2).
pub(super) fn bending_shapes(phi: f64, length: f64) -> [(Cubic, Cubic); 4] {
    let (d, h) = (1.0 / (1.0 + phi), length);
    let scaled = |factor: f64, cubic: Cubic| cubic.map(|x| factor * x);
    [
        (scaled(d, [1.0 + phi, -phi, -3.0, 2.0]), scaled(d / h, [0.0, -6.0, 6.0, 0.0])),
        (
            scaled(d * h, [0.0, 1.0 + 0.5 * phi, -2.0 - 0.5 * phi, 1.0]),
            scaled(d, [1.0 + phi, -4.0 - phi, 3.0, 0.0]),
        ),
        (scaled(d, [0.0, phi, 3.0, -2.0]), scaled(d / h, [0.0, 6.0, -6.0, 0.0])),
        (scaled(d * h, [0.0, -0.5 * phi, 0.5 * phi - 1.0, 1.0]), scaled(d, [0.0, phi - 2.0, 3.0, 0.0])),
    ]
}

/// Deflection and rotation under a uniform load of intensity one, by powers of the fraction of the length.
pub(super) fn uniform_load_shape(plane: &BendingPlane, length: f64) -> ([f64; 5], [f64; 4]) {
    let bending = plane.bending * length.powi(4) / 24.0;
    let shear = plane.shear * length * length / 2.0;
    let turn = 2.0 * bending / length;
    ([0.0, shear, bending - shear, -2.0 * bending, bending], [0.0, turn, -3.0 * turn, 2.0 * turn])
}
