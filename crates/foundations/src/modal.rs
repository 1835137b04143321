//! A structure in natural modes, with the static compliance of the modes that are left out.
//!
//! The unknowns are the coordinates q of m natural modes of unit modal mass. With the wheel forces F, the values Phi of
//! the modes under the wheels and the displacements u of the rail there:
//!
//! ```text
//! q'' + C q' + diag(omega^2) q = Phi^T F,    u = G_res F + Phi q,    G_res = G - sum_r phi_r phi_r^T / omega_r^2
//! ```
//!
//! G_res is the residual flexibility: what the structure would deflect statically in the modes that are left out. With
//! it the static deflection under F is that of G, however few modes there are. The foundation is built in four steps:
//!
//! 1. Modes: members are subdivided until the frequencies asked for are exact to [`ACCURACY`] ([`search`]).
//! 2. Excitation: modes that no wheel force and no carrier can excite are dropped ([`excited_by`]). If fewer than m are
//!    left, or if the last ones share their frequency with a mode that was not found, more modes are found.
//! 3. Residual flexibility: the lowest modes are subtracted from the exact surface of the members as given; all modes of
//!    a mesh are subtracted from the surface of that mesh, and what remains is its deformation between its points.
//! 4. Damping: a ratio of critical damping for each mode, and discrete dampers under the rail ([`damped`]).
//!
//! # Source
//! R. H. MacNeal, A hybrid method of component mode synthesis, Computers & Structures 1 (1971), 581-601.

use std::sync::Arc;

use fea::{FactoredFrame, Modes, RefinedModes};
use nalgebra::{DMatrix, Vector3};
use sim::{Dynamics, Extent, Foundation, Shapes};
use splines::{Compliance, ExactSurface, Probe, Rails, ResidualFlexibility};

use crate::built::{BuiltFoundation, MotionBasis};
use crate::error::Error;
use crate::mount::{self, Excitation};
use crate::solved::SolvedModel;
use formats::spec::ties::Pad;

/// Relative error of a frequency that the subdivision of members may leave.
const ACCURACY: f64 = 1e-6;
/// The same where modes are needed only to predict the error of leaving them out.
const COARSE: f64 = 1e-2;
/// Largest motion of a mode where wheels excitation, relative to that of the whole mass moving as one, below which wheels are
/// taken not to excite the mode.
const STILL: f64 = 1e-6;
/// Relative difference up to which two frequencies count as equal.
const EQUAL: f64 = 1e-6;

/// Modes of one mesh that wheels can excite, and the static compliance from which those in use are subtracted.
pub(super) struct MeshModes {
    refined: RefinedModes,
    excited: Vec<fea::Mode>,
    frame: Arc<FactoredFrame>,
    compliance: StaticCompliance,
    /// Whether `excited` has every mode of the mesh that wheels can excite.
    is_whole: bool,
}

/// Static compliance of the structure, before modes are subtracted.
enum StaticCompliance {
    /// Of the members as given: used with the lowest modes, whose mesh is fine.
    Given(ExactSurface),
    /// Of the members as they are subdivided: used with all modes of a mesh.
    Cut(ExactSurface),
}

impl MeshModes {
    /// At least the lowest `count` modes that `excitation` excites, or all if there are fewer.
    pub fn lowest(
        name: &str,
        solved: &SolvedModel,
        count: usize,
        excitation: Excitation,
    ) -> Result<MeshModes, Error> {
        let (refined, excited, is_whole) =
            search(solved, count, ACCURACY, excitation).map_err(Error::modes(name))?;
        let given = solved.surface.clone().map_or_else(|| surface(name, &solved.model, &solved.rails), Ok)?;
        MeshModes::new(name, refined, excited, Some(given), is_whole)
    }

    /// All modes that `excitation` excites of a mesh of `elements` elements for each member.
    pub fn whole(
        name: &str,
        solved: &SolvedModel,
        elements: usize,
        excitation: Excitation,
    ) -> Result<MeshModes, Error> {
        let refined = fea::full_modes(&solved.model, &solved.rails, elements).map_err(Error::modes(name))?;
        let excited = excited_by(&refined.modes, solved, excitation);
        MeshModes::new(name, refined, excited, None, true)
    }

    fn new(
        name: &str,
        refined: RefinedModes,
        excited: Vec<fea::Mode>,
        given: Option<ExactSurface>,
        is_whole: bool,
    ) -> Result<MeshModes, Error> {
        let frame_error = Error::frame(name);
        let frame = FactoredFrame::new(&refined.model, &refined.rails).map_err(&frame_error)?;
        let compliance = match given {
            Some(surface) => StaticCompliance::Given(surface),
            None => StaticCompliance::Cut(frame.surface().map_err(&frame_error)?.surface),
        };
        Ok(MeshModes { refined, excited, frame: Arc::new(frame), compliance, is_whole })
    }

    /// Whether it has `count` modes, or all that exist.
    pub fn has(&self, count: usize) -> bool {
        self.is_whole || self.excited.len() >= count
    }

    /// The foundation of the lowest `count` modes and the residual flexibility of the others; every mode has the fraction
    /// `ratio` of critical damping, beside that of `dampers`.
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
        let rail_error = Error::rails(name);
        let line = Arc::clone(self.frame.line().map_err(&frame_error)?);
        let residual: Box<dyn Compliance> = match &self.compliance {
            StaticCompliance::Given(exact) => {
                let scaled = shapes(&line, &kept.modes, |mode| mode.omega).map_err(&rail_error)?;
                Box::new(ResidualFlexibility::new(exact.clone(), scaled))
            }
            StaticCompliance::Cut(surface) => Box::new(kept.residual(surface).map_err(&frame_error)?),
        };
        let own = shapes(&line, &kept.modes, |_| 1.0).map_err(&rail_error)?;
        let rails = (0..refined.rails.len())
            .map(|rail| Extent { range: residual.range(rail), breaks: residual.breaks(rail) })
            .collect();
        let omega: Vec<f64> = kept.modes.iter().map(|mode| mode.omega).collect();
        let dynamics = if dampers.c > 0.0 {
            damped(&kept.modes, &omega, ratio, dampers)
        } else {
            Dynamics::Modes { ratio: vec![ratio; omega.len()], omega }
        };
        let foundation = Foundation {
            compliance: Some(residual),
            structure: Some(sim::Structure { dynamics, shapes: Box::new(ModeShapes(own)) }),
            rails,
            carrier: excitation.on.map(|on| mount::inertia(kept, on)),
            ..Foundation::default()
        };
        let motion = MotionBasis::Modes { frame: Arc::clone(&self.frame), refined: Box::new(refined) };
        Ok(BuiltFoundation { foundation, basis: Some(motion) })
    }
}

fn surface(name: &str, model: &fea::Model, rails: &[fea::Rail]) -> Result<ExactSurface, Error> {
    let found = FactoredFrame::new(model, rails).and_then(|frame| frame.surface());
    Ok(found.map_err(Error::frame(name))?.surface)
}

/// The mesh, at least the lowest `count` modes that wheels can excite, and whether these are all; frequencies have a
/// relative error of at most `accuracy`.
///
/// Asks for `count` modes and drops those that wheels cannot excite. As long as fewer than `count` remain, or the last
/// frequency found is also that of the next mode, twice as many modes are asked for (at least eight more).
fn search(
    solved: &SolvedModel,
    count: usize,
    accuracy: f64,
    excitation: Excitation,
) -> Result<(RefinedModes, Vec<fea::Mode>, bool), fea::Error> {
    let mut asked = count;
    loop {
        let refined = fea::refined_modes(&solved.model, &solved.rails, asked, accuracy)?;
        let excited = excited_by(&refined.modes, solved, excitation);
        let highest = refined.modes.modes.last().map_or(0.0, |mode| mode.omega);
        let is_whole = refined.modes.modes.len() < asked || refined.modes.next.is_none();
        // `excited_by` combines all modes of one frequency: it needs every one of them
        let is_split = refined.modes.next.is_some_and(|next| next <= highest * (1.0 + EQUAL));
        if is_whole || (excited.len() >= count && !is_split) {
            return Ok((refined, excited, is_whole));
        }
        asked = (2 * asked).max(asked + 8);
    }
}

/// The lowest `count` modes that vertical wheel forces excite, on a coarse mesh and without damping; `None` where no mass
/// is given.
pub(super) fn coarse_modes(
    name: &str,
    solved: &SolvedModel,
    count: usize,
) -> Result<Option<sim::Structure>, Error> {
    let (refined, mut excited, _) = match search(solved, count, COARSE, Excitation::VERTICAL) {
        Ok(found) => found,
        Err(fea::Error::NoMass) => return Ok(None),
        Err(error) => return Err(Error::modes(name)(error)),
    };
    excited.truncate(count);
    let frame_error = Error::frame(name);
    let frame = FactoredFrame::new(&refined.model, &refined.rails).map_err(&frame_error)?;
    let own = shapes(frame.line().map_err(&frame_error)?, &excited, |_| 1.0).map_err(Error::rails(name))?;
    let shapes = Box::new(ModeShapes(own));
    let omega: Vec<f64> = excited.iter().map(|mode| mode.omega).collect();
    let dynamics = Dynamics::Modes { ratio: vec![0.0; omega.len()], omega };
    Ok(Some(sim::Structure { dynamics, shapes }))
}

/// Dampers of equal damping constant under the ties of a rail.
#[derive(Clone, Copy)]
pub(super) struct Dampers<'p> {
    /// Where they are.
    pub pads: &'p [Pad],
    /// Damping constant, force time/length.
    pub c: f64,
}

impl Dampers<'_> {
    pub const NONE: Dampers<'static> = Dampers { pads: &[], c: 0.0 };
}

/// Modes of one structure, kept so that each mesh is solved once however many foundations are built of it.
#[derive(Default)]
pub struct ModeCache {
    lowest: Option<MeshModes>,
    /// Number of elements for each member, and all modes of that mesh.
    whole: Vec<(usize, MeshModes)>,
}

impl ModeCache {
    /// The foundation of the lowest `count` modes that `excitation` excites, each with the fraction `ratio` of critical
    /// damping.
    pub(super) fn lowest(
        &mut self,
        name: &str,
        solved: &SolvedModel,
        count: usize,
        ratio: f64,
        dampers: Dampers<'_>,
        excitation: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let cached = self.lowest.take().filter(|modes| modes.has(count));
        let modes = match cached {
            Some(modes) => modes,
            None => MeshModes::lowest(name, solved, count, excitation)?,
        };
        self.lowest.insert(modes).foundation(name, count, ratio, dampers, excitation)
    }

    /// The foundation of every mode that `excitation` excites of a mesh of `elements` elements for each member.
    pub(super) fn full(
        &mut self,
        name: &str,
        solved: &SolvedModel,
        elements: usize,
        ratio: f64,
        dampers: Dampers<'_>,
        excitation: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let index = match self.whole.iter().position(|(cached, _)| *cached == elements) {
            Some(index) => index,
            None => {
                self.whole.push((elements, MeshModes::whole(name, solved, elements, excitation)?));
                self.whole.len() - 1
            }
        };
        self.whole[index].1.foundation(name, usize::MAX, ratio, dampers, excitation)
    }
}

/// The modes that `excitation` excites, lowest first.
///
/// Modes of equal frequency are determined only up to a rotation among themselves. With R the motion of the rails in the
/// modes of one such group (one row for each place and direction of a possible force, one column for each mode), the modes
/// are rotated by the eigenvectors of R^T R: as few of them as possible then move the rails, and the others are dropped. A
/// mode is kept where its largest motion exceeds the fraction [`STILL`] of 1/sqrt(mass).
fn excited_by(modes: &Modes, solved: &SolvedModel, excitation: Excitation) -> Vec<fea::Mode> {
    let motions = rail_motions(modes, solved, excitation);
    // a mode of unit modal mass in which the whole mass moves as one moves by 1/sqrt(mass)
    let limit = STILL / modes.rigid_mass[0][0].sqrt();
    let mut kept = Vec::new();
    let mut first = 0;
    while first < modes.modes.len() {
        let omega = modes.modes[first].omega;
        let more = modes.modes[first..].iter().take_while(|mode| mode.omega <= omega * (1.0 + EQUAL));
        let cluster = first..first + more.count();
        first = cluster.end;
        let motion = motions.columns(cluster.start, cluster.len());
        let rotation = (motion.transpose() * motion).symmetric_eigen().eigenvectors;
        let mut rotated: Vec<(f64, fea::Mode)> = (0..cluster.len())
            .map(|c| {
                let weights = rotation.column(c);
                ((motion * weights).amax(), combination(&modes.modes[cluster.clone()], weights.as_slice()))
            })
            .filter(|(largest, _)| *largest > limit)
            .collect();
        rotated.sort_by(|a, b| b.0.total_cmp(&a.0));
        kept.extend(rotated.into_iter().map(|(_, mode)| mode));
    }
    kept
}

/// Motion of the rails in each mode where and in the directions in which wheels can excitation, and the momentum of each mode by
/// the motions of a carrier: rows x modes.
fn rail_motions(modes: &Modes, solved: &SolvedModel, excitation: Excitation) -> DMatrix<f64> {
    let mut rows = Vec::new();
    for (rail, given) in solved.rails.iter().enumerate() {
        let sampled = match &solved.surface {
            Some(surface) => sampling_points(surface.rails(), rail),
            None => given.stations.clone(),
        };
        for x in sampled {
            for axis in excitation.axes() {
                // no mode moves in a direction that nothing resists
                if let Ok(shapes) = modes.at(Probe { rail, x, axis }) {
                    rows.extend(shapes.into_iter().map(|[value, _]| value));
                }
            }
        }
    }
    let count = modes.modes.len();
    if let Some(on) = excitation.on {
        rows.extend(mount::coupled_momentum(modes, on));
    }
    DMatrix::from_row_slice(rows.len() / count.max(1), count, &rows)
}

/// The linear combination of modes of equal frequency by `weights`.
fn combination(modes: &[fea::Mode], weights: &[f64]) -> fea::Mode {
    let mut out = modes[0].clone();
    let add = |of: fn(&fea::Mode) -> &Vec<[f64; 6]>, at: usize, i: usize| -> f64 {
        modes.iter().zip(weights).map(|(mode, weight)| weight * of(mode)[at][i]).sum()
    };
    for (at, motion) in out.states.iter_mut().enumerate() {
        *motion = std::array::from_fn(|i| add(|mode| &mode.states, at, i));
    }
    for (at, motion) in out.points.iter_mut().enumerate() {
        *motion = std::array::from_fn(|i| add(|mode| &mode.points, at, i));
    }
    out.coupling = std::array::from_fn(|i| modes.iter().zip(weights).map(|(m, w)| w * m.coupling[i]).sum());
    out
}

/// Rail coordinates at which the motion of modes is sampled: seventeen on each rail element.
fn sampling_points(line: &Rails, rail: usize) -> Vec<f64> {
    let cells = line.elements().iter().filter(|cell| cell.rail == rail);
    cells
        .flat_map(|cell| (0..=16).map(|k| cell.x[0] + (cell.x[1] - cell.x[0]) * f64::from(k) / 16.0))
        .collect()
}

/// Modal matrices with discrete dampers: M = 1, K = diag(omega^2), C = diag(2 zeta omega) + c D^T D, where D_ir is the
/// elongation of damper i in mode r. D couples the modes, so that these matrices are not diagonal.
fn damped(modes: &[fea::Mode], omega: &[f64], ratio: f64, dampers: Dampers<'_>) -> Dynamics {
    let upward = |pad: &Pad, point: usize, arm: [f64; 3], mode: &fea::Mode| {
        let [x, y, z, rx, ry, rz] = mode.points[point];
        let by_rotation = Vector3::new(rx, ry, rz).cross(&Vector3::from(arm));
        (Vector3::new(x, y, z) + by_rotation).dot(&Vector3::from(pad.up))
    };
    let elongation = DMatrix::from_fn(dampers.pads.len(), modes.len(), |i, r| {
        let pad = &dampers.pads[i];
        let base = pad.base.map_or(0.0, |(point, arm)| upward(pad, point, arm, &modes[r]));
        upward(pad, pad.rail, [0.0; 3], &modes[r]) - base
    });
    let n = modes.len();
    let own = DMatrix::from_fn(n, n, |i, j| if i == j { 2.0 * ratio * omega[i] } else { 0.0 });
    let square = DMatrix::from_fn(n, n, |i, j| if i == j { omega[i] * omega[i] } else { 0.0 });
    let damping = own + elongation.transpose() * &elongation * dampers.c;
    Dynamics::Matrices { mass: DMatrix::identity(n, n), damping, stiffness: square }
}

/// Displacements of the rails in each mode, as shapes of the simulation.
struct ModeShapes(splines::RailShapes);

impl Shapes for ModeShapes {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error> {
        self.0.row(at, value, slope)
    }
}

/// The modes along `line`, each divided by its `divisor`.
fn shapes(
    line: &Arc<Rails>,
    modes: &[fea::Mode],
    divisor: impl Fn(&fea::Mode) -> f64,
) -> Result<splines::RailShapes, splines::Error> {
    let states = DMatrix::from_fn(6 * line.state_count(), modes.len(), |k, r| {
        modes[r].states[k / 6][k % 6] / divisor(&modes[r])
    });
    splines::RailShapes::new(Arc::clone(line), states)
}
