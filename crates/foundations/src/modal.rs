//! A structure in natural modes, with the residual flexibility of the omitted modes.
//!
//! The unknowns are the coordinates q of m natural modes of unit modal mass. F are the wheel forces, Phi the values
//! of the modes under the wheels, and u the displacements of the rail there:
//!
//! ```text
//! q'' + C q' + diag(omega^2) q = Phi^T F,    u = G_res F + Phi q,    G_res = G - sum_r phi_r phi_r^T / omega_r^2
//! ```
//!
//! G_res is the residual flexibility: the static deflection in the omitted modes. It makes the static deflection
//! under F equal to that of G for any number of modes. The foundation is built in five steps:
//!
//! 1. Modes: members are subdivided until the relative error of the requested frequencies is at most [`ACCURACY`]
//!    ([`search`]).
//! 2. Excitation: modes that no wheel force and no carrier can excite are dropped ([`excited_by`]). If fewer than m
//!    modes remain, or if the highest ones have the frequency of a mode that was not computed, more modes are
//!    computed.
//! 3. Iteration: of members that are flexible in shear a step of inverse iteration with the distributed mass makes the
//!    slopes of the modes continuous within members ([`RefinedModes::iterate`]). Of all modes of a mesh only those are used
//!    that it resolves ([`RefinedModes::keep_resolved`]).
//! 4. Residual flexibility: the lowest modes are subtracted from the exact surface of the members as given. All modes
//!    of a mesh are subtracted from the surface of that mesh; the remainder is the deformation of its elements
//!    between nodes.
//! 5. Damping: a ratio of critical damping for each mode, and discrete dampers under the rail ([`damped`]).
//!
//! # Source
//! R. H. MacNeal, A hybrid method of component mode synthesis, Computers & Structures 1 (1971), 581-601.

use std::sync::{Arc, OnceLock};

use fea::{FactoredFrame, RefinedModes};
use nalgebra::{DMatrix, Vector3};
use sim::{Dynamics, Extent, Foundation, Measure, Shapes};
use splines::{Compliance, ExactSurface, Probe, ResidualFlexibility};

use crate::built::{BuiltFoundation, MotionBasis};
use crate::error::Error;
use crate::mesh_modes::{MeshModes, ModeRequest, StaticCompliance};
use crate::mount::{self, Excitation};
use crate::solved::SolvedModel;
use formats::spec::ties::Pad;

/// Largest relative error of a frequency due to the subdivision of members.
pub(super) const ACCURACY: f64 = 1e-6;
/// The same for modes that serve only to estimate the error of leaving them out.
const COARSE: f64 = 0.1;
/// The same for modes of a result with a tolerance of extremes, relative to the tolerance.
const BY_EXTREMES: f64 = 0.1;
/// Error of a result at equal times by the phases of its modes, relative to its tolerance.
const BY_PHASES: f64 = 0.05;
/// Motion of a mode under the wheels, relative to that of the total mass moving as one rigid body, below which wheels
/// are assumed not to excite the mode.
const STILL: f64 = 1e-6;
/// Where an element is sampled, as a fraction of its length: the golden section, at which no mode of a regular structure has
/// its nodes.
const SAMPLED: f64 = 0.381_966_011_250_105;
/// Relative difference up to which two frequencies are treated as equal.
const EQUAL: f64 = 1e-6;

impl MeshModes {
    /// At least the lowest `count` modes that `excitation` excites, or all if there are fewer, with frequencies within
    /// `accuracy`.
    pub fn lowest(
        name: &str,
        solved: &SolvedModel,
        count: usize,
        accuracy: f64,
        excitation: Excitation,
    ) -> Result<Arc<MeshModes>, Error> {
        solved.modes.get(
            ModeRequest::Lowest {
                count,
                accuracy,
                excitation,
            },
            || {
                let (refined, excited, is_whole) =
                    search(solved, count, accuracy, excitation).map_err(Error::modes(name))?;
                MeshModes::new(
                    name,
                    refined,
                    excited,
                    Some(given_surface(name, solved)?),
                    is_whole,
                )
            },
        )
    }

    /// All modes that `excitation` excites of a mesh of `elements` elements for each member; of members that are
    /// flexible in shear those that the mesh resolves ([`RefinedModes::keep_resolved`]), unless discrete dampers act
    /// on all of them.
    pub fn whole(
        name: &str,
        solved: &SolvedModel,
        elements: usize,
        has_dampers: bool,
        excitation: Excitation,
    ) -> Result<Arc<MeshModes>, Error> {
        solved.modes.get(
            ModeRequest::Whole {
                elements,
                has_dampers,
                excitation,
            },
            || {
                let forces = excitation.forces();
                let mut refined = fea::full_modes(&solved.model, &solved.rails, &forces, elements)
                    .map_err(Error::modes(name))?;
                if !has_dampers {
                    refined
                        .keep_resolved(&solved.model, &forces)
                        .map_err(Error::modes(name))?;
                }
                let excited = excited_by(&refined, excitation);
                if refined.modes.next.is_some() {
                    let given = given_surface(name, solved)?;
                    return MeshModes::new(name, refined, excited, Some(given), true);
                }
                MeshModes::new(name, refined, excited, None, true)
            },
        )
    }

    fn new(
        name: &str,
        mut refined: RefinedModes,
        mut excited: Vec<fea::Mode>,
        given: Option<ExactSurface>,
        is_whole: bool,
    ) -> Result<MeshModes, Error> {
        let compliance = match given {
            Some(surface) => {
                refined.modes.modes = excited;
                refined.iterate().map_err(Error::modes(name))?;
                excited = refined.modes.modes.clone();
                StaticCompliance::Given(surface)
            }
            None => {
                let found = refined.frame.surface().map_err(Error::frame(name))?;
                StaticCompliance::Subdivided(found.surface)
            }
        };
        Ok(MeshModes {
            refined,
            excited,
            compliance,
            is_whole,
        })
    }

    /// Whether `count` modes, or all that exist, have been computed.
    pub fn has(&self, count: usize) -> bool {
        self.is_whole || self.excited.len() >= count
    }

    /// The foundation of the lowest `count` modes and the residual flexibility of the others. Every mode has the
    /// fraction `ratio` of critical damping in addition to the damping by `dampers`.
    pub fn foundation(
        &self,
        name: &str,
        count: usize,
        ratio: f64,
        dampers: Dampers<'_>,
        excitation: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let frame_error = Error::frame(name);
        let mut refined = self.refined.clone();
        refined.modes.modes = self.excited.iter().take(count).cloned().collect();
        let kept = &refined.modes;
        let residual: Box<dyn Compliance> = match &self.compliance {
            StaticCompliance::Given(exact) => {
                let scaled = kept.rail_shapes(|mode| mode.omega).map_err(&frame_error)?;
                Box::new(ResidualFlexibility::new(exact.clone(), scaled))
            }
            StaticCompliance::Subdivided(surface) => {
                Box::new(kept.residual(surface).map_err(&frame_error)?)
            }
        };
        let own = kept.rail_shapes(|_| 1.0).map_err(&frame_error)?;
        let rails = (0..refined.rails.len())
            .map(|rail| Extent {
                range: residual.range(rail),
                breaks: residual.breaks(rail),
            })
            .collect();
        let omega: Vec<f64> = kept.modes.iter().map(|mode| mode.omega).collect();
        let dynamics = if dampers.c > 0.0 {
            damped(&kept.modes, &omega, ratio, dampers)
        } else {
            Dynamics::Modes {
                ratio: vec![ratio; omega.len()],
                omega,
            }
        };
        let foundation = Foundation {
            compliance: Some(residual),
            structure: Some(sim::Structure {
                dynamics,
                shapes: Box::new(ModeShapes(own)),
            }),
            rails,
            carrier: excitation
                .carrier
                .map(|carrier| mount::inertia(kept, carrier)),
            ..Foundation::default()
        };
        let motion = MotionBasis::Modes {
            refined: Box::new(refined),
            inertia: OnceLock::new(),
        };
        Ok(BuiltFoundation {
            foundation,
            basis: Some(motion),
        })
    }
}

/// Surface of the members as given.
fn given_surface(name: &str, solved: &SolvedModel) -> Result<ExactSurface, Error> {
    if let Some(surface) = &solved.surface {
        return Ok(surface.clone());
    }
    let found = FactoredFrame::new(&solved.model, &solved.rails).and_then(|frame| frame.surface());
    Ok(found.map_err(Error::frame(name))?.surface)
}

/// Returns the mesh, at least the lowest `count` modes that wheels can excite, and whether these are all such modes.
/// Frequencies have a relative error of at most `accuracy`.
///
/// The function computes the `count` lowest modes of the unknowns that wheels can move, and drops those that wheels
/// excite by no more than rounding, such as modes with nodes at every rail, and those whose frequency the next mode has too,
/// as the pairs of two equal girders: [`excited_by`] combines all modes of one frequency. While fewer than `count` remain, it
/// computes more: two for each that was dropped, at least eight.
fn search(
    solved: &SolvedModel,
    count: usize,
    accuracy: f64,
    excitation: Excitation,
) -> Result<(RefinedModes, Vec<fea::Mode>, bool), fea::Error> {
    let forces = excitation.forces();
    let mut requested = count;
    loop {
        let mut refined =
            fea::excited_modes(&solved.model, &solved.rails, &forces, requested, accuracy)?;
        let is_whole = refined.modes.modes.len() < requested || refined.modes.next.is_none();
        drop_incomplete_group(&mut refined.modes);
        let excited = excited_by(&refined, excitation);
        if is_whole || excited.len() >= count {
            return Ok((refined, excited, is_whole));
        }
        let dropped = requested - excited.len().min(requested);
        requested = (requested + 2 * dropped).clamp(requested + 8, 2 * requested + 8);
    }
}

/// Drops the highest modes if the next one has the same frequency.
fn drop_incomplete_group(found: &mut fea::Modes) {
    let Some(next) = found.next else {
        return;
    };
    let is_below = |mode: &fea::Mode| next > mode.omega * (1.0 + EQUAL);
    let complete = found.modes.iter().take_while(|mode| is_below(mode)).count();
    if let Some(first) = found.modes.get(complete) {
        found.next = Some(first.omega);
        found.modes.truncate(complete);
    }
}

/// Dampers of equal damping constant under the ties of a rail.
#[derive(Clone, Copy)]
pub(super) struct Dampers<'p> {
    /// Their positions.
    pub pads: &'p [Pad],
    /// Damping constant, force time/length.
    pub c: f64,
}

impl Dampers<'_> {
    pub const NONE: Dampers<'static> = Dampers { pads: &[], c: 0.0 };
}

/// Modes of one structure in one run: foundations with fewer modes are built from the mesh of those with more. The modes
/// themselves are kept with the solution of the structure, for other runs.
#[derive(Default)]
pub struct ModeCache {
    /// In the order in which they were computed, with the accuracy of their frequencies. For one accuracy, the same number
    /// of modes is always taken from the same mesh: signs of modes, and so the coordinates in a run, differ between meshes.
    lowest: Vec<(f64, Arc<MeshModes>)>,
    /// Accuracies that were found for pairs of numbers of modes ([`ModeCache::accuracy`]).
    accuracies: Vec<([usize; 2], f64)>,
    /// Modes that serve only to estimate errors.
    coarse: Option<Arc<MeshModes>>,
    /// Number of elements for each member, and all modes of that mesh.
    whole: Vec<(usize, Arc<MeshModes>)>,
}

impl ModeCache {
    /// The foundation of the lowest `count` modes that `excitation` excites, with frequencies within `accuracy`, each
    /// with the fraction `ratio` of critical damping.
    pub(super) fn lowest(
        &mut self,
        name: &str,
        solved: &SolvedModel,
        (count, accuracy): (usize, f64),
        ratio: f64,
        dampers: Dampers<'_>,
        excitation: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let known = self
            .lowest
            .iter()
            .find(|(own, modes)| *own <= accuracy && modes.has(count));
        let coarse = self
            .coarse
            .as_ref()
            .filter(|modes| accuracy >= COARSE && modes.has(count));
        let modes = match known.map(|(_, modes)| modes).or(coarse) {
            Some(modes) => Arc::clone(modes),
            None => {
                let found = MeshModes::lowest(name, solved, count, accuracy, excitation)?;
                self.lowest.push((accuracy, Arc::clone(&found)));
                found
            }
        };
        modes.foundation(name, count, ratio, dampers, excitation)
    }

    /// Accuracy of the frequencies of the highest of `count` modes in a run of length `duration` whose error may reach
    /// `tolerance`, where only the lowest `kept` modes belong to a result and the others show its error.
    ///
    /// The error of a frequency omega by the length of the parts of members is at most proportional to omega^2
    /// ([`fea::refined_modes`]), and the amplitude of a mode under loads that move is about proportional to 1/omega^2.
    ///
    /// By extremes the error epsilon of the highest of the lowest n = `kept` modes may be a tenth of the tolerance; only the
    /// highest modes, whose share is small, err by as much. At equal times the phase of every oscillation counts: a phase
    /// error epsilon_k omega_k T of mode k, with T the duration, causes the error
    ///
    /// ```text
    /// epsilon_k omega_k T (omega_1/omega_k)^2 = epsilon (omega_1/omega_n)^2 omega_k T,    k = n at the most
    /// ```
    ///
    /// which may be a twentieth of the tolerance. The frequencies are those of the coarse modes; where these are not known,
    /// it is 1e-6. Where the mesh of the coarse modes is fine enough for the lowest n, they serve for all. The same numbers of
    /// modes always get the same accuracy, whatever coarse modes are known by then.
    ///
    /// # Errors
    /// Those of modes that cannot be found.
    pub(super) fn accuracy(
        &mut self,
        tolerance: (f64, Measure),
        duration: f64,
        counts: [usize; 2],
        (solved, excitation): (&SolvedModel, Excitation),
    ) -> Result<f64, fea::Error> {
        if let Some((_, known)) = self.accuracies.iter().find(|(own, _)| *own == counts) {
            return Ok(*known);
        }
        let accuracy = self.least_accuracy(tolerance, duration, counts, (solved, excitation))?;
        self.accuracies.push((counts, accuracy));
        Ok(accuracy)
    }

    fn least_accuracy(
        &self,
        (tolerance, measure): (f64, Measure),
        duration: f64,
        [count, kept]: [usize; 2],
        (solved, excitation): (&SolvedModel, Excitation),
    ) -> Result<f64, fea::Error> {
        let Some(modes) = self
            .coarse
            .as_ref()
            .filter(|modes| !modes.excited.is_empty())
        else {
            return Ok(ACCURACY);
        };
        let omega = |count: usize| modes.excited[count.clamp(1, modes.excited.len()) - 1].omega;
        let [lowest, own, highest] = [1, kept, count].map(omega);
        let square = |ratio: f64| ratio * ratio;
        let most = BY_EXTREMES * tolerance;
        let of_kept = match measure {
            Measure::Extremes => most,
            Measure::History => {
                most.min(BY_PHASES * tolerance * square(own / lowest) / (own * duration))
            }
        };
        let of_kept = of_kept.max(ACCURACY);
        if kept < count && modes.has(count) {
            let error = modes
                .refined
                .iterated_error(&solved.model, &excitation.forces(), own)?;
            if error <= of_kept {
                return Ok(COARSE);
            }
        }
        Ok((of_kept * square(highest / own)).min(COARSE.max(of_kept)))
    }

    /// The lowest `count` modes that `excitation` excites, with the fraction `ratio` of critical damping, and with
    /// frequencies within 10 %.
    pub(super) fn coarse(
        &mut self,
        name: &str,
        solved: &SolvedModel,
        count: usize,
        ratio: f64,
        excitation: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let modes = match self.coarse.take().filter(|modes| modes.has(count)) {
            Some(modes) => modes,
            None => MeshModes::lowest(name, solved, count, COARSE, excitation)?,
        };
        self.coarse
            .insert(modes)
            .foundation(name, count, ratio, Dampers::NONE, excitation)
    }

    /// The foundation of every mode that `excitation` excites of a mesh of `elements` elements for each member, as far
    /// as the mesh resolves the modes ([`MeshModes::whole`]).
    pub(super) fn full(
        &mut self,
        name: &str,
        solved: &SolvedModel,
        elements: usize,
        ratio: f64,
        dampers: Dampers<'_>,
        excitation: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let index = match self
            .whole
            .iter()
            .position(|(cached, _)| *cached == elements)
        {
            Some(index) => index,
            None => {
                let has_dampers = dampers.c > 0.0;
                let modes = MeshModes::whole(name, solved, elements, has_dampers, excitation)?;
                self.whole.push((elements, modes));
                self.whole.len() - 1
            }
        };
        self.whole[index]
            .1
            .foundation(name, usize::MAX, ratio, dampers, excitation)
    }
}

/// The modes that `excitation` excites, lowest first.
///
/// Modes of equal frequency are determined only up to a rotation among themselves. Let R be the motion of the rails
/// in the modes of one such group, with one row for each position and direction of a possible force and one column
/// for each mode. The modes are rotated by the eigenvectors of R^T R, after which as few of them as possible move the
/// rails. A mode is retained if its largest motion exceeds the fraction [`STILL`] of 1/sqrt(mass).
fn excited_by(refined: &RefinedModes, excitation: Excitation) -> Vec<fea::Mode> {
    let (modes, motions) = (&refined.modes, rail_motions(refined, excitation));
    // a mode of unit modal mass in which the total mass moves as one rigid body has the displacement 1/sqrt(mass)
    let limit = STILL / modes.rigid_mass[0][0].sqrt();
    let mut kept = Vec::new();
    let mut first = 0;
    while first < modes.modes.len() {
        let omega = modes.modes[first].omega;
        let more = modes.modes[first..]
            .iter()
            .take_while(|mode| mode.omega <= omega * (1.0 + EQUAL));
        let cluster = first..first + more.count();
        first = cluster.end;
        let motion = motions.columns(cluster.start, cluster.len());
        let rotation = (motion.transpose() * motion).symmetric_eigen().eigenvectors;
        let mut rotated: Vec<(f64, fea::Mode)> = (0..cluster.len())
            .map(|c| {
                let weights = rotation.column(c);
                (
                    (motion * weights).amax(),
                    combination(&modes.modes[cluster.clone()], weights.as_slice()),
                )
            })
            .filter(|(largest, _)| *largest > limit)
            .collect();
        rotated.sort_by(|a, b| b.0.total_cmp(&a.0));
        kept.extend(rotated.into_iter().map(|(_, mode)| mode));
    }
    kept
}

/// Motion of the rails in each mode, followed by the scaled coupling of each mode with the motions of a carrier: rows x
/// modes. The rails are sampled in the directions of possible wheel forces, at one place of each element of the mesh.
/// Places at equal distances along a member would be the nodes of one of its modes: in a mode that the mesh resolves
/// several elements lie between two nodes.
fn rail_motions(refined: &RefinedModes, excitation: Excitation) -> DMatrix<f64> {
    let modes = &refined.modes;
    let mut rows = Vec::new();
    for element in refined.frame.line().map_or(&[][..], |line| line.elements()) {
        let [from, to] = element.x;
        for axis in excitation.axes() {
            let probe = Probe {
                rail: element.rail,
                x: from + SAMPLED * (to - from),
                axis,
            };
            // no mode moves in an unrestrained direction
            if let Ok(shapes) = modes.at(probe) {
                rows.extend(shapes.into_iter().map(|[value, _]| value));
            }
        }
    }
    let count = modes.modes.len();
    if let Some(carrier) = excitation.carrier {
        rows.extend(mount::coupled_momentum(modes, carrier));
    }
    DMatrix::from_row_slice(rows.len() / count.max(1), count, &rows)
}

/// The linear combination of modes of equal frequency with factors `weights`.
fn combination(modes: &[fea::Mode], weights: &[f64]) -> fea::Mode {
    let mut out = modes[0].clone();
    let add = |of: fn(&fea::Mode) -> &Vec<[f64; 6]>, at: usize, i: usize| -> f64 {
        modes
            .iter()
            .zip(weights)
            .map(|(mode, weight)| weight * of(mode)[at][i])
            .sum()
    };
    for (at, motion) in out.states.iter_mut().enumerate() {
        *motion = std::array::from_fn(|i| add(|mode| &mode.states, at, i));
    }
    for (at, motion) in out.points.iter_mut().enumerate() {
        *motion = std::array::from_fn(|i| add(|mode| &mode.points, at, i));
    }
    for (at, planes) in out.between.iter_mut().enumerate() {
        for (plane, amplitudes) in planes.iter_mut().enumerate() {
            for (k, amplitude) in amplitudes.iter_mut().enumerate() {
                *amplitude = modes
                    .iter()
                    .zip(weights)
                    .map(|(m, w)| w * m.between[at][plane][k])
                    .sum();
            }
        }
    }
    out.coupling = std::array::from_fn(|i| {
        modes
            .iter()
            .zip(weights)
            .map(|(m, w)| w * m.coupling[i])
            .sum()
    });
    out
}

/// Modal matrices with discrete dampers: M = 1, K = diag(omega^2), C = diag(2 zeta omega) + c D^T D, where D_ir is
/// the elongation of damper i in mode r. The dampers couple the modes, so that C is not diagonal.
fn damped(modes: &[fea::Mode], omega: &[f64], ratio: f64, dampers: Dampers<'_>) -> Dynamics {
    let upward = |pad: &Pad, point: usize, arm: [f64; 3], mode: &fea::Mode| {
        let [x, y, z, rx, ry, rz] = mode.points[point];
        let by_rotation = Vector3::new(rx, ry, rz).cross(&Vector3::from(arm));
        (Vector3::new(x, y, z) + by_rotation).dot(&Vector3::from(pad.up))
    };
    let elongation = DMatrix::from_fn(dampers.pads.len(), modes.len(), |i, r| {
        let pad = &dampers.pads[i];
        let base = pad
            .base
            .map_or(0.0, |(point, arm)| upward(pad, point, arm, &modes[r]));
        upward(pad, pad.rail, [0.0; 3], &modes[r]) - base
    });
    let n = modes.len();
    let own = DMatrix::from_fn(
        n,
        n,
        |i, j| if i == j { 2.0 * ratio * omega[i] } else { 0.0 },
    );
    let square = DMatrix::from_fn(n, n, |i, j| if i == j { omega[i] * omega[i] } else { 0.0 });
    let damping = own + elongation.transpose() * &elongation * dampers.c;
    Dynamics::Matrices {
        mass: DMatrix::identity(n, n),
        damping,
        stiffness: square,
    }
}

/// Displacements of the rails in each mode as shape functions of the simulation.
struct ModeShapes(splines::RailShapes);

impl Shapes for ModeShapes {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error> {
        self.0.row(at, value, slope)
    }
}
