//! The lowest natural frequency of an imported structure, by which two distributions of its mass are compared.

use formats::spec::{Form, Spec};
use formats::text::source::Source;

use crate::rail::{RailRequest, rail_along_members};
use crate::structure::ImportedStructure;
use crate::write::write;

/// Largest number of members of a structure whose frequency is computed, so that an import takes no longer than a second.
const MOST_MEMBERS: usize = 1000;
/// Number of members that are tried as a rail, without which no spec can be read.
const MOST_TRIED: usize = 20;
/// Accuracy of the frequency, relative.
const ACCURACY: f64 = 1e-3;

/// The lowest natural frequency, in Hz; `None` if the structure is large, moves freely or has no mass that vibrates.
pub(crate) fn lowest_frequency(structure: &ImportedStructure) -> Option<f64> {
    if structure.members.len() > MOST_MEMBERS {
        return None;
    }
    let mut structure = structure.clone();
    if structure.rails.is_empty() {
        add_any_rail(&mut structure)?;
    }
    let source = Source {
        name: structure.name.clone(),
        text: write(&structure),
    };
    let Form::Frame(frame) = Spec::read(&source, None).ok()?.form else {
        return None;
    };
    let found = fea::refined_modes(&frame.model, &[], 1, ACCURACY).ok()?;
    let lowest = found.modes.modes.first()?.omega / std::f64::consts::TAU;
    (lowest.is_finite() && lowest > 0.0).then_some(lowest)
}

/// Adds a rail along one of the first members.
fn add_any_rail(structure: &mut ImportedStructure) -> Option<()> {
    let directions = [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0]];
    let ids = structure.members.iter().map(|member| member.id);
    let (up, rail) = ids
        .filter(|id| *id > 0)
        .take(MOST_TRIED)
        .flat_map(|id| directions.map(|up| (id, structure.up.unwrap_or(up))))
        .find_map(|(id, up)| {
            let asked: RailRequest = format!("any={id}").parse().ok()?;
            Some((up, rail_along_members(&asked, up, structure).ok()?))
        })?;
    structure.up = Some(up);
    structure.rails.push(rail);
    Some(())
}
