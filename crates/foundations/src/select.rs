//! The choice of a fidelity for structures whose foundation is "auto".
//!
//! The algorithm is that of [`sim::choose`]: it predicts the error of leaving mass or compliance out, runs the scene
//! at the lowest fidelity whose prediction is within the tolerance of the structure, estimates the error by a run at
//! a higher one, and refines until the estimate is within the tolerance. The fidelities in ascending order are rigid,
//! influence functions, natural modes, a mesh of half the elements, and the full mesh. This file builds the requested
//! foundations from the solutions of a scene's specs, caches their modes for all trials, and explains the choice in
//! words.

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

/// Number of elements of the finest mesh, within the limits for each member.
const ELEMENTS: usize = 192;
/// Least and largest number of elements of a member in the finest mesh. Half of the least number must still be a
/// mesh.
const PER_MEMBER: [usize; 2] = [2, 64];

/// A run of a scene and the foundations of its structures.
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
/// `input` is the simulation input made from `scene`; `known` has the solutions of its specs. The history contains
/// the degrees of freedom of those structures for which `recorded` (index of the structure, its foundation) is true.
/// `watch` is called with the simulated time after every step of every trial, and can stop the run.
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
    input: &sim::Scene,
    known: &[SolvedStructure],
    recorded: &dyn Fn(usize, &sim::Foundation) -> bool,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<AutoRun, Error> {
    let tolerances: Vec<Option<f64>> =
        scene.structures.iter().map(|structure| structure.auto.then_some(structure.tolerance)).collect();
    let mode_caches = scene.structures.iter().map(|_| ModeCache::default()).collect();
    let lateral = scene.has_flanges();
    let mut provider = SceneFoundations { scene, known, lateral, mode_caches, recorded };
    let sim::Selection { choices, run, .. } = sim::choose(input, &tolerances, &mut provider, watch)?;
    let mut mode_caches = provider.mode_caches;
    for choice in &choices {
        let structure = &mut scene.structures[choice.structure];
        let solved = solution_of(known, &structure.origin);
        structure.foundation = scene_foundation(structure, choice.fidelity, mesh_elements(solved));
    }
    // the run does not return its foundations; they are built again from the cached modes
    let built = scene
        .structures
        .iter()
        .zip(&mut mode_caches)
        .map(|(structure, cache)| build(cache, structure, solution_of(known, &structure.origin), lateral))
        .collect::<Result<Vec<BuiltFoundation>, Error>>()?;
    Ok(AutoRun { choices, run, built })
}

/// Number of elements of each member in the finest mesh of "auto": about 192 in total, 2 to 64 per member.
#[must_use]
pub fn mesh_elements(solved: Option<&SolvedModel>) -> usize {
    let members = solved.map_or(1, |solved| solved.model.members.len());
    (ELEMENTS / members.max(1)).clamp(PER_MEMBER[0], PER_MEMBER[1])
}

/// The foundation of a solved structure at one fidelity, for vertical wheel forces.
///
/// `cache` stores its modes between calls; `damping` is the fraction of critical damping of each mode; the finest
/// mesh has `finer` times as many elements as that of "auto".
///
/// # Errors
/// [`Error::Modes`] for modes of a structure without mass or with too many unknowns; [`Error::NoSurface`] for
/// influence functions of a structure whose surface has not been computed.
pub fn foundation_at(
    cache: &mut ModeCache,
    solved: &SolvedModel,
    fidelity: Fidelity,
    damping: f64,
    finer: usize,
) -> Result<sim::Foundation, Error> {
    let name = "structure";
    let rails = solved.rails.iter().enumerate();
    let elements = finer * mesh_elements(Some(solved));
    match (fidelity, &solved.surface) {
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

/// Approximately the lowest `count` modes of a solved structure that vertical wheel forces excite, with frequencies
/// within 1 %; `None` for a structure without mass.
///
/// # Errors
/// [`Error::Modes`] for modes that cannot be computed.
pub fn excited_modes(solved: &SolvedModel, count: usize) -> Result<Option<sim::Structure>, Error> {
    modal::coarse_modes("structure", solved, count)
}

/// The foundation in terms of scene files that corresponds to a fidelity.
fn scene_foundation(structure: &Structure, fidelity: Fidelity, elements: usize) -> Foundation {
    let damping = structure.damping;
    match fidelity {
        Fidelity::Rigid => Foundation::Rigid,
        Fidelity::Influence => Foundation::Influence,
        Fidelity::Modal(modes) => Foundation::Modal { modes, damping },
        Fidelity::Half => Foundation::Full { elements: elements / 2, damping },
        Fidelity::Full => Foundation::Full { elements, damping },
    }
}

/// Builds the foundations of a scene's structures at the fidelities that the selection requests.
struct SceneFoundations<'a> {
    scene: &'a Scene,
    known: &'a [SolvedStructure],
    lateral: bool,
    /// Modes of each structure.
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

    fn foundation(&mut self, structure: usize, fidelity: Fidelity) -> Result<sim::Foundation, Error> {
        let mut own = self.scene.structures[structure].clone();
        if own.auto {
            own.foundation = scene_foundation(&own, fidelity, mesh_elements(self.solved(structure)));
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
pub fn fidelity_name(fidelity: Fidelity) -> String {
    match fidelity {
        Fidelity::Rigid => "rigid".to_owned(),
        Fidelity::Influence => "influence".to_owned(),
        Fidelity::Modal(modes) => format!("modal, {modes} modes"),
        Fidelity::Half => "full, half the elements".to_owned(),
        Fidelity::Full => "full".to_owned(),
    }
}

/// The reason why a foundation was chosen, as a sentence without its full stop.
#[must_use]
pub fn selection_reason(choice: &Choice) -> String {
    let chosen = fidelity_name(choice.fidelity);
    let mut text = match (choice.reason, choice.estimate) {
        (Reason::NoMass, _) => {
            format!(
                "auto: {chosen}; the mass is not known, so the error of neglecting it is not known either"
            )
        }
        (Reason::QuasiStatic, _) => format!("auto: {chosen}; a quasi-static sweep has no inertia"),
        (Reason::Predicted, estimate) => format!(
            "auto: {chosen}; its predicted error, {:.1e}, is so far below the tolerance that no higher fidelity \
             was run",
            estimate.unwrap_or_default()
        ),
        (Reason::Sufficient, estimate) => format!(
            "auto: {chosen}; it is the lowest fidelity tried whose estimated error, {:.1e}, is within the tolerance",
            estimate.unwrap_or_default()
        ),
        (Reason::Highest, Some(estimate)) => format!(
            "auto: {chosen}; no lower fidelity was within the tolerance, and a mesh of half the elements differs by \
             {estimate:.1e}, which is more than the tolerance"
        ),
        (Reason::Highest, None) => {
            format!(
                "auto: {chosen}; no lower fidelity was within the tolerance, and its own error is not known"
            )
        }
        (Reason::Unchecked, _) => {
            format!("auto: {chosen}; no higher fidelity could be run to check it, so its error is not known")
        }
    };
    if let Some(predicted) = &choice.predicted {
        let PredictedErrors { deflection, speed, ripple, step, track, .. } = predicted;
        text += &format!(
            "; predicted errors without mass: deflection {deflection:.1e}, speed {speed:.1e}, ripple {ripple:.1e}, \
             load step {step:.1e}, track {track:.1e}"
        );
    }
    text
}

/// Warning about a choice whose error is not known to be within `tolerance`; `None` where it is.
#[must_use]
pub fn selection_doubt(name: &str, choice: &Choice, tolerance: f64) -> Option<String> {
    let chosen = fidelity_name(choice.fidelity);
    let why = match (choice.reason, choice.estimate) {
        (Reason::Highest, Some(estimate)) => format!(
            "the estimated error is above the tolerance: {chosen} is the highest fidelity, and a mesh of half the \
             elements differs by {estimate:.1e}, which is more than {tolerance}"
        ),
        (Reason::Highest, None) => format!(
            "the error of {chosen} is not known: it is the highest fidelity, and no coarser mesh could be run \
             to check it"
        ),
        (Reason::Unchecked, _) => {
            format!("the error of {chosen} is not known: no higher fidelity could be run to check it")
        }
        _ => return None,
    };
    let failed: Vec<String> = choice.failed.iter().map(|fidelity| fidelity_name(*fidelity)).collect();
    let list =
        if failed.is_empty() { String::new() } else { format!(" (could not be run: {})", failed.join("; ")) };
    Some(format!("{name}: {why}{list}"))
}
