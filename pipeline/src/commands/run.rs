//! `girderway run` and `girderway sim`: structures, tables, simulation, pictures and report.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::time::Instant;

use serde_json::{Value, json};
use sim::{Foundation, Run, Status};

use crate::cli::{Global, Scene as Arguments};
use crate::exit::{Exit, Failure};
use crate::link::{self, Solved};
use crate::manifest::Manifest;
use crate::motion::{Cast, cast};
use crate::output::{self, Folder};
use crate::pictures::{self, Labelled, Plate};
use crate::progress::Progress;
use crate::record::Record;
use crate::scene::{Case, Document, Origin, Scene};
use crate::spec::Spec;
use crate::{grid_file, story, summary, tables};

/// One case, run.
pub struct Outcome {
    /// Its label; the scene's own run is named by its foundations.
    pub label: String,
    /// What was simulated.
    pub cast: Cast,
    /// How it went.
    pub run: Run,
    /// Its named columns.
    pub record: Record,
}

/// Seconds spent in each stage, in order.
struct Clock {
    started: Instant,
    last: Instant,
    stages: Vec<(&'static str, f64)>,
}

impl Clock {
    fn new() -> Clock {
        let now = Instant::now();
        Clock { started: now, last: now, stages: Vec::new() }
    }

    fn lap(&mut self, stage: &'static str) {
        let now = Instant::now();
        self.stages.push((stage, (now - self.last).as_secs_f64()));
        self.last = now;
    }

    fn json(&self) -> Value {
        let mut stages: serde_json::Map<String, Value> =
            self.stages.iter().map(|(stage, seconds)| ((*stage).to_owned(), json!(seconds))).collect();
        stages.insert("total".to_owned(), json!((self.last - self.started).as_secs_f64()));
        Value::Object(stages)
    }
}

/// A spec that was solved, and what came of it.
pub(super) struct Known {
    pub spec: Arc<Spec>,
    pub solved: Solved,
}

/// The main job: from a scene to its output folder.
///
/// # Errors
/// What is wrong with the scene or the files it names; a structure that does not stand; a scene that cannot
/// start; a file that cannot be written.
pub fn run(args: &Arguments, global: Global) -> Result<Exit, Failure> {
    job("run", args, global, solve)
}

/// Where the structures' solutions come from: the document, and the output folder.
type Source = fn(&Document, &Path, &Progress) -> Result<Vec<Known>, Failure>;

/// `run` and `sim` alike, on what `structures` brings.
pub(super) fn job(name: &str, args: &Arguments, global: Global, structures: Source) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let mut clock = Clock::new();
    let document = Document::open(&args.scene)?;
    let scene = document.scene();
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from("girderway-out").join(&scene.name));
    let mut folder = Folder::new(&path)?;
    clock.lap("read");

    let known = structures(&document, &path, &progress)?;
    clock.lap("fea");
    let outcomes = simulate(&document, &known, global.threads, &progress)?;
    clock.lap("simulation");

    for structure in &scene.structures {
        if let Some(solved) = solved_of(&known, &structure.origin) {
            folder.add(
                &format!("grid-{}.json", structure.name),
                grid_file::write(&solved.grid, Some(&solved.surface)),
            );
            if let Some(text) = tables::adm(&structure.name, &solved.grid)
                .map_err(|error| Failure::Untrusted(error.to_string()))?
            {
                folder.add(&format!("{}.adm", structure.name), text);
            }
        }
    }
    for (case, outcome) in document.cases.iter().zip(&outcomes) {
        let name = case
            .label
            .as_ref()
            .map_or_else(|| "history.csv".to_owned(), |label| format!("history-{label}.csv"));
        folder.add(&name, outcome.record.csv().map_err(trouble)?);
    }
    folder.add("summary.json", output_json(&summary_of(&document, &outcomes)));
    clock.lap("tables");

    let plates = plates(scene, &document, &outcomes, &known)?;
    for plate in &plates {
        folder.add(&format!("plots/{}.svg", plate.name), plate.svg().map_err(trouble)?);
    }
    clock.lap("plots");
    let solved: Vec<Option<&Solved>> =
        scene.structures.iter().map(|structure| solved_of(&known, &structure.origin)).collect();
    let report = story::report(&document, &outcomes, &solved, plates);
    folder.add("report.html", report.html().map_err(trouble)?);
    clock.lap("report");
    folder.add_varying("timing.json", output_json(&clock.json()));
    let settings = json!({ "accuracy": scene.accuracy, "analysis": format!("{:?}", scene.analysis) });
    let written = folder.commit(Manifest::new(name, &document.inputs, settings))?;
    finish(&outcomes, &written, &document, global, &progress)
}

/// Says how it went; the exit status is that of the worst run.
fn finish(
    outcomes: &[Outcome],
    written: &Path,
    document: &Document,
    global: Global,
    progress: &Progress,
) -> Result<Exit, Failure> {
    for outcome in outcomes {
        for body in &document.scene().bodies {
            let deepest = outcome
                .record
                .values(&format!("{}.deflection", body.name))
                .iter()
                .copied()
                .fold(f64::MIN, f64::max);
            let unit = document.scene().units.length.word();
            progress.say(&format!("{}: {} sinks by at most {deepest:.6} {unit}", outcome.label, body.name));
        }
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let result =
            json!({ "output": written.display().to_string(), "summary": summary_of(document, outcomes) });
        output::print(&output_json(&result))?;
    }
    let failed = outcomes.iter().find(|outcome| outcome.run.status != Status::Done);
    match failed.and_then(|outcome| {
        summary::status(&outcome.run.status).1.map(|why| format!("{}: {why}", outcome.label))
    }) {
        Some(why) => Err(Failure::Untrusted(why)),
        None => Ok(Exit::Done),
    }
}

/// Solves every spec of every case once.
fn solve(document: &Document, _: &Path, progress: &Progress) -> Result<Vec<Known>, Failure> {
    let mut known: Vec<Known> = Vec::new();
    let stage = progress.stage("solving the structures");
    for structure in document.cases.iter().flat_map(|case| &case.scene.structures) {
        let Origin::Spec { file, spec } = &structure.origin else { continue };
        if known.iter().any(|entry| entry.spec == *spec) {
            continue;
        }
        let solved = link::solve(spec).map_err(|error| {
            match document.inputs.all().iter().find(|input| input.name == *file) {
                Some(input) => spec.refuse(&input.source, &error),
                None => Failure::Untrusted(error.to_string()),
            }
        })?;
        known.push(Known { spec: Arc::clone(spec), solved });
    }
    drop(stage);
    Ok(known)
}

fn solved_of<'a>(known: &'a [Known], origin: &Origin) -> Option<&'a Solved> {
    match origin {
        Origin::Spec { spec, .. } => {
            known.iter().find(|entry| entry.spec == *spec).map(|entry| &entry.solved)
        }
        Origin::Tables { .. } => None,
    }
}

/// Runs every case, on as many threads as asked for.
fn simulate(
    document: &Document,
    known: &[Known],
    threads: Option<u16>,
    progress: &Progress,
) -> Result<Vec<Outcome>, Failure> {
    let cases = &document.cases;
    let available = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.map_or(available, usize::from).min(cases.len());
    let done: Vec<AtomicU64> = cases.iter().map(|_| AtomicU64::new(0)).collect();
    let bar = progress.bar("simulating", 1000 * cases.len() as u64);
    let next = AtomicUsize::new(0);
    let work = || {
        let mut own = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(case) = cases.get(index) else { return own };
            let mut watch = |t: f64| {
                done[index].store((1000.0 * t / case.scene.end) as u64, Ordering::Relaxed);
                bar.set(done.iter().map(|share| share.load(Ordering::Relaxed)).sum());
                ControlFlow::Continue(())
            };
            own.push((index, one(case, known, &mut watch)));
        }
    };
    let mut outcomes: Vec<(usize, Result<Outcome, Failure>)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(&work)).collect();
        let mut all = work();
        for other in others {
            match other.join() {
                Ok(own) => all.extend(own),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    });
    outcomes.sort_by_key(|(index, _)| *index);
    outcomes.into_iter().map(|(_, outcome)| outcome).collect()
}

fn one(
    case: &Case,
    known: &[Known],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Outcome, Failure> {
    let scene = &case.scene;
    let lateral = scene.trucks.iter().any(|truck| scene.wheels[truck.wheel].lateral.is_some());
    let foundations = scene
        .structures
        .iter()
        .map(|structure| link::foundation(structure, solved_of(known, &structure.origin), lateral))
        .collect::<Result<Vec<Foundation>, Failure>>()?;
    let label = case.label.clone().unwrap_or_else(|| own_label(scene));
    let cast = cast(scene)?;
    let run = sim::run(&cast.scene, &foundations, watch)
        .map_err(|error| Failure::Untrusted(format!("{label}: {error}")))?;
    let record = Record::new(scene, &cast, &run.history);
    Ok(Outcome { label, cast, run, record })
}

/// The scene's own run is labelled by what carries it.
fn own_label(scene: &Scene) -> String {
    let mut words: Vec<&str> = scene.structures.iter().map(|structure| structure.foundation.word()).collect();
    words.dedup();
    words.join(" and ")
}

fn summary_of(document: &Document, outcomes: &[Outcome]) -> Value {
    let scene = document.scene();
    let mut result = summary::run(scene, &outcomes[0].record, &outcomes[0].run);
    result["format"] = json!("girderway-summary/1");
    result["name"] = json!(scene.name);
    result["units"] = summary::units(scene, &outcomes[0].record);
    let compare: serde_json::Map<String, Value> = document
        .cases
        .iter()
        .zip(outcomes)
        .skip(1)
        .map(|(case, outcome)| {
            (outcome.label.clone(), summary::run(&case.scene, &outcome.record, &outcome.run))
        })
        .collect();
    if !compare.is_empty() {
        result["compare"] = Value::Object(compare);
    }
    result
}

fn plates(
    scene: &Scene,
    document: &Document,
    outcomes: &[Outcome],
    known: &[Known],
) -> Result<Vec<Plate>, Failure> {
    let labelled: Vec<Labelled> = document
        .cases
        .iter()
        .zip(outcomes)
        .map(|(case, outcome)| Labelled {
            label: outcome.label.clone(),
            scene: &case.scene,
            record: &outcome.record,
        })
        .collect();
    let mut plates = pictures::paths(&labelled);
    plates.extend(pictures::wheels(&labelled[0], &outcomes[0].cast));
    for (index, structure) in scene.structures.iter().enumerate() {
        let Some(solved) = solved_of(known, &structure.origin) else { continue };
        plates.extend(
            pictures::girder(&structure.name, index, &labelled[0], &outcomes[0].cast, solved)
                .map_err(trouble)?,
        );
        plates.extend(pictures::structure(&structure.name, scene.units, solved).map_err(trouble)?);
    }
    Ok(plates)
}

/// Something that should not happen to checked input, told instead of hidden.
fn trouble(error: impl std::fmt::Display) -> Failure {
    Failure::Untrusted(format!("the results cannot be shown: {error}"))
}

fn output_json(value: &Value) -> String {
    format!("{value:#}\n")
}
