//! `girderway run` and `girderway sim`: structures, tables, simulation, pictures and report.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::{Value, json};

use super::planned::{check_names, planned_files};
use crate::cli::{Global, SceneArgs as Arguments};
use crate::clock::StageClock;
use crate::exit::{Exit, Failure};
use crate::folder::OutputFolder;
use crate::manifest::Manifest;
use crate::output;
use crate::progress::Progress;
use formats::grid::file as grid_file;
use formats::scene::Document;
use formats::spec::Spec;
use formats::tables;
use formats::text::fault::{Fault, Faults};
use formats::text::place::Place;
use foundations::{SolvedModel, SolvedStructure, distinct_specs, solution_of, solve_specs};
use report::figures::run::{OmittedFigure, figures};
use report::text::run_report;
use results::before;
use results::case_result::CaseResult;
use results::cases::{SimulationProgress, simulate};
use results::columns::peak;
use results::response::RunComparison;
use results::threads::parallel_map;
use results::{fatigue, run_error, summary, warning};

/// Solves the structures of a scene, simulates it, and writes the output folder.
///
/// # Errors
/// The scene or one of its files is invalid, a structure is a mechanism, the scene has no initial state, a run is
/// incomplete, or a file cannot be written.
pub fn run(args: &Arguments, global: Global) -> Result<Exit, Failure> {
    job("run", args, global, solve)
}

/// Function that returns the solved structures of a document; the path is that of the output folder.
type Source = fn(&Document, &Path, &Progress) -> Result<Vec<SolvedStructure>, Failure>;

/// Performs `run` on a document that is read.
pub(super) fn of_document(
    name: &str,
    document: &Document,
    path: &Path,
    force: bool,
    global: Global,
) -> Result<Exit, Failure> {
    whole(name, (document, path, force), (global, StageClock::new()), solve)
}

/// Performs the common part of `run` and `sim` with the solved structures that `structures` returns.
pub(super) fn job(name: &str, args: &Arguments, global: Global, structures: Source) -> Result<Exit, Failure> {
    let clock = StageClock::new();
    let document = Document::open(&args.scene)?;
    let path =
        args.output.clone().unwrap_or_else(|| PathBuf::from("girderway-out").join(&document.scene().name));
    whole(name, (&document, &path, args.force), (global, clock), structures)
}

/// Checks, simulates and writes a document into a folder.
fn whole(
    name: &str,
    (document, path, force): (&Document, &Path, bool),
    (global, mut clock): (Global, StageClock),
    structures: Source,
) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    before::check(document)?;
    progress.warn_of_commas(&document.inputs);
    let scene = document.scene();
    check_names(document, path)?;
    let mut folder = OutputFolder::open(path, name, force, &planned_files(name, document))?;
    clock.lap("read");

    let known = structures(document, path, &progress)?;
    clock.lap("fea");
    let bar = progress.bar("simulating", 1000);
    let outcomes = simulate(document, &known, global.threads, &|now| match now {
        SimulationProgress::Fraction(share) => bar.set((1000.0 * share) as u64),
        SimulationProgress::Trial(foundations) => bar.name(&format!("simulating, trial on {foundations}")),
    })
    .map_err(|error| located(document, error))?;
    drop(bar);
    clock.lap("simulation");

    for ((name, ..), entry) in distinct_specs(document).iter().zip(&known) {
        let solved = &entry.solution;
        folder.add(&format!("grid-{name}.json"), grid_file::write(&solved.grid, solved.surface.as_ref()));
        if let Some(text) = tables::adm(name, &solved.grid).map_err(unexpected)? {
            folder.add(&format!("{name}.adm"), text);
        }
    }
    let sheets = parallel_map(&outcomes, global.threads, |_, outcome| outcome.columns.csv());
    for (index, ((case, outcome), sheet)) in document.cases.iter().zip(&outcomes).zip(sheets).enumerate() {
        let name = case
            .label
            .as_ref()
            .map_or_else(|| "history.csv".to_owned(), |label| format!("history-{label}.csv"));
        folder.add(&name, sheet.map_err(unexpected)?);
        if let Some(cycles) = fatigue::csv(&outcome.fatigue, &outcome.columns).map_err(unexpected)? {
            folder.add(&name.replacen("history", "cycles", 1), cycles);
        }
        if let Some(envelope) = outcome.girders.csv(&case.scene, index + 1).map_err(unexpected)? {
            folder.add(&name.replacen("history", "envelope", 1), envelope);
        }
    }
    let runs: Vec<_> = outcomes
        .iter()
        .map(|outcome| (outcome.label.as_str(), &outcome.columns, &outcome.response))
        .collect();
    let comparison = RunComparison::new(&runs, global.threads);
    let summary = summary::of_document(document, &outcomes, comparison.json(&runs));
    folder.add("summary.json", output::json(&summary));
    clock.lap("tables");

    let mut figures = figures(document, &outcomes, &known, &comparison);
    for (name, svg) in figures.draw(global.threads) {
        folder.add(&format!("plots/{name}.svg"), svg.file());
    }
    clock.lap("plots");
    let solved: Vec<Option<&SolvedModel>> =
        scene.structures.iter().map(|structure| solution_of(&known, &structure.origin)).collect();
    let report = run_report::report(document, &outcomes, &solved, &comparison, figures.figures);
    folder.add("report.html", report.html(global.threads).map_err(unexpected)?);
    clock.lap("report");
    folder.add_varying("timing.json", output::json(&clock.json()));
    let settings = json!({ "accuracy": scene.accuracy, "analysis": format!("{:?}", scene.analysis) });
    let written = folder.commit(Manifest::new(name, &document.inputs, settings))?;
    for OmittedFigure { name, why } in figures.omitted {
        progress.say(&format!("warning: the figure {name} is omitted because it cannot be drawn: {why}"));
    }
    finish(&outcomes, &summary, &written, document, global, &progress)
}

/// Converts an error of the simulation. Faults of the scene that only its solved structures show, and bodies without a
/// static equilibrium on them, are located in the scene.
fn located(document: &Document, error: results::Error) -> Failure {
    let diagnosed = |fault: Fault| match document.inputs.all()[0].source() {
        Ok(scene) => scene.diagnose(&Faults(vec![fault])),
        Err(wrong) => vec![*wrong],
    };
    match &error {
        results::Error::Foundation(found) => match before::of_error(found, document.scene()) {
            Some(fault) => Failure::Input(diagnosed(fault)),
            None => error.into(),
        },
        results::Error::Run { body: Some(body), .. } => {
            let fault = Fault::new(&Place::root().key("bodies").key(body), error.to_string()).at_key();
            Failure::Untrusted(diagnosed(fault).iter().map(ToString::to_string).collect())
        }
        _ => error.into(),
    }
}

/// Prints the results and warnings. Returns an error if a run is incomplete.
fn finish(
    outcomes: &[CaseResult],
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
            let Some((_, deepest)) = peak(outcome.columns.part(&body.name, "deflection")) else { continue };
            progress.say(&format!("{}: {} sinks by at most {deepest:.6} {unit}", outcome.label, body.name));
        }
    }
    for outcome in outcomes {
        for choice in &outcome.choices {
            let name = &scene.structures[choice.structure].name;
            progress.say(&format!("{}: {name}: {}", outcome.label, foundations::selection_reason(choice)));
        }
    }
    for message in warning::messages(outcomes, document) {
        progress.say(&message.to_string());
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let result = json!({ "output": written.display().to_string(), "summary": summary });
        output::print(&output::json(&result))?;
    }
    let failed = outcomes.iter().zip(&document.cases).find_map(|(outcome, case)| {
        run_error::reason_incomplete(&outcome.run.status, &case.scene)
            .map(|why| format!("{}: {why}", outcome.label))
    });
    failed.map_or(Ok(Exit::Done), |why| Err(Failure::Untrusted(why)))
}

/// Solves each distinct spec of the document once.
fn solve(document: &Document, _: &Path, progress: &Progress) -> Result<Vec<SolvedStructure>, Failure> {
    solve_all(document, &distinct_specs(document), progress)
}

/// Solves the given specs of a document while a stage is shown.
pub(super) fn solve_all(
    document: &Document,
    specs: &[(String, &str, &Arc<Spec>)],
    progress: &Progress,
) -> Result<Vec<SolvedStructure>, Failure> {
    let _stage = progress.stage("solving the structures");
    Ok(solve_specs(document, specs)?)
}

/// Creates the failure of an error that should be impossible after the checks of the input.
fn unexpected(error: impl std::fmt::Display) -> Failure {
    Failure::Untrusted(format!("the results cannot be shown: {error}"))
}
