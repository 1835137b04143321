//! The foundation that a scene asks for, made of a structure's solution or tables.

use formats::scene::{self, Handover, Origin, Structure};
use sim::{Extent, Foundation};
use splines::{Axis, Influence, Probe};

use crate::built::BuiltFoundation;
use crate::error::Error;
use crate::modal::{Dampers, ModeCache};
use crate::mount::{self, Excitation};
use crate::parts;
use crate::solved::SolvedModel;
use crate::tables::influence;

/// What carries the rails of one structure of a scene, and the model behind it; modes that are known already stand in
/// `spectra`, `lateral`: whether wheels push sideways.
///
/// # Errors
/// What the tables or the FE model refuse.
pub fn build(
    spectra: &mut ModeCache,
    structure: &Structure,
    solved: Option<&SolvedModel>,
    lateral: bool,
) -> Result<BuiltFoundation, Error> {
    let irregularities = structure.irregularities.clone();
    let mut on = mount::mount(structure)?;
    let is_dragged = structure.longitudinal;
    let BuiltFoundation { mut foundation, motion } = build_on_ground(spectra, structure, solved, lateral)?;
    if let (Some(on), Some(own)) = (&mut on, foundation.on.take()) {
        (on.mass, on.coupling) = (own.mass, own.coupling);
    }
    if let (true, Some(compliance), Some(rail)) =
        (is_dragged, &foundation.compliance, structure.rails.first())
    {
        let probe = Probe { rail: 0, x: rail.range[0], axis: Axis::Longitudinal };
        let mut give = Influence::zeros(1);
        let known = compliance.fill(&[probe], &mut give).is_ok() && give.value[(0, 0)].is_finite();
        if !known {
            return Err(Error::NoLongitudinal { structure: structure.name.clone() });
        }
    }
    Ok(BuiltFoundation { foundation: Foundation { on, irregularities, is_dragged, ..foundation }, motion })
}

/// The same, without what carries it.
fn build_on_ground(
    spectra: &mut ModeCache,
    structure: &Structure,
    solved: Option<&SolvedModel>,
    lateral: bool,
) -> Result<BuiltFoundation, Error> {
    let extents = || {
        let extent =
            |rail: &formats::spec::RailOutline| Extent { range: Some(rail.range), breaks: Vec::new() };
        structure.rails.iter().map(extent).collect::<Vec<_>>()
    };
    let push = Excitation { lateral, longitudinal: structure.longitudinal, on: structure.on };
    match structure.foundation {
        scene::Foundation::Rigid => Ok(Foundation { rails: extents(), ..Foundation::rigid() }.into()),
        scene::Foundation::Influence => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Parts { count, handover, damping } => {
            let girder = solved
                .and_then(|solved| solved.girder.as_ref())
                .ok_or_else(|| Error::NoGirder { structure: structure.name.clone() })?;
            parts::foundation(girder, count, handover, damping, push)
        }
        scene::Foundation::Modal { modes, damping } => spectra.lowest(
            &structure.name,
            required_solution(structure, solved)?,
            modes,
            damping,
            Dampers::NONE,
            push,
        ),
        scene::Foundation::Full { elements, damping } => spectra.full(
            &structure.name,
            required_solution(structure, solved)?,
            elements,
            damping,
            Dampers::NONE,
            push,
        ),
        scene::Foundation::Ties { moves: false, .. } => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Ties { moves: true, modes, damping, c } => {
            let pads = match &structure.origin {
                Origin::Spec { spec, .. } => spec.pads(),
                Origin::Tables { .. } => &[],
            };
            let (name, dampers) = (&structure.name, Dampers { pads, c });
            let solved = required_solution(structure, solved)?;
            match modes {
                Some(count) => spectra.lowest(name, solved, count, damping, dampers, push),
                // the mesh as it is
                None => spectra.full(name, solved, 1, damping, dampers, push),
            }
        }
    }
}

fn required_solution<'s>(
    structure: &Structure,
    solved: Option<&'s SolvedModel>,
) -> Result<&'s SolvedModel, Error> {
    solved.ok_or_else(|| Error::NoSpec { structure: structure.name.clone() })
}

/// A girder as massless rigid parts with one contact a wheel on a datum blended over `window` (none: from centre
/// to centre): see [`sim::BlendedParts`].
///
/// # Errors
/// A girder that does not stand; windows that overlap.
pub fn rigid_parts(girder: &fea::Girder, count: usize, window: Option<f64>) -> Result<Foundation, Error> {
    Ok(parts::foundation(girder, count, Handover::Blend { length: window }, 0.0, Excitation::DOWN)?
        .foundation)
}

/// Every mode that vertical wheel forces can excite of a mesh of `elements` elements a member, undamped.
///
/// # Errors
/// A structure without mass; too many unknowns.
pub fn full_mesh(solved: &SolvedModel, elements: usize) -> Result<Foundation, Error> {
    Ok(ModeCache::default()
        .full("structure", solved, elements, 0.0, Dampers::NONE, Excitation::DOWN)?
        .foundation)
}
