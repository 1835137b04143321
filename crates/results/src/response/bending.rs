//! Envelopes of bending moments along girders.

use fea::{Component, Effect, Frame, Model};
use nalgebra::Vector3;
use sim::Channel;

use super::line::{ColumnInfluence, Part};
use super::loaded::{LoadedStructure, spread};
use formats::scene::columns::{Column, Kind};
use formats::units::Dimension;
use foundations::SolvedModel;

/// Sections along a rail, about.
const SECTIONS: usize = 192;
/// Fewest and most sections of a cell.
const A_CELL: [usize; 2] = [2, 24];
/// Most cells of a structure's rails.
const CELLS: usize = 100;
/// Output times looked at.
const TIMES: usize = 512;

/// Largest and smallest bending moment along the members under a rail, positive where they sag.
#[derive(Clone, Debug, PartialEq)]
pub struct Bending {
    /// Index of the rail in the scene.
    pub rail: usize,
    /// Rail coordinate, largest moment, smallest moment.
    pub rows: Vec<[f64; 3]>,
}

/// Of every rail of structure `s` with at most 100 cells, at up to 512 evenly spread output times, without own weight.
///
/// # Errors
/// What the frame refuses.
pub(super) fn of(loaded: &LoadedStructure<'_>, solved: &SolvedModel) -> Result<Vec<Bending>, fea::Error> {
    let LoadedStructure { scene, s, history, laid, .. } = *loaded;
    let (model, rails) = (&solved.model, &solved.rails);
    let frame = Frame::new(model, rails)?;
    let line = frame.line()?;
    let count = line.cells().len();
    if count > CELLS || history.is_empty() {
        return Ok(Vec::new());
    }
    let each = (SECTIONS * rails.len().max(1) / count.max(1)).clamp(A_CELL[0], A_CELL[1]);
    let (mut effects, mut places) = (Vec::new(), Vec::new());
    for cell in line.cells() {
        let Some(carrier) = cell.carrier.filter(|_| cell.ends[0] != cell.ends[1]) else { continue };
        let Some((component, sign)) = sagging(model, carrier.member) else { continue };
        for k in 0..=each {
            let x = cell.x[0] + (cell.x[1] - cell.x[0]) * k as f64 / each as f64;
            let place = (cell.place(x) / cell.length).clamp(0.0, 1.0);
            effects.push(Effect::Force { member: carrier.member, place, component });
            places.push((cell.rail, x, sign));
        }
    }
    let column =
        Column { name: String::new(), dimension: Dimension::MOMENT, kind: Kind::Section, direction: None };
    let owner: Vec<Part> = (0..effects.len()).map(|column| Part { column, weight: 1.0 }).collect();
    let columns = vec![column; effects.len()];
    let lines = ColumnInfluence::of(&frame, solved, laid, scene.gravity, columns, &effects, owner)?;
    let start = history.channels().iter().position(|c| *c == Channel::Acceleration(s, 0));
    let mut now = vec![0.0; places.len()];
    let mut extremes = vec![[f64::NEG_INFINITY, f64::INFINITY]; places.len()];
    for row in spread(history.len(), TIMES) {
        let sample = history.sample(row);
        let acceleration = start.map_or(&[][..], |at| &sample[at..at + lines.freedoms()]);
        lines.at(loaded.on(row).iter(), acceleration, &mut now);
        for ((extreme, value), (_, _, sign)) in extremes.iter_mut().zip(&now).zip(&places) {
            let value = sign * value;
            *extreme = [extreme[0].max(value), extreme[1].min(value)];
        }
    }
    let mut out = Vec::new();
    for (index, rail) in scene.rails.iter().enumerate().filter(|(_, rail)| rail.structure == s) {
        let own = places.iter().zip(&extremes).filter(|((on, ..), _)| *on == rail.rail);
        let mut rows: Vec<[f64; 3]> = own.map(|((_, x, _), [most, least])| [*x, *most, *least]).collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let moves = rows.iter().any(|row| row[1] != 0.0 || row[2] != 0.0);
        if moves {
            out.push(Bending { rail: index, rows });
        }
    }
    Ok(out)
}

/// The component that bends a member up and down, and its sign where it sags; `None` for a member that stands.
fn sagging(model: &Model, member: usize) -> Option<(Component, f64)> {
    let member = model.members.get(member)?;
    let end = |k: usize| Vector3::from(model.points[member.points[k]]) + Vector3::from(member.offsets[k]);
    let x = (end(1) - end(0)).try_normalize(0.0)?;
    let orientation = Vector3::from(member.orientation);
    let y = (orientation - x * x.dot(&orientation)).try_normalize(0.0)?;
    let up = Vector3::from(model.up).try_normalize(0.0)?;
    let (along_y, along_z) = (y.dot(&up), x.cross(&y).dot(&up));
    if x.dot(&up).abs() > 0.7 {
        None
    } else if along_y.abs() >= along_z.abs() {
        // Mz > 0 stretches the fibres at -y
        Some((Component::BendingZ, along_y.signum()))
    } else {
        // My > 0 those at +z
        Some((Component::BendingY, -along_z.signum()))
    }
}
