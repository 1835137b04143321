//! Foundations on demand, for structures whose foundation is "auto".

use std::ops::ControlFlow;

use sim::{Choice, Ladder, Predicted, Reason, Run, Rung};
use splines::Compliance;

use crate::build::build;
use crate::built::BuiltFoundation;
use crate::error::Error;
use crate::modal::{self, Dampers, ModeCache};
use crate::mount::Excitation;
use crate::solved::{SolvedModel, SolvedStructure, solution_of};
use formats::scene::{Foundation, Scene, Structure};

/// Elements of the mesh at the top where they suffice, and fewest and most a member; half of them must be a mesh too.
const ELEMENTS: usize = 192;
const A_MEMBER: [usize; 2] = [2, 64];

/// What a scene ran on, and how the run went.
pub struct AutoRun {
    /// Why foundations that were "auto" are what they are.
    pub choices: Vec<Choice>,
    /// The run.
    pub run: Run,
    /// What carried it.
    pub built: Vec<BuiltFoundation>,
}

/// Sets the foundation of every structure of `scene` that is "auto", says why, and runs the scene; the history holds the
/// freedoms of those that are `recorded`.
///
/// # Errors
/// A foundation that cannot be made; a scene that cannot start.
pub fn select_and_run(
    scene: &mut Scene,
    cast: &sim::Scene,
    known: &[SolvedStructure],
    recorded: &dyn Fn(usize, &sim::Foundation) -> bool,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<AutoRun, Error> {
    let tolerances: Vec<Option<f64>> =
        scene.structures.iter().map(|structure| structure.auto.then_some(structure.tolerance)).collect();
    let spectra = scene.structures.iter().map(|_| ModeCache::default()).collect();
    let lateral = scene.pushes_sideways();
    let mut rungs = SceneFoundations { scene, known, lateral, mode_caches: spectra, recorded };
    let sim::Selection { choices, run, .. } = sim::choose(cast, &tolerances, &mut rungs, watch)?;
    let mut spectra = rungs.mode_caches;
    for choice in &choices {
        let structure = &mut scene.structures[choice.structure];
        let solved = solution_of(known, &structure.origin);
        structure.foundation = scene_foundation(structure, choice.rung, mesh_elements(solved));
    }
    let again = scene.structures.iter().zip(&mut spectra);
    let laid = again
        .map(|(own, spectra)| build(spectra, own, solution_of(known, &own.origin), lateral))
        .collect::<Result<Vec<BuiltFoundation>, Error>>()?;
    Ok(AutoRun { choices, run, built: laid })
}

/// Elements a member of the mesh at the top.
#[must_use]
pub fn mesh_elements(solved: Option<&SolvedModel>) -> usize {
    let members = solved.map_or(1, |solved| solved.model.members.len());
    (ELEMENTS / members.max(1)).clamp(A_MEMBER[0], A_MEMBER[1])
}

/// A solved structure at `rung`, by modes known in `spectra` (of this structure), for vertical wheel forces; `damping` of
/// its modes by critical, `finer` times as many elements a member at the top as `"auto"` takes.
///
/// # Errors
/// A structure without mass where modes are asked for; too many unknowns.
pub fn foundation_at(
    spectra: &mut ModeCache,
    solved: &SolvedModel,
    rung: Rung,
    damping: f64,
    finer: usize,
) -> Result<sim::Foundation, Error> {
    let name = "structure";
    let rails = solved.rails.iter().enumerate();
    let elements = finer * mesh_elements(Some(solved));
    match (rung, &solved.surface) {
        (Rung::Modal(modes), _) => {
            Ok(spectra.lowest(name, solved, modes, damping, Dampers::NONE, Excitation::DOWN)?.foundation)
        }
        (Rung::Half, _) => {
            Ok(spectra.full(name, solved, elements / 2, damping, Dampers::NONE, Excitation::DOWN)?.foundation)
        }
        (Rung::Full, _) => {
            Ok(spectra.full(name, solved, elements, damping, Dampers::NONE, Excitation::DOWN)?.foundation)
        }
        (Rung::Influence, Some(surface)) => {
            Ok(sim::Foundation::influence(Box::new(surface.clone()), rails.len()))
        }
        (Rung::Influence, None) => Err(Error::NoSurface { structure: name.to_owned() }),
        (Rung::Rigid, surface) => {
            let range = |rail| surface.as_ref().and_then(|surface| surface.range(rail));
            let extent = |(rail, _)| sim::Extent { range: range(rail), breaks: Vec::new() };
            Ok(sim::Foundation { rails: rails.map(extent).collect(), ..sim::Foundation::rigid() })
        }
    }
}

/// About the lowest `count` modes of a solved structure that vertical wheel forces excite; `None` without mass.
///
/// # Errors
/// Modes that cannot be found.
pub fn excited_modes(solved: &SolvedModel, count: usize) -> Result<Option<sim::Structure>, Error> {
    modal::coarse_modes("structure", solved, count)
}

/// What a rung is in a scene.
fn scene_foundation(structure: &Structure, rung: Rung, elements: usize) -> Foundation {
    let damping = structure.damping;
    match rung {
        Rung::Rigid => Foundation::Rigid,
        Rung::Influence => Foundation::Influence,
        Rung::Modal(modes) => Foundation::Modal { modes, damping },
        Rung::Half => Foundation::Full { elements: elements / 2, damping },
        Rung::Full => Foundation::Full { elements, damping },
    }
}

struct SceneFoundations<'a> {
    scene: &'a Scene,
    known: &'a [SolvedStructure],
    lateral: bool,
    /// One a structure.
    mode_caches: Vec<ModeCache>,
    recorded: &'a dyn Fn(usize, &sim::Foundation) -> bool,
}

impl SceneFoundations<'_> {
    fn solved(&self, structure: usize) -> Option<&SolvedModel> {
        solution_of(self.known, &self.scene.structures[structure].origin)
    }
}

impl Ladder for SceneFoundations<'_> {
    type Error = Error;

    fn modes(&mut self, structure: usize, count: usize) -> Result<Option<sim::Structure>, Error> {
        Ok(match self.solved(structure) {
            Some(solved) => modal::coarse_modes(&self.scene.structures[structure].name, solved, count)?,
            None => None,
        })
    }

    fn foundation(&mut self, structure: usize, rung: Rung) -> Result<sim::Foundation, Error> {
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

/// A rung in words.
#[must_use]
pub fn fidelity_name(rung: Rung) -> String {
    match rung {
        Rung::Rigid => "rigid".to_owned(),
        Rung::Influence => "influence".to_owned(),
        Rung::Modal(modes) => format!("modal, {modes} modes"),
        Rung::Half => "full, half the elements".to_owned(),
        Rung::Full => "full".to_owned(),
    }
}

/// Why a foundation was chosen, in a sentence without its stop.
#[must_use]
pub fn selection_reason(choice: &Choice) -> String {
    let rung = fidelity_name(choice.rung);
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
        (Reason::Top, Some(estimate)) => format!(
            "auto: {rung}, as nothing lower was within the tolerance; half the elements differ by {estimate:.1e}, more \
             than the tolerance"
        ),
        (Reason::Top, None) => {
            format!("auto: {rung}, as nothing lower was within the tolerance; its own error is not known")
        }
        (Reason::Unchecked, _) => {
            format!("auto: {rung}, which no higher rung could check: its error is not known")
        }
    };
    if let Some(predicted) = &choice.predicted {
        let Predicted { give, speed, ripple, step, track, .. } = predicted;
        text += &format!(
            "; predicted without mass: give {give:.1e}, speed {speed:.1e}, ripple {ripple:.1e}, load step {step:.1e}, \
             track {track:.1e}"
        );
    }
    text
}

/// What a user should know of a choice whose error is not known to be allowed.
#[must_use]
pub fn selection_doubt(name: &str, choice: &Choice, tolerance: f64) -> Option<String> {
    let rung = fidelity_name(choice.rung);
    let why = match (choice.reason, choice.estimate) {
        (Reason::Top, Some(estimate)) => format!(
            "estimate above tolerance: {rung} is the top, and half its elements differ by {estimate:.1e}, more than \
             {tolerance}"
        ),
        (Reason::Top, None) => {
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
