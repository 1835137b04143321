//! `girderway run` and `girderway sim`: structures, tables, simulation, pictures and report.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Map, Value, json};

use crate::cases::{Known, Outcome, simulate, solved_of, specs};
use crate::cli::{Global, Scene as Arguments};
use crate::clock::Clock;
use crate::exit::{Exit, Failure};
use crate::inputs::Input;
use crate::link::{self, Solved};
use crate::manifest::Manifest;
use crate::output::{self, Folder};
use crate::pictures::{self, Labelled, Plate};
use crate::progress::Progress;
use crate::record::peak;
use crate::response::{self, Comparison, Response};
use crate::scene::{Document, Scene};
use crate::spec::Spec;
use crate::threads::side_by_side;
use crate::{animation, fatigue, grid_file, plight, story, summary, tables, warning};

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

    for ((name, ..), entry) in specs(&document).iter().zip(&known) {
        let solved = &entry.solved;
        folder.add(&format!("grid-{name}.json"), grid_file::write(&solved.grid, solved.surface.as_ref()));
        if let Some(text) = tables::adm(name, &solved.grid).map_err(trouble)? {
            folder.add(&format!("{name}.adm"), text);
        }
    }
    let sheets = side_by_side(&outcomes, global.threads, |_, outcome| outcome.record.csv());
    for ((case, outcome), sheet) in document.cases.iter().zip(&outcomes).zip(sheets) {
        let name = case
            .label
            .as_ref()
            .map_or_else(|| "history.csv".to_owned(), |label| format!("history-{label}.csv"));
        folder.add(&name, sheet.map_err(trouble)?);
        if let Some(cycles) = fatigue::csv(&outcome.fatigue, &outcome.record).map_err(trouble)? {
            folder.add(&name.replacen("history", "cycles", 1), cycles);
        }
    }
    let runs: Vec<_> =
        outcomes.iter().map(|outcome| (outcome.label.as_str(), &outcome.record, &outcome.response)).collect();
    let comparison = Comparison::new(&runs, global.threads);
    let summary = summary_of(&document, &outcomes, comparison.json(&runs));
    folder.add("summary.json", output::json(&summary));
    clock.lap("tables");

    let plates = plates(scene, &document, &outcomes, &known, &comparison)?;
    let drawn = side_by_side(&plates, global.threads, |_, plate| plate.svg());
    for (plate, svg) in plates.iter().zip(drawn) {
        folder.add(&format!("plots/{}.svg", plate.name), svg.map_err(trouble)?.file());
    }
    clock.lap("plots");
    let solved: Vec<Option<&Solved>> =
        scene.structures.iter().map(|structure| solved_of(&known, &structure.origin)).collect();
    let report = story::report(&document, &outcomes, &solved, &comparison, plates);
    folder.add("report.html", report.html(global.threads).map_err(trouble)?);
    clock.lap("report");
    folder.add_varying("timing.json", output::json(&clock.json()));
    let settings = json!({ "accuracy": scene.accuracy, "analysis": format!("{:?}", scene.analysis) });
    let written = folder.commit(Manifest::new(name, &document.inputs, settings))?;
    finish(&outcomes, &summary, &written, &document, global, &progress)
}

/// Says how it went; the exit status is that of the worst run.
fn finish(
    outcomes: &[Outcome],
    summary: &Value,
    written: &Path,
    document: &Document,
    global: Global,
    progress: &Progress,
) -> Result<Exit, Failure> {
    let scene = document.scene();
    let unit = scene.units.length.word();
    for outcome in outcomes {
        for body in &scene.bodies {
            let Some((_, deepest)) = peak(outcome.record.part(&body.name, "deflection")) else { continue };
            progress.say(&format!("{}: {} sinks by at most {deepest:.6} {unit}", outcome.label, body.name));
        }
    }
    for (outcome, case) in outcomes.iter().zip(&document.cases) {
        for choice in &outcome.choices {
            let name = &scene.structures[choice.structure].name;
            progress.say(&format!("{}: {name}: {}", outcome.label, crate::link::reason(choice)));
        }
        for warning in warning::of_case(&case.scene, outcome) {
            progress.say(&format!("warning: {}: {warning}", outcome.label));
        }
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let result = json!({ "output": written.display().to_string(), "summary": summary });
        output::print(&output::json(&result))?;
    }
    let failed = outcomes.iter().zip(&document.cases).find_map(|(outcome, case)| {
        plight::why(&outcome.run.status, &case.scene).map(|why| format!("{}: {why}", outcome.label))
    });
    failed.map_or(Ok(Exit::Done), |why| Err(Failure::Untrusted(why)))
}

/// Solves every spec of every case once.
fn solve(document: &Document, _: &Path, progress: &Progress) -> Result<Vec<Known>, Failure> {
    solve_all(document, &specs(document), progress)
}

/// Solves the given specs of a document.
pub(super) fn solve_all(
    document: &Document,
    specs: &[(String, &str, &Arc<Spec>)],
    progress: &Progress,
) -> Result<Vec<Known>, Failure> {
    let mut known: Vec<Known> = Vec::new();
    let stage = progress.stage("solving the structures");
    for &(_, file, spec) in specs {
        let solved =
            link::solve(spec).map_err(|error| match document.inputs.find(file).map(Input::source) {
                Some(Ok(source)) => spec.refuse(&source, &error),
                _ => Failure::untrusted(error),
            })?;
        known.push(Known { spec: Arc::clone(spec), solved });
    }
    drop(stage);
    Ok(known)
}

fn summary_of(document: &Document, outcomes: &[Outcome], comparison: Map<String, Value>) -> Value {
    let scene = document.scene();
    let mut result = summary::run(scene, &outcomes[0]);
    result["format"] = json!("girderway-summary/1");
    result["name"] = json!(scene.name);
    result["units"] = summary::units(scene, &outcomes[0].record);
    let compare: Map<String, Value> = document
        .cases
        .iter()
        .zip(outcomes)
        .skip(1)
        .map(|(case, outcome)| (outcome.label.clone(), summary::run(&case.scene, outcome)))
        .collect();
    if !compare.is_empty() {
        result["compare"] = Value::Object(compare);
    }
    if !comparison.is_empty() {
        result["comparison"] = Value::Object(comparison);
    }
    result
}

fn plates(
    scene: &Scene,
    document: &Document,
    outcomes: &[Outcome],
    known: &[Known],
    comparison: &Comparison,
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
    let fired: Vec<(f64, &str)> = outcomes[0]
        .run
        .fired
        .iter()
        .map(|fired| (fired.time, scene.events[fired.rule].name.as_str()))
        .collect();
    let mut plates: Vec<Plate> = animation::plate(&labelled[0], &outcomes[0].cast)?.into_iter().collect();
    plates.extend(pictures::travel(&labelled[0], &fired));
    plates.extend(response::rails(&labelled, comparison));
    plates.extend(pictures::paths(&labelled));
    plates.extend(pictures::wheels(&labelled[0], &outcomes[0].cast));
    let responses: Vec<&Response> = outcomes.iter().map(|outcome| &outcome.response).collect();
    plates.extend(response::pictures(&labelled, &responses, &outcomes[0].lines));
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
