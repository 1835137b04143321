//! Builds the foundation that a scene specifies from the solution or the tables of a structure.

use formats::scene::{self, Handover, Origin, Structure};
use sim::{Extent, Foundation};
use splines::{Axis, Influence, Probe};

use crate::built::BuiltFoundation;
use crate::error::Error;
use crate::modal::{ACCURACY, Dampers, ModeCache};
use crate::mount::{self, Excitation};
use crate::parts;
use crate::solved::SolvedModel;
use crate::tables::influence;

/// Builds the foundation of one structure of a scene, with the model of its degrees of freedom.
///
/// `cache` stores modes of this structure between calls; `solved` is the solution of its spec
/// ([`crate::solution_of`]), `None` for a structure defined by tables; `lateral` is whether wheels of the scene exert
/// lateral forces.
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
/// [`Error::NoSpec`], [`Error::Unsolved`] where the foundation needs a solution that is missing; errors of the tables
/// and of the FE model.
pub fn build(
    cache: &mut ModeCache,
    structure: &Structure,
    solved: Option<&SolvedModel>,
    lateral: bool,
) -> Result<BuiltFoundation, Error> {
    build_with_modes(cache, structure, solved, lateral, ACCURACY)
}

/// [`build`], with the frequencies of a foundation in a given number of modes within `accuracy`.
pub(super) fn build_with_modes(
    cache: &mut ModeCache,
    structure: &Structure,
    solved: Option<&SolvedModel>,
    lateral: bool,
    accuracy: f64,
) -> Result<BuiltFoundation, Error> {
    let irregularities = structure.irregularities.clone();
    let mut carrier = mount::mount(structure)?;
    let is_loaded_along = structure.longitudinal;
    let BuiltFoundation {
        mut foundation,
        basis: motion,
    } = build_on_ground(cache, structure, solved, lateral, accuracy)?;
    // where the degrees of freedom represent the mass, their mass matrix replaces the rigid mass of the spec
    if let (Some(carrier), Some(moving)) = (&mut carrier, foundation.carrier.take()) {
        (carrier.mass, carrier.coupling) = (moving.mass, moving.coupling);
    }
    if let (true, Some(compliance), Some(rail)) = (
        is_loaded_along,
        &foundation.compliance,
        structure.rails.first(),
    ) {
        let probe = Probe {
            rail: 0,
            x: rail.range[0],
            axis: Axis::Longitudinal,
        };
        let mut influence = Influence::zeros(1);
        let is_known = compliance.fill(&[probe], &mut influence).is_ok()
            && influence.value[(0, 0)].is_finite();
        if !is_known {
            return Err(Error::NoLongitudinal {
                structure: structure.name.clone(),
            });
        }
    }
    Ok(BuiltFoundation {
        foundation: Foundation {
            carrier,
            irregularities,
            is_loaded_along,
            ..foundation
        },
        basis: motion,
    })
}

/// Builds the foundation as if the structure stood on the ground, without the lines of its rails on a carrying body,
/// without irregularities and without compliance along the rails.
fn build_on_ground(
    cache: &mut ModeCache,
    structure: &Structure,
    solved: Option<&SolvedModel>,
    lateral: bool,
    accuracy: f64,
) -> Result<BuiltFoundation, Error> {
    let extents = || {
        let extent = |rail: &formats::spec::RailOutline| Extent {
            range: Some(rail.range),
            breaks: Vec::new(),
        };
        structure.rails.iter().map(extent).collect::<Vec<_>>()
    };
    let excitation = Excitation::of(structure, lateral);
    match structure.foundation {
        scene::Foundation::Rigid => Ok(Foundation {
            rails: extents(),
            ..Foundation::rigid()
        }
        .into()),
        scene::Foundation::Influence => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Parts {
            count,
            handover,
            damping,
        } => {
            let girder = solved
                .and_then(|solved| solved.girder.as_ref())
                .ok_or_else(|| Error::NoGirder {
                    structure: structure.name.clone(),
                })?;
            parts::foundation(girder, count, handover, damping, excitation)
        }
        scene::Foundation::Modal { modes, damping } => cache.lowest(
            &structure.name,
            required_solution(structure, solved)?,
            (modes, accuracy),
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
        scene::Foundation::Ties {
            has_mass: false, ..
        } => Ok(influence(structure, solved)?.into()),
        scene::Foundation::Ties {
            has_mass: true,
            modes,
            damping,
            c,
        } => {
            let pads = match &structure.origin {
                Origin::Spec { spec, .. } => spec.pads(),
                Origin::Tables { .. } => &[],
            };
            let (name, dampers) = (&structure.name, Dampers { pads, c });
            let solved = required_solution(structure, solved)?;
            match modes {
                Some(count) => cache.lowest(
                    name,
                    solved,
                    (count, ACCURACY),
                    damping,
                    dampers,
                    excitation,
                ),
                // members between ties are not subdivided
                None => cache.full(name, solved, 1, damping, dampers, excitation),
            }
        }
    }
}

/// The lowest `count` modes of a structure that its wheels excite, with frequencies within 10 %, to estimate the error of
/// leaving modes out.
///
/// # Errors
/// Those of [`build`].
pub(super) fn coarse_modes(
    cache: &mut ModeCache,
    structure: &Structure,
    solved: &SolvedModel,
    lateral: bool,
    count: usize,
) -> Result<BuiltFoundation, Error> {
    cache.coarse(
        &structure.name,
        solved,
        count,
        structure.damping,
        Excitation::of(structure, lateral),
    )
}

fn required_solution<'s>(
    structure: &Structure,
    solved: Option<&'s SolvedModel>,
) -> Result<&'s SolvedModel, Error> {
    solved.ok_or_else(|| Error::NoSpec {
        structure: structure.name.clone(),
    })
}

/// A girder as `count` massless rigid parts. Within the length `window` about a joint the displacements of its two
/// parts are blended (`None`: from centre to centre). See [`sim::BlendedParts`].
///
/// # Errors
/// [`Error::Chain`] for a girder that is a mechanism; [`Error::Windows`] for windows that overlap.
pub fn rigid_parts_foundation(
    girder: &fea::Girder,
    count: usize,
    window: Option<f64>,
) -> Result<Foundation, Error> {
    Ok(parts::foundation(
        girder,
        count,
        Handover::Blend { length: window },
        0.0,
        Excitation::VERTICAL,
    )?
    .foundation)
}

/// All modes that vertical wheel forces can excite in a mesh of `elements` elements per member, undamped.
///
/// # Errors
/// [`Error::Modes`] for a structure without mass, or with too many unknowns.
pub fn full_mesh_foundation(solved: &SolvedModel, elements: usize) -> Result<Foundation, Error> {
    Ok(ModeCache::default()
        .full(
            "structure",
            solved,
            elements,
            0.0,
            Dampers::NONE,
            Excitation::VERTICAL,
        )?
        .foundation)
}
