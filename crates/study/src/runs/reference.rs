//! Converged references: runs whose own error is known by comparison with a second run.
//!
//! A reference is a pair of runs that differ in everything that can err: the number of modes (or of elements) and the
//! method of integration. Pairs are run ever finer until the largest difference of a pair is far below what the study
//! must resolve ([`StudyBudget::margin`]), until a run exceeds its time limit, or until the list of the budget ends; the
//! closest pair is kept. The difference d of the pair limits the resolution of the reference: errors of settings are
//! resolved if they exceed [`RESOLUTION_FACTOR`] d.

use sim::{Measure, Method, Stepping};

use crate::Error;
use crate::measure::cpu::limited;
use crate::measure::deviation::{ComparedColumns, deviations, horizon, study_measure};
use crate::measure::quantity::ErrorGroup;
use crate::runs::setup::SetupCache;
use crate::settings::budget::StudyBudget;
use crate::settings::detail::MeshDetail;
use crate::settings::setting::{ReferenceKind, Setting, SettingFamily};
use formats::scene::{Analysis, Scene, stepper_word};
use results::run_error;

/// Ratio of the smallest error that a reference resolves to the difference of its two runs.
pub const RESOLUTION_FACTOR: f64 = 10.0;
/// Ratio of the time limit of a reference to that of other runs.
const LIMIT_FACTOR: f64 = 10.0;
/// Resolution above which a reference is not used for a group of columns.
const COARSEST: f64 = 0.1;
/// Difference of a pair below which no finer pair is run.
const SMALLEST_DIFFERENCE: f64 = 1e-9;

/// Function that makes the scene of a reference for a number of modes or elements.
pub type Make<'m> = dyn Fn(MeshDetail) -> Scene + 'm;

/// A converged run, and the second run whose difference from it bounds its error.
#[derive(Clone, Debug)]
pub struct ConvergedReference {
    /// The kind of settings that it is the reference for.
    pub kind: ReferenceKind,
    /// Columns of the run itself.
    pub columns: ComparedColumns,
    /// Columns of the second run.
    pub second: ComparedColumns,
    /// The settings of both runs in words.
    pub descriptions: [String; 2],
    /// The measure by which runs are compared.
    pub measure: Measure,
    /// Relative difference of both runs in each group.
    pub difference: [Option<f64>; ErrorGroup::COUNT],
    /// Accuracy, and largest relative difference of deflections and wheel forces, of each pair that was run.
    pub approach: Vec<(f64, f64)>,
}

impl ConvergedReference {
    /// A reference from the columns of its two runs; `descriptions`: the settings of both in words.
    #[must_use]
    pub fn new(
        kind: ReferenceKind,
        columns: ComparedColumns,
        second: ComparedColumns,
        descriptions: [String; 2],
        measure: Measure,
    ) -> ConvergedReference {
        let difference = differences(&second, &columns, measure);
        ConvergedReference {
            kind,
            columns,
            second,
            descriptions,
            measure,
            difference,
            approach: Vec::new(),
        }
    }

    /// The smallest error that it resolves in a group: [`RESOLUTION_FACTOR`] times the difference of its runs;
    /// infinite where it has no column of the group.
    #[must_use]
    pub fn resolution(&self, group: ErrorGroup) -> f64 {
        let at = ErrorGroup::ALL.iter().position(|own| *own == group);
        let difference = at.and_then(|at| self.difference[at]);
        difference.map_or(f64::INFINITY, |difference| {
            RESOLUTION_FACTOR * difference.max(f64::EPSILON)
        })
    }

    /// The same; `None` where it is coarser than 0.1, which is of no use.
    #[must_use]
    pub fn usable_resolution(&self, group: ErrorGroup) -> Option<f64> {
        Some(self.resolution(group)).filter(|least| *least <= COARSEST)
    }

    /// The larger resolution of deflections and vertical wheel forces.
    #[must_use]
    pub fn worst_resolution(&self) -> f64 {
        self.difference[..ErrorGroup::REQUIRED]
            .iter()
            .flatten()
            .fold(0.0, |most, own| most.max(RESOLUTION_FACTOR * own))
    }

    /// The last output time, s, until which it resolves errors of deflections and vertical wheel forces down to
    /// `resolution`; `None` where it does so at no output time.
    #[must_use]
    pub fn horizon(&self, resolution: f64) -> Option<f64> {
        horizon(
            &self.second,
            &self.columns,
            &ErrorGroup::ALL[..ErrorGroup::REQUIRED],
            resolution / RESOLUTION_FACTOR,
        )
    }

    /// Restricts the reference to the motion until `time`, s.
    pub fn cut(&mut self, time: f64) {
        self.columns.cut(time);
        self.second.cut(time);
        self.difference = differences(&self.second, &self.columns, self.measure);
    }
}

/// Difference of two runs in each group.
fn differences(
    run: &ComparedColumns,
    reference: &ComparedColumns,
    measure: Measure,
) -> [Option<f64>; ErrorGroup::COUNT] {
    deviations(run, reference).map(|own| own.map(|own| own.by(measure)))
}

/// Runs ever finer pairs until one agrees (see the top of this file).
///
/// The first run of a pair is the scene that `make` returns for a number of modes, integrated by the method that
/// "auto" takes; the second has half the modes and is integrated by SDIRK4 at the same accuracy (at ten times the
/// tolerance where the first run took SDIRK4 as well). Where no pair resolves `budget.resolution` and `meshes` is
/// set, pairs of all modes of a mesh follow: in buildings the lowest modes are those of single members, and modes
/// converge slowly.
///
/// # Errors
/// A scene that cannot start; [`Error::NoReference`] where no pair ran to its end.
pub fn reference(
    cache: &mut SetupCache<'_>,
    kind: ReferenceKind,
    make: &Make<'_>,
    meshes: bool,
    budget: &StudyBudget,
) -> Result<ConvergedReference, Error> {
    let mut search = Search {
        best: None,
        approach: Vec::new(),
        why: String::new(),
    };
    let modes = budget
        .references
        .iter()
        .map(|&(accuracy, modes)| (accuracy, MeshDetail::Modes(modes)));
    search.refine(cache, kind, make, modes, budget)?;
    let is_near = search
        .best
        .as_ref()
        .is_some_and(|best| best.worst_resolution() <= budget.resolution);
    if meshes && !is_near {
        let all = budget
            .meshes
            .iter()
            .map(|&(accuracy, elements)| (accuracy, MeshDetail::Mesh(elements)));
        search.refine(cache, kind, make, all, budget)?;
    }
    let no_reference = || Error::NoReference(search.why.clone());
    let best = search.best.ok_or_else(no_reference)?;
    Ok(ConvergedReference {
        approach: search.approach,
        ..best
    })
}

/// The closest pair so far, and the differences of all pairs.
struct Search {
    best: Option<ConvergedReference>,
    approach: Vec<(f64, f64)>,
    /// Why the search ended, if a run was not completed.
    why: String,
}

impl Search {
    /// Runs the pairs of `levels` until one agrees or one of its runs exceeds its limit.
    fn refine(
        &mut self,
        cache: &mut SetupCache<'_>,
        kind: ReferenceKind,
        make: &Make<'_>,
        levels: impl Iterator<Item = (f64, MeshDetail)>,
        budget: &StudyBudget,
    ) -> Result<(), Error> {
        let wanted =
            (budget.resolution / RESOLUTION_FACTOR * budget.margin).max(SMALLEST_DIFFERENCE);
        for (accuracy, detail) in levels {
            let scenes = [make(detail), make(detail.half())];
            let [(columns, words), (second, second_words)] =
                match pair(cache, &scenes, accuracy, budget.limit * LIMIT_FACTOR) {
                    Ok(Ok(pair)) => pair,
                    Ok(Err(stopped)) => {
                        self.why = stopped;
                        break;
                    }
                    // more modes than the structure has: the pairs that ran before remain
                    Err(failure) if self.best.is_some() => {
                        self.why = failure.to_string();
                        break;
                    }
                    Err(failure) => return Err(failure),
                };
            let reference = ConvergedReference::new(
                kind,
                columns,
                second,
                [words, second_words],
                study_measure(&scenes[0]),
            );
            let largest = reference
                .difference
                .iter()
                .flatten()
                .fold(0.0_f64, |most, own| most.max(*own));
            self.approach
                .push((accuracy, reference.worst_resolution() / RESOLUTION_FACTOR));
            if self
                .best
                .as_ref()
                .is_none_or(|best| reference.worst_resolution() < best.worst_resolution())
            {
                self.best = Some(reference);
            }
            if largest < wanted {
                break;
            }
        }
        Ok(())
    }
}

/// Columns of a run, and its setting in words.
type DescribedRun = (ComparedColumns, String);

/// The two runs of a pair; the inner error says why one of them did not reach its end.
fn pair(
    cache: &mut SetupCache<'_>,
    scenes: &[Scene; 2],
    accuracy: f64,
    limit: f64,
) -> Result<Result<[DescribedRun; 2], String>, Error> {
    let none = || Err("no method can integrate the scene".to_owned());
    let (first, method, words) = match one(cache, &scenes[0], accuracy, Method::Auto, limit)? {
        Ok(Some(run)) => run,
        Ok(None) => return Ok(none()),
        Err(why) => return Ok(Err(why)),
    };
    let differs = !matches!(method, Some(Method::Sdirk4));
    let again = if differs { accuracy } else { 10.0 * accuracy };
    match one(cache, &scenes[1], again, Method::Sdirk4, limit)? {
        Ok(Some((second, _, second_words))) => Ok(Ok([(first, words), (second, second_words)])),
        Ok(None) => Ok(none()),
        Err(why) => Ok(Err(why)),
    }
}

/// Columns of a run with its method and its setting in words; `None` where the method cannot integrate the scene; or
/// why the run did not reach its end.
type Attempt = Result<Option<(ComparedColumns, Option<Method>, String)>, String>;

/// Runs `scene` once at `accuracy` by `method`, within `limit` seconds.
fn one(
    cache: &mut SetupCache<'_>,
    scene: &Scene,
    accuracy: f64,
    method: Method,
    limit: f64,
) -> Result<Attempt, Error> {
    let stepping = Stepping { method, step: None };
    let scene = Scene {
        accuracy,
        stepping,
        ..scene.clone()
    };
    let setting = Setting {
        family: SettingFamily::Written,
        parameter: "accuracy",
        value: accuracy,
        scene,
        stations: None,
    };
    let case = cache.set_up(&setting)?;
    let run = match limited(limit, |watch| case.run(watch)) {
        Ok(run) => run,
        Err(sim::Error::Method { .. }) => return Ok(Ok(None)),
        Err(error) => {
            return Err(Error::Run(run_error::in_scene_names(
                &error,
                &setting.scene,
            )));
        }
    };
    if !run.status.is_complete() {
        return Ok(Err(run_error::reason_incomplete(
            &run.status,
            &setting.scene,
        )
        .unwrap_or_default()));
    }
    let mut columns = cache.columns_of(&case, &run)?;
    let lengths = setting
        .scene
        .rails
        .iter()
        .map(|rail| rail.range[1] - rail.range[0]);
    columns.prune(lengths.fold(0.0, f64::max));
    let mut words: Vec<String> = Vec::new();
    for structure in &setting.scene.structures {
        words.push(format!("{}: {}", structure.name, foundation(structure)));
    }
    match setting.scene.analysis {
        Analysis::Dynamic => {
            let method = run.method.map_or("", stepper_word);
            words.push(format!(
                "{method} at accuracy {accuracy:.0e}, {} steps",
                run.counts.steps
            ));
        }
        Analysis::QuasiStatic => words.push("equilibrium at every output time".to_owned()),
    }
    Ok(Ok(Some((columns, run.method, words.join("; ")))))
}

/// The foundation of a structure in words.
#[must_use]
pub fn foundation(structure: &formats::scene::Structure) -> String {
    use formats::scene::Foundation;
    let word = structure.foundation.word();
    match structure.foundation {
        Foundation::Parts { count, .. } => format!("{word}, {count} parts"),
        Foundation::Modal { modes, .. } => format!("{word}, {modes} modes"),
        Foundation::Full { elements, .. } => format!("{word}, {elements} elements per member"),
        Foundation::Influence => format!("{word}, {}", structure.interpolation.word()),
        Foundation::Rigid | Foundation::Ties { .. } => word.to_owned(),
    }
}
