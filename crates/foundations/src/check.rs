//! What can be known of a scene before its structures are solved.

use formats::scene::{Foundation, Origin, Scene, Structure};

use crate::build::build;
use crate::error::Error;
use crate::modal::ModeCache;
use crate::mount::Excitation;

/// Checks a scene before its structures are solved: all modes of a mesh can be found together, and the wheels can carry
/// the bodies at rest.
///
/// `input` is the simulation input made from `scene`. The static equilibrium is solved on rigid rails: whether
/// one-sided contacts can balance the weights does not depend on the stiffness of a rail ([`sim::check_equilibrium`]).
///
/// ```
/// use formats::scene::Document;
/// use formats::scene::motion::simulation_input;
///
/// let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
/// let input = simulation_input(document.scene()).expect("trucks with equal wheels");
/// foundations::check_scene(document.scene(), &input.scene).expect("a bogie that stands on its wheels");
/// ```
///
/// # Errors
/// [`Error::Modes`] for a mesh with too many unknowns; [`Error::Simulation`] with [`sim::Error::NoEquilibrium`] for bodies
/// that their wheels cannot carry. Other faults are left to the run.
pub fn check_scene(scene: &Scene, input: &sim::Scene) -> Result<(), Error> {
    let lateral = scene.has_flanges();
    for structure in &scene.structures {
        check_mesh(structure, lateral)?;
    }
    let on_rigid_rails = |structure: &Structure| {
        let rigid = Structure {
            foundation: Foundation::Rigid,
            auto: false,
            ..structure.clone()
        };
        build(&mut ModeCache::default(), &rigid, None, lateral).map(|built| built.foundation)
    };
    let Ok(rigid) = scene
        .structures
        .iter()
        .map(on_rigid_rails)
        .collect::<Result<Vec<_>, Error>>()
    else {
        return Ok(());
    };
    match sim::check_equilibrium(input, &rigid) {
        Err(error @ sim::Error::NoEquilibrium { fall: Some(_), .. }) => {
            Err(Error::Simulation(error))
        }
        _ => Ok(()),
    }
}

/// Checks the number of unknowns of a structure all of whose modes are computed.
fn check_mesh(structure: &Structure, lateral: bool) -> Result<(), Error> {
    let elements = match structure.foundation {
        Foundation::Full { elements, .. } => elements,
        Foundation::Ties {
            has_mass: true,
            modes: None,
            ..
        } => 1,
        _ => return Ok(()),
    };
    let Origin::Spec { spec, .. } = &structure.origin else {
        return Ok(());
    };
    let Ok((model, rails)) = spec.model() else {
        return Ok(());
    };
    let excitation = Excitation::of(structure, lateral);
    match fea::check_full_modes(&model, &rails, &excitation.forces(), elements) {
        Err(source @ (fea::Error::TooManyModes { .. } | fea::Error::Elements { .. })) => {
            Err(Error::Modes {
                structure: structure.name.clone(),
                source,
            })
        }
        _ => Ok(()),
    }
}
