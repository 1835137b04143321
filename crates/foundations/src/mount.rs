//! Structures on bodies: where their rails are, and what they weigh.

use fea::Modes;
use sim::{Axle, Mount};
use splines::Axis;

use crate::error::Error;
use formats::scene::{On, Origin, Structure};

/// Where the rails of a structure are on the body that carries it; `None` on the ground.
///
/// # Errors
/// A spec that no model can be made of.
pub fn mount(structure: &Structure) -> Result<Option<Mount>, Error> {
    let (Some(On { body, at, .. }), Origin::Spec { spec, .. }) = (structure.on, &structure.origin) else {
        return Ok(None);
    };
    let refused = Error::frame(&structure.name);
    let (model, rails) = spec.model().map_err(&refused)?;
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
    let mass = Mount::moved(&fea::rigid_mass(&model).map_err(&refused)?, at);
    Ok(Some(Mount { body, rails: rails.iter().map(axle).collect(), mass, coupling: Vec::new() }))
}

/// What moves a structure: wheels, sideways and along the rail too where they push so, and the body that carries it.
#[derive(Clone, Copy)]
pub(super) struct Excitation {
    pub lateral: bool,
    pub longitudinal: bool,
    pub on: Option<On>,
}

impl Excitation {
    /// Vertical wheel forces on a structure on the ground.
    pub const DOWN: Excitation = Excitation { lateral: false, longitudinal: false, on: None };

    /// Directions in which wheels push.
    pub fn axes(self) -> Vec<Axis> {
        let pushes =
            [(Axis::Vertical, true), (Axis::Lateral, self.lateral), (Axis::Longitudinal, self.longitudinal)];
        pushes.into_iter().filter(|(_, pushes)| *pushes).map(|(axis, _)| axis).collect()
    }
}

/// Momentum of every mode by the motions of its carrier that may change, relative to that of the whole mass: one line a
/// motion, of the size of a mode's motion in which all mass moves alike.
pub(super) fn coupled_momentum(modes: &Modes, on: On) -> Vec<f64> {
    let total = Mount::moved(&modes.total, on.at);
    let couplings: Vec<[f64; 6]> =
        modes.modes.iter().map(|mode| Mount::moved_load(&mode.coupling, on.at)).collect();
    let moving = (0..6).filter(|&i| on.moves[i] && total[i][i] > 0.0);
    moving
        .flat_map(|i| {
            let size = (total[i][i] * modes.total[0][0]).sqrt();
            couplings.iter().map(move |coupling| coupling[i] / size)
        })
        .collect()
}

/// Mass of a structure in modes, and the momentum of those that are kept; its rails come later.
pub(super) fn inertia(modes: &Modes, on: On) -> Mount {
    let coupling = modes.modes.iter().map(|mode| Mount::moved_load(&mode.coupling, on.at)).collect();
    Mount { body: on.body, rails: Vec::new(), mass: Mount::moved(&modes.total, on.at), coupling }
}
