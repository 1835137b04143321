//! Structures on bodies: where their rails are, and what they weigh.

use sim::{Axle, Mount};

use crate::exit::Failure;
use crate::scene::{Origin, Structure};

/// Where the rails of a structure are on the body that carries it; `None` on the ground.
///
/// # Errors
/// A spec that no model can be made of.
pub fn mount(structure: &Structure) -> Result<Option<Mount>, Failure> {
    let (Some((body, at)), Origin::Spec { spec, .. }) = (structure.on, &structure.origin) else {
        return Ok(None);
    };
    let refused = |error: fea::Error| Failure::Untrusted(format!("{}: {error}", structure.name));
    let (model, rails) = spec.model().map_err(refused)?;
    let axle = |rail: &fea::Rail| {
        let size = rail.axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let along = rail.axis.map(|a| a / size);
        // The rail itself lies at its offset from the member: only what is across it moves its line.
        let across = rail.segments.first().and_then(|segment| {
            let member = model.members.get(segment.member)?;
            let point = model.points.get(member.points[0])?;
            let offset = member.offsets[0];
            Some([0, 1, 2].map(|k| point[k] + offset[k] + segment.offset[k] - rail.origin[k]))
        });
        let across = across.unwrap_or_default();
        let ahead: f64 = across.iter().zip(along).map(|(a, e)| a * e).sum();
        Axle { origin: [0, 1, 2].map(|k| at[k] + rail.origin[k] + across[k] - ahead * along[k]), along }
    };
    let mass = Mount::moved(&fea::rigid_mass(&model).map_err(refused)?, at);
    Ok(Some(Mount { body, rails: rails.iter().map(axle).collect(), mass, coupling: Vec::new() }))
}
