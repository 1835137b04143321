//! The study itself: references, runs, errors, times.

use std::ops::ControlFlow;

use sim::Stepping;

use crate::Error;
use crate::measure::cpu::{self, limited};
use crate::measure::deviation::deviations;
use crate::measure::memory::{self, Memory};
use crate::measure::quantity::ErrorGroup;
use crate::measure::spread::Spread;
use crate::observer::Observer;
use crate::runs::point::{MeasuredPoint, PointOutcome, StudyPoint};
use crate::runs::reference::{ConvergedReference, Make, reference};
use crate::runs::setup::{CaseSetup, SetupCache};
use crate::settings::budget::StudyBudget;
use crate::settings::detail::MeshDetail;
use crate::settings::ladder::{self, SceneKinds, varies};
use crate::settings::setting::{Against, Setting, SettingFamily};
use formats::motion::cast;
use formats::scene::{Analysis, Scene};
use foundations::SolvedStructure;
use results::cases::records_structure;
use results::run_error;

/// Shorter runs than this are timed several at once.
const BATCH: f64 = 2e-3;
/// The most of them.
const MOST: f64 = 200.0;
/// Share of a scene's time that a study must tell of.
const LEAST: f64 = 0.25;

/// What a study found.
#[derive(Clone, Debug)]
pub struct Study {
    /// When it ends, s, where its references tell nothing of what comes after; `None`: with the scene.
    pub until: Option<f64>,
    /// What errors are measured against.
    pub references: Vec<ConvergedReference>,
    /// References that could not be run, and why.
    pub lost: Vec<(Against, String)>,
    /// The settings, in order.
    pub points: Vec<StudyPoint>,
    /// What "auto" chose, or why it did not.
    pub auto: Result<Auto, String>,
}

/// What "auto" chose.
#[derive(Clone, Debug, Default)]
pub struct Auto {
    /// Structure and reason.
    pub reasons: Vec<(String, String)>,
    /// Times of the whole choice, all trials included.
    pub trials: Option<Spread>,
}

impl Study {
    /// The reference of a family.
    #[must_use]
    pub fn reference(&self, against: Against) -> Option<&ConvergedReference> {
        self.references.iter().find(|own| own.against == against)
    }
}

/// Studies `scene`, whose structures are `known`.
///
/// # Errors
/// A scene that cannot start; references that cannot be run.
pub fn study(
    scene: &Scene,
    known: &[SolvedStructure],
    depth: &StudyBudget,
    observer: &dyn Observer,
) -> Result<Study, Error> {
    let kinds = SceneKinds::of(scene, known);
    let mut workshop = SetupCache::new(scene, known);
    let asks = scene.structures.iter().any(|structure| structure.auto);
    let choose = |scene: &Scene| {
        observer.say("choosing foundations");
        auto(scene, known, depth)
    };
    let first = asks.then(|| choose(scene));
    let mut own = match &first {
        Some((_, Some(chosen))) => chosen.clone(),
        _ => scene.clone(),
    };
    own.structures.iter_mut().for_each(|structure| structure.auto = false);

    observer.say("running references");
    let (mut references, lost) = references(&own, kinds, &mut workshop, depth, observer)?;
    if references.is_empty() {
        let first = lost.into_iter().next().map(|(_, why)| why);
        return Err(Error::Lost(first.unwrap_or_default()));
    }
    let until = until(&references, own.end, depth.resolution);
    if let Some(time) = until {
        observer.say(&format!("no reference tells what comes after t = {time} s: the study ends there"));
        references.iter_mut().for_each(|reference| reference.cut(time));
    }
    let end = until.unwrap_or(scene.end);
    let scene = &Scene { end, ..scene.clone() };
    own.end = end;
    let (auto, chosen) = first.unwrap_or_else(|| choose(scene));
    let chosen = chosen.map(|chosen| Scene { end, ..chosen });
    for reference in &references {
        let told = ErrorGroup::ALL.iter().filter(|own| reference.resolves(**own).is_finite());
        let told: Vec<String> =
            told.map(|own| format!("{} from {:.1e}", own.name(), reference.resolves(*own))).collect();
        observer.say(&format!(
            "reference \"{}\" tells errors of {} on: {}",
            reference.against.word(),
            told.join(", "),
            reference.words[0]
        ));
    }
    let mut settings = ladder::settings(&own, known, kinds, depth);
    let (family, knob) = (SettingFamily::Written, "accuracy");
    settings.push(Setting { family, knob, value: own.accuracy, scene: own.clone(), stations: None });
    if kinds.varies && own.analysis == Analysis::Dynamic {
        let family = SettingFamily::Stepping;
        settings.push(Setting { family, knob, value: own.accuracy, scene: own.clone(), stations: None });
    }
    if let Some(chosen) = chosen {
        let (family, value) = (SettingFamily::Auto, chosen.accuracy);
        settings.push(Setting { family, knob, value, scene: chosen, stations: None });
    }
    if !kinds.varies {
        // errors of foundations mean nothing: only the scene's own can be run
        settings.retain(|setting| {
            setting.family.against() == Against::Own || setting.family == SettingFamily::Written
        });
    }
    let bar = observer.begin("running", settings.len() as u64);
    let mut rigs = Vec::new();
    let mut points = Vec::new();
    for (index, setting) in settings.into_iter().enumerate() {
        let against = if kinds.varies { setting.family.against() } else { Against::Own };
        let reference = references.iter().find(|own| own.against == against);
        let (rig, outcome) = match reference {
            Some(reference) => measure(&mut workshop, &setting, reference, depth),
            None => {
                let why = lost.iter().find(|(own, _)| *own == against).map_or("", |(_, why)| why.as_str());
                (None, PointOutcome::Refused(why.to_owned()))
            }
        };
        rigs.push(rig);
        points.push(StudyPoint { setting, outcome });
        bar.reach(index as u64 + 1);
    }
    drop(bar);
    let mut study = Study { until, references, lost, points, auto };
    time(&mut study, &rigs, scene, known, depth, observer);
    Ok(study)
}

/// References, and those that could not be run.
type References = (Vec<ConvergedReference>, Vec<(Against, String)>);

/// What errors of settings of `own` are measured against.
fn references(
    own: &Scene,
    kinds: SceneKinds,
    workshop: &mut SetupCache<'_>,
    depth: &StudyBudget,
    observer: &dyn Observer,
) -> Result<References, Error> {
    let whole = |detail: MeshDetail| ladder::whole(own, kinds, detail);
    let massless = |_| ladder::massless(own);
    let written = |_| own.clone();
    let all: [(Against, &Make<'_>, bool); 3] = [
        (Against::Whole, &whole, kinds.has_mass && own.analysis == Analysis::Dynamic),
        (Against::Massless, &massless, false),
        (Against::Own, &written, false),
    ];
    let mut found: Vec<ConvergedReference> = Vec::new();
    let mut lost = Vec::new();
    let mut seen: Vec<Scene> = Vec::new();
    for (against, make, meshes) in all {
        if against != Against::Own && !kinds.varies {
            continue;
        }
        let plain = Scene { accuracy: 0.0, stepping: Stepping::default(), ..make(MeshDetail::Modes(2)) };
        let same = seen.iter().position(|own| *own == plain);
        let reference = match same {
            Some(at) => Ok(ConvergedReference { against, ..ConvergedReference::clone(&found[at]) }),
            None => reference(workshop, against, make, meshes, depth),
        };
        match reference {
            Ok(reference) => {
                seen.push(plain);
                found.push(reference);
            }
            Err(error) => {
                let why = error.to_string();
                observer.say(&format!("reference \"{}\": {why}", against.word()));
                lost.push((against, why));
            }
        }
    }
    Ok((found, lost))
}

/// When a study of a scene of so many seconds ends before it: where some reference tells deflections and wheel forces down
/// to `resolution` until then alone. `None`: all tell them to the end, or one of them for less than [`LEAST`] of it.
fn until(references: &[ConvergedReference], end: f64, resolution: f64) -> Option<f64> {
    let short = references.iter().filter(|reference| reference.worst_resolution() > resolution);
    let times = short.map(|reference| reference.horizon(resolution).unwrap_or(0.0));
    times.reduce(f64::min).filter(|time| *time >= LEAST * end)
}

/// Runs a setting once, and compares it with the reference; ready to run again where it reached its end.
fn measure(
    workshop: &mut SetupCache<'_>,
    setting: &Setting,
    reference: &ConvergedReference,
    depth: &StudyBudget,
) -> (Option<(CaseSetup, f64)>, PointOutcome) {
    let refused = |why: String| (None, PointOutcome::Refused(why));
    let rig = match workshop.set_up(setting) {
        Ok(rig) => rig,
        Err(failure) => return refused(failure.to_string()),
    };
    let start = cpu::seconds();
    let ran = memory::count_allocations(|| limited(depth.limit, |watch| rig.run(watch)));
    let run = match ran.out {
        Ok(run) => run,
        Err(error) => return refused(run_error::in_scene_names(&error, &setting.scene)),
    };
    let seconds = cpu::seconds() - start;
    match &run.status {
        sim::Status::Stopped => return (None, PointOutcome::Stopped),
        status if !status.is_complete() => {
            return refused(run_error::reason_incomplete(status, &setting.scene).unwrap_or_default());
        }
        _ => {}
    }
    let trace = match workshop.columns_of(&rig, &run) {
        Ok(trace) => trace,
        Err(failure) => return refused(failure.to_string()),
    };
    // a second one: the first left modes and tables with the workshop
    let foundations = memory::count_allocations(|| workshop.set_up(setting)).retained;
    let measured = MeasuredPoint {
        errors: deviations(&trace, &reference.columns),
        counts: run.counts,
        dof_count: rig.dof_count(),
        time: None,
        setup: rig.setup,
        memory: foundations.zip(ran.peak).map(|(foundations, run)| Memory { foundations, run }),
    };
    (Some((rig, seconds)), PointOutcome::Done(Box::new(measured)))
}

/// Lets "auto" choose every foundation that may vary: what it says, and the scene on its choice.
fn auto(
    scene: &Scene,
    known: &[SolvedStructure],
    depth: &StudyBudget,
) -> (Result<Auto, String>, Option<Scene>) {
    let mut chosen = asked(scene);
    let choices = match choose(&mut chosen, known, 10.0 * depth.limit) {
        Ok(choices) => choices,
        Err(why) => return (Err(why), None),
    };
    if choices.is_empty() {
        return (Err("no foundation may vary".to_owned()), None);
    }
    let name = |choice: &sim::Choice| chosen.structures[choice.structure].name.clone();
    let reasons =
        choices.iter().map(|choice| (name(choice), foundations::selection_reason(choice))).collect();
    for choice in choices.iter().filter(|choice| choice.predicted.is_some()) {
        chosen.accuracy = chosen.accuracy.min(sim::STEPPING * chosen.structures[choice.structure].tolerance);
    }
    chosen.structures.iter_mut().for_each(|structure| structure.auto = false);
    (Ok(Auto { reasons, trials: None }), Some(chosen))
}

/// The scene with every foundation that may vary left to "auto".
fn asked(scene: &Scene) -> Scene {
    let mut out = ladder::massless(scene);
    out.stepping = Stepping::default();
    for structure in out.structures.iter_mut().filter(|structure| varies(structure)) {
        structure.auto = true;
    }
    out
}

/// Lets "auto" choose, within `limit` seconds.
fn choose(scene: &mut Scene, known: &[SolvedStructure], limit: f64) -> Result<Vec<sim::Choice>, String> {
    let cast = cast(scene).map_err(|failure| failure.to_string())?;
    let recorded = records_structure(scene, known);
    let found =
        limited(limit, |watch| foundations::select_and_run(scene, &cast.scene, known, &recorded, watch));
    let found = found.map_err(|trouble| match trouble {
        foundations::Error::Simulation(error) => run_error::in_scene_names(&error, scene),
        other => other.to_string(),
    })?;
    match found.run.status {
        sim::Status::Stopped => Err("it took longer than a setting may".to_owned()),
        _ => Ok(found.choices),
    }
}

/// Times all that ran to its end: every repetition runs all of them, so that what else the machine does meets all alike.
fn time(
    study: &mut Study,
    rigs: &[Option<(CaseSetup, f64)>],
    scene: &Scene,
    known: &[SolvedStructure],
    depth: &StudyBudget,
    observer: &dyn Observer,
) {
    let bar = observer.begin("timing", depth.repetitions as u64);
    let mut times: Vec<Vec<f64>> = rigs.iter().map(|_| Vec::new()).collect();
    let mut trials = Vec::new();
    for repetition in 0..depth.repetitions {
        for k in 0..rigs.len() {
            // another one begins each time
            let index = (k + repetition * rigs.len() / depth.repetitions) % rigs.len();
            let Some((rig, first)) = &rigs[index] else { continue };
            if repetition as f64 * first > depth.limit {
                continue;
            }
            let batch = (BATCH / first.max(1e-9)).ceil().clamp(1.0, MOST);
            let start = cpu::seconds();
            for _ in 0..batch as usize {
                let _ = std::hint::black_box(rig.run(&mut |_| ControlFlow::Continue(())));
            }
            times[index].push((cpu::seconds() - start) / batch);
        }
        let spent: f64 = trials.iter().sum();
        if study.auto.is_ok() && spent <= depth.limit {
            let mut again = asked(scene);
            let start = cpu::seconds();
            if choose(&mut again, known, f64::INFINITY).is_ok() {
                trials.push(cpu::seconds() - start);
            }
        }
        bar.reach(repetition as u64 + 1);
    }
    for (point, times) in study.points.iter_mut().zip(&times) {
        if let PointOutcome::Done(measured) = &mut point.outcome {
            measured.time = Spread::of(times);
        }
    }
    if let Ok(auto) = &mut study.auto {
        auto.trials = Spread::of(&trials);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::deviation::ComparedColumns;

    /// Two runs of ten seconds whose wheel forces part by a tenth from `time` on.
    fn parted(against: Against, time: usize) -> ConvergedReference {
        let trace = |shift: f64| {
            let force = |k: usize| if k < time { 1.0 } else { 1.0 + shift };
            let columns = vec![
                ("body.deflection".to_owned(), ErrorGroup::Deflection, vec![1.0; 11]),
                ("wheel.vertical".to_owned(), ErrorGroup::WheelForce, (0..11).map(force).collect()),
            ];
            ComparedColumns { time: (0..11).map(|k| k as f64).collect(), columns }
        };
        ConvergedReference::new(against, trace(0.0), trace(0.1), Default::default())
    }

    #[test]
    fn a_study_ends_where_the_first_of_its_references_parts() {
        let all = [parted(Against::Whole, 6), parted(Against::Massless, 8), parted(Against::Own, 11)];
        assert_eq!(until(&all, 10.0, 1e-2), Some(5.0));
        assert_eq!(until(&all[1..], 10.0, 1e-2), Some(7.0));
        assert_eq!(until(&all[2..], 10.0, 1e-2), None, "they agree to the end");
        assert_eq!(until(&all, 10.0, 1.1), None, "all that is asked for is told");
        assert_eq!(
            until(&[parted(Against::Own, 3)], 10.0, 1e-2),
            None,
            "a fifth of the time tells too little"
        );
    }

    #[test]
    fn a_reference_that_is_cut_tells_what_is_left() {
        let mut own = parted(Against::Own, 6);
        assert!((own.worst_resolution() - 1.0).abs() < 1e-12, "ten times a tenth");
        own.cut(5.0);
        assert_eq!((own.worst_resolution(), own.columns.time.len()), (0.0, 6));
    }
}
