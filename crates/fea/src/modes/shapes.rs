//! Shapes of a member in one plane of bending, as polynomials in the fraction of its length.

use nalgebra::SVector;
use splines::{BeamColumn, lowered};

use crate::assembly::BendingPlane;

/// Twelve displacements and rotations of the ends of a member.
pub(super) type Vector12 = SVector<f64, 12>;

/// Coefficients of the longest polynomials.
const LONGEST: usize = 9;

/// Terms of a power series: |(lambda l)^2| is at most one.
const SERIES: usize = 20;

/// A polynomial in the fraction of the length: the coefficient of each power.
pub(super) type Polynomial = [f64; LONGEST];

/// Integrals over 0 to 1 of products of two powers.
const POWERS: [Polynomial; LONGEST] = {
    let mut table = [[0.0; LONGEST]; LONGEST];
    let mut p = 0;
    while p < LONGEST {
        let mut q = 0;
        while q < LONGEST {
            table[p][q] = 1.0 / (p + q + 1) as f64;
            q += 1;
        }
        p += 1;
    }
    table
};

/// Integral over 0 to 1 of a product of two polynomials.
pub(super) fn integral_of_product(a: &Polynomial, b: &Polynomial) -> f64 {
    Moments::of(a).integral_with(b)
}

/// Integrals over 0 to 1 of a polynomial times each power, for its products with many others.
#[derive(Clone, Copy)]
pub(super) struct Moments([f64; LONGEST]);

impl Moments {
    pub fn of(polynomial: &Polynomial) -> Self {
        let mut sums = [0.0; LONGEST];
        for (coefficient, row) in polynomial.iter().zip(&POWERS) {
            sums.iter_mut()
                .zip(row)
                .for_each(|(sum, integral)| *sum += coefficient * integral);
        }
        Moments(sums)
    }

    /// Integral over 0 to 1 of the product with another polynomial.
    pub fn integral_with(&self, other: &Polynomial) -> f64 {
        self.0.iter().zip(other).map(|(a, b)| a * b).sum()
    }
}

/// |(lambda l)^2| up to which an axial force bends the shapes; parts of members with more have those without.
pub(super) const MOST_BENT: f64 = 1.0;

/// Whether the shapes of a plane are those of the beam-column.
pub(super) fn is_bent(plane: &BendingPlane, length: f64) -> bool {
    let square = plane.bending * plane.tension / (1.0 + plane.shear * plane.tension);
    plane.tension != 0.0 && (square * length * length).abs() <= MOST_BENT
}

/// Deflection and rotation of the member without load, for a unit deflection and a unit rotation of its first
/// end, then of its last; cubic and quadratic with phi = 12 EI / (G As L^2), or as an axial force bends them.
pub(super) fn bending_shapes(plane: &BendingPlane, length: f64) -> [[Polynomial; 2]; 4] {
    if is_bent(plane, length) {
        return BeamColumn::new(plane.bending, plane.shear, plane.tension, length).polynomials();
    }
    let phi = plane.shear_ratio(length);
    let (d, h) = (1.0 / (1.0 + phi), length);
    let scaled = |factor: f64, cubic: [f64; 4]| polynomial(&cubic.map(|x| factor * x));
    [
        [
            scaled(d, [1.0 + phi, -phi, -3.0, 2.0]),
            scaled(d / h, [0.0, -6.0, 6.0, 0.0]),
        ],
        [
            scaled(d * h, [0.0, 1.0 + 0.5 * phi, -2.0 - 0.5 * phi, 1.0]),
            scaled(d, [1.0 + phi, -4.0 - phi, 3.0, 0.0]),
        ],
        [
            scaled(d, [0.0, phi, 3.0, -2.0]),
            scaled(d / h, [0.0, 6.0, -6.0, 0.0]),
        ],
        [
            scaled(d * h, [0.0, -0.5 * phi, 0.5 * phi - 1.0, 1.0]),
            scaled(d, [0.0, phi - 2.0, 3.0, 0.0]),
        ],
    ]
}

/// Coefficients of a polynomial of lower degree.
pub(super) fn polynomial(coefficients: &[f64]) -> Polynomial {
    std::array::from_fn(|p| coefficients.get(p).copied().unwrap_or(0.0))
}

/// Deflection and rotation of the clamped member under a uniform load of intensity one.
pub(super) fn uniform_load_shape(plane: &BendingPlane, length: f64) -> [Polynomial; 2] {
    if is_bent(plane, length) {
        return bent_deflection(plane, length, &[polynomial(&[1.0]), polynomial(&[])]);
    }
    let bending = plane.bending * length.powi(4) / 24.0;
    let shear = plane.shear * length * length / 2.0;
    let turn = 2.0 * bending / length;
    [
        polynomial(&[0.0, shear, bending - shear, -2.0 * bending, bending]),
        polynomial(&[0.0, turn, -3.0 * turn, 2.0 * turn]),
    ]
}

/// Twice the strain energy of this deflection.
pub(super) fn uniform_load_stiffness(plane: &BendingPlane, length: f64) -> f64 {
    let (c, g) = (plane.bending, plane.shear);
    if is_bent(plane, length) {
        // The work of the load.
        let [deflection, _] = uniform_load_shape(plane, length);
        return length * integral_of_product(&deflection, &polynomial(&[1.0]));
    }
    let mut stiffness = c * length.powi(5) / 720.0 + g * length.powi(3) / 12.0;
    if plane.tension != 0.0 {
        // The axial force times the integral of the square of the slope.
        let slopes = c * c * length.powi(7) / 30_240.0 + c * g * length.powi(5) / 360.0;
        stiffness += plane.tension * (slopes + g * g * length.powi(3) / 12.0);
    }
    stiffness
}

/// Deflection and rotation of the clamped member with an axial force under the force f = `loads[0]` and the moment mu =
/// `loads[1]` per length, of degree eight through values of the power series of
///
/// H' = -f,    theta'' = lambda^2 theta - c (H/(1 + g N) + mu),    w' = (theta + g H)/(1 + g N).
pub(super) fn bent_deflection(
    plane: &BendingPlane,
    length: f64,
    loads: &[Polynomial; 2],
) -> [Polynomial; 2] {
    let (c, g, h) = (plane.bending, plane.shear, length);
    let stiffening = 1.0 + g * plane.tension;
    let square = c * plane.tension / stiffening * h * h;
    // The motion with the rotation `turn` per fraction and the transverse force `force` at the first end under a share of the loads.
    let motion = |turn: f64, force: f64, share: f64| {
        let load = |k: usize, p: usize| share * loads[k].get(p).copied().unwrap_or(0.0);
        let transverse: [f64; SERIES] = std::array::from_fn(|p| match p {
            0 => force,
            _ => -h * load(0, p - 1) / p as f64,
        });
        let (mut deflection, mut rotation) = ([0.0; SERIES], [0.0; SERIES]);
        rotation[1] = turn;
        for p in 2..SERIES {
            let bend = c * h * h * (transverse[p - 2] / stiffening + load(1, p - 2));
            rotation[p] = (square * rotation[p - 2] - bend) / (p * (p - 1)) as f64;
        }
        for p in 1..SERIES {
            deflection[p] = h * (rotation[p - 1] + g * transverse[p - 1]) / (stiffening * p as f64);
        }
        [lowered(&deflection), lowered(&rotation)]
    };
    let [of_loads, of_turn, of_force] = [
        motion(0.0, 0.0, 1.0),
        motion(1.0, 0.0, 0.0),
        motion(0.0, 1.0, 0.0),
    ];
    let end = |of: &[Polynomial; 2]| {
        of.each_ref()
            .map(|polynomial| polynomial.iter().sum::<f64>())
    };
    let ([w, t], [wt, tt], [wf, tf]) = (end(&of_loads), end(&of_turn), end(&of_force));
    let determinant = wt * tf - wf * tt;
    let [turn, force] = [
        (wf * t - w * tf) / determinant,
        (w * tt - wt * t) / determinant,
    ];
    std::array::from_fn(|k| {
        std::array::from_fn(|p| of_loads[k][p] + turn * of_turn[k][p] + force * of_force[k][p])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Identity: with a small axial force the series is the polynomial without one; analytic: the equations hold.
    #[test]
    fn bent_deflection_obeys_its_equations() {
        let plane = |tension: f64| BendingPlane {
            deflection: 1,
            rotation: 5,
            sign: 1.0,
            bending: 0.3,
            shear: 0.7,
            tension,
        };
        let length = 0.4;
        let loads = [polynomial(&[0.4, -1.0, 2.0]), polynomial(&[1.2, 0.7])];
        let (with, n) = (plane(-0.6), -0.6);
        let [w, t] = bent_deflection(&with, length, &loads);
        let value = |of: &Polynomial, s: f64| of.iter().rev().fold(0.0, |sum, c| sum * s + c);
        let derivative = |of: &Polynomial| -> Polynomial {
            std::array::from_fn(|p| of.get(p + 1).map_or(0.0, |c| (p + 1) as f64 * c / length))
        };
        let shear: Polynomial = std::array::from_fn(|p| (derivative(&w)[p] - t[p]) / with.shear);
        let transverse: Polynomial = std::array::from_fn(|p| shear[p] + n * derivative(&w)[p]);
        let moment = derivative(&t).map(|x| x / with.bending);
        for s in [0.0, 0.3, 0.8] {
            assert!(
                (value(&derivative(&transverse), s) + value(&loads[0], s)).abs() < 1e-7,
                "{s}"
            );
            assert!(
                (value(&derivative(&moment), s) + value(&shear, s) + value(&loads[1], s)).abs()
                    < 1e-7,
                "{s}"
            );
        }
        for end in [0.0, 1.0] {
            assert!(value(&w, end).abs() < 1e-15 && value(&t, end).abs() < 1e-15);
        }
        let [[near, _], [straight, _]] =
            [1e-12, 0.0].map(|n| uniform_load_shape(&plane(n), length));
        near.iter()
            .zip(straight)
            .for_each(|(a, b)| assert!((a - b).abs() < 1e-13, "{a}, not {b}"));
        let energies = [1e-12, 0.0].map(|n| uniform_load_stiffness(&plane(n), length));
        assert!((energies[0] / energies[1] - 1.0).abs() < 1e-11);
    }
}
