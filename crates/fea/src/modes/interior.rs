//! Motions of members between their ends that the ends do not determine.
//!
//! The shapes of a member without load have a constant shear force. In a mode the inertia of the member is a
//! distributed load, under which the shear force is about linear. Without that part the shear force of a Timoshenko
//! member jumps where elements meet, and with it the slope w' = rotation + V/GAs of the rail, in proportion to the
//! length of the elements. The deflection of the clamped member under a uniform load, with an amplitude of its own in
//! each plane of bending, removes the leading part of these jumps. The square of a frequency then errs by the fourth
//! power of the length where it erred by the second, apart from a small term of the rotary inertia.
//!
//! The motion is a further Rayleigh-Ritz function. Zero at the ends, it is orthogonal to the shapes of the member
//! without load in the strain energy, so that only the mass couples it. The rest of the jumps is removed after the search,
//! without further unknowns, by a step of inverse iteration with the mass as it is distributed
//! ([`crate::RefinedModes::iterate`]).
//!
//! Without shear flexibility the slope is a degree of freedom of the ends, and continuous: such planes have no
//! interior motion.

use crate::assembly::{BendingPlane, Bodies, Element, bending_planes};
use crate::model::{BeamTheory, CrossSection, MemberKind, Model};
use crate::modes::inertia_motions::{InertiaMotions, MassPerLength};
use crate::modes::shapes::{
    Vector12, bending_shapes, integral_of_product, uniform_load_shape, uniform_load_stiffness,
};

/// Deflection of a member with clamped ends under a uniform load of intensity one in one plane of bending:
///
/// w = s^2 (L - s)^2/(24 EI) + s (L - s)/(2 GAs),    rotation = s (L - s) (L - 2 s)/(12 EI)
///
/// without axial force, and its mass and stiffness.
#[derive(Clone, Debug)]
pub(super) struct InteriorMotion {
    /// Index of the member.
    pub member: usize,
    /// 0 for the local x-y plane, 1 for the x-z plane.
    pub plane: usize,
    /// Twice the strain energy.
    pub stiffness: f64,
    /// Twice the kinetic energy at unit speed.
    pub mass: f64,
    /// Product of inertia with the motion of the member by each degree of freedom of its flexible ends, local axes.
    pub coupling: Vector12,
}

impl InteriorMotion {
    /// The interior motions of all members with mass and with flexibility in shear. Members within one rigid body do
    /// not deform.
    pub fn all(m: &Model, elements: &[Element], bodies: &Bodies) -> Vec<InteriorMotion> {
        let members = elements.iter().enumerate().filter(|(_, element)| {
            let [first, last] = bodies.pair(element.points);
            first != last
        });
        members
            .flat_map(|(member, element)| InteriorMotion::of_member(m, member, element))
            .collect()
    }

    /// The interior motions of a member, at most one in each plane of bending.
    pub fn of_member(m: &Model, member: usize, element: &Element) -> Vec<InteriorMotion> {
        let given = &m.members[member];
        let section = &m.sections[given.section];
        let is_shear_beam = m.theory == BeamTheory::Timoshenko && given.kind == MemberKind::Beam;
        if !is_shear_beam || section.mass <= 0.0 {
            return Vec::new();
        }
        let planes = bending_planes(&element.flexibility).into_iter().enumerate();
        planes
            .filter(|(_, plane)| plane.bending.is_finite() && plane.shear > 0.0)
            .map(|(k, plane)| InteriorMotion::new(member, k, &plane, element.length, section))
            .filter(|motion| motion.stiffness.is_finite() && motion.stiffness > 0.0)
            .collect()
    }

    fn new(
        member: usize,
        index: usize,
        plane: &BendingPlane,
        length: f64,
        section: &CrossSection,
    ) -> InteriorMotion {
        let [deflection, rotation] = uniform_load_shape(plane, length);
        let second = if index == 0 { section.iz } else { section.iy };
        let density = section.mass * length;
        let rotary = density * section.gyration_squared(second);
        let mass = density * integral_of_product(&deflection, &deflection)
            + rotary * integral_of_product(&rotation, &rotation);
        let mut coupling = Vector12::zeros();
        for ((k, sign), [shape, turn]) in end_degrees(plane)
            .into_iter()
            .zip(bending_shapes(plane, length))
        {
            coupling[k] = sign
                * (density * integral_of_product(&shape, &deflection)
                    + rotary * integral_of_product(&turn, &rotation));
        }
        let stiffness = uniform_load_stiffness(plane, length);
        InteriorMotion {
            member,
            plane: index,
            stiffness,
            mass,
            coupling,
        }
    }

    /// Index and sign, among the degrees of freedom of the flexible ends, of the deflections and rotations of both ends.
    pub fn ends(&self, element: &Element) -> [(usize, f64); 4] {
        end_degrees(&bending_planes(&element.flexibility)[self.plane])
    }

    /// The deflections under the inertia of the motions of the member in this plane; `m` is the model of `element`.
    pub fn inertia_motions(&self, m: &Model, element: &Element) -> InertiaMotions {
        let section = &m.sections[m.members[self.member].section];
        let second = if self.plane == 0 {
            section.iz
        } else {
            section.iy
        };
        let mass = MassPerLength {
            deflection: section.mass,
            rotation: section.mass * section.gyration_squared(second),
        };
        let plane = &bending_planes(&element.flexibility)[self.plane];
        let mut released = [[0.0; 4]; 4];
        if let Some(own) = &element.released {
            let ends = self.ends(element);
            released = ends.map(|(i, a)| ends.map(|(j, b)| a * b * own.compliance[(i, j)]));
        }
        InertiaMotions::new(self.plane, plane, element.length, mass, &released)
    }

    /// Intensity of the load at which twice the strain energy is one.
    pub fn unit_load(&self) -> f64 {
        self.stiffness.sqrt().recip()
    }
}

/// Index and sign, among the degrees of freedom of the flexible ends, of the deflections and rotations of both ends.
pub(super) fn end_degrees(plane: &BendingPlane) -> [(usize, f64); 4] {
    [
        (plane.deflection, 1.0),
        (plane.rotation, plane.sign),
        (plane.deflection + 6, 1.0),
        (plane.rotation + 6, plane.sign),
    ]
}
