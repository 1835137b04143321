//! The choice of a fidelity for structures whose foundation is "auto".
//!
//! The algorithm is that of [`sim::choose`]: the scene is run with influence functions, the wheel forces act on the
//! natural modes to estimate the error of leaving the mass out, and runs with modes follow where it is not small. This
//! file builds the requested foundations from the solutions of a scene's specs, caches their modes for all trials, and
//! explains the choice in words.

use std::ops::ControlFlow;

use sim::{
    Choice, Fidelity, FoundationProvider, History, ModalBasis, Reason, Record, Run, Tolerance,
    TrialCheck,
};

use crate::build::{build_with_modes, coarse_modes};
use crate::built::{BuiltFoundation, MotionBasis};
use crate::error::Error;
use crate::modal::{ACCURACY, ModeCache};
use crate::mount::Excitation;
use crate::solved::{SolvedStructure, solution_of};
use formats::scene::{Foundation, Scene, Structure};

/// A run of a scene and the foundations of its structures.
pub struct AutoRun {
    /// The fidelity chosen for each structure whose foundation is "auto", with the reason.
    pub choices: Vec<Choice>,
    /// The run.
    pub run: Run,
    /// The foundations, one for each structure.
    pub built: Vec<BuiltFoundation>,
}

/// The quantities by which the runs of a choice are judged.
pub trait TrialObserver {
    /// The quantities of a run with this history, in which the degrees of freedom of structure s represent the motions
    /// `bases[s]`.
    ///
    /// # Errors
    /// A quantity that cannot be computed.
    fn record(&mut self, history: &History, bases: &[Option<MotionBasis>])
    -> Result<Record, Error>;

    /// Reactions and internal forces of a structure by name, with minus their values per unit acceleration of each of
    /// the motions of `basis`.
    ///
    /// # Errors
    /// An effect that cannot be computed.
    fn effects(
        &mut self,
        structure: usize,
        basis: &MotionBasis,
    ) -> Result<Vec<(String, Vec<f64>)>, Error>;

    /// Receives the foundations of each run of a choice before it starts.
    fn begin(&mut self, trial: &str);
}

/// Judges runs by the quantities of the simulator alone, without reactions and internal forces.
impl TrialObserver for () {
    fn record(&mut self, history: &History, _: &[Option<MotionBasis>]) -> Result<Record, Error> {
        Ok(Record::of(history))
    }

    fn effects(&mut self, _: usize, _: &MotionBasis) -> Result<Vec<(String, Vec<f64>)>, Error> {
        Ok(Vec::new())
    }

    fn begin(&mut self, _: &str) {}
}

/// Chooses the foundation of every structure of `scene` that is "auto", enters it in `scene`, and runs the scene.
///
/// `input` is the simulation input made from `scene`; `known` has the solutions of its specs. The history contains
/// the degrees of freedom of those structures for which `recorded` (index of the structure, its foundation) is true.
/// `observer` gives the quantities by which the runs are judged. `watch` is called with the simulated time after every
/// step of every trial, and with the end of the scene after each trial, which is judged then; it can stop the run.
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
/// let watch = &mut |_| ControlFlow::Continue(());
/// let found = select_and_run(&mut scene, &input.scene, &solved, &all, &mut (), watch).expect("a scene that starts");
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
    observer: &mut dyn TrialObserver,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<AutoRun, Error> {
    let tolerance = |structure: &Structure| Tolerance {
        value: structure.tolerance,
        measure: structure.measure,
    };
    let tolerances: Vec<Option<Tolerance>> = scene
        .structures
        .iter()
        .map(|structure| structure.auto.then(|| tolerance(structure)))
        .collect();
    let mode_caches = scene
        .structures
        .iter()
        .map(|_| ModeCache::default())
        .collect();
    let lateral = scene.has_flanges();
    let bases = scene.structures.iter().map(|_| None).collect();
    let duration = input.end;
    let mut provider = SceneFoundations {
        scene,
        known,
        lateral,
        duration,
        mode_caches,
        bases,
        recorded,
        observer,
    };
    let sim::Selection { choices, run, .. } =
        sim::choose(input, &tolerances, &mut provider, watch)?;
    // the run does not return its foundations; they are built again from the cached modes
    let built = (0..tolerances.len())
        .map(|structure| {
            let choice = choices.iter().find(|choice| choice.structure == structure);
            provider.build(
                structure,
                choice.map_or(Fidelity::Rigid, |choice| choice.fidelity),
                None,
            )
        })
        .collect::<Result<Vec<BuiltFoundation>, Error>>()?;
    for choice in &choices {
        let structure = &mut scene.structures[choice.structure];
        structure.foundation = scene_foundation(structure, choice.fidelity);
    }
    Ok(AutoRun {
        choices,
        run,
        built,
    })
}

/// The foundation in terms of scene files that corresponds to a fidelity.
fn scene_foundation(structure: &Structure, fidelity: Fidelity) -> Foundation {
    let damping = structure.damping;
    match fidelity {
        Fidelity::Rigid => Foundation::Rigid,
        Fidelity::Influence => Foundation::Influence,
        Fidelity::Modal(modes) => Foundation::Modal { modes, damping },
    }
}

/// Builds the foundations of a scene's structures at the fidelities that the selection requests.
struct SceneFoundations<'a> {
    scene: &'a Scene,
    known: &'a [SolvedStructure],
    lateral: bool,
    /// Largest duration of a run.
    duration: f64,
    /// Modes of each structure.
    mode_caches: Vec<ModeCache>,
    /// Motions of the degrees of freedom of the foundations that were built last.
    bases: Vec<Option<MotionBasis>>,
    recorded: &'a dyn Fn(usize, &sim::Foundation) -> bool,
    observer: &'a mut dyn TrialObserver,
}

impl SceneFoundations<'_> {
    /// Builds the foundation of a structure at a fidelity, which is ignored where the foundation is fixed. Where only the
    /// lowest `kept` modes belong to a result, the frequencies of the others may err by more.
    fn build(
        &mut self,
        structure: usize,
        fidelity: Fidelity,
        kept: Option<usize>,
    ) -> Result<BuiltFoundation, Error> {
        let mut own = self.scene.structures[structure].clone();
        if own.auto {
            own.foundation = scene_foundation(&own, fidelity);
        }
        let cache = &mut self.mode_caches[structure];
        let solved = solution_of(self.known, &own.origin);
        let accuracy = match (fidelity, solved) {
            (Fidelity::Modal(count), Some(solved)) if own.auto => {
                let (counts, excitation) = (
                    [count, kept.unwrap_or(count)],
                    Excitation::of(&own, self.lateral),
                );
                let tolerance = (own.tolerance, own.measure);
                let found = cache.accuracy(tolerance, self.duration, counts, (solved, excitation));
                found.map_err(Error::modes(&own.name))?
            }
            _ => ACCURACY,
        };
        build_with_modes(cache, &own, solved, self.lateral, accuracy)
    }

    /// Enters a foundation as that of the next run.
    fn enter(&mut self, structure: usize, built: BuiltFoundation) -> sim::Foundation {
        let BuiltFoundation {
            mut foundation,
            basis,
        } = built;
        foundation.recorded = (self.recorded)(structure, &foundation);
        self.bases[structure] = basis;
        foundation
    }
}

impl FoundationProvider for SceneFoundations<'_> {
    type Error = Error;

    fn modes(&mut self, structure: usize, count: usize) -> Result<Option<ModalBasis>, Error> {
        let own = &self.scene.structures[structure];
        let Some(solved) = solution_of(self.known, &own.origin) else {
            return Ok(None);
        };
        let cache = &mut self.mode_caches[structure];
        let BuiltFoundation { foundation, basis } =
            match coarse_modes(cache, own, solved, self.lateral, count) {
                Ok(built) => built,
                Err(Error::Modes {
                    source: fea::Error::NoMass,
                    ..
                }) => return Ok(None),
                Err(error) => return Err(error),
            };
        let (Some(modes), Some(basis)) = (foundation.structure, basis) else {
            return Ok(None);
        };
        let is_whole = modes.dynamics.dofs() < count;
        let coupling = foundation
            .carrier
            .map_or_else(Vec::new, |carrier| carrier.coupling);
        let effects = self.observer.effects(structure, &basis)?;
        Ok(Some(ModalBasis {
            structure: modes,
            coupling,
            effects,
            is_whole,
        }))
    }

    fn foundation(
        &mut self,
        structure: usize,
        fidelity: Fidelity,
    ) -> Result<sim::Foundation, Error> {
        let built = self.build(structure, fidelity, None)?;
        Ok(self.enter(structure, built))
    }

    fn finer_foundation(
        &mut self,
        structure: usize,
        count: usize,
        kept: usize,
    ) -> Result<sim::Foundation, Error> {
        let built = self.build(structure, Fidelity::Modal(count), Some(kept))?;
        Ok(self.enter(structure, built))
    }

    fn run(
        &mut self,
        scene: &sim::Scene,
        foundations: &[sim::Foundation],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, sim::Error> {
        let run = sim::run_by(self.scene.stepping, scene, foundations, watch)?;
        // a run that has ended early is done as well; the next call can stop what follows
        let _ = watch(self.scene.end);
        Ok(run)
    }

    fn observe(&mut self, history: &History) -> Result<Record, Error> {
        self.observer.record(history, &self.bases)
    }

    fn begin(&mut self, fidelities: &[(usize, Fidelity)]) {
        if fidelities.is_empty() {
            return;
        }
        let is_single = self.scene.structures.len() == 1;
        let words = fidelities.iter().map(|(structure, fidelity)| {
            let name = &self.scene.structures[*structure].name;
            let fidelity = fidelity_name(*fidelity);
            if is_single {
                fidelity
            } else {
                format!("{name} {fidelity}")
            }
        });
        self.observer.begin(&words.collect::<Vec<_>>().join(", "));
    }
}

/// A fidelity in words.
#[must_use]
pub fn fidelity_name(fidelity: Fidelity) -> String {
    match fidelity {
        Fidelity::Rigid => "rigid".to_owned(),
        Fidelity::Influence => "influence".to_owned(),
        Fidelity::Modal(1) => "modal, 1 mode".to_owned(),
        Fidelity::Modal(modes) => format!("modal, {modes} modes"),
    }
}

/// How an error was estimated, in words.
#[must_use]
pub fn check_name(check: TrialCheck) -> String {
    match check {
        TrialCheck::Replay(modes) => format!("{modes} natural modes under its wheel forces"),
        TrialCheck::Run(fidelity) => fidelity_name(fidelity),
        TrialCheck::Start(fidelity) => {
            format!(
                "the first eighth of {} with smaller steps",
                fidelity_name(fidelity)
            )
        }
        TrialCheck::Whole(fidelity) => {
            format!(
                "the motion of {} with larger steps",
                fidelity_name(fidelity)
            )
        }
    }
}

/// The reason why a foundation was chosen, as a sentence without its full stop.
#[must_use]
pub fn selection_reason(choice: &Choice) -> String {
    let chosen = fidelity_name(choice.fidelity);
    let error = || {
        let of = if choice.quantity.is_empty() {
            String::new()
        } else {
            format!(" of {}", choice.quantity)
        };
        format!(
            "the estimated error{of}, {:.1e},",
            choice.estimate.unwrap_or_default()
        )
    };
    match choice.reason {
        Reason::NoMass => {
            format!(
                "auto: {chosen}; the mass is not known, so the error due to neglecting it cannot be estimated"
            )
        }
        Reason::QuasiStatic => format!("auto: {chosen}; a quasi-static sweep has no inertia"),
        Reason::Sufficient => {
            format!(
                "auto: {chosen}; it is the lowest fidelity tried for which {} is within the tolerance",
                error()
            )
        }
        Reason::Kept => format!(
            "auto: {chosen}; {} of influence functions is also within the tolerance, but the results are those of the \
             run that verified it",
            error().trim_end_matches(',')
        ),
        Reason::Limit => format!(
            "auto: {chosen}; {} exceeds the tolerance, and the limit of three runs with natural modes was reached",
            error()
        ),
        Reason::NoBetter => {
            format!(
                "auto: {chosen}; {} exceeds the tolerance, and no number of natural modes is estimated to reduce it sufficiently",
                error()
            )
        }
        Reason::Unchecked => {
            format!(
                "auto: {chosen}; its error is not known, because no other fidelity could be run for comparison"
            )
        }
    }
}

/// Warning about a choice whose error is not known to be within `tolerance`; `None` where it is known to be.
#[must_use]
pub fn selection_doubt(name: &str, choice: &Choice, tolerance: f64) -> Option<String> {
    let chosen = fidelity_name(choice.fidelity);
    let why = match choice.reason {
        Reason::Limit | Reason::NoBetter => format!(
            "the estimated error of {} with the foundation {chosen} is {:.1e}, which exceeds the tolerance \
             {tolerance}; {}",
            if choice.quantity.is_empty() {
                "the run"
            } else {
                &choice.quantity
            },
            choice.estimate.unwrap_or(f64::INFINITY),
            if choice.reason == Reason::Limit {
                "it was not possible to reduce it in three runs"
            } else {
                "no number of natural modes is estimated to reduce it sufficiently"
            }
        ),
        Reason::Unchecked => {
            format!(
                "the error of {chosen} is not known: no other fidelity could be run for comparison"
            )
        }
        Reason::Sufficient | Reason::Kept => match choice.drifting {
            Some(bounces) => format!(
                "the estimated error of values at the same time with the foundation {chosen} is valid for 100 cycles \
                 of wheel bounce; this run has {bounces:.0} undamped cycles, whose phases drift. Extremes are not \
                 affected: \"measure\": \"extremes\""
            ),
            None => return None,
        },
        Reason::NoMass | Reason::QuasiStatic => return None,
    };
    let failed: Vec<String> = choice
        .failed
        .iter()
        .map(|fidelity| fidelity_name(*fidelity))
        .collect();
    let list = if failed.is_empty() {
        String::new()
    } else {
        format!(" (could not be run: {})", failed.join("; "))
    };
    Some(format!("{name}: {why}{list}"))
}
