//! Modes of a model whose members are cut, so that they are those of the structure and not of its mesh.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::assembly::{Bodies, Element, ScaledStiffness};
use crate::error::Error;
use crate::influence::{Effect, FactoredFrame, Layout, RailLoads};
use crate::model::{
    BeamTheory, CrossSection, Member, MemberKind, Model, Rail, cut_members, flexible_ends,
};
use crate::modes::all::few_enough;
use crate::modes::decoupled::{Directions, ExcitingForces, Part};
use crate::modes::mass::ScaledMass;
use crate::modes::mode::{Mode, Modes};
use crate::modes::shapes::MOST_BENT;

/// Most elements of a mesh of which all modes are asked for; its matrices are assembled to count the unknowns.
const MOST_ELEMENTS: usize = 100_000;
/// Most parts of a member.
const MOST_PARTS: usize = 128;
/// Parts of each member in the mesh that shows which deformations of it forces can cause.
const FIRST_PARTS: usize = 3;
/// Factor on the asymptotic estimate of the highest frequency, from which it differs by the supports.
const FREQUENCY_MARGIN: f64 = 1.1;
/// Relative error bound of the compliances of a mesh: its frequencies and the effects of its inertia need no more.
const MESH_ACCURACY: f64 = 1e-9;

/// Largest estimated error of a frequency, relative, up to which a mesh is taken to resolve the shape of the mode.
const RESOLVED: f64 = 0.05;
/// Steps of the iteration for the asymptotic frequency.
const FREQUENCY_STEPS: usize = 40;
/// Fraction of the modes of a mesh that is kept whatever their errors: on a uniform girder, those up to this estimate.
const LEAST_RESOLVED: f64 = 1.0 / 8.0;
/// Factor on the leading errors of a part that deflects under its own inertia, which leave out their coupling.
const COUPLING: f64 = 1.4;
/// Error of an iterated mode, relative to the square of the error before ([`RefinedModes::iterate`]).
const ITERATED: f64 = 6.0;

/// A model with its members cut into parts, and its modes.
#[derive(Clone, Debug)]
pub struct RefinedModes {
    /// The model: the points of the given one first; members in their order, each in its parts.
    pub model: Model,
    /// The same rails over the parts.
    pub rails: Vec<Rail>,
    /// Number of parts of each given member.
    pub parts: Vec<usize>,
    /// Largest relative error of a frequency due to the length of the parts, estimated for the highest mode before any
    /// iteration. It exceeds the accuracy asked for if a member would need more than 128 parts, or if a truss or rod,
    /// which is not cut, vibrates along its axis. `None` if not estimated.
    pub error: Option<f64>,
    /// The factored stiffness of the model with these rails.
    pub frame: Arc<FactoredFrame>,
    /// Modes of the model.
    pub modes: Modes,
}

impl RefinedModes {
    /// Drops the modes that the mesh does not resolve, if members of `m`, the given model, are flexible in shear. Without
    /// such members all modes are kept.
    ///
    /// Frequencies and shapes of modes that vary over few elements are those of the mesh, and the slopes of these shapes
    /// jump where elements meet. The static part of these jumps cancels against those of the residual flexibility, the
    /// dynamic part does not: a wheel with a damper feels it at every node, however fine the mesh. Modes are kept up to
    /// the frequency at which the mesh errs by the fraction 1/20. After [`RefinedModes::iterate`] their slopes are
    /// continuous, and they err by about the square of that. The motion in the others is static, and belongs to the residual
    /// flexibility of the members as given.
    ///
    /// [`RefinedModes::error`] is then the estimate for the highest mode kept.
    ///
    /// # Errors
    /// As [`FactoredFrame::modes`].
    pub fn keep_resolved(&mut self, m: &Model, forces: &ExcitingForces) -> Result<(), Error> {
        let all = &mut self.modes.modes;
        if all.iter().all(|mode| mode.between.is_empty()) {
            return Ok(());
        }
        let directions = member_directions(&self.frame, &self.model, forces, &self.parts)?;
        let error = |mode: &Mode| largest_error(m, &self.parts, &directions, mode.omega);
        let least = (LEAST_RESOLVED * all.len() as f64).ceil() as usize;
        let count = all
            .iter()
            .take_while(|mode| error(mode) <= RESOLVED)
            .count()
            .max(least);
        self.error = all.get(..count).and_then(<[Mode]>::last).map(error);
        self.modes.next = all.get(count).map(|mode| mode.omega);
        all.truncate(count);
        Ok(())
    }

    /// Replaces the modes, as computed from the mesh, by those after one step of inverse iteration with the mass as it is
    /// distributed along the members that are flexible in shear, and a Rayleigh-Ritz step among them: within such members
    /// their slopes are continuous where parts meet, and the errors of their frequencies are of twice the order. Modes
    /// without such members are left as they are.
    ///
    /// # Errors
    /// [`Error::Modes`] if the Rayleigh-Ritz step has no eigenvalues in doubles.
    pub fn iterate(&mut self) -> Result<(), Error> {
        self.frame.iterate(&self.model, &mut self.modes)
    }

    /// Estimate of the relative error of a frequency `omega` of these modes after [`RefinedModes::iterate`]; `m` is the given
    /// model, and `forces` are those that excite the modes.
    ///
    /// # Errors
    /// As [`FactoredFrame::modes`].
    pub fn iterated_error(
        &self,
        m: &Model,
        forces: &ExcitingForces,
        omega: f64,
    ) -> Result<f64, Error> {
        let directions = member_directions(&self.frame, &self.model, forces, &self.parts)?;
        let divided = errors_of_members(m, &self.parts, &directions, omega, PartError::iterated);
        Ok(divided.max(undivided_error(m, &directions, omega)))
    }

    /// An effect of the given model as one of the model cut into parts. A section where two parts meet is just
    /// inside the second.
    #[must_use]
    pub fn effect(&self, effect: Effect) -> Effect {
        match effect {
            Effect::InternalForce {
                member,
                place,
                component,
            } if member < self.parts.len() => {
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
/// the fraction (k h)^4 / 1440 in bending, with k^4 = m omega^2 / EI; and m omega^2 h^2 / (24 EA), or the like for twist.
/// In a part that is flexible in shear and deflects under its own inertia too, the fractions are those of the parts of
/// the inertia that this deflection leaves out: m omega^2 k^2 h^4 / (1440 G As) + m omega^2 k^2 h^6 / (201600 EI) for
/// the linear part of the load, with k the wavenumber of the beam, and m omega^2 r^2 h^2 / (24 EI) for the moment of
/// the rotation, with r the radius of gyration, times the fraction of the kinetic energy in the rotation. That fraction is
/// about r^2 k^2 in long waves and at most 1 in any. [`RefinedModes::iterate`] makes these errors much smaller; they are
/// bounds then. The first mesh is made for an estimate of the highest frequency asked
/// for by Weyl's law; members are cut further until each term is below `accuracy` at the frequency found.
/// Trusses and rods are not cut, nor are beams without an axial or bending stiffness that others have: their mass acts
/// at their ends. Where the last mode has a frequency that further modes share, to a relative difference of 1e-6 in its
/// square, these are returned too.
///
/// # Errors
/// As [`FactoredFrame::modes`].
///
/// # Source
/// Leading terms of the dispersion of cubic and linear elements: Belytschko and Mindle (1987), in Reliability of
/// Methods for Engineering Analysis; Hughes, The Finite Element Method (1987), section 9.1.
pub fn refined_modes(
    m: &Model,
    rails: &[Rail],
    count: usize,
    accuracy: f64,
) -> Result<RefinedModes, Error> {
    refine(m, rails, None, count, accuracy)
}

/// The `count` lowest modes among those of the unknowns that `forces` can move. Members are cut until the frequencies lie
/// within `accuracy` after [`RefinedModes::iterate`], which the caller makes of the modes that it keeps; only deformations in
/// which the forces can move a member are refined.
///
/// The estimates before the iteration are those of [`refined_modes`]. In bending with flexibility in shear the iteration makes
/// of an error e at most 6 e^2; there e may be as large as that allows, but for accuracies below 1/20 at most 1/20, up to which
/// shapes are resolved.
///
/// # Errors
/// As [`FactoredFrame::excited_modes`].
pub fn excited_modes(
    m: &Model,
    rails: &[Rail],
    forces: &ExcitingForces,
    count: usize,
    accuracy: f64,
) -> Result<RefinedModes, Error> {
    refine(m, rails, Some(forces), count, accuracy)
}

fn refine(
    m: &Model,
    rails: &[Rail],
    forces: Option<&ExcitingForces>,
    count: usize,
    accuracy: f64,
) -> Result<RefinedModes, Error> {
    let mut parts = first_parts(m, rails, FIRST_PARTS)?;
    let (directions, allowed) = match forces {
        Some(forces) => {
            let (model, rails) = cut_members(m, rails, &parts);
            let frame = FactoredFrame::with_accuracy(&model, &rails, MESH_ACCURACY)?;
            let directions = member_directions(&frame, &model, forces, &parts)?;
            (directions, AllowedError::before_iteration(accuracy))
        }
        None => (
            vec![Directions::ALL; parts.len()],
            AllowedError {
                sheared: accuracy,
                others: accuracy,
            },
        ),
    };
    if let Some(omega) = asymptotic_frequency(m, &directions, count) {
        let cut = m.members.iter().zip(&directions).zip(&mut parts);
        for ((member, &directions), parts) in cut.filter(|((member, _), _)| divisible(m, member)) {
            *parts = parts_needed(m, member, directions, FREQUENCY_MARGIN * omega, allowed);
        }
    }
    loop {
        let (model, rails) = cut_members(m, rails, &parts);
        let frame = FactoredFrame::with_accuracy(&model, &rails, MESH_ACCURACY)?;
        let found = match forces {
            Some(forces) => frame.lowest_excited(&model, forces, count, accuracy)?,
            None => frame.modes_in_groups(&model, count)?,
        };
        let highest = found.modes.last().map_or(0.0, |mode| mode.omega);
        // If the coarse mesh has fewer modes than asked for, its highest says nothing about those.
        let short = found.modes.len() < count;
        let next: Vec<usize> = m
            .members
            .iter()
            .zip(&directions)
            .zip(&parts)
            .map(|((member, &directions), &now)| match divisible(m, member) {
                true if short && directions != Directions::NONE => (2 * now).min(MOST_PARTS),
                true => now.max(parts_needed(m, member, directions, highest, allowed)),
                false => 1,
            })
            .collect();
        if next == parts {
            let divided = largest_error(m, &parts, &directions, highest);
            let error = Some(divided.max(undivided_error(m, &directions, highest)));
            return Ok(RefinedModes {
                model,
                rails,
                parts,
                error,
                frame: Arc::new(frame),
                modes: found,
            });
        }
        parts = next;
    }
}

/// The deformations of each given member that `forces` can cause, from a frame with the members in `parts`.
fn member_directions(
    frame: &FactoredFrame,
    model: &Model,
    forces: &ExcitingForces,
    parts: &[usize],
) -> Result<Vec<Directions>, Error> {
    let of_parts = frame.moved_directions(model, forces)?;
    let mut rest = of_parts.as_slice();
    let members = parts.iter().map(|&count| {
        let (own, others) = rest.split_at(count);
        rest = others;
        own.iter()
            .fold(Directions::NONE, |all, &part| all.with(part))
    });
    Ok(members.collect())
}

/// All modes that `forces` can excite of a frame whose beams are cut into `parts` equal parts each: the whole
/// finite-element model in uncoupled coordinates.
///
/// [`RefinedModes::error`] is not estimated: the highest modes of any mesh belong to the mesh.
///
/// # Errors
/// As [`FactoredFrame::all_excited_modes`].
pub fn full_modes(
    m: &Model,
    rails: &[Rail],
    forces: &ExcitingForces,
    parts: usize,
) -> Result<RefinedModes, Error> {
    let parts = first_parts(m, rails, parts.max(1))?;
    let (model, rails) = cut_members(m, rails, &parts);
    let frame = FactoredFrame::new(&model, &rails)?;
    let modes = frame.all_excited_modes(&model, forces)?;
    Ok(RefinedModes {
        model,
        rails,
        parts,
        error: None,
        frame: Arc::new(frame),
        modes,
    })
}

/// Parts of each member, for `count` parts of those that may be cut.
///
/// The frame is factored as given, so that whatever is refused is named by the given indices.
fn first_parts(m: &Model, rails: &[Rail], count: usize) -> Result<Vec<usize>, Error> {
    FactoredFrame::new(m, rails)?;
    Ok(parts_of_each(m, count))
}

/// `count` parts for each member that may be cut, 1 for the others.
fn parts_of_each(m: &Model, count: usize) -> Vec<usize> {
    m.members
        .iter()
        .map(|member| if divisible(m, member) { count } else { 1 })
        .collect()
}

/// Checks that [`full_modes`] has no more unknowns than it accepts, before anything is factored. Time and memory grow
/// in proportion to the number of elements.
///
/// # Errors
/// [`Error::TooManyModes`]; [`Error::Elements`] for a mesh of more than 100,000 elements; an entry of model or
/// rails that cannot be used; [`Error::Mechanism`] for a mass in a direction that nothing stiffens.
pub fn check_full_modes(
    m: &Model,
    rails: &[Rail],
    forces: &ExcitingForces,
    parts: usize,
) -> Result<(), Error> {
    m.check()?;
    let parts = parts_of_each(m, parts.max(1));
    let elements = parts
        .iter()
        .fold(0_usize, |sum, count| sum.saturating_add(*count));
    if elements > MOST_ELEMENTS {
        return Err(Error::Elements {
            elements,
            most: MOST_ELEMENTS,
        });
    }
    let (model, rails) = cut_members(m, rails, &parts);
    let elements = Element::all(&model)?;
    let mut bodies = Bodies::new(&model);
    let layout = Layout::new(&model, &rails, &elements, &bodies)?;
    let stiffness = ScaledStiffness::new(&model, &elements, &mut bodies)?;
    let mass = ScaledMass::new(&model, &elements, &bodies, &stiffness)?;
    let loads = RailLoads {
        line: Some(&layout.line),
        states: &layout.states,
        bodies: &bodies,
        numbering: &stiffness.numbering,
    };
    few_enough(Part::moved_by(forces, loads, &stiffness, &mass).len())
}

/// Whether a member may be cut: a beam with mass, and with every axial and bending stiffness that any beam has. Without
/// torsional stiffness the points between its parts turn freely about its axis, a rotation that is left out. Without mass the
/// member is exact as it is, and its parts have no modes.
fn divisible(m: &Model, member: &Member) -> bool {
    let sizes = |section: &CrossSection| [section.area, section.iy, section.iz];
    let own = sizes(&m.sections[member.section]);
    let beams = || {
        m.members
            .iter()
            .filter(|other| other.kind == MemberKind::Beam)
    };
    member.kind == MemberKind::Beam
        && m.sections[member.section].mass > 0.0
        && (0..3).all(|k| {
            own[k] > 0.0 || beams().all(|other| sizes(&m.sections[other.section])[k] == 0.0)
        })
}

/// The frequency below which the members that may be cut have `count` modes for the deformations `directions`.
///
/// Weyl's law: for high frequencies each deformation of a member of length L and wavenumber k contributes k L / pi
/// modes below omega, with k^4 = m omega^2 / EI in bending (see [`errors_of_one_part`] for flexibility in shear),
/// k^2 = m omega^2 / EA along the axis, and the like for twist. The number grows with a power of omega between 1/2 and
/// 1, so that the iteration omega := omega (count / number)^(3/2) at least halves the error of log omega.
///
/// `None` where no such member has mass.
///
/// # Source
/// Courant and Hilbert, Methods of Mathematical Physics I (1953), chapter VI, section 4.
fn asymptotic_frequency(m: &Model, directions: &[Directions], count: usize) -> Option<f64> {
    let number = |omega: f64| -> f64 {
        let cut = m
            .members
            .iter()
            .zip(directions)
            .filter(|(member, _)| divisible(m, member));
        cut.map(|(member, &directions)| phase(m, member, directions, omega))
            .sum::<f64>()
            / std::f64::consts::PI
    };
    let mut omega = 1.0_f64;
    for _ in 0..FREQUENCY_STEPS {
        let ratio = count as f64 / number(omega);
        omega *= ratio.powf(1.5);
        if !(omega.is_finite() && omega > 0.0) {
            return None;
        }
    }
    Some(omega)
}

/// Sum of wavenumber times length over the deformations `directions` of a member at the frequency `omega`.
fn phase(m: &Model, member: &Member, directions: Directions, omega: f64) -> f64 {
    let section = &m.sections[member.section];
    let inertia = section.mass * omega * omega;
    let f = section.flexibility(m.theory);
    let polar = section.gyration_squared(section.iy + section.iz);
    let along = [
        (f.axial, directions.axial),
        (f.torsion * polar, directions.torsion),
    ];
    let straight = along.map(|(flexibility, moves)| {
        if moves {
            (inertia * flexibility).sqrt()
        } else {
            0.0
        }
    });
    let bent =
        bent_planes(m, section, directions).map(|(c, g, _)| wave_squared(inertia, c, g).sqrt());
    let all = straight
        .into_iter()
        .chain(bent)
        .filter(|wavenumber| wavenumber.is_finite());
    length_squared(m, member).sqrt() * all.sum::<f64>()
}

/// Bending and shear flexibility, and second moment, of the planes in which a member bends. Without flexibility in
/// shear in the theory of `m` the second is 0.
fn bent_planes(
    m: &Model,
    section: &CrossSection,
    directions: Directions,
) -> impl Iterator<Item = (f64, f64, f64)> {
    let f = section.flexibility(m.theory);
    let sheared = |g: f64| {
        if m.theory == BeamTheory::Timoshenko {
            g
        } else {
            0.0
        }
    };
    let planes = [
        (f.bending_z, sheared(f.shear_y), section.iz),
        (f.bending_y, sheared(f.shear_z), section.iy),
    ];
    planes
        .into_iter()
        .zip(directions.bending)
        .filter(|(_, moves)| *moves)
        .map(|(plane, _)| plane)
}

/// Square of the wavenumber k of bending, with `inertia` = m omega^2, `c` = 1/EI and `g` = 1/(G As):
/// EI k^4 = m omega^2 (1 + k^2 EI/(G As)).
fn wave_squared(inertia: f64, c: f64, g: f64) -> f64 {
    let sheared = 0.5 * inertia * g;
    sheared + (sheared * sheared + inertia * c).sqrt()
}

/// Square of the length of a member between its flexible ends.
fn length_squared(m: &Model, member: &Member) -> f64 {
    let ends = flexible_ends(member.points.map(|point| m.points[point]), member.offsets)
        .map(Vector3::from);
    (ends[1] - ends[0]).norm_squared()
}

/// A relative error of a frequency with a member in one part.
struct PartError {
    size: f64,
    /// Power of the number of parts by which it falls.
    power: i32,
    /// Whether it is one of bending with flexibility in shear.
    is_sheared: bool,
}

impl PartError {
    /// The error with the member in `parts` parts.
    fn in_parts(&self, parts: usize) -> f64 {
        self.size / (parts as f64).powi(self.power)
    }

    /// The same after the iteration, as far as the mesh resolves the mode.
    fn iterated(&self, parts: usize) -> f64 {
        let own = self.in_parts(parts);
        if self.is_sheared && own <= RESOLVED {
            ITERATED * own * own
        } else {
            own
        }
    }
}

/// Largest errors that a mesh may have: in bending with flexibility in shear, and otherwise.
#[derive(Clone, Copy)]
struct AllowedError {
    sheared: f64,
    others: f64,
}

impl AllowedError {
    /// Those for which modes have the accuracy `accuracy` after the iteration.
    fn before_iteration(accuracy: f64) -> Self {
        AllowedError {
            sheared: (accuracy / ITERATED).sqrt().min(RESOLVED).max(accuracy),
            others: accuracy,
        }
    }

    /// Least number of parts for an error, not rounded.
    fn parts(self, error: &PartError) -> f64 {
        let allowed = if error.is_sheared {
            self.sheared
        } else {
            self.others
        };
        (error.size / allowed).powf(1.0 / f64::from(error.power))
    }
}

/// Relative errors of a frequency with a member in one part, for the deformations `directions`.
fn errors_of_one_part(
    m: &Model,
    member: &Member,
    directions: Directions,
    omega: f64,
) -> Vec<PartError> {
    let section = &m.sections[member.section];
    let square = length_squared(m, member);
    let inertia = section.mass * omega * omega;
    let f = section.flexibility(m.theory);
    let polar = section.gyration_squared(section.iy + section.iz);
    let mut all = Vec::new();
    let mut add = |size: f64, power: i32, is_sheared: bool| {
        all.push(PartError {
            size,
            power,
            is_sheared,
        })
    };
    for (flexibility, moves) in [
        (f.axial, directions.axial),
        (f.torsion * polar, directions.torsion),
    ] {
        if moves {
            add(inertia * flexibility * square / 24.0, 2, false);
        }
    }
    for (c, g, area) in bent_planes(m, section, directions) {
        if g > 0.0 {
            let gyration = section.gyration_squared(area);
            let wave = wave_squared(inertia, c, g);
            let leading = COUPLING * inertia * square;
            add(leading * wave * g * square / 1440.0, 4, true);
            add(leading * wave * c * square * square / 201_600.0, 6, true);
            add(
                leading * c * gyration * (gyration * wave).min(1.0) / 24.0,
                2,
                true,
            );
        } else {
            add(inertia * c * square * square / 1440.0, 4, false);
        }
    }
    all.retain(|error| error.size.is_finite());
    all
}

/// Largest of these errors over all members that may be cut.
fn largest_error(m: &Model, parts: &[usize], directions: &[Directions], omega: f64) -> f64 {
    errors_of_members(m, parts, directions, omega, PartError::in_parts)
}

/// The same of what `of` makes of an error and a number of parts.
fn errors_of_members(
    m: &Model,
    parts: &[usize],
    directions: &[Directions],
    omega: f64,
    of: fn(&PartError, usize) -> f64,
) -> f64 {
    let cut = m
        .members
        .iter()
        .zip(parts)
        .zip(directions)
        .filter(|((member, _), _)| divisible(m, member));
    let errors = cut.flat_map(|((member, &parts), &directions)| {
        let all = errors_of_one_part(m, member, directions, omega).into_iter();
        all.map(move |error| of(&error, parts))
    });
    errors.fold(0.0, f64::max)
}

/// Largest error over the trusses and rods, which are not cut: that of their axial motion, which is linear between their
/// ends. Their mass moves across them with the straight line between the ends, without an error.
fn undivided_error(m: &Model, directions: &[Directions], omega: f64) -> f64 {
    let bars = m
        .members
        .iter()
        .zip(directions)
        .filter(|(member, _)| member.kind != MemberKind::Beam);
    let errors = bars.map(|(member, &directions)| {
        let axial = Directions {
            axial: directions.axial,
            ..Directions::NONE
        };
        errors_of_one_part(m, member, axial, omega)
            .iter()
            .map(|error| error.in_parts(1))
            .fold(0.0, f64::max)
    });
    errors.fold(0.0, f64::max)
}

/// Parts of a member for which the errors at a frequency are allowed.
fn parts_needed(
    m: &Model,
    member: &Member,
    directions: Directions,
    omega: f64,
    allowed: AllowedError,
) -> usize {
    let errors = errors_of_one_part(m, member, directions, omega);
    let parts = errors.iter().map(|error| allowed.parts(error).ceil());
    parts
        .fold(bent_parts(m, member, directions), f64::max)
        .min(MOST_PARTS as f64) as usize
}

/// Parts in which an axial force bends the shapes of a member that is flexible in shear by their series alone.
fn bent_parts(m: &Model, member: &Member, directions: Directions) -> f64 {
    let sheared =
        bent_planes(m, &m.sections[member.section], directions).filter(|(_, g, _)| *g > 0.0);
    let squares = sheared.map(|(c, g, _)| (c * member.tension / (1.0 + g * member.tension)).abs());
    let most = squares
        .filter(|square| square.is_finite())
        .fold(0.0, f64::max);
    (most * length_squared(m, member) / MOST_BENT)
        .sqrt()
        .ceil()
        .max(1.0)
}
