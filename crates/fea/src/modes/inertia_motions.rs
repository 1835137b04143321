//! Deflections of members between their ends under the inertia of their own motions.
//!
//! A mode moves the mass of a member by the shapes without load, with amplitudes z_1 to z_4 (deflection and rotation of
//! both ends), and by its interior motion U, with amplitude z_5. Each of these five motions N_j has a distributed inertia
//! per omega^2: the force m N_j along the deflection and the moment m r^2 theta_j. The clamped member deflects under it
//! by a polynomial of degree eight,
//!
//! Q' = -f,    M' = -Q - mu,    EI theta' = M,    w' = theta + Q/GAs,    w = theta = 0 at both ends,
//!
//! and about a state with the axial force N by the series of
//!
//! H' = -f,    H = Q + N w',    M' = -Q - mu,    EI theta' = M,    w' = theta + Q/GAs
//!
//! up to the same degree; of which the interior motion already carries a part, its projection on U in the strain energy. Where ends are released,
//! they move under this load by K_rr^-1 times its work on their motions, beside the tips. The rest and this part are the
//! motions delta_j of this module. In the strain energy they are orthogonal to all motions of the mesh.

use splines::MemberMotion;

use crate::assembly::BendingPlane;
use crate::modes::shapes::{
    Moments, Polynomial, bending_shapes, bent_deflection, is_bent, uniform_load_shape,
    uniform_load_stiffness,
};

/// Number of motions with inertia in one plane of a member: four of the ends, and the interior motion.
pub(super) const MOTIONS: usize = 5;

/// The motions delta_j of a member in one plane of bending.
#[derive(Clone, Debug)]
pub(super) struct InertiaMotions {
    /// Deflection and rotation under a unit of each motion and of omega^2.
    pub motions: [MemberMotion; MOTIONS],
    /// Products of their strain energies, twice: also the work of the inertia of motion i on delta_j, and on any part of
    /// the mesh none.
    pub stiffness: [[f64; MOTIONS]; MOTIONS],
    /// Products of their kinetic energies, twice.
    pub mass: [[f64; MOTIONS]; MOTIONS],
    /// The interior motion.
    pub uniform: MemberMotion,
}

/// The mass of a member: per length, and of the rotation of its sections.
#[derive(Clone, Copy, Debug)]
pub(super) struct MassPerLength {
    pub deflection: f64,
    pub rotation: f64,
}

impl InertiaMotions {
    /// The motions in plane number `index` of a member of length `length`. `released` is K_rr^-1 of its released ends in
    /// this plane, by deflection and rotation of both ends; zeros without releases.
    pub fn new(
        index: usize,
        plane: &BendingPlane,
        length: f64,
        mass: MassPerLength,
        released: &[[f64; 4]; 4],
    ) -> InertiaMotions {
        let shapes = shapes(plane, length);
        let moments = |of: &[Polynomial; 2]| of.each_ref().map(Moments::of);
        let work = |a: &[Moments; 2], b: &[Polynomial; 2]| {
            length
                * (mass.deflection * a[0].integral_with(&b[0])
                    + mass.rotation * a[1].integral_with(&b[1]))
        };
        let shape_moments = shapes.each_ref().map(moments);
        let of_shapes = products(|i, j| work(&shape_moments[i], &shapes[j]));
        let uniform = &shapes[MOTIONS - 1];
        let energy = uniform_load_stiffness(plane, length);
        let rest: [[Polynomial; 2]; MOTIONS] = std::array::from_fn(|j| {
            let loads = [
                shapes[j][0].map(|c| mass.deflection * c),
                shapes[j][1].map(|c| mass.rotation * c),
            ];
            let whole = clamped_deflection(plane, length, &loads);
            let carried = of_shapes[j][MOTIONS - 1] / energy;
            let mut rest: [Polynomial; 2] = std::array::from_fn(|k| {
                std::array::from_fn(|p| whole[k][p] - carried * uniform[k][p])
            });
            for (row, shape) in released.iter().zip(&shapes) {
                let moved: f64 = row
                    .iter()
                    .zip(&of_shapes[j])
                    .map(|(c, work)| c * work)
                    .sum();
                for (rest, shape) in rest.iter_mut().zip(shape) {
                    rest.iter_mut()
                        .zip(shape)
                        .for_each(|(rest, c)| *rest += moved * c);
                }
            }
            rest
        });
        let rest_moments = rest.each_ref().map(moments);
        InertiaMotions {
            motions: rest.map(|[deflection, rotation]| MemberMotion {
                plane: index,
                deflection,
                rotation,
            }),
            // Its two halves are equal but for rounding.
            stiffness: products(|i, j| {
                0.5 * (work(&shape_moments[i], &rest[j]) + work(&shape_moments[j], &rest[i]))
            }),
            mass: products(|i, j| work(&rest_moments[i], &rest[j])),
            uniform: uniform_load_motion(index, plane, length),
        }
    }
}

/// A symmetric matrix of products, each computed once.
fn products(product: impl Fn(usize, usize) -> f64) -> [[f64; MOTIONS]; MOTIONS] {
    let upper: [[f64; MOTIONS]; MOTIONS] =
        std::array::from_fn(|i| std::array::from_fn(|j| if i <= j { product(i, j) } else { 0.0 }));
    std::array::from_fn(|i| std::array::from_fn(|j| upper[i.min(j)][i.max(j)]))
}

/// Deflection and rotation of the motions N_j.
fn shapes(plane: &BendingPlane, length: f64) -> [[Polynomial; 2]; MOTIONS] {
    let [a, b, c, d] = bending_shapes(plane, length);
    [a, b, c, d, uniform_load_shape(plane, length)]
}

/// The interior motion of a member: its deflection between clamped ends under a uniform load of intensity one.
pub(super) fn uniform_load_motion(index: usize, plane: &BendingPlane, length: f64) -> MemberMotion {
    let [deflection, rotation] = uniform_load_shape(plane, length);
    MemberMotion {
        plane: index,
        deflection,
        rotation,
    }
}

/// Deflection and rotation of the clamped member under the force f = `loads[0]` and the moment mu = `loads[1]` per
/// length, of degree four and three at most.
fn clamped_deflection(
    plane: &BendingPlane,
    length: f64,
    loads: &[Polynomial; 2],
) -> [Polynomial; 2] {
    if is_bent(plane, length) {
        return bent_deflection(plane, length, loads);
    }
    let (c, g, h) = (plane.bending, plane.shear, length);
    // Repeated integrals from the first end, by the fraction of the length.
    let force = repeated(&loads[0]);
    let moment = repeated(&loads[1]);
    let at_end = |polynomial: &Polynomial| polynomial.iter().sum::<f64>();
    let [_, f2, f3, f4] = force.each_ref().map(at_end);
    let [_, m2, m3, _] = moment.each_ref().map(at_end);
    // Shear force and bending moment at the first end, so that rotation and deflection vanish at the last.
    let bent = h * c * (h * h * (0.5 * f3 - f4) + h * (m3 - 0.5 * m2));
    let shear = (h * g * f2 + bent) / (h * h * c / 12.0 + g);
    let bending = 0.5 * h * shear - h * h * f3 + h * m2;
    let mut rotation = [0.0; 9];
    let mut deflection = [0.0; 9];
    for p in 0..9 {
        rotation[p] = h * c * (h * h * force[2][p] - h * moment[1][p]);
        deflection[p] =
            h * h * c * (h * h * force[3][p] - h * moment[2][p]) - h * h * g * force[1][p];
    }
    rotation[1] += h * c * bending;
    rotation[2] -= 0.5 * h * h * c * shear;
    deflection[1] += h * g * shear;
    deflection[2] += 0.5 * h * h * c * bending;
    deflection[3] -= h * h * h * c * shear / 6.0;
    [deflection, rotation]
}

/// Four repeated integrals from 0 of a polynomial.
fn repeated(of: &Polynomial) -> [Polynomial; 4] {
    let mut current = *of;
    std::array::from_fn(|_| {
        for p in (1..9).rev() {
            current[p] = current[p - 1] / p as f64;
        }
        current[0] = 0.0;
        current
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modes::shapes::{integral_of_product, polynomial};

    const PLANE: BendingPlane = BendingPlane {
        deflection: 1,
        rotation: 5,
        sign: 1.0,
        bending: 0.3,
        shear: 0.7,
        tension: 0.0,
    };
    const LENGTH: f64 = 1.7;

    fn value(polynomial: &[f64], s: f64) -> f64 {
        polynomial.iter().rev().fold(0.0, |sum, c| sum * s + c)
    }

    fn derivative(of: &Polynomial) -> Polynomial {
        std::array::from_fn(|p| of.get(p + 1).map_or(0.0, |c| (p + 1) as f64 * c / LENGTH))
    }

    /// Analytic: the balance of forces and moments of the clamped Timoshenko member.
    #[test]
    fn clamped_deflection_is_in_equilibrium_with_its_loads() {
        let loads = [
            polynomial(&[0.4, -1.0, 2.0, 0.3, -0.9]),
            polynomial(&[1.2, 0.7, -2.0, 0.5]),
        ];
        let [deflection, rotation] = clamped_deflection(&PLANE, LENGTH, &loads);
        let slope = derivative(&deflection);
        let shear: Polynomial = std::array::from_fn(|p| (slope[p] - rotation[p]) / PLANE.shear);
        let moment = derivative(&rotation).map(|c| c / PLANE.bending);
        for s in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let force = value(&derivative(&shear), s) + value(&loads[0], s);
            let couple = value(&derivative(&moment), s) + value(&shear, s) + value(&loads[1], s);
            assert!(
                force.abs() < 1e-12 && couple.abs() < 1e-12,
                "{s}: {force:e}, {couple:e}"
            );
        }
        for s in [0.0, 1.0] {
            assert!(value(&deflection, s).abs() < 1e-14 && value(&rotation, s).abs() < 1e-14);
        }
    }

    /// Identity: what is left of a deflection is orthogonal to the interior motion, and the work of the inertia of each motion
    /// on it is the product of the strain energies. Equilibrium: a released end has no moment.
    #[test]
    fn inertia_motions_are_orthogonal_to_the_interior_motion() {
        let mass = MassPerLength {
            deflection: 2.0,
            rotation: 0.6,
        };
        // The rotation of the first end is released; its stiffness is (4 + phi) EI/((1 + phi) L).
        let phi = PLANE.shear_ratio(LENGTH);
        let mut released = [[0.0; 4]; 4];
        released[1][1] = PLANE.bending * LENGTH * (1.0 + phi) / (4.0 + phi);
        let found = InertiaMotions::new(0, &PLANE, LENGTH, mass, &released);
        let energy = |a: &MemberMotion, b: &MemberMotion| {
            let shear = |motion: &MemberMotion| -> Polynomial {
                let slope = derivative(&motion.deflection);
                std::array::from_fn(|p| (slope[p] - motion.rotation[p]) / PLANE.shear)
            };
            let bend =
                |motion: &MemberMotion| derivative(&motion.rotation).map(|c| c / PLANE.bending);
            LENGTH
                * (PLANE.shear * integral_of_product(&shear(a), &shear(b))
                    + PLANE.bending * integral_of_product(&bend(a), &bend(b)))
        };
        let uniform = uniform_load_motion(0, &PLANE, LENGTH);
        let largest = (0..MOTIONS)
            .map(|j| found.stiffness[j][j])
            .fold(0.0, f64::max);
        for (i, a) in found.motions.iter().enumerate() {
            let product = energy(a, &uniform);
            assert!(product.abs() < 1e-14, "{i}: {product:e}");
            for (j, b) in found.motions.iter().enumerate() {
                let error = energy(a, b) - found.stiffness[i][j];
                assert!(
                    error.abs() < 1e-11 * largest,
                    "{i} {j}: {error:e} of {largest:e}"
                );
            }
            // With the part that the interior motion carries, the released end has no moment.
            let [deflection, rotation] = &shapes(&PLANE, LENGTH)[i];
            let work = LENGTH
                * (mass.deflection * integral_of_product(deflection, &uniform.deflection)
                    + mass.rotation * integral_of_product(rotation, &uniform.rotation));
            let carried = work / energy(&uniform, &uniform);
            let moment = derivative(&a.rotation)[0] + carried * derivative(&uniform.rotation)[0];
            assert!(moment.abs() < 1e-13, "{i}: {moment:e}");
        }
    }
}
