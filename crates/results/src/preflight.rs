//! Faults of a scene that are known before its structures are solved.

use formats::scene::motion::simulation_input;
use formats::scene::{Document, Scene};
use formats::text::diagnostic::Diagnostic;
use formats::text::fault::{Fault, Faults};
use formats::text::place::Place;

use crate::Error;
use crate::run_error::of_fall;

/// Checks every case of a document as [`foundations::check_scene`] does, and locates what is wrong.
///
/// ```
/// use formats::scene::Document;
///
/// let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
/// results::preflight::check(&document).expect("a bogie that stands on its wheels");
/// ```
///
/// # Errors
/// Meshes with too many unknowns, and bodies that their wheels cannot carry.
pub fn check(document: &Document) -> Result<(), Vec<Diagnostic>> {
    let mut wrong: Vec<Diagnostic> = Vec::new();
    for case in &document.cases {
        let Some(fault) = fault(&case.scene) else {
            continue;
        };
        let found = document.diagnose(case.label.as_deref(), &Faults(vec![fault]));
        wrong.extend(
            found
                .into_iter()
                .filter(|new| !wrong.contains(new))
                .collect::<Vec<_>>(),
        );
    }
    if wrong.is_empty() { Ok(()) } else { Err(wrong) }
}

/// A document that has been checked ([`check`]), with the wheels at rest in the preload of the structures that ask for them
/// ([`foundations::with_wheels_at_rest`]).
///
/// # Errors
/// As [`check`].
pub fn validate(document: Document) -> Result<Document, Vec<Diagnostic>> {
    check(&document)?;
    Ok(foundations::with_wheels_at_rest(document))
}

/// The fault of one case, at its place in the scene.
fn fault(scene: &Scene) -> Option<Fault> {
    // trucks that cannot be simulated are left to the run
    let input = simulation_input(scene).ok()?;
    of_error(&foundations::check_scene(scene, &input.scene).err()?, scene)
}

/// The fault of a scene that an error of its foundations shows; `None` where it is not one of the scene alone.
#[must_use]
pub fn of_error(error: &foundations::Error, scene: &Scene) -> Option<Fault> {
    let root = Place::root();
    match error {
        foundations::Error::Modes { structure, source } => {
            let list = root.key("structures");
            let (key, hint) = match source {
                fea::Error::TooManyModes { .. } | fea::Error::Elements { .. } => (
                    "elements",
                    "use fewer, or \"modal\", which computes only the lowest modes",
                ),
                fea::Error::NoMass => (
                    "foundation",
                    "give its materials a density, or the girder `mass_per_length`",
                ),
                _ => return None,
            };
            Some(Fault::new(&list.key(structure).key(key), source.to_string()).hint(hint))
        }
        foundations::Error::Simulation(sim::Error::NoEquilibrium { fall, .. }) => {
            let fall = fall.as_ref()?;
            let (why, hint) = of_fall(fall, scene);
            let list = root.key("bodies");
            let place = list.key(&scene.bodies[fall.body].name);
            let fault = Fault::new(&place, format!("has no static equilibrium: {why}"));
            Some(fault.at_key().hint(hint))
        }
        foundations::Error::NoLongitudinal { structure } => {
            let list = root.key("structures");
            let fault = Fault::new(
                &list.key(structure).key("longitudinal"),
                "the compliance of the structure along its rails is not known",
            );
            Some(fault.hint("omit `longitudinal`"))
        }
        _ => None,
    }
}

/// Locates an error of the simulation in the scene: faults that only the solved structures show, and bodies without a
/// static equilibrium on them. Other errors remain as they are.
#[must_use]
pub fn located(document: &Document, error: Error) -> Error {
    let diagnosed = |fault: Fault| document.diagnose(None, &Faults(vec![fault]));
    match &error {
        Error::Foundation(found) => match of_error(found, document.scene()) {
            Some(fault) => Error::Input(diagnosed(fault)),
            None => error,
        },
        Error::Run { at, .. } if !at.is_empty() => {
            let fault = |place: &Place| Fault::new(place, error.to_string()).at_key();
            let root = Place::root();
            let found = match at.as_slice() {
                [list, name] => fault(&root.key(list).key(name)),
                [key, ..] => fault(&root.key(key)),
                [] => fault(&root),
            };
            Error::NoSolution(diagnosed(found).iter().map(ToString::to_string).collect())
        }
        _ => error,
    }
}
