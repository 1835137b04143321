//! Strain energy of a member in a finite motion of its ends.

use nalgebra::{Const, SVector, U1, Vector3};
use num_dual::{DualNum, DualSVec64};

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
    /// S of s = 1/2 d^T S d; zero for a truss.
    shortening: Matrix6,
    /// Whether it resists tension alone.
    is_cable: bool,
}

/// A member in a motion of its bodies.
struct Deformed<D> {
    /// Turns of its bodies.
    turns: [Turn<D>; 2],
    /// |c|.
    length: D,
    /// The axes of the member, and those that turn with each end.
    axes: [Vec3<D>; 3],
    ends: [[Vec3<D>; 3]; 2],
    /// Length of the product of the first axis and the sum of the second axes of both ends.
    width: D,
    /// e.
    elongation: D,
    /// Sines of d_a and d_b, along them.
    sines: [Vec3<D>; 2],
}

impl<D: DualNum<Primitive = f64> + Copy> Deformed<D> {
    /// d_a and d_b.
    fn rotations(&self) -> [D; 6] {
        let [a, b] = self
            .sines
            .map(|sine| scaled(sine, angle_by_sine(dot(sine, sine))[0]));
        [a[0], a[1], a[2], b[0], b[1], b[2]]
    }
}

/// asin(x)/x by s = x^2, and its derivative.
fn angle_by_sine<D: DualNum<Primitive = f64> + Copy>(s: D) -> [D; 2] {
    const C: [f64; 3] = [1.0 / 6.0, 3.0 / 40.0, 15.0 / 336.0];
    [
        ((s * C[2] + C[1]) * s + C[0]) * s + 1.0,
        (s * (3.0 * C[2]) + 2.0 * C[1]) * s + C[0],
    ]
}

/// The part of `v` across the unit vector `axis`.
fn normal<D: DualNum<Primitive = f64> + Copy>(v: Vec3<D>, axis: Vec3<D>) -> Vec3<D> {
    difference(v, scaled(axis, dot(axis, v)))
}

/// u_b - u_a and the rotation vectors of both bodies in their motions.
fn relative([a, b]: [&SVector<f64, 6>; 2]) -> (Vec3<f64>, [Vec3<f64>; 2]) {
    let apart = std::array::from_fn(|k| b[k] - a[k]);
    (apart, [a, b].map(|own| [own[3], own[4], own[5]]))
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
        let rows = [[5, 11], [4, 10]];
        let slopes: [Option<[SVector<f64, 6>; 2]>; 2] =
            std::array::from_fn(|plane| is_bent[plane].then(|| rows[plane].map(row)));
        let product = |a: &SVector<f64, 6>, b: &SVector<f64, 6>| a * b.transpose();
        let shortening = slopes
            .iter()
            .flatten()
            .map(|[p, q]| (product(p, p) + product(q, q)) * 4.0 - product(p, q) - product(q, p));
        let shortening = shortening.sum::<Matrix6>() * (element.length / 30.0);
        MovingMember {
            bodies,
            arms: arms.map(Into::into),
            line: (element.axes.row(0).transpose() * element.length).into(),
            length: element.length,
            axes: std::array::from_fn(|i| std::array::from_fn(|j| element.axes[(i, j)])),
            axial: stiffness[(6, 6)],
            bending,
            slopes,
            shortening,
            is_truss: bending.iter().all(|own| *own == 0.0),
            is_cable,
        }
    }

    /// The member in a motion of its bodies, by u_b - u_a and their rotation vectors.
    fn deformed<D: DualNum<Primitive = f64> + Copy>(
        &self,
        apart: Vec3<D>,
        turns: [Vec3<D>; 2],
    ) -> Deformed<D> {
        let turns = turns.map(Turn::new);
        let moved: [Vec3<D>; 2] = std::array::from_fn(|end| turns[end].change(self.arms[end]));
        let change = sum(apart, difference(moved[1], moved[0]));
        let line = sum(constant(self.line), change);
        let length = dot(line, line).sqrt();
        // |c| - |X| without the difference of two large numbers
        let elongation = dot(change, sum(constant(self.line), line)) / (length + self.length);
        let first = scaled(line, length.recip());
        let ends: [[Vec3<D>; 3]; 2] =
            std::array::from_fn(|end| self.axes.map(|axis| turns[end].of(axis)));
        let across = cross(first, sum(ends[0][1], ends[1][1]));
        let width = dot(across, across).sqrt();
        let third = scaled(across, width.recip());
        let axes = [first, cross(third, first), third];
        // the axial vector of the rotation from the axes of the member to those of its end: sin(d) along d
        let sines = ends.map(|own| {
            std::array::from_fn(|k| {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                (dot(axes[j], own[i]) - dot(axes[i], own[j])) * 0.5
            })
        });
        Deformed {
            turns,
            length,
            width,
            axes,
            ends,
            elongation,
            sines,
        }
    }

    /// Derivatives of the energy by e and by d_a, d_b.
    fn forces<D: DualNum<Primitive = f64> + Copy>(
        &self,
        elongation: D,
        rotations: &[D; 6],
    ) -> (D, [D; 6]) {
        let none = [D::zero(); 6];
        if self.is_cable && elongation.re() < 0.0 {
            return (D::zero(), none);
        }
        if self.is_truss {
            return (elongation * self.axial, none);
        }
        let times = |matrix: &Matrix6, i: usize| {
            (0..6).fold(D::zero(), |sum, j| sum + rotations[j] * matrix[(i, j)])
        };
        let by_rotations: [D; 6] = std::array::from_fn(|i| times(&self.shortening, i));
        let shortened = rotations.iter().zip(by_rotations);
        let stretch = shortened.fold(elongation, |stretch, (d, by)| stretch + *d * by * 0.5);
        let axial = stretch * self.axial;
        let moments = std::array::from_fn(|i| times(&self.bending, i) + axial * by_rotations[i]);
        (axial, moments)
    }

    /// Gradient of the energy in motions of its bodies, for each of them.
    pub fn forces_on_bodies(&self, motions: [&SVector<f64, 6>; 2]) -> [SVector<f64, 6>; 2] {
        let (apart, turns) = relative(motions);
        let [by_apart, by_a, by_b] = self.gradient(apart, turns);
        let of = |sign: f64, by_turn: Vec3<f64>| {
            SVector::from_fn(|k, _| {
                if k < 3 {
                    sign * by_apart[k]
                } else {
                    by_turn[k - 3]
                }
            })
        };
        [of(-1.0, by_a), of(1.0, by_b)]
    }

    /// Gradient of the energy by u_b - u_a and the rotation vectors of both bodies.
    ///
    /// The forces of e, d_a and d_b go back through what [`MovingMember::deformed`] makes of the motions, in the reverse order.
    fn gradient<D: DualNum<Primitive = f64> + Copy>(
        &self,
        apart: Vec3<D>,
        turns: [Vec3<D>; 2],
    ) -> [Vec3<D>; 3] {
        let own = self.deformed(apart, turns);
        let (axial, moments) = self.forces(own.elongation, &own.rotations());
        let [first, _, third] = own.axes;
        let turned = |end: usize, by_axes: [Vec3<D>; 3], by_tip: Vec3<D>| {
            let [a, b, c] = by_axes;
            let [own_a, own_b, own_c] = self.axes;
            let all = [(a, own_a), (b, own_b), (c, own_c), (by_tip, self.arms[end])];
            own.turns[end].gradient(&all)
        };
        if self.is_truss {
            let (by_line, none) = (scaled(first, axial), [[D::zero(); 3]; 3]);
            return [
                by_line,
                turned(0, none, by_line.map(|x| -x)),
                turned(1, none, by_line),
            ];
        }
        let mut by_axes = [[D::zero(); 3]; 3];
        let mut by_ends = [[[D::zero(); 3]; 3]; 2];
        for end in 0..2 {
            let sine = own.sines[end];
            let moment = std::array::from_fn(|k| moments[3 * end + k]);
            let [factor, slope] = angle_by_sine(dot(sine, sine));
            let along = dot(sine, moment) * slope * 2.0;
            for k in 0..3 {
                let (i, j) = ((k + 1) % 3, (k + 2) % 3);
                let half = (moment[k] * factor + sine[k] * along) * 0.5;
                for c in 0..3 {
                    by_axes[j][c] += own.ends[end][i][c] * half;
                    by_axes[i][c] -= own.ends[end][j][c] * half;
                    by_ends[end][i][c] += own.axes[j][c] * half;
                    by_ends[end][j][c] -= own.axes[i][c] * half;
                }
            }
        }
        // the second axis is third x first, the third that across the first and the mean of the second axes of both ends
        let by_third = sum(by_axes[2], cross(first, by_axes[1]));
        let by_across = scaled(normal(by_third, third), own.width.recip());
        let mean = sum(own.ends[0][1], own.ends[1][1]);
        let by_first = sum(
            by_axes[0],
            sum(cross(by_axes[1], third), cross(mean, by_across)),
        );
        let by_mean = cross(by_across, first);
        let by_line = sum(
            scaled(first, axial),
            scaled(normal(by_first, first), own.length.recip()),
        );
        by_ends
            .iter_mut()
            .for_each(|own| own[1] = sum(own[1], by_mean));
        [
            by_line,
            turned(0, by_ends[0], by_line.map(|x| -x)),
            turned(1, by_ends[1], by_line),
        ]
    }

    /// Gradient of the energy, with its derivatives, in motions of its bodies, as [`MovingMember::gradient`] has it.
    fn differentiated(&self, motions: [&SVector<f64, 6>; 2]) -> [Vec3<DualSVec64<9>>; 3] {
        let (apart, [of_a, of_b]) = relative(motions);
        let variables = |values: Vec3<f64>, from: usize| {
            std::array::from_fn(|k| DualSVec64::<9>::from_re(values[k]).derivative(from + k))
        };
        self.gradient(
            variables(apart, 0),
            [variables(of_a, 3), variables(of_b, 6)],
        )
    }

    /// Second derivatives of the energy by the motions of its bodies, three displacements and three rotations each: of the first
    /// body, between both, of the second.
    pub fn stiffness(&self, motions: [&SVector<f64, 6>; 2]) -> [Matrix6; 3] {
        let gradient = self.differentiated(motions);
        let rows: Vec<SVector<f64, 9>> = gradient
            .as_flattened()
            .iter()
            .map(|own| own.eps.unwrap_generic(Const::<9>, U1))
            .collect();
        // by the columns of each body: its displacements enter with their sign, then its rotations
        let place = |body: usize, k: usize| if k < 3 { k } else { 3 * body + k };
        let sign = |body: usize, k: usize| if k < 3 && body == 0 { -1.0 } else { 1.0 };
        let block = |a: usize, b: usize| {
            Matrix6::from_fn(|i, j| sign(a, i) * sign(b, j) * rows[place(a, i)][place(b, j)])
        };
        [block(0, 0), block(0, 1), block(1, 1)]
    }

    /// Internal forces at both ends.
    pub fn end_forces(&self, motions: [&SVector<f64, 6>; 2]) -> EndForces {
        let (apart, turns) = relative(motions);
        let own = self.deformed(apart, turns);
        let rotations = own.rotations();
        let (axial, by) = self.forces(own.elongation, &rotations);
        let moment = |end: usize, k: usize| if end == 0 { -by[k] } else { by[3 + k] };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{CrossSection, Member, MemberKind, Model};

    /// A member on arms, and the vector from the reference of its first body to that of the second.
    fn on_arms(kind: MemberKind) -> (MovingMember, Vector3<f64>) {
        let section = CrossSection {
            e: 2.1e8,
            g: 8.1e7,
            area: 0.02,
            iy: 1e-4,
            iz: 8e-4,
            j: 2e-6,
            ..CrossSection::default()
        };
        let model = Model {
            points: vec![[0.0; 3], [3.0, 1.0, -2.0]],
            sections: vec![section],
            members: vec![Member {
                kind,
                ..Member::beam([0, 1], 0, [0.2, 1.0, 0.1])
            }],
            up: [0.0, 1.0, 0.0],
            ..Model::default()
        };
        let element = Element::all(&model)
            .expect("a model without faults")
            .remove(0);
        let arms = [[0.3, -0.2, 0.5], [-0.4, 0.1, 0.2]].map(Vector3::from);
        let apart = Vector3::new(3.0, 1.0, -2.0) + arms[0] - arms[1];
        (MovingMember::new(&element, [0, 1], arms, false), apart)
    }

    fn motion(displacement: Vector3<f64>, turn: Vector3<f64>) -> SVector<f64, 6> {
        SVector::from_fn(|k, _| if k < 3 { displacement[k] } else { turn[k - 3] })
    }

    /// Identities: forces are the gradient of an energy, so that their derivatives are symmetric, and those with and without
    /// derivatives are the same.
    #[test]
    fn forces_in_finite_motions_have_symmetric_derivatives() {
        for kind in [MemberKind::Beam, MemberKind::Truss] {
            let (member, _) = on_arms(kind);
            let a = motion(Vector3::new(0.1, -0.2, 0.05), Vector3::new(0.4, 0.1, -0.3));
            let b = motion(Vector3::new(-0.1, 0.3, 0.2), Vector3::new(-0.2, 0.5, 0.1));
            let [first, _, second] = member.stiffness([&a, &b]);
            let largest = first.amax();
            for own in [first, second] {
                assert!(
                    (own - own.transpose()).amax() < 1e-13 * largest,
                    "{kind:?}: {own}"
                );
            }
            let [by_apart, by_a, by_b] = member
                .differentiated([&a, &b])
                .map(|own| Vector3::from(own.map(|component| component.re)));
            let gradient = [motion(-by_apart, by_a), motion(by_apart, by_b)];
            let plain = member.forces_on_bodies([&a, &b]);
            for (own, plain) in gradient.iter().zip(plain) {
                assert!(
                    (own - plain).amax() < 1e-13 * plain.amax(),
                    "{kind:?}: {own} {plain}"
                );
            }
        }
    }

    /// Identity: a member that moves and turns as a rigid body has no forces.
    #[test]
    fn rigid_motions_are_free_of_forces() {
        for kind in [MemberKind::Beam, MemberKind::Truss] {
            let (member, apart) = on_arms(kind);
            let (start, turn) = (Vector3::new(5.0, -3.0, 2.0), Vector3::new(0.9, -1.1, 0.7));
            let moved = Vector3::from(Turn::new(turn.into()).change(apart.into()));
            let bodies = [motion(start, turn), motion(start + moved, turn)];
            let forces = member.forces_on_bodies(bodies.each_ref());
            let size = member.axial * member.length;
            assert!(
                forces.iter().all(|own| own.amax() < 1e-14 * size),
                "{kind:?}: {forces:?}"
            );
        }
    }
}
