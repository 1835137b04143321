//! Converged runs that errors are measured against.

use sim::{Method, Stepping};

use crate::Error;
use crate::measure::cpu::limited;
use crate::measure::deviation::{ComparedColumns, deviations, horizon};
use crate::measure::quantity::ErrorGroup;
use crate::runs::setup::SetupCache;
use crate::settings::budget::StudyBudget;
use crate::settings::detail::MeshDetail;
use crate::settings::setting::{Against, Setting, SettingFamily};
use formats::scene::{Analysis, Scene, stepper_word};
use results::run_error;

/// How much closer than the smallest error told the two finest runs must agree.
pub const MARGIN: f64 = 10.0;
/// How much longer than other runs a reference may take.
const PATIENCE: f64 = 10.0;
/// Smallest error told above which nothing is said of a quantity.
const UNTOLD: f64 = 0.1;
/// Difference at which nothing finer is tried.
const CLOSE: f64 = 1e-9;

/// What makes a scene of such a detail.
pub type Make<'m> = dyn Fn(MeshDetail) -> Scene + 'm;

/// A converged run, and how far from it the one next to it is.
#[derive(Clone, Debug)]
pub struct ConvergedReference {
    /// What it is the reference for.
    pub against: Against,
    /// The run itself.
    pub columns: ComparedColumns,
    /// The one beside it.
    pub second: ComparedColumns,
    /// The two settings in words: the run's, and that of the one beside it.
    pub words: [String; 2],
    /// Largest difference of the two in each group.
    pub difference: [Option<f64>; ErrorGroup::COUNT],
    /// Largest differences of the pairs before in what a study must tell, by the accuracy asked.
    pub approach: Vec<(f64, f64)>,
}

impl ConvergedReference {
    /// `trace` as the reference, which tells as much as it is close to `beside`; `words`: the settings of both.
    #[must_use]
    pub fn new(
        against: Against,
        columns: ComparedColumns,
        second: ComparedColumns,
        words: [String; 2],
    ) -> ConvergedReference {
        let difference = differences(&second, &columns);
        ConvergedReference { against, columns, second, words, difference, approach: Vec::new() }
    }

    /// The smallest error that it can tell in a group; infinite where it does not know the group.
    #[must_use]
    pub fn resolves(&self, quantity: ErrorGroup) -> f64 {
        let at = ErrorGroup::ALL.iter().position(|own| *own == quantity);
        let difference = at.and_then(|at| self.difference[at]);
        difference.map_or(f64::INFINITY, |difference| MARGIN * difference.max(f64::EPSILON))
    }

    /// The same, where it tells more than whether a run is of any use.
    #[must_use]
    pub fn resolution_of(&self, quantity: ErrorGroup) -> Option<f64> {
        Some(self.resolves(quantity)).filter(|least| *least <= UNTOLD)
    }

    /// The larger of those of deflections and vertical wheel forces.
    #[must_use]
    pub fn worst_resolution(&self) -> f64 {
        self.difference[..ErrorGroup::ASKED].iter().flatten().fold(0.0, |most, own| most.max(MARGIN * own))
    }

    /// Until when it tells deflections and vertical wheel forces down to `resolution`: the last output time to which the two
    /// runs are close enough. `None`: not even at the first.
    #[must_use]
    pub fn horizon(&self, resolution: f64) -> Option<f64> {
        horizon(&self.second, &self.columns, &ErrorGroup::ALL[..ErrorGroup::ASKED], resolution / MARGIN)
    }

    /// The same reference for the motion until `time`, s.
    pub fn cut(&mut self, time: f64) {
        self.columns.cut(time);
        self.second.cut(time);
        self.difference = differences(&self.second, &self.columns);
    }
}

/// Largest difference of two runs in each group.
fn differences(run: &ComparedColumns, reference: &ComparedColumns) -> [Option<f64>; ErrorGroup::COUNT] {
    deviations(run, reference).map(|own| own.map(|own| own.largest))
}

/// Runs two settings that differ in everything that can err, ever finer, until they agree: the scene that `make` gives for a
/// number of modes by the method that "auto" takes, beside that of half the modes by SDIRK, at the same accuracy; a scene
/// that only SDIRK integrates, at ten times the accuracy. Where modes come no nearer than `depth.resolution`, as in
/// buildings, whose lowest modes are those of single members, and `meshes`: the same by whole meshes.
///
/// # Errors
/// A scene that cannot start; no pair that ran to its end.
pub fn reference(
    workshop: &mut SetupCache<'_>,
    against: Against,
    make: &Make<'_>,
    meshes: bool,
    depth: &StudyBudget,
) -> Result<ConvergedReference, Error> {
    let mut search = Search { best: None, approach: Vec::new(), why: String::new() };
    let modes = depth.references.iter().map(|&(accuracy, modes)| (accuracy, MeshDetail::Modes(modes)));
    search.climb(workshop, against, make, modes, depth)?;
    let is_near = search.best.as_ref().is_some_and(|best| best.worst_resolution() <= depth.resolution);
    if meshes && !is_near {
        let all = depth.meshes.iter().map(|&(accuracy, elements)| (accuracy, MeshDetail::Mesh(elements)));
        search.climb(workshop, against, make, all, depth)?;
    }
    let untold = || Error::NoReference(search.why.clone());
    let best = search.best.ok_or_else(untold)?;
    Ok(ConvergedReference { approach: search.approach, ..best })
}

/// The closest pair so far.
struct Search {
    best: Option<ConvergedReference>,
    approach: Vec<(f64, f64)>,
    /// Why it ended.
    why: String,
}

impl Search {
    /// Goes through `rungs` until a pair agrees or one of its runs exceeds its limit.
    fn climb(
        &mut self,
        workshop: &mut SetupCache<'_>,
        against: Against,
        make: &Make<'_>,
        rungs: impl Iterator<Item = (f64, MeshDetail)>,
        depth: &StudyBudget,
    ) -> Result<(), Error> {
        let wanted = (depth.resolution / MARGIN * 1e-2).max(CLOSE);
        for (accuracy, detail) in rungs {
            let scenes = [make(detail), make(detail.half())];
            let [(trace, method), (beside, second)] =
                match pair(workshop, &scenes, accuracy, depth.limit * PATIENCE) {
                    Ok(Ok(pair)) => pair,
                    Ok(Err(stopped)) => {
                        self.why = stopped;
                        break;
                    }
                    // more modes than can be found: what was run before stands
                    Err(failure) if self.best.is_some() => {
                        self.why = failure.to_string();
                        break;
                    }
                    Err(failure) => return Err(failure),
                };
            let found = ConvergedReference::new(against, trace, beside, [method, second]);
            let largest = found.difference.iter().flatten().fold(0.0_f64, |most, own| most.max(*own));
            self.approach.push((accuracy, found.worst_resolution() / MARGIN));
            if self.best.as_ref().is_none_or(|best| found.worst_resolution() < best.worst_resolution()) {
                self.best = Some(found);
            }
            if largest < wanted {
                break;
            }
        }
        Ok(())
    }
}

/// A run's columns, and its setting in words.
type Told = (ComparedColumns, String);

/// Two runs that differ in all that can err; the inner error says why one of them did not reach its end.
fn pair(
    workshop: &mut SetupCache<'_>,
    scenes: &[Scene; 2],
    accuracy: f64,
    limit: f64,
) -> Result<Result<[Told; 2], String>, Error> {
    let none = || Err("no method integrates it".to_owned());
    let (first, method, words) = match one(workshop, &scenes[0], accuracy, Method::Auto, limit)? {
        Ok(Some(told)) => told,
        Ok(None) => return Ok(none()),
        Err(why) => return Ok(Err(why)),
    };
    let is_other = !matches!(method, Some(Method::Sdirk4));
    let again = if is_other { accuracy } else { 10.0 * accuracy };
    match one(workshop, &scenes[1], again, Method::Sdirk4, limit)? {
        Ok(Some((second, _, beside))) => Ok(Ok([(first, words), (second, beside)])),
        Ok(None) => Ok(none()),
        Err(why) => Ok(Err(why)),
    }
}

/// A run with its method and its setting in words; `None` where no method integrates it; or why it did not reach its end.
type Tried = Result<Option<(ComparedColumns, Option<Method>, String)>, String>;

/// One run; `None` where the method does not suit the scene.
fn one(
    workshop: &mut SetupCache<'_>,
    scene: &Scene,
    accuracy: f64,
    method: Method,
    limit: f64,
) -> Result<Tried, Error> {
    let stepping = Stepping { method, step: None };
    let scene = Scene { accuracy, stepping, ..scene.clone() };
    let setting =
        Setting { family: SettingFamily::Written, knob: "accuracy", value: accuracy, scene, stations: None };
    let rig = workshop.set_up(&setting)?;
    let run = match limited(limit, |watch| rig.run(watch)) {
        Ok(run) => run,
        Err(sim::Error::Method { .. }) => return Ok(Ok(None)),
        Err(error) => return Err(Error::Run(run_error::in_scene_names(&error, &setting.scene))),
    };
    if !run.status.is_complete() {
        return Ok(Err(run_error::reason_incomplete(&run.status, &setting.scene).unwrap_or_default()));
    }
    let mut trace = workshop.columns_of(&rig, &run)?;
    let lengths = setting.scene.rails.iter().map(|rail| rail.range[1] - rail.range[0]);
    trace.prune(lengths.fold(0.0, f64::max));
    let mut words: Vec<String> = Vec::new();
    for structure in &setting.scene.structures {
        words.push(format!("{}: {}", structure.name, foundation(structure)));
    }
    match setting.scene.analysis {
        Analysis::Dynamic => {
            let method = run.method.map_or("", stepper_word);
            words.push(format!("{method} at accuracy {accuracy:.0e}, {} steps", run.counts.steps));
        }
        Analysis::QuasiStatic => words.push("equilibrium at every output time".to_owned()),
    }
    Ok(Ok(Some((trace, run.method, words.join("; ")))))
}

/// A foundation in words.
#[must_use]
pub fn foundation(structure: &formats::scene::Structure) -> String {
    use formats::scene::Foundation;
    let word = structure.foundation.word();
    match structure.foundation {
        Foundation::Parts { count, .. } => format!("{word}, {count} parts"),
        Foundation::Modal { modes, .. } => format!("{word}, {modes} modes"),
        Foundation::Full { elements, .. } => format!("{word}, {elements} elements a member"),
        Foundation::Influence => format!("{word}, {}", structure.reading.word()),
        Foundation::Rigid | Foundation::Ties { .. } => word.to_owned(),
    }
}
