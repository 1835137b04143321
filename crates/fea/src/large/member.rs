//! Strain energy of a member in a finite motion of its ends.

use nalgebra::{Const, SVector, U1, Vector3};
use num_dual::{Dual2SVec64, DualNum, DualSVec64};

use super::turn::{Turn, Vec3, constant, cross, difference, dot, scaled, sum};
use crate::assembly::{Element, Matrix6};

/// A member that turns with the line between its ends.
///
/// The bodies at its ends move by u_a, u_b and turn by the rotation vectors t_a, t_b; r_a, r_b are the rigid arms from their
/// references to its ends, and X the vector from end to end before the motion. The line between the ends becomes
///
/// c = X + u_b - u_a + (R_b r_b - r_b) - (R_a r_a - r_a)
///
/// The first axis of the member lies along c, the second beside the mean of the second axes of both ends. In these axes the ends
/// are apart by e = |c| - |X| more than before and turned by the small rotations d_a, d_b. The energy is that of the linear
/// member, with releases and shear, in which the elongation also has what bending shortens,
///
/// E = EA/(2 L) (e + s)^2 + 1/2 d^T K d,    s = L/30 sum over both planes of (2 p^2 - p q + 2 q^2)
///
/// with the slopes p and q of the flexible ends: a beam of small strain, moderately bent between its ends. Trusses have e alone.
///
/// # Source
/// Crisfield, Non-linear Finite Element Analysis of Solids and Structures 1 (1991), chapter 7, and 2 (1997), chapter 17.
pub(super) struct MovingMember {
    /// Bodies at its ends; they differ.
    pub bodies: [usize; 2],
    arms: [[f64; 3]; 2],
    /// X.
    line: [f64; 3],
    length: f64,
    axes: [[f64; 3]; 3],
    /// EA/L; 0 where it does not resist its elongation.
    axial: f64,
    /// K over d_a, d_b; zero for a truss.
    bending: Matrix6,
    /// For each plane its slopes p and q by d_a, d_b; `None` where the member stays straight.
    slopes: [Option<[SVector<f64, 6>; 2]>; 2],
    is_truss: bool,
    /// Whether it resists tension alone.
    is_cable: bool,
}

/// Derivatives of an energy by the motions of two bodies, three displacements and three rotations each.
pub(super) struct PairEnergy {
    pub gradient: [SVector<f64, 6>; 2],
    /// Of the first body, between both, of the second.
    pub hessian: [Matrix6; 3],
}

/// Internal forces at the ends of a member, in the axes that turn with it, as those of [`splines::ForceComponent`].
pub(super) type EndForces = [[f64; 6]; 2];

impl MovingMember {
    /// `arms` lead from the references of the bodies to the ends of the member; its element has no axial force.
    pub fn new(
        element: &Element,
        bodies: [usize; 2],
        arms: [Vector3<f64>; 2],
        is_cable: bool,
    ) -> MovingMember {
        let stiffness = element.stiffness();
        let turning = [3, 4, 5, 9, 10, 11];
        let bending = Matrix6::from_fn(|i, j| stiffness[(turning[i], turning[j])]);
        let recovery = element.recovery();
        let row = |at: usize| SVector::<f64, 6>::from_fn(|j, _| recovery[(at, turning[j])]);
        let is_bent = [element.flexibility.bending_z, element.flexibility.bending_y]
            .map(|flexibility| flexibility.is_finite());
        let slopes = [[5, 11], [4, 10]];
        MovingMember {
            bodies,
            arms: arms.map(Into::into),
            line: (element.axes.row(0).transpose() * element.length).into(),
            length: element.length,
            axes: std::array::from_fn(|i| std::array::from_fn(|j| element.axes[(i, j)])),
            axial: stiffness[(6, 6)],
            bending,
            slopes: std::array::from_fn(|plane| is_bent[plane].then(|| slopes[plane].map(row))),
            is_truss: bending.iter().all(|own| *own == 0.0),
            is_cable,
        }
    }

    /// Elongation e and rotations d_a, d_b of the ends, by u_b - u_a and the rotation vectors of both bodies.
    fn deformation<D: DualNum<Primitive = f64> + Copy>(
        &self,
        apart: Vec3<D>,
        turns: [Vec3<D>; 2],
    ) -> (D, [D; 6]) {
        let turns = turns.map(Turn::new);
        let moved: [Vec3<D>; 2] = std::array::from_fn(|end| turns[end].change(self.arms[end]));
        let change = sum(apart, difference(moved[1], moved[0]));
        let line = sum(constant(self.line), change);
        let length = dot(line, line).sqrt();
        // |c| - |X| without the difference of two large numbers
        let elongation = dot(change, sum(constant(self.line), line)) / (length + self.length);
        if self.is_truss {
            return (elongation, [D::zero(); 6]);
        }
        let ends: [[Vec3<D>; 3]; 2] =
            std::array::from_fn(|end| self.axes.map(|axis| turns[end].of(axis)));
        let first = scaled(line, length.recip());
        let across = cross(first, sum(ends[0][1], ends[1][1]));
        let third = scaled(across, dot(across, across).sqrt().recip());
        let own = [first, cross(third, first), third];
        let mut rotations = [D::zero(); 6];
        for (end, axes) in ends.iter().enumerate() {
            // the axial vector of the rotation from the axes of the member to those of its end: sin(d) along d
            let sine: Vec3<D> = std::array::from_fn(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                (dot(own[j], axes[i]) - dot(own[i], axes[j])) * 0.5
            });
            let s = dot(sine, sine);
            // asin(x)/x
            let factor = ((s * (15.0 / 336.0) + 3.0 / 40.0) * s + 1.0 / 6.0) * s + 1.0;
            for k in 0..3 {
                rotations[3 * end + k] = sine[k] * factor;
            }
        }
        (elongation, rotations)
    }

    /// The energy by elongation and rotations of the ends.
    fn energy<D: DualNum<Primitive = f64> + Copy>(&self, elongation: D, rotations: [D; 6]) -> D {
        if self.is_cable && elongation.re() < 0.0 {
            return D::zero();
        }
        let mut stretch = elongation;
        let mut energy = D::zero();
        if !self.is_truss {
            for [p, q] in self.slopes.iter().flatten() {
                let slope = |row: &SVector<f64, 6>| {
                    (0..6).fold(D::zero(), |sum, k| sum + rotations[k] * row[k])
                };
                let (p, q) = (slope(p), slope(q));
                stretch += (p * p * 2.0 - p * q + q * q * 2.0) * (self.length / 30.0);
            }
            for i in 0..6 {
                let row = (0..6).fold(D::zero(), |sum, j| {
                    sum + rotations[j] * self.bending[(i, j)]
                });
                energy += row * rotations[i] * 0.5;
            }
        }
        energy + stretch * stretch * (0.5 * self.axial)
    }

    /// Derivatives of the energy in motions of its bodies.
    pub fn derivatives(&self, motions: [&SVector<f64, 6>; 2]) -> PairEnergy {
        let at = |k: usize| match k {
            0..3 => motions[1][k] - motions[0][k],
            3..6 => motions[0][k],
            _ => motions[1][k - 3],
        };
        let variables: [Dual2SVec64<9>; 9] =
            std::array::from_fn(|k| Dual2SVec64::<9>::from_re(at(k)).derivative(k));
        let part = |from: usize| std::array::from_fn(|k| variables[from + k]);
        let (elongation, rotations) = self.deformation(part(0), [part(3), part(6)]);
        let energy = self.energy(elongation, rotations);
        let gradient = energy.v1.unwrap_generic(U1, Const::<9>);
        let hessian = energy.v2.unwrap_generic(Const::<9>, Const::<9>);
        // by the columns of each body: its displacements enter with their sign, then its rotations
        let place = |body: usize, k: usize| if k < 3 { k } else { 3 * body + k };
        let sign = |body: usize, k: usize| if k < 3 && body == 0 { -1.0 } else { 1.0 };
        let block = |a: usize, b: usize| {
            Matrix6::from_fn(|i, j| sign(a, i) * sign(b, j) * hessian[(place(a, i), place(b, j))])
        };
        PairEnergy {
            gradient: [0, 1]
                .map(|body| SVector::from_fn(|k, _| sign(body, k) * gradient[place(body, k)])),
            hessian: [block(0, 0), block(0, 1), block(1, 1)],
        }
    }

    /// Internal forces at both ends.
    pub fn end_forces(&self, motions: [&SVector<f64, 6>; 2]) -> EndForces {
        let apart = std::array::from_fn(|k| motions[1][k] - motions[0][k]);
        let turn = |end: usize| std::array::from_fn(|k| motions[end][3 + k]);
        let (elongation, rotations) = self.deformation(apart, [turn(0), turn(1)]);
        let variable = |value: f64, k: usize| DualSVec64::<7>::from_re(value).derivative(k);
        let energy = self.energy(
            variable(elongation, 0),
            std::array::from_fn(|k| variable(rotations[k], 1 + k)),
        );
        let by = energy.eps.unwrap_generic(Const::<7>, U1);
        let axial = by[0];
        let moment = |end: usize, k: usize| if end == 0 { -by[1 + k] } else { by[4 + k] };
        std::array::from_fn(|end| {
            // dMz/dx = -H and dMy/dx = H along the line between the ends; the shear force is normal to the bent axis
            let across = [
                -(moment(1, 2) - moment(0, 2)) / self.length,
                (moment(1, 1) - moment(0, 1)) / self.length,
            ];
            let slope = |plane: usize, sign: f64| {
                self.slopes[plane].as_ref().map_or(0.0, |rows| {
                    sign * rows[end].dot(&SVector::<f64, 6>::from(rotations))
                })
            };
            [
                axial,
                across[0] - axial * slope(0, 1.0),
                across[1] - axial * slope(1, -1.0),
                moment(end, 0),
                moment(end, 1),
                moment(end, 2),
            ]
        })
    }
}
