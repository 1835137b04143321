//! Members cut into parts, so that modes are those of the structure and not of its mesh.

use nalgebra::Vector3;

use crate::effect::Effect;
use crate::error::Error;
use crate::model::{Kind, Member, Model};
use crate::modes::{Modes, modes};
use crate::rail::{Rail, Segment};
use crate::section::{Section, Theory};

/// Most parts of a member.
const MOST: usize = 128;
/// Parts of each member where no frequency is known yet.
const FIRST: usize = 3;

/// A model with its members cut into parts, and its modes.
#[derive(Clone, Debug)]
pub struct Refined {
    /// The model: points of the given one first, members in their order, each in its parts.
    pub model: Model,
    /// The same rails over the parts.
    pub rails: Vec<Rail>,
    /// Parts of each member given.
    pub parts: Vec<usize>,
    /// Largest relative error of a frequency by the length of the parts, estimated at the highest: above the
    /// accuracy asked where a member would need more than 128 parts. `None`: not estimated.
    pub error: Option<f64>,
    /// Modes of the model.
    pub modes: Modes,
}

impl Refined {
    /// An effect of the model given, in the model cut into parts. Where two parts meet the section is just beyond.
    #[must_use]
    pub fn effect(&self, effect: Effect) -> Effect {
        match effect {
            Effect::Force { member, place, component } if member < self.parts.len() => {
                let first: usize = self.parts[..member].iter().sum();
                let count = self.parts[member];
                let along = place * count as f64;
                let part = (along.floor() as usize).min(count - 1);
                Effect::Force {
                    member: first + part,
                    place: (along - part as f64).clamp(0.0, 1.0),
                    component,
                }
            }
            other => other,
        }
    }
}

/// The `count` lowest modes, members cut so that frequencies lie within `accuracy`, relative, of those of
/// members with their mass spread evenly.
///
/// Shapes between points are those without load. In a member of length h between two points what they miss
/// raises omega by (k h)^4 / 1440 in bending, k^4 = m omega^2 / EI; m omega^2 h^2 / 24 GAs in shear; and
/// m omega^2 h^2 / 24 EA, or its like in twist. Members are cut until each is below `accuracy` at the highest
/// frequency asked, which is first found on a coarse mesh, from above. Trusses are not cut, nor are beams
/// without a stiffness that others have: their mass acts at their ends.
///
/// # Errors
/// As [`modes`].
///
/// # Source
/// Leading terms of the dispersion of cubic and linear elements: Belytschko and Mindle (1987), in Reliability of
/// Methods for Engineering Analysis; Hughes, The Finite Element Method (1987), section 9.1.
pub fn refined_modes(m: &Model, rails: &[Rail], count: usize, accuracy: f64) -> Result<Refined, Error> {
    m.check()?;
    // Refuses what it must by the names of the points given.
    crate::Frame::new(m, rails)?;
    let mut parts: Vec<usize> =
        m.members.iter().map(|member| if divisible(m, member) { FIRST } else { 1 }).collect();
    loop {
        let (model, rails) = divided(m, rails, &parts);
        let found = modes(&model, &rails, count)?;
        let highest = found.modes.last().map_or(0.0, |mode| mode.omega);
        // Too few modes on a coarse mesh say nothing of those asked.
        let short = found.modes.len() < count;
        let wanted: Vec<usize> = m
            .members
            .iter()
            .zip(&parts)
            .map(|(member, &now)| match divisible(m, member) {
                false => 1,
                true if short => (2 * now).min(MOST),
                true => now.max(needed(m, member, highest, accuracy)),
            })
            .collect();
        if wanted == parts {
            let cut = m.members.iter().zip(&parts).filter(|(member, _)| divisible(m, member));
            let errors = cut.flat_map(|(member, &parts)| {
                let all = missed(m, member, highest).into_iter();
                all.map(move |(size, power)| size / (parts as f64).powi(power))
            });
            let error = errors.fold(0.0, f64::max);
            return Ok(Refined { model, rails, parts, error: Some(error), modes: found });
        }
        parts = wanted;
    }
}

/// All modes of a frame whose beams are cut into `parts` equal parts each: the finite-element model whole, in
/// coordinates that do not couple.
///
/// No [`Refined::error`] is estimated: the highest modes of any mesh are the mesh's own.
///
/// # Errors
/// As [`Frame::all_modes`](crate::Frame::all_modes).
pub fn full_modes(m: &Model, rails: &[Rail], parts: usize) -> Result<Refined, Error> {
    m.check()?;
    crate::Frame::new(m, rails)?;
    let parts: Vec<usize> =
        m.members.iter().map(|member| if divisible(m, member) { parts.max(1) } else { 1 }).collect();
    let (model, rails) = divided(m, rails, &parts);
    let modes = crate::Frame::new(&model, &rails)?.all_modes(&model)?;
    Ok(Refined { model, rails, parts, error: None, modes })
}

/// Whether a member may be cut: a beam that resists whatever any member resists.
fn divisible(m: &Model, member: &Member) -> bool {
    let sizes = |section: &Section| [section.area, section.iy, section.iz, section.j];
    let own = sizes(&m.sections[member.section]);
    let beams = || m.members.iter().filter(|other| other.kind == Kind::Beam);
    member.kind == Kind::Beam
        && (0..4).all(|k| own[k] > 0.0 || beams().all(|other| sizes(&m.sections[other.section])[k] == 0.0))
}

/// What one part of a member misses at a frequency, as (size, power of the number of parts).
fn missed(m: &Model, member: &Member, omega: f64) -> Vec<(f64, i32)> {
    let section = &m.sections[member.section];
    let end = |k: usize| Vector3::from(m.points[member.points[k]]) + Vector3::from(member.offsets[k]);
    let square = (end(1) - end(0)).norm_squared();
    let inertia = section.mass * omega * omega;
    let f = section.flexibility(m.theory);
    let polar = if section.area > 0.0 { (section.iy + section.iz) / section.area } else { 0.0 };
    let fourth = |bending: f64| (inertia * bending * square * square / 1440.0, 4);
    let second = |flexibility: f64| (inertia * flexibility * square / 24.0, 2);
    let mut all = vec![fourth(f.bending_y), fourth(f.bending_z), second(f.axial), second(f.torsion * polar)];
    if m.theory == Theory::Timoshenko {
        all.extend([second(f.shear_y), second(f.shear_z)]);
    }
    all.retain(|(size, _)| size.is_finite());
    all
}

/// Parts of a member for an accuracy at a frequency.
fn needed(m: &Model, member: &Member, omega: f64, accuracy: f64) -> usize {
    let parts = missed(m, member, omega)
        .into_iter()
        .map(|(size, power)| (size / accuracy).powf(1.0 / f64::from(power)).ceil());
    parts.fold(1.0, f64::max).min(MOST as f64) as usize
}

/// A model with its members cut into equal parts, and its rails over them.
fn divided(m: &Model, rails: &[Rail], parts: &[usize]) -> (Model, Vec<Rail>) {
    let mut model = Model { members: Vec::new(), ..m.clone() };
    let mut first = Vec::with_capacity(parts.len());
    for (member, &count) in m.members.iter().zip(parts) {
        first.push(model.members.len());
        let end = |k: usize| Vector3::from(m.points[member.points[k]]) + Vector3::from(member.offsets[k]);
        let (a, b) = (end(0), end(1));
        let mut last = member.points[0];
        for k in 1..=count {
            let next = if k == count {
                member.points[1]
            } else {
                model.points.push((a + (b - a) * (k as f64 / count as f64)).into());
                model.points.len() - 1
            };
            let mut part = Member { points: [last, next], ..*member };
            if k > 1 {
                part.offsets[0] = [0.0; 3];
                part.releases[0] = [false; 6];
            }
            if k < count {
                part.offsets[1] = [0.0; 3];
                part.releases[1] = [false; 6];
            }
            model.members.push(part);
            last = next;
        }
    }
    let rails = rails
        .iter()
        .map(|rail| {
            let all = rail.segments.iter().flat_map(|segment| {
                let from = first[segment.member];
                let offset = segment.offset;
                (from..from + parts[segment.member]).map(move |member| Segment { member, offset })
            });
            Rail { segments: all.collect(), ..rail.clone() }
        })
        .collect();
    (model, rails)
}
