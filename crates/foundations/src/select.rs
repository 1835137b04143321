//! The choice of a fidelity for structures whose foundation is "auto".
//!
//! The algorithm is that of [`sim::choose`]: it predicts the error of leaving mass or compliance out, runs the scene at the
//! lowest fidelity whose prediction is within the tolerance of the structure, estimates the error by a run at a higher one,
//! and refines until the estimate is within the tolerance. The order of fidelities is rigid, influence functions, natural
//! modes, a mesh of half the elements, the mesh. This file builds the foundations that it asks for, from the solutions of a
//! scene's specs, keeps their modes for all trials, and says why a fidelity was chosen.

use std::ops::ControlFlow;

use sim::{Choice, Fidelity, FoundationProvider, PredictedErrors, Reason, Run};
use splines::Compliance;

use crate::build::build;
use crate::built::BuiltFoundation;
use crate::error::Error;
use crate::modal::{self, Dampers, ModeCache};
use crate::mount::Excitation;
use crate::solved::{SolvedModel, SolvedStructure, solution_of};
use formats::scene::{Foundation, Scene, Structure};

/// Elements of the finest mesh, as far as the limits for each member allow.
const ELEMENTS: usize = 192;
/// Fewest and most elements of a member in the finest mesh; half of the fewest must still be a mesh.
const PER_MEMBER: [usize; 2] = [2, 64];

/// A run of a scene, with the foundations it ran on.
pub struct AutoRun {
    /// The fidelity chosen for each structure whose foundation is "auto", with the reason.
    pub choices: Vec<Choice>,
    /// The run.
    pub run: Run,
    /// The foundations, one for each structure.
    pub built: Vec<BuiltFoundation>,
}

/// Chooses the foundation of every structure of `scene` that is "auto", enters it in `scene`, and runs the scene.
///
/// `cast` is the simulation input made of `scene`; `known` has the solutions of its specs. The history holds the degrees
/// of freedom of those structures for which `recorded` (index of the structure, its foundation) is true. `watch` is called
/// with the simulated time after every step of every trial, and can stop the run.
///
/// ```
/// use std::ops::ControlFlow;
///
/// use formats::scene::motion::simulation_input;
/// use formats::scene::Document;
/// use foundations::{distinct_specs, select_and_run, selection_reason, solve_specs};
///
/// let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
/// let solved = solve_specs(&document, &distinct_specs(&document)).expect("a girder that stands");
/// let mut scene = document.scene().clone();
/// scene.structures[0].auto = true;
/// scene.structures[0].tolerance = 0.01;
/// let input = simulation_input(&scene).expect("trucks with equal wheels");
///
/// let all = |_: usize, _: &sim::Foundation| true;
/// let found = select_and_run(&mut scene, &input.scene, &solved, &all, &mut |_| ControlFlow::Continue(()))
///     .expect("a scene that starts");
/// assert!(found.run.status.is_complete());
/// assert!(selection_reason(&found.choices[0]).starts_with("auto: "));
/// ```
///
/// # Errors
/// A foundation that cannot be built; [`Error::Simulation`] for a scene that cannot start.
pub fn select_and_run(
    scene: &mut Scene,
    cast: &sim::Scene,
    known: &[SolvedStructure],
    recorded: &dyn Fn(usize, &sim::Foundation) -> bool,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<AutoRun, Error> {
    let tolerances: Vec<Option<f64>> =
        scene.structures.iter().map(|structure| structure.auto.then_some(structure.tolerance)).collect();
    let mode_caches = scene.structures.iter().map(|_| ModeCache::default()).collect();
    let lateral = scene.has_flanges();
    let mut provider = SceneFoundations { scene, known, lateral, mode_caches, recorded };
    let sim::Selection { choices, run, .. } = sim::choose(cast, &tolerances, &mut provider, watch)?;
    let mut mode_caches = provider.mode_caches;
    for choice in &choices {
        let structure = &mut scene.structures[choice.structure];
        let solved = solution_of(known, &structure.origin);
        structure.foundation = scene_foundation(structure, choice.fidelity, mesh_elements(solved));
    }
    // the run keeps no foundations: they are built again from the modes that are cached
    let built = scene
        .structures
        .iter()
        .zip(&mut mode_caches)
        .map(|(structure, cache)| build(cache, structure, solution_of(known, &structure.origin), lateral))
        .collect::<Result<Vec<BuiltFoundation>, Error>>()?;
    Ok(AutoRun { choices, run, built })
}

/// Number of elements for each member in the finest mesh of "auto": 192 in all, 2 to 64 for a member.
#[must_use]
pub fn mesh_elements(solved: Option<&SolvedModel>) -> usize {
    let members = solved.map_or(1, |solved| solved.model.members.len());
    (ELEMENTS / members.max(1)).clamp(PER_MEMBER[0], PER_MEMBER[1])
}

/// The foundation of a solved structure at fidelity `rung`, for vertical wheel forces.
///
/// `cache` keeps its modes from one call to the next; `damping` is the fraction of critical damping of each mode; the
/// finest mesh has `finer` times as many elements as that of "auto".
///
/// # Errors
/// [`Error::Modes`] for a structure without mass where modes are asked for, or with too many unknowns;
/// [`Error::NoSurface`] for influence functions of a structure whose surface is not known.
pub fn foundation_at(
    cache: &mut ModeCache,
    solved: &SolvedModel,
    rung: Fidelity,
    damping: f64,
    finer: usize,
) -> Result<sim::Foundation, Error> {
    let name = "structure";
    let rails = solved.rails.iter().enumerate();
    let elements = finer * mesh_elements(Some(solved));
    match (rung, &solved.surface) {
        (Fidelity::Modal(modes), _) => {
            Ok(cache.lowest(name, solved, modes, damping, Dampers::NONE, Excitation::VERTICAL)?.foundation)
        }
        (Fidelity::Half, _) => Ok(cache
            .full(name, solved, elements / 2, damping, Dampers::NONE, Excitation::VERTICAL)?
            .foundation),
        (Fidelity::Full, _) => {
            Ok(cache.full(name, solved, elements, damping, Dampers::NONE, Excitation::VERTICAL)?.foundation)
        }
        (Fidelity::Influence, Some(surface)) => {
            Ok(sim::Foundation::massless(Box::new(surface.clone()), rails.len()))
        }
        (Fidelity::Influence, None) => Err(Error::NoSurface { structure: name.to_owned() }),
        (Fidelity::Rigid, surface) => {
            let range = |rail| surface.as_ref().and_then(|surface| surface.range(rail));
            let extent = |(rail, _)| sim::Extent { range: range(rail), breaks: Vec::new() };
            Ok(sim::Foundation { rails: rails.map(extent).collect(), ..sim::Foundation::rigid() })
        }
    }
}

/// About the lowest `count` modes of a solved structure that vertical wheel forces excite, with frequencies to 1 %; `None`
/// without mass.
///
/// # Errors
/// [`Error::Modes`] for modes that cannot be found.
pub fn excited_modes(solved: &SolvedModel, count: usize) -> Result<Option<sim::Structure>, Error> {
    modal::coarse_modes("structure", solved, count)
}

/// The foundation of a scene that a fidelity stands for.
fn scene_foundation(structure: &Structure, rung: Fidelity, elements: usize) -> Foundation {
    let damping = structure.damping;
    match rung {
        Fidelity::Rigid => Foundation::Rigid,
        Fidelity::Influence => Foundation::Influence,
        Fidelity::Modal(modes) => Foundation::Modal { modes, damping },
        Fidelity::Half => Foundation::Full { elements: elements / 2, damping },
        Fidelity::Full => Foundation::Full { elements, damping },
    }
}

/// Builds the foundations of a scene's structures at the fidelities that the selection asks for.
struct SceneFoundations<'a> {
    scene: &'a Scene,
    known: &'a [SolvedStructure],
    lateral: bool,
    /// One for each structure.
    mode_caches: Vec<ModeCache>,
    recorded: &'a dyn Fn(usize, &sim::Foundation) -> bool,
}

impl SceneFoundations<'_> {
    fn solved(&self, structure: usize) -> Option<&SolvedModel> {
        solution_of(self.known, &self.scene.structures[structure].origin)
    }
}

impl FoundationProvider for SceneFoundations<'_> {
    type Error = Error;

    fn modes(&mut self, structure: usize, count: usize) -> Result<Option<sim::Structure>, Error> {
        Ok(match self.solved(structure) {
            Some(solved) => modal::coarse_modes(&self.scene.structures[structure].name, solved, count)?,
            None => None,
        })
    }

    fn foundation(&mut self, structure: usize, rung: Fidelity) -> Result<sim::Foundation, Error> {
        let mut own = self.scene.structures[structure].clone();
        if own.auto {
            own.foundation = scene_foundation(&own, rung, mesh_elements(self.solved(structure)));
        }
        let solved = solution_of(self.known, &own.origin);
        let mut foundation = build(&mut self.mode_caches[structure], &own, solved, self.lateral)?.foundation;
        foundation.recorded = (self.recorded)(structure, &foundation);
        Ok(foundation)
    }

    fn run(
        &mut self,
        scene: &sim::Scene,
        foundations: &[sim::Foundation],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, sim::Error> {
        sim::run_by(self.scene.stepping, scene, foundations, watch)
    }
}

/// A fidelity in words.
#[must_use]
pub fn fidelity_name(rung: Fidelity) -> String {
    match rung {
        Fidelity::Rigid => "rigid".to_owned(),
        Fidelity::Influence => "influence".to_owned(),
        Fidelity::Modal(modes) => format!("modal, {modes} modes"),
        Fidelity::Half => "full, half the elements".to_owned(),
        Fidelity::Full => "full".to_owned(),
    }
}

/// Why a foundation was chosen, as a sentence without its full stop.
#[must_use]
pub fn selection_reason(choice: &Choice) -> String {
    let rung = fidelity_name(choice.fidelity);
    let mut text = match (choice.reason, choice.estimate) {
        (Reason::NoMass, _) => {
            format!("auto: {rung}; no mass given: the error of leaving it out is not known")
        }
        (Reason::QuasiStatic, _) => format!("auto: {rung}; a quasi-static sweep has no inertia"),
        (Reason::Predicted, estimate) => format!(
            "auto: {rung}, predicted to err by {:.1e}, so far below the tolerance that no higher rung was run",
            estimate.unwrap_or_default()
        ),
        (Reason::Sufficient, estimate) => format!(
            "auto: {rung}, the lowest rung tried whose estimated error, {:.1e}, is within the tolerance",
            estimate.unwrap_or_default()
        ),
        (Reason::Highest, Some(estimate)) => format!(
            "auto: {rung}, as nothing lower was within the tolerance; half the elements differ by {estimate:.1e}, more \
             than the tolerance"
        ),
        (Reason::Highest, None) => {
            format!("auto: {rung}, as nothing lower was within the tolerance; its own error is not known")
        }
        (Reason::Unchecked, _) => {
            format!("auto: {rung}, which no higher rung could check: its error is not known")
        }
    };
    if let Some(predicted) = &choice.predicted {
        let PredictedErrors { deflection: give, speed, ripple, step, track, .. } = predicted;
        text += &format!(
            "; predicted without mass: give {give:.1e}, speed {speed:.1e}, ripple {ripple:.1e}, load step {step:.1e}, \
             track {track:.1e}"
        );
    }
    text
}

/// What a user must know of a choice whose error is not known to be within `tolerance`; `None` where it is.
#[must_use]
pub fn selection_doubt(name: &str, choice: &Choice, tolerance: f64) -> Option<String> {
    let rung = fidelity_name(choice.fidelity);
    let why = match (choice.reason, choice.estimate) {
        (Reason::Highest, Some(estimate)) => format!(
            "estimate above tolerance: {rung} is the top, and half its elements differ by {estimate:.1e}, more than \
             {tolerance}"
        ),
        (Reason::Highest, None) => {
            format!("{rung} is the top, and no coarser mesh could be run: its error is not known")
        }
        (Reason::Unchecked, _) => format!("the error of {rung} is not known: no higher rung could be run"),
        _ => return None,
    };
    let failed: Vec<String> = choice.failed.iter().map(|rung| fidelity_name(*rung)).collect();
    let list =
        if failed.is_empty() { String::new() } else { format!(" (could not be run: {})", failed.join("; ")) };
    Some(format!("{name}: {why}{list}"))
}
