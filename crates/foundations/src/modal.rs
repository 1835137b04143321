//! A structure in natural modes, with the static give of what they leave.

use std::sync::Arc;

use fea::{Frame, Modes, Refined};
use nalgebra::{DMatrix, Vector3};
use sim::{Dynamics, Extent, Foundation, Shapes};
use splines::{Compliance, Line, Probe, Rest, Surface};

use crate::built::{BuiltFoundation, MotionBasis};
use crate::error::Error;
use crate::mount::{self, Excitation};
use crate::solved::SolvedModel;
use formats::track::Pad;

/// Error of a frequency that the cutting of members may leave.
const ACCURACY: f64 = 1e-6;
/// The same where modes only say what is to be left out.
const COARSE: f64 = 1e-2;
/// Motion of the rails where wheels push, by that of the whole mass moving alike, below which wheels cannot excite it.
const STILL: f64 = 1e-6;
/// Relative difference of two frequencies that are one.
const EQUAL: f64 = 1e-6;

/// Modes of one mesh that wheels can excite, and what is needed to leave some of them out.
pub(super) struct MeshModes {
    refined: Refined,
    excited: Vec<fea::Mode>,
    frame: Arc<Frame>,
    compliance: StaticCompliance,
    /// Whether there are no others.
    is_whole: bool,
}

/// Static give of the structure, without what modes take of it.
enum StaticCompliance {
    /// Of the members as given: for a few modes on members cut into many parts.
    Given(Surface),
    /// Of the members as they are cut: for all modes of a mesh.
    Cut(Surface),
}

impl MeshModes {
    /// At least the lowest `count` modes, where there are so many.
    pub fn lowest(
        name: &str,
        solved: &SolvedModel,
        count: usize,
        push: Excitation,
    ) -> Result<MeshModes, Error> {
        let (refined, felt, is_whole) = search(solved, count, ACCURACY, push).map_err(Error::modes(name))?;
        let known = solved.surface.clone().map_or_else(|| surface(name, &solved.model, &solved.rails), Ok)?;
        MeshModes::new(name, refined, felt, Some(known), is_whole)
    }

    /// All modes of a mesh of `parts` elements a member.
    pub fn whole(
        name: &str,
        solved: &SolvedModel,
        parts: usize,
        push: Excitation,
    ) -> Result<MeshModes, Error> {
        let refined = fea::full_modes(&solved.model, &solved.rails, parts).map_err(Error::modes(name))?;
        let felt = excited_by(&refined.modes, solved, push);
        MeshModes::new(name, refined, felt, None, true)
    }

    fn new(
        name: &str,
        refined: Refined,
        felt: Vec<fea::Mode>,
        known: Option<Surface>,
        is_whole: bool,
    ) -> Result<MeshModes, Error> {
        let untrusted = Error::frame(name);
        let frame = Frame::new(&refined.model, &refined.rails).map_err(&untrusted)?;
        let give = match known {
            Some(surface) => StaticCompliance::Given(surface),
            None => StaticCompliance::Cut(frame.surface().map_err(&untrusted)?.surface),
        };
        Ok(MeshModes { refined, excited: felt, frame: Arc::new(frame), compliance: give, is_whole })
    }

    /// Whether `count` modes are there, or all that exist.
    pub fn has(&self, count: usize) -> bool {
        self.is_whole || self.excited.len() >= count
    }

    /// The lowest `count` modes, `ratio` of critical damping each.
    pub fn foundation(
        &self,
        name: &str,
        count: usize,
        ratio: f64,
        dampers: Dampers<'_>,
        push: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let untrusted = Error::frame(name);
        let mut refined = self.refined.clone();
        refined.modes.modes = self.excited.iter().take(count).cloned().collect();
        let kept = &refined.modes;
        let unfit = Error::rails(name);
        let line = Arc::clone(self.frame.line().map_err(&untrusted)?);
        let rest: Box<dyn Compliance> = match &self.compliance {
            StaticCompliance::Given(exact) => {
                let taken = shapes(&line, &kept.modes, |mode| mode.omega).map_err(&unfit)?;
                Box::new(Rest::new(exact.clone(), taken))
            }
            StaticCompliance::Cut(surface) => Box::new(kept.residual(surface).map_err(&untrusted)?),
        };
        let own = shapes(&line, &kept.modes, |_| 1.0).map_err(&unfit)?;
        let rails = (0..refined.rails.len())
            .map(|rail| Extent { range: rest.range(rail), breaks: rest.breaks(rail) })
            .collect();
        let omega: Vec<f64> = kept.modes.iter().map(|mode| mode.omega).collect();
        let dynamics = if dampers.c > 0.0 {
            damped(&kept.modes, &omega, ratio, dampers)
        } else {
            Dynamics::Modes { ratio: vec![ratio; omega.len()], omega }
        };
        let foundation = Foundation {
            compliance: Some(rest),
            structure: Some(sim::Structure { dynamics, shapes: Box::new(ModeShapes(own)) }),
            rails,
            on: push.on.map(|on| mount::inertia(kept, on)),
            ..Foundation::default()
        };
        let motion = MotionBasis::Modes { frame: Arc::clone(&self.frame), refined: Box::new(refined) };
        Ok(BuiltFoundation { foundation, motion: Some(motion) })
    }
}

fn surface(name: &str, model: &fea::Model, rails: &[fea::Rail]) -> Result<Surface, Error> {
    let found = Frame::new(model, rails).and_then(|frame| frame.surface());
    Ok(found.map_err(Error::frame(name))?.surface)
}

/// At least the lowest `count` modes that wheels can excite, and whether these are all; frequencies within `accuracy`.
fn search(
    solved: &SolvedModel,
    count: usize,
    accuracy: f64,
    push: Excitation,
) -> Result<(Refined, Vec<fea::Mode>, bool), fea::Error> {
    let mut asked = count;
    loop {
        let refined = fea::refined_modes(&solved.model, &solved.rails, asked, accuracy)?;
        let felt = excited_by(&refined.modes, solved, push);
        let highest = refined.modes.modes.last().map_or(0.0, |mode| mode.omega);
        let is_whole = refined.modes.modes.len() < asked || refined.modes.next.is_none();
        // Some of the modes of one frequency are not enough to turn them.
        let torn = refined.modes.next.is_some_and(|next| next <= highest * (1.0 + EQUAL));
        if is_whole || (felt.len() >= count && !torn) {
            return Ok((refined, felt, is_whole));
        }
        asked = (2 * asked).max(asked + 8);
    }
}

/// The lowest `count` modes that vertical wheel forces excite, on a coarse mesh; `None` where no mass is given.
pub(super) fn coarse_modes(
    name: &str,
    solved: &SolvedModel,
    count: usize,
) -> Result<Option<sim::Structure>, Error> {
    let (refined, mut felt, _) = match search(solved, count, COARSE, Excitation::DOWN) {
        Ok(found) => found,
        Err(fea::Error::NoMass) => return Ok(None),
        Err(error) => return Err(Error::modes(name)(error)),
    };
    felt.truncate(count);
    let untrusted = Error::frame(name);
    let frame = Frame::new(&refined.model, &refined.rails).map_err(&untrusted)?;
    let own = shapes(frame.line().map_err(&untrusted)?, &felt, |_| 1.0).map_err(Error::rails(name))?;
    let shapes = Box::new(ModeShapes(own));
    let omega: Vec<f64> = felt.iter().map(|mode| mode.omega).collect();
    let dynamics = Dynamics::Modes { ratio: vec![0.0; omega.len()], omega };
    Ok(Some(sim::Structure { dynamics, shapes }))
}

/// Dampers of one size under the ties of a rail.
#[derive(Clone, Copy)]
pub(super) struct Dampers<'p> {
    /// Where they are.
    pub pads: &'p [Pad],
    /// Force time/length.
    pub c: f64,
}

impl Dampers<'_> {
    pub const NONE: Dampers<'static> = Dampers { pads: &[], c: 0.0 };
}

/// Modes of one structure that were found already.
#[derive(Default)]
pub struct ModeCache {
    lowest: Option<MeshModes>,
    /// By elements a member.
    whole: Vec<(usize, MeshModes)>,
}

impl ModeCache {
    /// The lowest `count` modes that wheels can excite, `ratio` of critical damping each.
    pub(super) fn lowest(
        &mut self,
        name: &str,
        solved: &SolvedModel,
        count: usize,
        ratio: f64,
        dampers: Dampers<'_>,
        push: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let known = self.lowest.take().filter(|spectrum| spectrum.has(count));
        let spectrum = match known {
            Some(known) => known,
            None => MeshModes::lowest(name, solved, count, push)?,
        };
        self.lowest.insert(spectrum).foundation(name, count, ratio, dampers, push)
    }

    /// Every mode that wheels can excite of a mesh of `parts` elements a member.
    pub(super) fn full(
        &mut self,
        name: &str,
        solved: &SolvedModel,
        parts: usize,
        ratio: f64,
        dampers: Dampers<'_>,
        push: Excitation,
    ) -> Result<BuiltFoundation, Error> {
        let at = match self.whole.iter().position(|(own, _)| *own == parts) {
            Some(at) => at,
            None => {
                self.whole.push((parts, MeshModes::whole(name, solved, parts, push)?));
                self.whole.len() - 1
            }
        };
        self.whole[at].1.foundation(name, usize::MAX, ratio, dampers, push)
    }
}

/// Modes that move the rails where and as wheels can push.
///
/// Modes of one frequency are any of their sums: they are turned so that as few as can be move the rails there.
fn excited_by(modes: &Modes, solved: &SolvedModel, push: Excitation) -> Vec<fea::Mode> {
    let motions = motions(modes, solved, push);
    // A mode in which the whole mass moves alike, of modal mass 1, moves by 1 / sqrt(mass).
    let limit = STILL / modes.total[0][0].sqrt();
    let mut kept = Vec::new();
    let mut first = 0;
    while first < modes.modes.len() {
        let omega = modes.modes[first].omega;
        let more = modes.modes[first..].iter().take_while(|mode| mode.omega <= omega * (1.0 + EQUAL));
        let cluster = first..first + more.count();
        first = cluster.end;
        let of = motions.columns(cluster.start, cluster.len());
        let turn = (of.transpose() * of).symmetric_eigen().eigenvectors;
        let mut turned: Vec<(f64, fea::Mode)> = (0..cluster.len())
            .map(|c| {
                let shares = turn.column(c);
                ((of * shares).amax(), sum(&modes.modes[cluster.clone()], shares.as_slice()))
            })
            .filter(|(largest, _)| *largest > limit)
            .collect();
        turned.sort_by(|a, b| b.0.total_cmp(&a.0));
        kept.extend(turned.into_iter().map(|(_, mode)| mode));
    }
    kept
}

/// Motion of the rails, places and directions x modes, where and as wheels can push.
fn motions(modes: &Modes, solved: &SolvedModel, push: Excitation) -> DMatrix<f64> {
    let mut rows = Vec::new();
    for (rail, given) in solved.rails.iter().enumerate() {
        let places = match &solved.surface {
            Some(surface) => places(surface.line(), rail),
            None => given.stations.clone(),
        };
        for x in places {
            for axis in push.axes() {
                // a direction that nothing resists moves no mode
                if let Ok(shapes) = modes.at(Probe { rail, x, axis }) {
                    rows.extend(shapes.into_iter().map(|[value, _]| value));
                }
            }
        }
    }
    let count = modes.modes.len();
    if let Some(on) = push.on {
        rows.extend(mount::coupled_momentum(modes, on));
    }
    DMatrix::from_row_slice(rows.len() / count.max(1), count, &rows)
}

/// A sum of modes of one frequency.
fn sum(modes: &[fea::Mode], shares: &[f64]) -> fea::Mode {
    let mut out = modes[0].clone();
    let add = |of: fn(&fea::Mode) -> &Vec<[f64; 6]>, at: usize, i: usize| -> f64 {
        modes.iter().zip(shares).map(|(mode, share)| share * of(mode)[at][i]).sum()
    };
    for (at, motion) in out.states.iter_mut().enumerate() {
        *motion = std::array::from_fn(|i| add(|mode| &mode.states, at, i));
    }
    for (at, motion) in out.points.iter_mut().enumerate() {
        *motion = std::array::from_fn(|i| add(|mode| &mode.points, at, i));
    }
    out.coupling = std::array::from_fn(|i| modes.iter().zip(shares).map(|(m, s)| s * m.coupling[i]).sum());
    out
}

/// Places along a rail close enough to see every mode: seventeen a cell.
fn places(line: &Line, rail: usize) -> Vec<f64> {
    let cells = line.cells().iter().filter(|cell| cell.rail == rail);
    cells
        .flat_map(|cell| (0..=16).map(|k| cell.x[0] + (cell.x[1] - cell.x[0]) * f64::from(k) / 16.0))
        .collect()
}

/// M = 1, K = omega^2, C = 2 zeta omega + c D^T D; D: by how much each mode stretches each damper.
fn damped(modes: &[fea::Mode], omega: &[f64], ratio: f64, dampers: Dampers<'_>) -> Dynamics {
    let up = |pad: &Pad, point: usize, arm: [f64; 3], mode: &fea::Mode| {
        let [x, y, z, rx, ry, rz] = mode.points[point];
        let turn = Vector3::new(rx, ry, rz).cross(&Vector3::from(arm));
        (Vector3::new(x, y, z) + turn).dot(&Vector3::from(pad.up))
    };
    let stretch = DMatrix::from_fn(dampers.pads.len(), modes.len(), |i, r| {
        let pad = &dampers.pads[i];
        let base = pad.base.map_or(0.0, |(point, arm)| up(pad, point, arm, &modes[r]));
        up(pad, pad.rail, [0.0; 3], &modes[r]) - base
    });
    let n = modes.len();
    let own = DMatrix::from_fn(n, n, |i, j| if i == j { 2.0 * ratio * omega[i] } else { 0.0 });
    let square = DMatrix::from_fn(n, n, |i, j| if i == j { omega[i] * omega[i] } else { 0.0 });
    let damping = own + stretch.transpose() * &stretch * dampers.c;
    Dynamics::Matrices { mass: DMatrix::identity(n, n), damping, stiffness: square }
}

/// Modes along the rails.
struct ModeShapes(splines::Shapes);

impl Shapes for ModeShapes {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error> {
        self.0.row(at, value, slope)
    }
}

/// Modes along `line`, each divided by what `size` says of it.
fn shapes(
    line: &Arc<Line>,
    modes: &[fea::Mode],
    size: impl Fn(&fea::Mode) -> f64,
) -> Result<splines::Shapes, splines::Error> {
    let states = DMatrix::from_fn(6 * line.states(), modes.len(), |k, r| {
        modes[r].states[k / 6][k % 6] / size(&modes[r])
    });
    splines::Shapes::new(Arc::clone(line), states)
}
