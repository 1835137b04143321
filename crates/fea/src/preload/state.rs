//! The equilibrium of a preload: axial forces of the whole structure.

use std::sync::Arc;

use nalgebra::SVector;

use super::caution::Caution;
use super::critical::{Critical, CriticalFactor};
use super::forces::{MemberForces, StateForces};
use super::given::{BodyLoads, Preload};
use crate::assembly::Element;
use crate::error::{EntryFault, Error, ModelEntry};
use crate::influence::FactoredFrame;
use crate::model::{ArmStiffness, Member, MemberKind, Model, Rail};

/// Change of the axial forces, relative to the largest, at which they are those of the equilibrium.
const UNCHANGED: f64 = 1e-10;
/// The same where rounding lets them change no less from one step to the next.
const ROUNDED: f64 = 1e-7;
/// Ratio of two changes from which the forces are extrapolated.
const QUICK: f64 = 0.2;
/// Most steps to the equilibrium.
const MOST_STEPS: usize = 20;
/// Angle, radian, by which a member may turn for its motion to count as small.
const MOST_TURNED: f64 = 0.1;
/// Sag measure (w L)^2 E A/(12 T^3) from which a cable is not a straight bar.
const MOST_SAG: f64 = 1e-2;

/// A structure about the state of its preload.
#[derive(Clone, Debug)]
pub struct PreloadedState {
    /// The model with the axial forces in its members and the stiffness of its rigid arms: grids, surfaces, effects and
    /// modes of it are those about the state.
    pub model: Model,
    /// The critical factor on the whole preload.
    pub critical: CriticalFactor,
    /// What is left out and may matter.
    pub cautions: Vec<Caution>,
    /// For each point its three displacements and three rotations under the preload, global.
    pub displacements: Vec<[f64; 6]>,
    /// Steps to the equilibrium.
    pub steps: usize,
    /// The factored stiffness of the model with the rails that were given.
    pub frame: Arc<FactoredFrame>,
}

/// The state of `m` under `preload`, about which its motions are small.
///
/// Algorithm. (1) The first axial forces N are those of the analysis of first order; where that is a mechanism, as with
/// hangers, those of the structure with a small tension in all members. (2) N <- N((K + K_g(N))^-1 f), extrapolated from two
/// steps, until it changes by less than 1e-10 of the largest. K_g holds N of all members and the forces on rigid arms. (3) The critical factor is
/// counted; at or below 1 the structure is refused.
///
/// An axial force that varies along a member, as by its own weight, counts by its mean: the error falls with the square of
/// the number of parts into which the member is cut.
///
/// # Errors
/// As [`FactoredFrame::new`]; [`Error::Buckled`]; [`Error::NoEquilibrium`]; [`Error::Invalid`] for a force on what is not
/// held and for cables that are slack or sag.
///
/// ```
/// use fea::{CriticalFactor, CrossSection, Member, Model, Preload, Support, preloaded};
///
/// // A cantilever of 2 m, compressed by half of its critical load.
/// let section = CrossSection { e: 2.1e11, g: 8.1e10, area: 5e-3, iy: 8e-5, iz: 8e-5, j: 1e-4, ..CrossSection::default() };
/// let model = Model {
///     points: vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
///     sections: vec![section],
///     members: vec![Member::beam([0, 1], 0, [0.0, 1.0, 0.0])],
///     supports: vec![Support { point: 0, fixed: [true; 6] }],
///     up: [0.0, 1.0, 0.0],
///     ..Model::default()
/// };
/// let critical = (std::f64::consts::PI / 4.0).powi(2) * section.e * section.iz;
/// let preload = Preload { points: vec![(1, [-0.5 * critical, 0.0, 0.0])], ..Preload::default() };
/// let state = preloaded(&model, &[], &preload)?;
/// assert!((state.critical.value() - 2.0).abs() < 1e-9);
/// assert!((state.model.members[0].tension / (-0.5 * critical) - 1.0).abs() < 1e-12);
/// # Ok::<(), fea::Error>(())
/// ```
pub fn preloaded(m: &Model, rails: &[Rail], preload: &Preload) -> Result<PreloadedState, Error> {
    let LoadedFrame {
        model,
        frame,
        steps,
        forces,
        displacements,
    } = loaded_frame(m, rails, preload)?;
    let critical = Critical::new(&model)?.first()?;
    if let CriticalFactor::At(factor, mode) = &critical
        && *factor <= 1.0
    {
        return Err(Error::Buckled {
            factor: *factor,
            mode: mode.most,
        });
    }
    let cautions = Caution::all(&model, &frame.elements, &forces);
    Ok(PreloadedState {
        model,
        critical,
        cautions,
        displacements,
        steps,
        frame: Arc::new(frame),
    })
}

/// A structure with the axial forces of the equilibrium under a preload, factored.
#[derive(Debug)]
pub struct LoadedFrame {
    /// The model with the axial forces.
    pub model: Model,
    /// Its factored stiffness, with the rails that were given.
    pub frame: FactoredFrame,
    /// Steps to the equilibrium.
    pub steps: usize,
    forces: Vec<MemberForces>,
    displacements: Vec<[f64; 6]>,
}

/// The equilibrium of a preload as in [`preloaded`], without the critical factor. A stiffness that has a factor is that of a
/// stable state, unless a member has buckled between its ends.
///
/// # Errors
/// As [`preloaded`], but for members that buckle between their ends.
pub fn loaded_frame(m: &Model, rails: &[Rail], preload: &Preload) -> Result<LoadedFrame, Error> {
    m.check()?;
    preload.check(m)?;
    let mut model = m.unloaded();
    let mut frame = first_frame(&mut model, rails, preload)?;
    let mut last = f64::INFINITY;
    let mut before: Option<[Vec<f64>; 2]> = None;
    for step in 1..=MOST_STEPS {
        let BodyLoads { load, on_arms } = preload.loads(&model, &frame)?;
        let motions = frame.motions(&load);
        let forces = StateForces::new(&model, &frame, &motions, &on_arms);
        let largest = forces
            .members
            .iter()
            .fold(0.0_f64, |most, own| most.max(own.axial.abs()));
        let given: Vec<f64> = model.members.iter().map(|member| member.tension).collect();
        let found: Vec<f64> = forces.members.iter().map(|own| own.axial).collect();
        let change = given
            .iter()
            .zip(&found)
            .fold(0.0_f64, |most, (given, found)| {
                most.max((found - given).abs())
            });
        let settled =
            change <= UNCHANGED * largest || (change <= ROUNDED * largest && change >= 0.5 * last);
        if settled && are_equal(&model.arms, &forces.arms) {
            check_turned(&forces.members)?;
            check_tension(&model)?;
            check_sag(&model, preload)?;
            let displacements = point_motions(&frame, &motions);
            if frame.line().is_err() {
                frame = frame.with_rails(rails)?;
            }
            return Ok(LoadedFrame {
                model,
                frame,
                steps: step,
                forces: forces.members,
                displacements,
            });
        }
        last = change;
        model = with_forces(model, forces);
        if let Some(next) = before
            .as_ref()
            .and_then(|before| accelerated(before, [&given, &found]))
        {
            model
                .members
                .iter_mut()
                .zip(next)
                .for_each(|(member, n)| member.tension = n);
        }
        before = Some([given, found]);
        frame = frame
            .reloaded(&model)
            .map_err(|error| buckled(&model, error))?;
        if !preload.rails.is_empty() {
            frame = frame.with_rails(rails)?;
        }
    }
    let (member, _) =
        model
            .members
            .iter()
            .enumerate()
            .fold((0, 0.0_f64), |most, (index, member)| {
                if member.tension.abs() > most.1 {
                    (index, member.tension.abs())
                } else {
                    most
                }
            });
    Err(Error::NoEquilibrium {
        member,
        turned: None,
    })
}

/// Refuses a state in which a member turns too far for its motion to count as small.
fn check_turned(forces: &[MemberForces]) -> Result<(), Error> {
    let turned = forces
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.turned.total_cmp(&b.1.turned));
    match turned.filter(|(_, own)| own.turned > MOST_TURNED) {
        Some((member, own)) => Err(Error::NoEquilibrium {
            member,
            turned: Some(own.turned),
        }),
        None => Ok(()),
    }
}

/// Axial forces nearer to the equilibrium than the last ones found, by the last two steps, each its forces given and found: with
/// the changes r0 and r1 of both, found1 - t (found1 - found0) with t = r1 (r1 - r0)/|r1 - r0|^2, which leaves the least change
/// if it is linear. `None` where the changes do not yet fall quickly.
///
/// # Source
/// Anderson, Iterative procedures for nonlinear integral equations, Journal of the ACM 12 (1965).
fn accelerated(before: &[Vec<f64>; 2], now: [&Vec<f64>; 2]) -> Option<Vec<f64>> {
    let change = |[given, found]: [&Vec<f64>; 2]| -> Vec<f64> {
        given
            .iter()
            .zip(found)
            .map(|(given, found)| found - given)
            .collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (first, second) = (change(before.each_ref()), change(now));
    let turn: Vec<f64> = first
        .iter()
        .zip(&second)
        .map(|(first, second)| second - first)
        .collect();
    if dot(&second, &second) > QUICK * QUICK * dot(&first, &first) {
        return None;
    }
    let share = dot(&second, &turn) / dot(&turn, &turn);
    let [_, last] = before;
    let next = now[1]
        .iter()
        .zip(last)
        .map(|(found, last)| found - share * (found - last));
    share.is_finite().then(|| next.collect())
}

/// The frame of first order; where that is a mechanism, the frame with a small tension in all members, which is left in
/// `model`.
fn first_frame(
    model: &mut Model,
    rails: &[Rail],
    preload: &Preload,
) -> Result<FactoredFrame, Error> {
    let error = match FactoredFrame::new(model, rails) {
        Err(error @ (Error::Mechanism { .. } | Error::IllConditioned { .. })) => error,
        other => return other,
    };
    let size = |force: &[f64; 3]| force.iter().map(|f| f.abs()).sum::<f64>();
    let points = preload.points.iter().map(|(_, force)| size(force));
    let given = points
        .chain(preload.rails.iter().map(|given| size(&given.force)))
        .sum::<f64>();
    let mass = crate::modes::rigid_mass(model).map_or(0.0, |mass| mass[0][0]);
    let tension = 0.1 * (given + mass * size(&preload.acceleration));
    if tension <= 0.0 || !tension.is_finite() {
        return Err(error);
    }
    model
        .members
        .iter_mut()
        .for_each(|member| member.tension = tension);
    FactoredFrame::new(model, rails).map_err(|_| error)
}

/// The model with the axial forces of its members and the stiffness of its arms.
fn with_forces(mut model: Model, forces: StateForces) -> Model {
    for (member, own) in model.members.iter_mut().zip(&forces.members) {
        member.tension = own.axial;
    }
    model.arms = forces.arms;
    model
}

/// The error of a loaded model that cannot be factored: its buckling, if it buckles at or below its load.
fn buckled(model: &Model, error: Error) -> Error {
    let is_singular = matches!(
        error,
        Error::Mechanism { .. }
            | Error::IllConditioned { .. }
            | Error::Released { .. }
            | Error::Invalid {
                fault: EntryFault::ShearCollapse { .. },
                ..
            }
    );
    if !is_singular {
        return error;
    }
    if let Err(slack) = check_tension(model) {
        return slack;
    }
    match Critical::new(model).and_then(|critical| critical.first()) {
        Ok(CriticalFactor::At(factor, mode)) if factor <= 1.0 => Error::Buckled {
            factor,
            mode: mode.most,
        },
        _ => error,
    }
}

/// Whether rigid arms have the same stiffness, to the accuracy of the equilibrium.
fn are_equal(a: &[ArmStiffness], b: &[ArmStiffness]) -> bool {
    let all = || {
        a.iter()
            .chain(b)
            .flat_map(|arm| arm.stiffness.as_flattened())
    };
    let largest = all().fold(0.0_f64, |most, k| most.max(k.abs()));
    let equal = |(a, b): (&ArmStiffness, &ArmStiffness)| {
        let pairs = a
            .stiffness
            .as_flattened()
            .iter()
            .zip(b.stiffness.as_flattened());
        a.point == b.point
            && pairs
                .into_iter()
                .all(|(a, b)| (a - b).abs() <= ROUNDED * largest)
    };
    largest == 0.0 || (a.len() == b.len() && a.iter().zip(b).all(equal))
}

/// Refuses cables that are slack.
fn check_tension(model: &Model) -> Result<(), Error> {
    let is_slack = |member: &Member| member.kind == MemberKind::Cable && member.tension <= 0.0;
    match model.members.iter().position(is_slack) {
        Some(index) => Err(Error::Invalid {
            entry: ModelEntry::Member(index),
            fault: EntryFault::Slack {
                tension: model.members[index].tension,
            },
        }),
        None => Ok(()),
    }
}

/// Refuses cables that sag so much that they are no straight bars.
fn check_sag(model: &Model, preload: &Preload) -> Result<(), Error> {
    let gravity = nalgebra::Vector3::from(preload.acceleration);
    for (index, member) in model.members.iter().enumerate() {
        if member.kind != MemberKind::Cable {
            continue;
        }
        let element: Element = Element::new(model, index)?;
        let section = &model.sections[member.section];
        let along = gravity.dot(&element.axes.row(0).transpose());
        let across = (gravity.norm_squared() - along * along).max(0.0).sqrt();
        // The horizontal length is the part of the length across the weight.
        let weight = section.mass * element.length * across;
        let sag = weight * weight * section.e * section.area / (12.0 * member.tension.powi(3));
        if sag > MOST_SAG {
            return Err(Error::Invalid {
                entry: ModelEntry::Member(index),
                fault: EntryFault::Sag { sag },
            });
        }
    }
    Ok(())
}

/// For each point its three displacements and three rotations, global, by the motions of the bodies.
fn point_motions(frame: &FactoredFrame, motions: &[SVector<f64, 6>]) -> Vec<[f64; 6]> {
    let bodies = &frame.bodies;
    let of = |point: usize| {
        let motion = bodies.motion(point, &nalgebra::Vector3::zeros());
        (motion * motions[bodies.of_point[point]]).into()
    };
    (0..bodies.of_point.len()).map(of).collect()
}
