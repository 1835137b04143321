//! Reactions and internal forces of forces on the mass: of weight, and of inertia in motion.

use nalgebra::{DMatrix, SMatrix, SVector, Vector3};

use splines::{MemberMotion, Probe};

use crate::assembly::{BendingPlane, Combination, Element, Matrix12, arm, bending_planes, transformation};
use crate::error::Error;
use crate::factor::SparseLoad;
use crate::influence::{Effect, FactoredFrame, Functional};
use crate::model::{BeamTheory, CrossSection, Member, MemberKind, Model, PointMass};
use crate::modes::inertia_motions::InertiaMotions;
use crate::modes::interior::InteriorMotion;
use crate::modes::mass::{release_shapes, unreleased_mass};
use crate::modes::mode::{BETWEEN, Mode};
use crate::modes::shapes::{Vector12, bending_shapes};

type Vector6 = SVector<f64, 6>;

/// Places and weights of Gauss quadrature on -1 to 1, exact to degree nine.
const GAUSS: [[f64; 2]; 5] = [
    [-0.906_179_845_938_664, 0.236_926_885_056_189_08],
    [-0.538_469_310_105_683_1, 0.478_628_670_499_366_47],
    [0.0, 128.0 / 225.0],
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_47],
    [0.906_179_845_938_664, 0.236_926_885_056_189_08],
];

/// The forces M a of a uniform acceleration a of the whole structure, its supports included: with a = -g up its weight.
/// M is the consistent mass of the members and the rigid masses.
#[derive(Clone, Debug)]
pub struct Weight {
    forces: InertiaForces,
}

/// Forces M a on the references of the bodies, and the acceleration of each member, local: of its flexible ends, and of
/// its motions between them ([`Mode::between`]).
#[derive(Clone, Debug)]
struct InertiaForces {
    on_bodies: Vec<Vector6>,
    end_accelerations: Vec<Vector12>,
    between: Vec<[[f64; BETWEEN]; 2]>,
    /// Whether the acceleration is the same everywhere.
    is_uniform: bool,
}

impl FactoredFrame {
    /// The forces M a of a uniform acceleration a, global. `m` is the model that the frame was made of.
    #[must_use]
    pub fn weight(&self, m: &Model, acceleration: [f64; 3]) -> Weight {
        let reference = |body: usize| self.bodies.list[body].reference;
        let [a, b, c] = acceleration;
        let motion = SVector::from([a, b, c, 0.0, 0.0, 0.0]);
        let mut forces = self.inertia_forces(m, &[motion], true, |motion, body| {
            arm(&Vector3::from(m.points[reference(body)])) * motion
        });
        Weight { forces: forces.swap_remove(0) }
    }

    /// Effects of the forces of a uniform acceleration. The frame is solved once for each effect, for its adjoint load, so
    /// that forces and reactions are in equilibrium to the rounding of the factor.
    ///
    /// `m` is the model that the frame was made of.
    ///
    /// # Errors
    /// [`Error::Invalid`] for an effect of a member or restraint that does not exist, or a place outside 0 to 1.
    ///
    /// # Source
    /// Reciprocity as in [`FactoredFrame::influence_lines`].
    pub fn effects_of_weight(
        &self,
        m: &Model,
        weight: &Weight,
        effects: &[Effect],
    ) -> Result<Vec<f64>, Error> {
        let one = |functional: &Functional| {
            let adjoint = self.motions(&self.scaled_where_stiffened(&functional.strain));
            weight.forces.work(&adjoint) + self.held_effect(m, functional, &weight.forces, &[])
        };
        Ok(self.functionals(m, effects)?.iter().map(one).collect())
    }

    /// Effects of the forces M a where a is the shape of each mode, M being the consistent mass of the members and the rigid
    /// masses, supports included: effects x modes. A structure whose modes move with accelerations q'' under rail loads F has
    /// the effects
    ///
    /// E = A F - (these) q''
    ///
    /// where A are the static effects of the loads. Forces of damping are internal: they act like its stiffness. The frame is
    /// solved once for each effect (its adjoint load) or once for each mode, whichever are fewer.
    ///
    /// `m` is the model that the frame was made of; `modes` are modes of the same frame.
    ///
    /// Guarantee: forces M a and reactions are in equilibrium to the rounding of the factor, whatever the
    /// residuals of the modes. The reactions to the shape of a mode along a global axis add up to minus its
    /// [`Mode::coupling`] with that axis.
    ///
    /// # Errors
    /// [`Error::Invalid`] for an effect of a member or restraint that does not exist, or a place outside 0 to 1.
    ///
    /// # Source
    /// Mode acceleration: Cook, Malkus, Plesha and Witt, Concepts and Applications of Finite Element Analysis
    /// (2002), section 11.8; reciprocity as in [`FactoredFrame::influence_lines`].
    pub fn effects_of_modes(
        &self,
        m: &Model,
        effects: &[Effect],
        modes: &[Mode],
    ) -> Result<DMatrix<f64>, Error> {
        let functionals = self.functionals(m, effects)?;
        let reference = |body: usize| self.bodies.list[body].reference;
        let mut shapes =
            self.inertia_forces(m, modes, false, |mode, body| mode.points[reference(body)].into());
        let between = self.add_interior_motions(m, modes, &mut shapes);
        let mut out = DMatrix::zeros(effects.len(), modes.len());
        if functionals.len() <= shapes.len() {
            for (e, functional) in functionals.iter().enumerate() {
                let adjoint = self.motions(&self.scaled_where_stiffened(&functional.strain));
                for (k, forces) in shapes.iter().enumerate() {
                    out[(e, k)] = forces.work(&adjoint) + self.held_effect(m, functional, forces, &between);
                }
            }
        } else {
            for (k, forces) in shapes.iter().enumerate() {
                let motions = self.motions_under(forces);
                for (e, functional) in functionals.iter().enumerate() {
                    let elastic = functional.strain.evaluate(&motions);
                    out[(e, k)] = elastic + self.held_effect(m, functional, forces, &between);
                }
            }
        }
        Ok(out)
    }

    /// Displacements at probes under the forces of a uniform acceleration.
    ///
    /// The result is exact where a rail element ends; between its ends the deflection by the mass of the element itself,
    /// with both ends held, is left out.
    ///
    /// # Errors
    /// A probe beyond its rail.
    pub fn displacements_of_weight(&self, weight: &Weight, at: &[Probe]) -> Result<Vec<f64>, Error> {
        let motions = self.motions_under(&weight.forces);
        at.iter().map(|&probe| Ok(self.row(probe)?.0.evaluate(&motions))).collect()
    }

    /// The forces of a uniform acceleration as a load on the scaled unknowns, without what acts on degrees of freedom that
    /// nothing stiffens.
    pub(crate) fn load_of_weight(&self, weight: &Weight) -> SparseLoad {
        self.load_of(&weight.forces)
    }

    /// Motions of the references of all bodies under forces M a.
    fn motions_under(&self, forces: &InertiaForces) -> Vec<Vector6> {
        self.motions(&self.load_of(forces))
    }

    fn load_of(&self, forces: &InertiaForces) -> SparseLoad {
        let on_body = |(body, force): (usize, &Vector6)| {
            let mut load = Combination::default();
            (0..6).for_each(|k| load.add(6 * body + k, force[k]));
            self.scaled_where_stiffened(&load)
        };
        forces.on_bodies.iter().enumerate().flat_map(on_body).collect()
    }

    /// The forces M a for each of `all`; `motion` gives the acceleration of the reference of a body.
    fn inertia_forces<T>(
        &self,
        m: &Model,
        all: &[T],
        is_uniform: bool,
        motion: impl Fn(&T, usize) -> Vector6,
    ) -> Vec<InertiaForces> {
        let bodies = self.bodies.list.len();
        let motions: Vec<Vec<Vector6>> =
            all.iter().map(|one| (0..bodies).map(|body| motion(one, body)).collect()).collect();
        let zero = || InertiaForces {
            on_bodies: vec![SVector::zeros(); bodies],
            end_accelerations: vec![Vector12::zeros(); self.elements.len()],
            between: vec![[[0.0; BETWEEN]; 2]; self.elements.len()],
            is_uniform,
        };
        let mut out: Vec<InertiaForces> = all.iter().map(|_| zero()).collect();
        for (index, (element, member)) in self.elements.iter().zip(&m.members).enumerate() {
            let section = &m.sections[member.section];
            if section.mass == 0.0 {
                continue;
            }
            let pair = self.bodies.pair(element.points);
            let b = transformation(element, &self.bodies);
            let ends = release_shapes(element).map_or(b, |recovery| recovery * b);
            let own = member_mass(m, member, element, is_uniform);
            let mass = ends.transpose() * own;
            for (forces, motions) in out.iter_mut().zip(&motions) {
                forces.add_member(index, pair, &ends, &mass, motions);
            }
        }
        for mass in &m.masses {
            self.add_rigid_mass(mass, &motions, &mut out);
        }
        out
    }

    /// Adds the forces of the motions of members between their ends in modes, and returns these motions by member and plane.
    fn add_interior_motions(
        &self,
        m: &Model,
        modes: &[Mode],
        out: &mut [InertiaForces],
    ) -> Vec<[Option<MotionsBetween>; 2]> {
        let mut all = vec![[None, None]; self.elements.len()];
        for motion in InteriorMotion::all(m, &self.elements, &self.bodies) {
            let InteriorMotion { member, plane, .. } = motion;
            let element = &self.elements[member];
            let b = transformation(element, &self.bodies);
            let ends = release_shapes(element).map_or(b, |recovery| recovery * b);
            let own = MotionsBetween::new(m, element, &motion);
            for (forces, mode) in out.iter_mut().zip(modes) {
                let Some(amplitudes) = mode.between.get(member).map(|planes| planes[plane]) else { continue };
                forces.between[member][plane] = amplitudes;
                let force = ends.transpose() * (own.end_forces * SVector::from(amplitudes));
                for (end, body) in self.bodies.pair(element.points).into_iter().enumerate() {
                    forces.on_bodies[body] += force.fixed_rows::<6>(6 * end);
                }
            }
            all[member][plane] = Some(own);
        }
        all
    }

    fn add_rigid_mass(&self, mass: &PointMass, motions: &[Vec<Vector6>], out: &mut [InertiaForces]) {
        let body = self.bodies.of_point[mass.point];
        let motion = self.bodies.motion(mass.point, &Vector3::from(mass.offset));
        for (forces, motions) in out.iter_mut().zip(motions) {
            let mut own = motion * motions[body];
            for k in 0..3 {
                own[k] *= mass.mass;
                own[k + 3] *= mass.inertia[k];
            }
            forces.on_bodies[body] += motion.transpose() * own;
        }
    }

    /// The part of an effect of forces M a that does not follow from the motions of the bodies: less what acts on the
    /// effect directly, plus what the mass of its own member adds between the fixed ends. `between` has the motions of the
    /// members between their ends, where the forces have any.
    fn held_effect(
        &self,
        m: &Model,
        functional: &Functional,
        forces: &InertiaForces,
        between: &[[Option<MotionsBetween>; 2]],
    ) -> f64 {
        let own = functional.section.as_ref();
        let own = own.map_or(0.0, |section| self.own_member(m, section, forces, between.get(section.member)));
        own - functional.direct.evaluate(&forces.on_bodies)
    }

    /// Internal force at a section from the mass of its own member between fixed ends: the end forces, and the
    /// integral of m N a over the part before the section.
    fn own_member(
        &self,
        m: &Model,
        section: &splines::InternalForce,
        forces: &InertiaForces,
        motions: Option<&[Option<MotionsBetween>; 2]>,
    ) -> f64 {
        let (ends, between) = (&forces.end_accelerations[section.member], &forces.between[section.member]);
        let (element, member) = (&self.elements[section.member], &m.members[section.member]);
        let pair = self.bodies.pair(element.points);
        let cross_section = &m.sections[member.section];
        if pair[0] == pair[1] || cross_section.mass == 0.0 {
            return 0.0;
        }
        let distributed =
            DistributedMass { element, section: cross_section, theory: m.theory, kind: member.kind };
        let own = member_mass(m, member, element, forces.is_uniform);
        let mut turned = 0.0;
        if forces.is_uniform {
            turned = element.uniform_load_under_tension(cross_section.mass, ends, section);
        }
        let mut fixed = own * ends;
        let moved = [0, 1].map(|plane| {
            let own = motions.and_then(|motions| motions[plane].as_ref())?;
            (between[plane] != [0.0; BETWEEN]).then_some((own, &between[plane]))
        });
        for (own, amplitudes) in moved.into_iter().flatten() {
            fixed += own.end_forces * SVector::from(*amplitudes);
        }
        let added = moved.map(|of| of.map(|(own, amplitudes)| own.inertia.sum(amplitudes)));
        let end_forces: f64 = section.ends.iter().zip(fixed.iter()).map(|(a, b)| a * b).sum();
        let to = section.place * element.length;
        end_forces
            + turned
            + GAUSS
                .iter()
                .map(|[place, weight]| {
                    let z = 0.5 * to * (1.0 + place);
                    let load = distributed.force(ends, &added, z / element.length);
                    let balance = section.component.balance(to - z);
                    0.5 * to * weight * balance.iter().zip(load).map(|(a, b)| a * b).sum::<f64>()
                })
                .sum::<f64>()
    }
}

/// The mass of a member between its flexible ends, for accelerations by the shapes of a mode or for a uniform one, under
/// which the moments at the clamped ends are known exactly.
fn member_mass(m: &Model, member: &Member, element: &Element, is_uniform: bool) -> Matrix12 {
    let section = &m.sections[member.section];
    let planes = bending_planes(&element.flexibility);
    if !is_uniform {
        return unreleased_mass(element, section, m.theory, member.kind, &planes);
    }
    let straight = planes.map(|plane| BendingPlane { tension: 0.0, ..plane });
    let mut own = unreleased_mass(element, section, m.theory, member.kind, &straight);
    element.bend_uniform_load(&mut own);
    own
}

/// The motions between the ends of a member in one plane.
#[derive(Clone, Debug)]
struct MotionsBetween {
    inertia: InertiaMotions,
    /// Products of their inertia with the motion of the member by each degree of freedom of its flexible ends, local axes:
    /// degrees of freedom x motions.
    end_forces: SMatrix<f64, 12, BETWEEN>,
}

impl MotionsBetween {
    fn new(m: &Model, element: &Element, motion: &InteriorMotion) -> MotionsBetween {
        let mut end_forces = SMatrix::<f64, 12, BETWEEN>::zeros();
        end_forces.set_column(0, &motion.coupling);
        let inertia = motion.inertia_motions(m, element);
        for (row, degree) in motion.ends(element).into_iter().enumerate() {
            for (k, product) in inertia.stiffness[row].iter().enumerate() {
                end_forces[(degree.0, 1 + k)] = degree.1 * product;
            }
        }
        MotionsBetween { inertia, end_forces }
    }
}

impl InertiaForces {
    /// Work of the forces in motions of the bodies.
    fn work(&self, motions: &[Vector6]) -> f64 {
        motions.iter().zip(&self.on_bodies).map(|(motion, force)| motion.dot(force)).sum()
    }

    /// Adds the forces on the mass of a member whose flexible ends move by `ends` with its two bodies;
    /// `mass` = ends^T M.
    fn add_member(
        &mut self,
        index: usize,
        pair: [usize; 2],
        ends: &Matrix12,
        mass: &Matrix12,
        motions: &[Vector6],
    ) {
        let both = Vector12::from_fn(|k, _| motions[pair[k / 6]][k % 6]);
        let local = ends * both;
        let load = mass * local;
        for (k, &body) in pair.iter().enumerate() {
            self.on_bodies[body] += load.fixed_rows::<6>(6 * k);
        }
        self.end_accelerations[index] = local;
    }
}

/// The mass along a member.
struct DistributedMass<'a> {
    element: &'a Element,
    section: &'a CrossSection,
    theory: BeamTheory,
    kind: MemberKind,
}

impl DistributedMass<'_> {
    /// Force and moment per length, local, at the fraction `at` of the length, for accelerations `ends` of the
    /// flexible ends and the motions `added` between them.
    fn force(&self, ends: &Vector12, added: &[Option<MemberMotion>; 2], at: f64) -> [f64; 6] {
        let section = self.section;
        let linear = |k: usize| section.mass * ((1.0 - at) * ends[k] + at * ends[k + 6]);
        let mut out = [0.0; 6];
        out[0] = linear(0);
        if self.kind == MemberKind::Beam {
            out[3] = linear(3) * section.gyration_squared(section.iy + section.iz);
        }
        let planes = bending_planes(&self.element.flexibility);
        for ((plane, second), added) in planes.iter().zip([section.iz, section.iy]).zip(added) {
            if plane.bending.is_infinite() {
                out[plane.deflection] = linear(plane.deflection);
                continue;
            }
            let [deflection, rotation] = self.bending(plane, ends, added.as_ref(), at);
            out[plane.deflection] = section.mass * deflection;
            if self.theory == BeamTheory::Timoshenko {
                out[plane.rotation] = plane.sign * section.mass * section.gyration_squared(second) * rotation;
            }
        }
        out
    }

    /// Accelerations of deflection and rotation of the section at the fraction `at` of the length.
    fn bending(
        &self,
        plane: &BendingPlane,
        ends: &Vector12,
        added: Option<&MemberMotion>,
        at: f64,
    ) -> [f64; 2] {
        let length = self.element.length;
        let shapes = bending_shapes(plane, length);
        let (v, turn, sign) = (plane.deflection, plane.rotation, plane.sign);
        let moved = [ends[v], sign * ends[turn], ends[v + 6], sign * ends[turn + 6]];
        let value = |powers: &[f64]| powers.iter().rev().fold(0.0, |sum, c| sum * at + c);
        let sum =
            |k: usize| -> f64 { shapes.iter().zip(moved).map(|(pair, moved)| value(&pair[k]) * moved).sum() };
        let own = added.map_or([0.0; 2], |motion| [value(&motion.deflection), value(&motion.rotation)]);
        [sum(0) + own[0], sum(1) + own[1]]
    }
}
