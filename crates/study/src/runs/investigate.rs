//! A study: settings of a scene, their errors against converged references, and their costs.
//!
//! 1. "auto" chooses the foundations that the scene leaves to it.
//! 2. Converged references are run, up to three (see [`ReferenceKind`]). Where none of them resolves deflections and
//!    wheel forces to the end of the scene, the study ends earlier.
//! 3. Every setting runs once: its largest errors in each group of columns, its counts of steps and stages, its
//!    memory.
//! 4. All settings that ran to their ends are timed, in repetitions that run all of them in turn.

use sim::Stepping;

use crate::Error;
use crate::measure::cpu::{self, limited};
use crate::measure::deviation::deviations;
use crate::measure::memory::{self, Memory};
use crate::measure::quantity::ErrorGroup;
use crate::observer::Observer;
use crate::runs::auto::{Auto, choose_foundations};
use crate::runs::point::{MeasuredPoint, PointOutcome, StudyPoint};
use crate::runs::reference::{ConvergedReference, Make, reference};
use crate::runs::setup::{SetupCache, TimedCase};
use crate::runs::timing::time;
use crate::settings::budget::StudyBudget;
use crate::settings::detail::MeshDetail;
use crate::settings::list::{self, SceneKinds};
use crate::settings::setting::{ReferenceKind, Setting, SettingFamily};
use formats::scene::{Analysis, Scene};
use foundations::SolvedStructure;
use results::run_error;

/// Smallest fraction of the duration of a scene to which a study may be shortened.
const SHORTEST: f64 = 0.25;

/// The results of a study.
#[derive(Clone, Debug)]
pub struct Study {
    /// Time, s, at which the study ends because no reference resolves errors after it; `None`: it ends with the
    /// scene.
    pub until: Option<f64>,
    /// The converged runs that errors are measured against.
    pub references: Vec<ConvergedReference>,
    /// References that could not be run, with the reason.
    pub failed_references: Vec<(ReferenceKind, String)>,
    /// The settings, in order.
    pub points: Vec<StudyPoint>,
    /// The foundations that "auto" chose, or why it chose none.
    pub auto: Result<Auto, String>,
}

impl Study {
    /// The reference of one kind, where it could be run.
    #[must_use]
    pub fn reference(&self, kind: ReferenceKind) -> Option<&ConvergedReference> {
        self.references.iter().find(|own| own.kind == kind)
    }
}

/// Studies `scene`, whose structures are solved in `known`, within `budget`.
///
/// # Errors
/// A scene that cannot start; no reference that could be run.
pub fn study(
    scene: &Scene,
    known: &[SolvedStructure],
    budget: &StudyBudget,
    observer: &dyn Observer,
) -> Result<Study, Error> {
    let kinds = SceneKinds::of(scene, known);
    let mut cache = SetupCache::new(scene, known);
    let is_auto = scene.structures.iter().any(|structure| structure.auto);
    let choose = |scene: &Scene| {
        observer.message("choosing foundations");
        choose_foundations(scene, known, budget)
    };
    let first = is_auto.then(|| choose(scene));
    let mut own = match &first {
        Some((_, Some(chosen))) => chosen.clone(),
        _ => scene.clone(),
    };
    own.structures
        .iter_mut()
        .for_each(|structure| structure.auto = false);

    observer.message("running references");
    let (mut references, failed) = references(&own, kinds, &mut cache, budget, observer)?;
    if references.is_empty() {
        let first = failed.into_iter().next().map(|(_, why)| why);
        return Err(Error::NoReferences(first.unwrap_or_default()));
    }
    let until = until(&references, own.end, budget.resolution);
    if let Some(time) = until {
        observer.message(&format!(
            "no reference resolves errors after t = {time} s: the study ends at this time"
        ));
        references
            .iter_mut()
            .for_each(|reference| reference.cut(time));
    }
    let end = until.unwrap_or(scene.end);
    let scene = &Scene {
        end,
        ..scene.clone()
    };
    own.end = end;
    let (mut auto, chosen) = first.unwrap_or_else(|| choose(scene));
    let chosen = chosen.map(|chosen| Scene { end, ..chosen });
    references
        .iter()
        .for_each(|reference| report_resolution(reference, observer));
    let settings = settings(&own, chosen, known, kinds, budget);
    let (mut points, cases) = measure_all(
        settings,
        kinds,
        &references,
        &failed,
        &mut cache,
        budget,
        observer,
    );
    time(
        &mut points,
        &mut auto,
        &cases,
        scene,
        known,
        budget,
        observer,
    );
    Ok(Study {
        until,
        references,
        failed_references: failed,
        points,
        auto,
    })
}

/// Reports the smallest error that a reference resolves in each group.
fn report_resolution(reference: &ConvergedReference, observer: &dyn Observer) {
    let resolved = ErrorGroup::ALL
        .iter()
        .filter(|own| reference.resolution(**own).is_finite());
    let resolved: Vec<String> = resolved
        .map(|own| format!("{} from {:.1e}", own.name(), reference.resolution(*own)))
        .collect();
    observer.message(&format!(
        "reference \"{}\" resolves errors of {}: {}",
        reference.kind.word(),
        resolved.join(", "),
        reference.descriptions[0]
    ));
}

/// All settings: those of the list, the scene as written, and the foundations that "auto" has `chosen`.
fn settings(
    own: &Scene,
    chosen: Option<Scene>,
    known: &[SolvedStructure],
    kinds: SceneKinds,
    budget: &StudyBudget,
) -> Vec<Setting> {
    let mut settings = list::settings(own, known, kinds, budget);
    let (family, parameter) = (SettingFamily::Written, "accuracy");
    settings.push(Setting {
        family,
        parameter,
        value: own.accuracy,
        scene: own.clone(),
        stations: None,
    });
    if kinds.varies && own.analysis == Analysis::Dynamic {
        let family = SettingFamily::Stepping;
        settings.push(Setting {
            family,
            parameter,
            value: own.accuracy,
            scene: own.clone(),
            stations: None,
        });
    }
    if let Some(chosen) = chosen {
        let (family, value) = (SettingFamily::Auto, chosen.accuracy);
        settings.push(Setting {
            family,
            parameter,
            value,
            scene: chosen,
            stations: None,
        });
    }
    if !kinds.varies {
        // there is no other foundation to compare with: only the scene's own can be run
        settings.retain(|setting| {
            setting.family.reference_kind() == ReferenceKind::Own
                || setting.family == SettingFamily::Written
        });
    }
    settings
}

/// Runs every setting once and compares it with its reference.
fn measure_all(
    settings: Vec<Setting>,
    kinds: SceneKinds,
    references: &[ConvergedReference],
    failed: &[(ReferenceKind, String)],
    cache: &mut SetupCache<'_>,
    budget: &StudyBudget,
    observer: &dyn Observer,
) -> (Vec<StudyPoint>, Vec<TimedCase>) {
    let bar = observer.begin("running", settings.len() as u64);
    let mut cases = Vec::new();
    let mut points = Vec::new();
    for (index, setting) in settings.into_iter().enumerate() {
        let kind = if kinds.varies {
            setting.family.reference_kind()
        } else {
            ReferenceKind::Own
        };
        let reference = references.iter().find(|own| own.kind == kind);
        let (case, outcome) = match reference {
            Some(reference) => measure(cache, &setting, reference, budget),
            None => {
                let why = failed
                    .iter()
                    .find(|(own, _)| *own == kind)
                    .map_or("", |(_, why)| why.as_str());
                (None, PointOutcome::Refused(why.to_owned()))
            }
        };
        cases.push(case);
        points.push(StudyPoint { setting, outcome });
        bar.advance_to(index as u64 + 1);
    }
    (points, cases)
}

/// References, and those that could not be run with the reason.
type References = (Vec<ConvergedReference>, Vec<(ReferenceKind, String)>);

/// Runs the references of settings of `own`. Where two references are of the same scene, it runs once.
fn references(
    own: &Scene,
    kinds: SceneKinds,
    cache: &mut SetupCache<'_>,
    budget: &StudyBudget,
    observer: &dyn Observer,
) -> Result<References, Error> {
    let whole = |detail: MeshDetail| list::whole(own, kinds, detail);
    let massless = |_| list::massless(own);
    let written = |_| own.clone();
    let all: [(ReferenceKind, &Make<'_>, bool); 3] = [
        (
            ReferenceKind::Whole,
            &whole,
            kinds.has_mass && own.analysis == Analysis::Dynamic,
        ),
        (ReferenceKind::Massless, &massless, false),
        (ReferenceKind::Own, &written, false),
    ];
    let mut references: Vec<ConvergedReference> = Vec::new();
    let mut failed = Vec::new();
    let mut seen: Vec<Scene> = Vec::new();
    for (kind, make, meshes) in all {
        if kind != ReferenceKind::Own && !kinds.varies {
            continue;
        }
        let plain = Scene {
            accuracy: 0.0,
            stepping: Stepping::default(),
            ..make(MeshDetail::Modes(2))
        };
        let same = seen.iter().position(|own| *own == plain);
        let reference = match same {
            Some(at) => Ok(ConvergedReference {
                kind,
                ..ConvergedReference::clone(&references[at])
            }),
            None => reference(cache, kind, make, meshes, budget),
        };
        match reference {
            Ok(reference) => {
                seen.push(plain);
                references.push(reference);
            }
            Err(error) => {
                let why = error.to_string();
                observer.message(&format!("reference \"{}\": {why}", kind.word()));
                failed.push((kind, why));
            }
        }
    }
    Ok((references, failed))
}

/// The time at which a study must end before the scene does, at `end`: the earliest until which a reference resolves
/// errors of deflections and wheel forces down to `resolution`. `None` where all resolve them to the end, or where
/// that time is less than the fraction [`SHORTEST`] of `end`.
fn until(references: &[ConvergedReference], end: f64, resolution: f64) -> Option<f64> {
    let short = references
        .iter()
        .filter(|reference| reference.worst_resolution() > resolution);
    let times = short.map(|reference| reference.horizon(resolution).unwrap_or(0.0));
    times
        .reduce(f64::min)
        .filter(|time| *time >= SHORTEST * end)
}

/// Runs a setting once and compares it with the reference; a setting that reached its end is returned for timing.
fn measure(
    cache: &mut SetupCache<'_>,
    setting: &Setting,
    reference: &ConvergedReference,
    budget: &StudyBudget,
) -> (TimedCase, PointOutcome) {
    let refused = |why: String| (None, PointOutcome::Refused(why));
    let case = match cache.set_up(setting) {
        Ok(case) => case,
        Err(failure) => return refused(failure.to_string()),
    };
    let start = cpu::seconds();
    let ran = memory::count_allocations(|| limited(budget.limit, |watch| case.run(watch)));
    let run = match ran.out {
        Ok(run) => run,
        Err(error) => return refused(run_error::in_scene_names(&error, &setting.scene)),
    };
    let seconds = cpu::seconds() - start;
    match &run.status {
        sim::Status::Stopped => return (None, PointOutcome::Stopped),
        status if !status.is_complete() => {
            return refused(
                run_error::reason_incomplete(status, &setting.scene).unwrap_or_default(),
            );
        }
        _ => {}
    }
    let columns = match cache.columns_of(&case, &run) {
        Ok(columns) => columns,
        Err(failure) => return refused(failure.to_string()),
    };
    // foundations are built again to count their memory: the first time, modes and tables went into the cache
    let foundations = memory::count_allocations(|| cache.set_up(setting)).retained;
    let measured = MeasuredPoint {
        errors: deviations(&columns, &reference.columns),
        measure: reference.measure,
        counts: run.counts,
        dof_count: case.dof_count(),
        time: None,
        setup: case.setup,
        memory: foundations
            .zip(ran.peak)
            .map(|(foundations, run)| Memory { foundations, run }),
    };
    (
        Some((case, seconds)),
        PointOutcome::Done(Box::new(measured)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::deviation::ComparedColumns;

    /// Two runs of ten seconds whose wheel forces differ by a tenth from `time` on.
    fn diverging(kind: ReferenceKind, time: usize) -> ConvergedReference {
        let trace = |shift: f64| {
            let force = |k: usize| if k < time { 1.0 } else { 1.0 + shift };
            let columns = vec![
                (
                    "body.deflection".to_owned(),
                    ErrorGroup::Deflection,
                    vec![1.0; 11],
                ),
                (
                    "wheel.vertical".to_owned(),
                    ErrorGroup::WheelForce,
                    (0..11).map(force).collect(),
                ),
            ];
            ComparedColumns {
                time: (0..11).map(|k| k as f64).collect(),
                columns,
            }
        };
        ConvergedReference::new(
            kind,
            trace(0.0),
            trace(0.1),
            Default::default(),
            sim::Measure::History,
        )
    }

    #[test]
    fn a_study_ends_where_the_first_of_its_references_diverges() {
        let all = [
            diverging(ReferenceKind::Whole, 6),
            diverging(ReferenceKind::Massless, 8),
            diverging(ReferenceKind::Own, 11),
        ];
        assert_eq!(until(&all, 10.0, 1e-2), Some(5.0));
        assert_eq!(until(&all[1..], 10.0, 1e-2), Some(7.0));
        assert_eq!(until(&all[2..], 10.0, 1e-2), None, "they agree to the end");
        assert_eq!(
            until(&all, 10.0, 1.1),
            None,
            "the resolution asked for is reached"
        );
        assert_eq!(
            until(&[diverging(ReferenceKind::Own, 3)], 10.0, 1e-2),
            None,
            "a fifth of the time is too short"
        );
    }

    #[test]
    fn a_reference_that_is_cut_resolves_the_rest() {
        let mut own = diverging(ReferenceKind::Own, 6);
        assert!(
            (own.worst_resolution() - 1.0).abs() < 1e-12,
            "ten times a tenth"
        );
        own.cut(5.0);
        assert_eq!((own.worst_resolution(), own.columns.time.len()), (0.0, 6));
    }
}
