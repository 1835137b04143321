//! Reactions and internal forces of forces on the mass: of weight, and of inertia in motion.

use std::sync::OnceLock;

use nalgebra::{DMatrix, SMatrix, SVector, Vector3};

use splines::{InternalForce, Probe, RailElement, ShapeRow};

use crate::assembly::{
    BendingPlane, Combination, Element, Matrix12, arm, bending_planes, transformation,
};
use crate::error::Error;
use crate::factor::SparseLoad;
use crate::influence::{Effect, FactoredFrame, Functional, released_load};
use crate::model::{BeamTheory, CrossSection, Member, MemberKind, Model, PointMass};
use crate::modes::inertia_motions::InertiaMotions;
use crate::modes::interior::{InteriorMotion, end_degrees};
use crate::modes::mass::{release_shapes, unreleased_mass};
use crate::modes::mode::{BETWEEN, Mode};
use crate::modes::shapes::{Polynomial, Vector12, bending_shapes};

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

/// The forces M a where a is the shape of each of some modes ([`FactoredFrame::inertia_of_modes`]).
#[derive(Clone, Debug)]
pub struct ModeInertia {
    forces: Vec<InertiaForces>,
    /// Motions of the references of all bodies under the forces of each mode, once an effect has asked for them.
    motions: OnceLock<Vec<Vec<Vector6>>>,
}

/// Forces M a on the references of the bodies, and the accelerations a of these references.
#[derive(Clone, Debug)]
struct InertiaForces {
    on_bodies: Vec<Vector6>,
    accelerations: Vec<Vector6>,
}

/// The part of an effect of forces M a that does not follow from the motions of the bodies: less what acts on the effect
/// directly, plus what the mass of its own member adds between the fixed ends.
struct HeldEffect<'a> {
    direct: &'a Combination,
    own: Option<OwnMember>,
}

/// What the mass of a member between fixed ends adds to an internal force of it.
struct OwnMember {
    member: usize,
    bodies: [usize; 2],
    /// By the accelerations of the references of the two bodies.
    by_bodies: Vector12,
    /// By the accelerations of its motions between the ends, by plane.
    by_motions: [[f64; BETWEEN]; 2],
}

impl FactoredFrame {
    /// The forces M a of a uniform acceleration a, global. `m` is the model that the frame was made of.
    #[must_use]
    pub fn weight(&self, m: &Model, acceleration: [f64; 3]) -> Weight {
        let reference = |body: usize| self.bodies.list[body].reference;
        let [a, b, c] = acceleration;
        let motion = SVector::from([a, b, c, 0.0, 0.0, 0.0]);
        let bodies = 0..self.bodies.list.len();
        let accelerations = bodies
            .map(|body| arm(&Vector3::from(m.points[reference(body)])) * motion)
            .collect();
        Weight {
            forces: self
                .inertia_forces(m, vec![accelerations], true)
                .swap_remove(0),
        }
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
            weight.forces.work(&adjoint)
                + self
                    .held_effect(m, functional, true)
                    .under(&weight.forces, &[])
        };
        Ok(self.functionals(m, effects)?.iter().map(one).collect())
    }

    /// The forces M a where a is the shape of each mode, M being the consistent mass of the members and the rigid masses,
    /// supports included. `m` is the model that the frame was made of; `modes` are modes of the same frame.
    #[must_use]
    pub fn inertia_of_modes(&self, m: &Model, modes: &[Mode]) -> ModeInertia {
        let of_mode = |mode: &Mode| -> Vec<Vector6> {
            self.bodies
                .list
                .iter()
                .map(|body| mode.points[body.reference].into())
                .collect()
        };
        let mut forces = self.inertia_forces(m, modes.iter().map(of_mode).collect(), false);
        self.add_interior_motions(m, modes, &mut forces);
        ModeInertia {
            forces,
            motions: OnceLock::new(),
        }
    }

    /// Effects of the inertia of modes: effects x modes. A structure whose modes move with accelerations q'' under rail
    /// loads F has the effects
    ///
    /// E = A F - (these) q''
    ///
    /// where A are the static effects of the loads. Forces of damping are internal: they act like its stiffness. The frame is
    /// solved once for each effect (its adjoint load) or once for each mode, whichever are fewer; the motions of the modes are
    /// kept for the next effects.
    ///
    /// `m` is the model that the frame was made of; `modes` are modes of the same frame, and `inertia` is theirs.
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
        inertia: &ModeInertia,
    ) -> Result<DMatrix<f64>, Error> {
        let functionals = self.functionals(m, effects)?;
        let ModeInertia { forces, motions } = inertia;
        let mut out = DMatrix::zeros(effects.len(), forces.len());
        let motions = (functionals.len() > forces.len()).then(|| {
            motions.get_or_init(|| forces.iter().map(|own| self.motions_under(own)).collect())
        });
        for (e, functional) in functionals.iter().enumerate() {
            let elastic: Vec<f64> = match motions {
                Some(motions) => motions
                    .iter()
                    .map(|own| functional.strain.evaluate(own))
                    .collect(),
                None => {
                    let adjoint = self.motions(&self.scaled_where_stiffened(&functional.strain));
                    forces.iter().map(|own| own.work(&adjoint)).collect()
                }
            };
            let held = self.held_effect(m, functional, false);
            for (k, (forces, mode)) in forces.iter().zip(modes).enumerate() {
                out[(e, k)] = elastic[k] + held.under(forces, &mode.between);
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
    pub fn displacements_of_weight(
        &self,
        weight: &Weight,
        at: &[Probe],
    ) -> Result<Vec<f64>, Error> {
        let motions = self.motions_under(&weight.forces);
        let line = self.line()?;
        let displacement = |&probe: &Probe| {
            let row = line.row(probe)?;
            let by_motions = self.rail_loads().of_row(&row).evaluate(&motions);
            let own = self.released_ends_under(&weight.forces, &line.elements()[row.element], &row);
            Ok(by_motions + own)
        };
        at.iter().map(displacement).collect()
    }

    /// What the released ends of the member that carries a rail element add to a displacement of the rail, while they move
    /// under the forces on that member alone: K_rr^-1 times these forces, the tips held.
    fn released_ends_under(
        &self,
        forces: &InertiaForces,
        cell: &RailElement,
        row: &ShapeRow,
    ) -> f64 {
        let Some(carrier) = cell.member else {
            return 0.0;
        };
        let element = &self.elements[carrier.id];
        let Some(released) = &element.released else {
            return 0.0;
        };
        let model = self.model();
        let member = &model.members[carrier.id];
        if model.sections[member.section].mass == 0.0 {
            return 0.0;
        }
        let accelerations = forces.of_both(self.bodies.pair(element.points));
        let load =
            member_mass(model, member, element, true) * self.flexible_ends(element) * accelerations;
        (released_load(cell, row).transpose() * released.compliance * load)[0]
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
        forces
            .on_bodies
            .iter()
            .enumerate()
            .flat_map(on_body)
            .collect()
    }

    /// The forces M a for each of some accelerations of the references of all bodies.
    fn inertia_forces(
        &self,
        m: &Model,
        all: Vec<Vec<Vector6>>,
        is_uniform: bool,
    ) -> Vec<InertiaForces> {
        let zeros = vec![SVector::zeros(); self.bodies.list.len()];
        let new = |accelerations| InertiaForces {
            on_bodies: zeros.clone(),
            accelerations,
        };
        let mut out: Vec<InertiaForces> = all.into_iter().map(new).collect();
        for (element, member) in self.elements.iter().zip(&m.members) {
            if m.sections[member.section].mass == 0.0 {
                continue;
            }
            let pair = self.bodies.pair(element.points);
            let ends = self.flexible_ends(element);
            let mass = ends.transpose() * member_mass(m, member, element, is_uniform) * ends;
            out.iter_mut()
                .for_each(|forces| forces.add_member(pair, &mass));
        }
        for mass in &m.masses {
            self.add_rigid_mass(mass, &mut out);
        }
        out
    }

    /// Motions of the flexible ends of a member by those of its two bodies, without load.
    fn flexible_ends(&self, element: &Element) -> Matrix12 {
        let tips = transformation(element, &self.bodies);
        release_shapes(element).map_or(tips, |recovery| recovery * tips)
    }

    /// Adds the forces of the motions of members between their ends in modes.
    fn add_interior_motions(&self, m: &Model, modes: &[Mode], out: &mut [InertiaForces]) {
        for motion in InteriorMotion::all(m, &self.elements, &self.bodies) {
            let element = &self.elements[motion.member];
            let by_ends = self.flexible_ends(element).transpose()
                * MotionsBetween::new(m, element, &motion).end_forces;
            let bodies = self.bodies.pair(element.points);
            for (forces, mode) in out.iter_mut().zip(modes) {
                let Some(amplitudes) = mode.between.get(motion.member) else {
                    continue;
                };
                let force = by_ends * SVector::from(amplitudes[motion.plane]);
                for (end, &body) in bodies.iter().enumerate() {
                    forces.on_bodies[body] += force.fixed_rows::<6>(6 * end);
                }
            }
        }
    }

    fn add_rigid_mass(&self, mass: &PointMass, out: &mut [InertiaForces]) {
        let body = self.bodies.of_point[mass.point];
        let motion = self.bodies.motion(mass.point, &Vector3::from(mass.offset));
        for forces in out {
            let mut own = motion * forces.accelerations[body];
            for k in 0..3 {
                own[k] *= mass.mass;
                own[k + 3] *= mass.inertia[k];
            }
            forces.on_bodies[body] += motion.transpose() * own;
        }
    }

    /// The part of an effect that the motions of the bodies do not cause, for accelerations by the shapes of modes or for a
    /// uniform one.
    fn held_effect<'a>(
        &self,
        m: &Model,
        functional: &'a Functional,
        is_uniform: bool,
    ) -> HeldEffect<'a> {
        let own = functional
            .section
            .as_ref()
            .and_then(|section| self.own_member(m, section, is_uniform));
        HeldEffect {
            direct: &functional.direct,
            own,
        }
    }

    /// Internal force at a section from the mass of its own member between fixed ends: the end forces, and the
    /// integral of m N a over the part before the section, N being the motions of the member.
    fn own_member(
        &self,
        m: &Model,
        section: &InternalForce,
        is_uniform: bool,
    ) -> Option<OwnMember> {
        let (element, member) = (&self.elements[section.member], &m.members[section.member]);
        let bodies = self.bodies.pair(element.points);
        let cross_section = &m.sections[member.section];
        if bodies[0] == bodies[1] || cross_section.mass == 0.0 {
            return None;
        }
        let ends = Vector12::from(section.ends);
        let mut force = LinearForce {
            by_ends: member_mass(m, member, element, is_uniform).transpose() * ends,
            by_motions: [[0.0; BETWEEN]; 2],
        };
        if is_uniform
            && let Some((degree, turned)) =
                element.uniform_load_under_tension(cross_section.mass, section)
        {
            force.by_ends[degree] += turned;
        }
        let mut motions = [None, None];
        if !is_uniform {
            for motion in InteriorMotion::of_member(m, section.member, element) {
                let own = MotionsBetween::new(m, element, &motion);
                force.by_motions[motion.plane] = (own.end_forces.transpose() * ends).into();
                motions[motion.plane] = Some(own.inertia);
            }
        }
        let distributed = DistributedMass {
            element,
            section: cross_section,
            theory: m.theory,
            kind: member.kind,
            motions,
        };
        let to = section.place * element.length;
        for [place, weight] in GAUSS {
            let z = 0.5 * to * (1.0 + place);
            let balance = section
                .component
                .balance(to - z)
                .map(|share| 0.5 * to * weight * share);
            distributed.add_balance(&balance, z / element.length, &mut force);
        }
        let by_bodies = self.flexible_ends(element).transpose() * force.by_ends;
        Some(OwnMember {
            member: section.member,
            bodies,
            by_bodies,
            by_motions: force.by_motions,
        })
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
    let straight = planes.map(|plane| BendingPlane {
        tension: 0.0,
        ..plane
    });
    let mut own = unreleased_mass(element, section, m.theory, member.kind, &straight);
    element.bend_uniform_load(&mut own);
    own
}

/// The motions between the ends of a member in one plane.
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
        MotionsBetween {
            inertia,
            end_forces,
        }
    }
}

impl InertiaForces {
    /// Work of the forces in motions of the bodies.
    fn work(&self, motions: &[Vector6]) -> f64 {
        motions
            .iter()
            .zip(&self.on_bodies)
            .map(|(motion, force)| motion.dot(force))
            .sum()
    }

    /// Adds the forces on the mass of a member between two bodies.
    fn add_member(&mut self, bodies: [usize; 2], mass: &Matrix12) {
        let load = mass * self.of_both(bodies);
        for (end, body) in bodies.into_iter().enumerate() {
            self.on_bodies[body] += load.fixed_rows::<6>(6 * end);
        }
    }

    /// Accelerations of the references of two bodies.
    fn of_both(&self, bodies: [usize; 2]) -> Vector12 {
        Vector12::from_fn(|k, _| self.accelerations[bodies[k / 6]][k % 6])
    }
}

impl HeldEffect<'_> {
    /// The part under forces M a; `between` has the accelerations of the motions of all members between their ends, or is
    /// empty.
    fn under(&self, forces: &InertiaForces, between: &[[[f64; BETWEEN]; 2]]) -> f64 {
        let own = self.own.as_ref().map_or(0.0, |own| {
            let planes = between
                .get(own.member)
                .into_iter()
                .flatten()
                .zip(&own.by_motions);
            let motions = planes
                .flat_map(|(amplitudes, forces)| amplitudes.iter().zip(forces))
                .map(|(a, b)| a * b);
            own.by_bodies.dot(&forces.of_both(own.bodies)) + motions.sum::<f64>()
        });
        own - self.direct.evaluate(&forces.on_bodies)
    }
}

/// A force that is linear in the accelerations of the flexible ends of a member, and of its motions between them by plane.
struct LinearForce {
    by_ends: Vector12,
    by_motions: [[f64; BETWEEN]; 2],
}

/// The mass along a member.
struct DistributedMass<'a> {
    element: &'a Element,
    section: &'a CrossSection,
    theory: BeamTheory,
    kind: MemberKind,
    /// Its motions between the ends, by plane.
    motions: [Option<InertiaMotions>; 2],
}

impl DistributedMass<'_> {
    /// Adds the force that balances the mass at the fraction `at` of the length; `balance` is the share of each component of
    /// force and moment per length there, local.
    fn add_balance(&self, balance: &[f64; 6], at: f64, force: &mut LinearForce) {
        let section = self.section;
        let linear = |by_ends: &mut Vector12, k: usize, share: f64| {
            by_ends[k] += share * (1.0 - at);
            by_ends[k + 6] += share * at;
        };
        let LinearForce {
            by_ends,
            by_motions,
        } = force;
        linear(by_ends, 0, section.mass * balance[0]);
        if self.kind == MemberKind::Beam {
            linear(
                by_ends,
                3,
                section.mass * section.gyration_squared(section.iy + section.iz) * balance[3],
            );
        }
        let value = |powers: &[f64]| powers.iter().rev().fold(0.0, |sum, c| sum * at + c);
        let planes = bending_planes(&self.element.flexibility);
        for (index, (plane, second)) in planes.iter().zip([section.iz, section.iy]).enumerate() {
            let deflected = section.mass * balance[plane.deflection];
            if plane.bending.is_infinite() {
                linear(by_ends, plane.deflection, deflected);
                continue;
            }
            let mut turned = 0.0;
            if self.theory == BeamTheory::Timoshenko {
                let rotary = section.mass * section.gyration_squared(second);
                turned = plane.sign * rotary * balance[plane.rotation];
            }
            let share =
                |shape: &[Polynomial; 2]| deflected * value(&shape[0]) + turned * value(&shape[1]);
            let shapes = bending_shapes(plane, self.element.length);
            for ((degree, sign), shape) in end_degrees(plane).into_iter().zip(&shapes) {
                by_ends[degree] += sign * share(shape);
            }
            if let Some(motions) = &self.motions[index] {
                let all = std::iter::once(&motions.uniform).chain(&motions.motions);
                for (own, motion) in by_motions[index].iter_mut().zip(all) {
                    *own += share(&[motion.deflection, motion.rotation]);
                }
            }
        }
    }
}
