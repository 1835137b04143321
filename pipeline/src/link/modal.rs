//! A structure in natural modes, with the static give of what they leave.

use std::sync::Arc;

use fea::{Frame, Modes, Refined};
use nalgebra::DMatrix;
use sim::{Dynamics, Extent, Foundation, Shapes};
use splines::{Axis, Compliance, Line, Probe};

use super::Solved;
use crate::exit::Failure;

/// Error of a frequency that the cutting of members may leave.
const ACCURACY: f64 = 1e-6;
/// Motion of the rails where wheels push, by that of the whole mass moving alike, below which wheels cannot excite it.
const STILL: f64 = 1e-6;

/// The lowest `count` modes that wheels can excite, `ratio` of critical damping each.
pub(super) fn lowest(
    name: &str,
    solved: &Solved,
    count: usize,
    ratio: f64,
    lateral: bool,
) -> Result<Foundation, Failure> {
    let mut asked = count;
    loop {
        let refined = fea::refined_modes(&solved.model, &solved.rails, asked, ACCURACY)
            .map_err(|error| refused(name, &error))?;
        let felt = felt(&refined.modes, solved, lateral)?;
        let all = refined.modes.modes.len() < asked || refined.modes.next.is_none();
        if felt.len() >= count || all {
            return foundation(name, &refined, &felt[..count.min(felt.len())], ratio);
        }
        asked = (2 * asked).max(asked + 8);
    }
}

/// Every mode that wheels can excite of a mesh of `parts` elements a member.
pub(super) fn full(
    name: &str,
    solved: &Solved,
    parts: usize,
    ratio: f64,
    lateral: bool,
) -> Result<Foundation, Failure> {
    let refined =
        fea::full_modes(&solved.model, &solved.rails, parts).map_err(|error| refused(name, &error))?;
    let felt = felt(&refined.modes, solved, lateral)?;
    foundation(name, &refined, &felt, ratio)
}

fn refused(name: &str, error: &fea::Error) -> Failure {
    let hint = match error {
        fea::Error::NoMass => "  hint: give its materials a density, or the girder `mass_per_length`",
        fea::Error::TooManyModes { .. } => {
            "  hint: \"modal\" takes the lowest modes alone; or fewer `elements`"
        }
        _ => "",
    };
    Failure::Untrusted(format!("{name}: {error}{hint}"))
}

/// Modes that move the rails where and as wheels can push, by their index.
fn felt(modes: &Modes, solved: &Solved, lateral: bool) -> Result<Vec<usize>, Failure> {
    let axes: &[Axis] = if lateral { &[Axis::Vertical, Axis::Lateral] } else { &[Axis::Vertical] };
    let mut largest = vec![0.0_f64; modes.modes.len()];
    for (rail, given) in solved.rails.iter().enumerate() {
        let line = solved.surface.as_ref().map(splines::Surface::line);
        let places = match line {
            Some(line) => places(line, rail),
            None => given.stations.clone(),
        };
        for x in places {
            for &axis in axes {
                // a direction that nothing resists moves no mode
                let Ok(shapes) = modes.at(Probe { rail, x, axis }) else { continue };
                for (largest, [value, _]) in largest.iter_mut().zip(shapes) {
                    *largest = largest.max(value.abs());
                }
            }
        }
    }
    // A mode in which the whole mass moves alike, of modal mass 1, moves by 1 / sqrt(mass).
    let limit = STILL / modes.total[0][0].sqrt();
    Ok((0..largest.len()).filter(|&k| largest[k] > limit).collect())
}

/// Places along a rail close enough to see every mode: seventeen a cell.
fn places(line: &Line, rail: usize) -> Vec<f64> {
    let cells = line.cells().iter().filter(|cell| cell.rail == rail);
    cells
        .flat_map(|cell| (0..=16).map(|k| cell.x[0] + (cell.x[1] - cell.x[0]) * f64::from(k) / 16.0))
        .collect()
}

fn foundation(name: &str, refined: &Refined, felt: &[usize], ratio: f64) -> Result<Foundation, Failure> {
    let untrusted = |error: fea::Error| Failure::Untrusted(format!("{name}: {error}"));
    let frame = Frame::new(&refined.model, &refined.rails).map_err(untrusted)?;
    let surface = frame.surface().map_err(untrusted)?.surface;
    let mut kept = refined.modes.clone();
    kept.modes = felt.iter().map(|&k| refined.modes.modes[k].clone()).collect();
    let rest = kept.residual(&surface).map_err(untrusted)?;
    let line = Arc::clone(surface.line());
    let states = DMatrix::from_fn(6 * line.states(), felt.len(), |k, r| kept.modes[r].states[k / 6][k % 6]);
    let rails = (0..refined.rails.len())
        .map(|rail| Extent { range: rest.range(rail), breaks: rest.breaks(rail) })
        .collect();
    let omega: Vec<f64> = kept.modes.iter().map(|mode| mode.omega).collect();
    let dynamics = Dynamics::Modes { ratio: vec![ratio; omega.len()], omega };
    let shapes = Box::new(ModeShapes { line, states });
    Ok(Foundation {
        compliance: Some(Box::new(rest)),
        structure: Some(sim::Structure { dynamics, shapes }),
        rails,
        ..Foundation::default()
    })
}

/// Modes along the rails: N(x) times the motion of the cells' ends.
struct ModeShapes {
    line: Arc<Line>,
    /// Freedoms of the states x modes.
    states: DMatrix<f64>,
}

impl Shapes for ModeShapes {
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error> {
        let row = self.line.row(at)?;
        for (r, (value, slope)) in value.iter_mut().zip(slope).enumerate() {
            (*value, *slope) = (0.0, 0.0);
            let column = self.states.column(r);
            for (&k, (share, share_slope)) in row.indices().iter().zip(row.values().iter().zip(row.slopes()))
            {
                *value += share * column[k];
                *slope += share_slope * column[k];
            }
        }
        Ok(())
    }
}
