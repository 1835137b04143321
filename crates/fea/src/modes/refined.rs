//! Modes of a model whose members are cut, so that they are those of the structure and not of its mesh.

use nalgebra::Vector3;

use crate::error::Error;
use crate::influence::{Effect, FactoredFrame};
use crate::model::{BeamTheory, CrossSection, Member, MemberKind, Model, Rail, cut_members, flexible_ends};
use crate::modes::lowest::modes;
use crate::modes::mode::Modes;

/// Most parts of a member.
const MOST_PARTS: usize = 128;
/// Parts of each member while no frequency is known.
const FIRST_PARTS: usize = 3;

/// A model with its members cut into parts, and its modes.
#[derive(Clone, Debug)]
pub struct RefinedModes {
    /// The model: the points of the given one first; members in their order, each in its parts.
    pub model: Model,
    /// The same rails over the parts.
    pub rails: Vec<Rail>,
    /// Number of parts of each given member.
    pub parts: Vec<usize>,
    /// Largest relative error of a frequency due to the length of the parts, estimated for the highest mode. It
    /// exceeds the accuracy asked for if a member would need more than 128 parts. `None` if not estimated.
    pub error: Option<f64>,
    /// Modes of the model.
    pub modes: Modes,
}

impl RefinedModes {
    /// An effect of the given model as one of the model cut into parts. A section where two parts meet is just
    /// inside the second.
    #[must_use]
    pub fn effect(&self, effect: Effect) -> Effect {
        match effect {
            Effect::InternalForce { member, place, component } if member < self.parts.len() => {
                let first: usize = self.parts[..member].iter().sum();
                let count = self.parts[member];
                let along = place * count as f64;
                let part = (along.floor() as usize).min(count - 1);
                Effect::InternalForce {
                    member: first + part,
                    place: (along - part as f64).clamp(0.0, 1.0),
                    component,
                }
            }
            other => other,
        }
    }
}

/// The `count` lowest modes, with members cut until the frequencies lie within `accuracy`, relative, of those
/// of members with evenly distributed mass.
///
/// Between points the shapes are those of the member without load. In a part of length h this raises omega by
/// the fraction (k h)^4 / 1440 in bending, with k^4 = m omega^2 / EI; m omega^2 h^2 / (24 G As) in shear; and
/// m omega^2 h^2 / (24 EA), or the like for twist. Starting from a coarse mesh, whose frequencies are too high,
/// members are cut until each term is below `accuracy` at the highest frequency asked for. Trusses and rods are
/// not cut, nor are beams without an axial or bending stiffness that others have: their mass acts at their ends.
///
/// # Errors
/// As [`modes`].
///
/// # Source
/// Leading terms of the dispersion of cubic and linear elements: Belytschko and Mindle (1987), in Reliability of
/// Methods for Engineering Analysis; Hughes, The Finite Element Method (1987), section 9.1.
pub fn refined_modes(m: &Model, rails: &[Rail], count: usize, accuracy: f64) -> Result<RefinedModes, Error> {
    let mut parts = first_parts(m, rails, FIRST_PARTS)?;
    loop {
        let (model, rails) = cut_members(m, rails, &parts);
        let found = modes(&model, &rails, count)?;
        let highest = found.modes.last().map_or(0.0, |mode| mode.omega);
        // If the coarse mesh has fewer modes than asked for, its highest says nothing about those.
        let short = found.modes.len() < count;
        let next: Vec<usize> = m
            .members
            .iter()
            .zip(&parts)
            .map(|(member, &now)| match divisible(m, member) {
                false => 1,
                true if short => (2 * now).min(MOST_PARTS),
                true => now.max(parts_needed(m, member, highest, accuracy)),
            })
            .collect();
        if next == parts {
            let error = largest_error(m, &parts, highest);
            return Ok(RefinedModes { model, rails, parts, error: Some(error), modes: found });
        }
        parts = next;
    }
}

/// All modes of a frame whose beams are cut into `parts` equal parts each: the whole finite-element model in
/// uncoupled coordinates.
///
/// [`RefinedModes::error`] is not estimated: the highest modes of any mesh belong to the mesh.
///
/// # Errors
/// As [`FactoredFrame::all_modes`].
pub fn full_modes(m: &Model, rails: &[Rail], parts: usize) -> Result<RefinedModes, Error> {
    let parts = first_parts(m, rails, parts.max(1))?;
    let (model, rails) = cut_members(m, rails, &parts);
    let modes = FactoredFrame::new(&model, &rails)?.all_modes(&model)?;
    Ok(RefinedModes { model, rails, parts, error: None, modes })
}

/// `count` parts for each member that may be cut, 1 for the others.
///
/// The frame is factored as given, so that whatever is refused is named by the given indices.
fn first_parts(m: &Model, rails: &[Rail], count: usize) -> Result<Vec<usize>, Error> {
    FactoredFrame::new(m, rails)?;
    Ok(m.members.iter().map(|member| if divisible(m, member) { count } else { 1 }).collect())
}

/// Whether a member may be cut: a beam with every axial and bending stiffness that any beam has. Without torsional
/// stiffness the points between its parts turn freely about its axis, a rotation that is left out.
fn divisible(m: &Model, member: &Member) -> bool {
    let sizes = |section: &CrossSection| [section.area, section.iy, section.iz];
    let own = sizes(&m.sections[member.section]);
    let beams = || m.members.iter().filter(|other| other.kind == MemberKind::Beam);
    member.kind == MemberKind::Beam
        && (0..3).all(|k| own[k] > 0.0 || beams().all(|other| sizes(&m.sections[other.section])[k] == 0.0))
}

/// Relative errors of a frequency with a member in one part; each with the power of the number of parts by
/// which it falls.
fn errors_of_one_part(m: &Model, member: &Member, omega: f64) -> Vec<(f64, i32)> {
    let section = &m.sections[member.section];
    let ends = flexible_ends(member.points.map(|point| m.points[point]), member.offsets).map(Vector3::from);
    let square = (ends[1] - ends[0]).norm_squared();
    let inertia = section.mass * omega * omega;
    let f = section.flexibility(m.theory);
    let polar = section.gyration_squared(section.iy + section.iz);
    let fourth = |bending: f64| (inertia * bending * square * square / 1440.0, 4);
    let second = |flexibility: f64| (inertia * flexibility * square / 24.0, 2);
    let mut all = vec![fourth(f.bending_y), fourth(f.bending_z), second(f.axial), second(f.torsion * polar)];
    if m.theory == BeamTheory::Timoshenko {
        all.extend([second(f.shear_y), second(f.shear_z)]);
    }
    all.retain(|(size, _)| size.is_finite());
    all
}

/// Largest of these errors over all members that may be cut.
fn largest_error(m: &Model, parts: &[usize], omega: f64) -> f64 {
    let cut = m.members.iter().zip(parts).filter(|(member, _)| divisible(m, member));
    let errors = cut.flat_map(|(member, &parts)| {
        let all = errors_of_one_part(m, member, omega).into_iter();
        all.map(move |(size, power)| size / (parts as f64).powi(power))
    });
    errors.fold(0.0, f64::max)
}

/// Parts of a member for an accuracy at a frequency.
fn parts_needed(m: &Model, member: &Member, omega: f64, accuracy: f64) -> usize {
    let parts = errors_of_one_part(m, member, omega)
        .into_iter()
        .map(|(size, power)| (size / accuracy).powf(1.0 / f64::from(power)).ceil());
    parts.fold(1.0, f64::max).min(MOST_PARTS as f64) as usize
}
