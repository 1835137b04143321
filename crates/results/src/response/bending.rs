//! Envelopes of bending moments along girders.

use fea::{Effect, FactoredFrame, ForceComponent, Model};
use nalgebra::Vector3;
use sim::Channel;

use super::influence::{ColumnInfluence, ColumnTerm};
use super::loaded::{LoadedStructure, spread};
use formats::scene::columns::{Column, Kind};
use formats::units::Dimension;
use foundations::SolvedModel;

/// Approximate number of sections per rail.
const SECTIONS: usize = 192;
/// Smallest and largest number of intervals between the sections of a rail element.
const INTERVALS: [usize; 2] = [2, 24];
/// Largest number of rail elements of a structure for which envelopes are computed.
const MAX_ELEMENTS: usize = 100;
/// Largest number of output times that are evaluated.
const MAX_TIMES: usize = 512;

/// Largest and smallest bending moment along the members under a rail, positive for sagging moments.
#[derive(Clone, Debug, PartialEq)]
pub struct Bending {
    /// Index of the rail in the scene.
    pub rail: usize,
    /// Rail coordinate, largest moment, smallest moment; by increasing coordinate.
    pub rows: Vec<[f64; 3]>,
}

/// The envelopes of every rail of the structure, without dead load; none for a structure with more than 100 rail
/// elements.
///
/// About 192 sections of the members under each rail are chosen. Their bending moments are computed from influence
/// lines and inertia like those of columns ([`ColumnInfluence`]), at up to 512 evenly distributed output times. Rails
/// whose moments are zero throughout are omitted.
///
/// # Errors
/// The errors of the frame solver.
pub(super) fn moment_envelopes(
    loaded: &LoadedStructure<'_>,
    solved: &SolvedModel,
) -> Result<Vec<Bending>, fea::Error> {
    let LoadedStructure { scene, s, history, built, .. } = *loaded;
    let (model, rails) = (&solved.model, &solved.rails);
    let frame = FactoredFrame::new(model, rails)?;
    let rail_elements = frame.line()?;
    let count = rail_elements.elements().len();
    if count > MAX_ELEMENTS || history.is_empty() {
        return Ok(Vec::new());
    }
    let intervals = (SECTIONS * rails.len().max(1) / count.max(1)).clamp(INTERVALS[0], INTERVALS[1]);
    let (mut effects, mut places) = (Vec::new(), Vec::new());
    for element in rail_elements.elements() {
        let Some(member) = element.member.filter(|_| element.ends[0] != element.ends[1]) else { continue };
        let Some((component, sign)) = sagging(model, member.id) else { continue };
        for k in 0..=intervals {
            let x = element.x[0] + (element.x[1] - element.x[0]) * k as f64 / intervals as f64;
            let place = (element.place_on_member(x) / element.length).clamp(0.0, 1.0);
            effects.push(Effect::InternalForce { member: member.id, place, component });
            places.push((element.rail, x, sign));
        }
    }
    let column =
        Column { name: String::new(), dimension: Dimension::MOMENT, kind: Kind::Section, direction: None };
    let terms: Vec<ColumnTerm> =
        (0..effects.len()).map(|column| ColumnTerm { column, weight: 1.0 }).collect();
    let columns = vec![column; effects.len()];
    let lines = ColumnInfluence::of(&frame, solved, built, scene.gravity, columns, &effects, terms)?;
    let start = history.channels().iter().position(|c| *c == Channel::Acceleration(s, 0));
    let mut now = vec![0.0; places.len()];
    let mut extremes = vec![[f64::NEG_INFINITY, f64::INFINITY]; places.len()];
    for row in spread(history.len(), MAX_TIMES) {
        let sample = history.sample(row);
        let acceleration = start.map_or(&[][..], |at| &sample[at..at + lines.dofs()]);
        lines.at(loaded.on(row).iter(), acceleration, &mut now);
        for ((extreme, value), (_, _, sign)) in extremes.iter_mut().zip(&now).zip(&places) {
            let value = sign * value;
            *extreme = [extreme[0].max(value), extreme[1].min(value)];
        }
    }
    let mut out = Vec::new();
    for (index, rail) in scene.rails.iter().enumerate().filter(|(_, rail)| rail.structure == s) {
        let on_rail = places.iter().zip(&extremes).filter(|((on, ..), _)| *on == rail.rail);
        let mut rows: Vec<[f64; 3]> = on_rail.map(|((_, x, _), [most, least])| [*x, *most, *least]).collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        if rows.iter().any(|row| row[1] != 0.0 || row[2] != 0.0) {
            out.push(Bending { rail: index, rows });
        }
    }
    Ok(out)
}

/// The component of the bending moment of a member in its vertical plane, and the sign of a sagging moment; `None`
/// for a member steeper than about 45 degrees.
fn sagging(model: &Model, member: usize) -> Option<(ForceComponent, f64)> {
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
        // Mz > 0 causes tension in the fibres at -y
        Some((ForceComponent::BendingZ, along_y.signum()))
    } else {
        // My > 0 causes tension in the fibres at +z
        Some((ForceComponent::BendingY, -along_z.signum()))
    }
}
