//! The foundation that a scene asks for, built from a structure's solution or tables.

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

/// The foundation of one structure of a scene, with the model behind it.
///
/// `cache` keeps modes of this structure from one call to the next; `solved` is the solution of its spec
/// ([`crate::solution_of`]), `None` for a structure of tables; `lateral` says whether wheels of the scene excitation sideways.
///
/// ```
/// use formats::scene::Document;
/// use foundations::{ModeCache, build, distinct_specs, solution_of, solve_specs};
///
/// let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
/// let solved = solve_specs(&document, &distinct_specs(&document)).expect("a girder that stands");
/// let structure = &document.scene().structures[0];
///
/// let built = build(&mut ModeCache::default(), structure, solution_of(&solved, &structure.origin), false)
///     .expect("influence functions");
/// assert!(built.foundation.compliance.is_some());
/// assert_eq!(built.foundation.dofs(), 0, "without mass there are no degrees of freedom");
/// ```
///
/// # Errors
/// [`Error::NoLongitudinal`] where the compliance along the rails is needed and not known; [`Error::NoGirder`],
/// [`Error::NoSpec`], [`Error::Unsolved`] where the foundation needs a solution that is missing; what the tables or the FE
/// model refuse.
pub fn build(
    cache: &mut ModeCache,
    structure: &Structure,
    solved: Option<&SolvedModel>,
    lateral: bool,
) -> Result<BuiltFoundation, Error> {
    let irregularities = structure.irregularities.clone();
    let mut on = mount::mount(structure)?;
    let is_dragged = structure.longitudinal;
    let BuiltFoundation { mut foundation, basis: motion } =
        build_on_ground(cache, structure, solved, lateral)?;
    // where degrees of freedom carry the mass, their own mass matrix replaces the rigid mass of the spec
    if let (Some(on), Some(moving)) = (&mut on, foundation.carrier.take()) {
        (on.mass, on.coupling) = (moving.mass, moving.coupling);
    }
    if let (true, Some(compliance), Some(rail)) =
        (is_dragged, &foundation.compliance, structure.rails.first())
    {
        let probe = Probe { rail: 0, x: rail.range[0], axis: Axis::Longitudinal };
        let mut influence = Influence::zeros(1);
        let is_known =
            compliance.fill(&[probe], &mut influence).is_ok() && influence.value[(0, 0)].is_finite();
        if !is_known {
            return Err(Error::NoLongitudinal { structure: structure.name.clone() });
        }
    }
    Ok(BuiltFoundation {
        foundation: Foundation { carrier: on, irregularities, is_loaded_along: is_dragged, ..foundation },
        basis: motion,
    })
}

/// The same for a structure on the ground: without its rails' lines on a body, irregularities and compliance along them.
fn build_on_ground(
    cache: &mut ModeCache,
    structure: &Structure,
    solved: Option<&SolvedModel>,
    lateral: bool,
) -> Result<BuiltFoundation, Error> {
    let extents = || {
        let extent =
            |rail: &formats::spec::RailOutline| Extent { range: Some(rail.range), breaks: Vec::new() };
        structure.rails.iter().map(extent).collect::<Vec<_>>()
    };
    let excitation = Excitation { lateral, longitudinal: structure.longitudinal, on: structure.carrier };
    match structure.foundation {
        scene::Foundation::Rigid => Ok(Foundation { rails: extents(), ..Foundation::rigid() }.into()),
        scene::Foundation::Influence => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Parts { count, handover, damping } => {
            let girder = solved
                .and_then(|solved| solved.girder.as_ref())
                .ok_or_else(|| Error::NoGirder { structure: structure.name.clone() })?;
            parts::foundation(girder, count, handover, damping, excitation)
        }
        scene::Foundation::Modal { modes, damping } => cache.lowest(
            &structure.name,
            required_solution(structure, solved)?,
            modes,
            damping,
            Dampers::NONE,
            excitation,
        ),
        scene::Foundation::Full { elements, damping } => cache.full(
            &structure.name,
            required_solution(structure, solved)?,
            elements,
            damping,
            Dampers::NONE,
            excitation,
        ),
        scene::Foundation::Ties { has_mass: false, .. } => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Ties { has_mass: true, modes, damping, c } => {
            let pads = match &structure.origin {
                Origin::Spec { spec, .. } => spec.pads(),
                Origin::Tables { .. } => &[],
            };
            let (name, dampers) = (&structure.name, Dampers { pads, c });
            let solved = required_solution(structure, solved)?;
            match modes {
                Some(count) => cache.lowest(name, solved, count, damping, dampers, excitation),
                // members between ties are not subdivided
                None => cache.full(name, solved, 1, damping, dampers, excitation),
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

/// A girder as `count` massless rigid parts; a wheel passes from one part to the next within the length `window` about
/// their joint, where the two are blended (`None`: from centre to centre). See [`sim::BlendedParts`].
///
/// # Errors
/// [`Error::Chain`] for a girder that does not stand; [`Error::Windows`] for windows that overlap.
pub fn rigid_parts_foundation(
    girder: &fea::Girder,
    count: usize,
    window: Option<f64>,
) -> Result<Foundation, Error> {
    Ok(parts::foundation(girder, count, Handover::Blend { length: window }, 0.0, Excitation::VERTICAL)?
        .foundation)
}

/// Every mode that vertical wheel forces can excite of a mesh of `elements` elements for each member, undamped.
///
/// # Errors
/// [`Error::Modes`] for a structure without mass, or with too many unknowns.
pub fn full_mesh_foundation(solved: &SolvedModel, elements: usize) -> Result<Foundation, Error> {
    Ok(ModeCache::default()
        .full("structure", solved, elements, 0.0, Dampers::NONE, Excitation::VERTICAL)?
        .foundation)
}
