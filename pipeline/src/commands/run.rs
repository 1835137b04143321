//! `girderway run` and `girderway sim`: structures, tables, simulation, pictures and report.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde_json::json;

use crate::cli::{FailOnLimit, Global, SceneArgs as Arguments};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use crate::verdict::exit as exit_of;
use formats::scene::Document;
use formats::spec::Spec;
use formats::verdict::VerdictResult;
use foundations::{SolvedStructure, distinct_specs, solve_specs};
use outputs::clock::StageClock;
use outputs::files::json as json_text;
use outputs::folder::OutputFolder;
use outputs::planned::{check_names, planned_files};
use outputs::run_files::{WrittenRun, write_run};
use results::cases::{RunOptions, SimulationProgress};
use results::preflight;
use results::scene_run::SceneRun;
use results::verdict::verdict;
use results::warning;

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
    document: Document,
    path: &Path,
    force: bool,
    global: Global,
) -> Result<Exit, Failure> {
    whole(
        "run",
        document,
        Wanted {
            path,
            force,
            fail: None,
        },
        (global, StageClock::new()),
        solve,
    )
}

/// Performs the common part of `run` and `sim` with the solved structures that `structures` returns.
pub(super) fn job(
    name: &str,
    args: &Arguments,
    global: Global,
    structures: Source,
) -> Result<Exit, Failure> {
    let clock = StageClock::new();
    let document = Document::open(&args.scene)?;
    let folder = || PathBuf::from("girderway-out").join(&document.scene().name);
    let path = args.output.clone().unwrap_or_else(folder);
    whole(
        name,
        document,
        Wanted {
            path: &path,
            force: args.force,
            fail: args.fail_on_limit,
        },
        (global, clock),
        structures,
    )
}

/// Where the results go, and when a verdict fails the command.
struct Wanted<'a> {
    path: &'a Path,
    force: bool,
    fail: Option<FailOnLimit>,
}

/// Checks and simulates a document, and writes its files into a folder.
fn whole(
    name: &str,
    document: Document,
    Wanted { path, force, fail }: Wanted<'_>,
    (global, mut clock): (Global, StageClock),
    structures: Source,
) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let document = preflight::validate(document)?;
    progress.warn_of_commas(&document.inputs);
    check_names(&document, path)?;
    let folder = OutputFolder::open(path, name, force, &planned_files(name, &document))?;
    clock.lap("read");

    let known = structures(&document, path, &progress)?;
    clock.lap("fea");
    let bar = progress.bar("simulating", 1000);
    let options = RunOptions {
        threads: global.threads,
        ..RunOptions::default()
    };
    let run = SceneRun::on(document, known, options, &|now| {
        match now {
            // nobody knows how long an evaluation takes
            SimulationProgress::Fraction(share) if share >= 1.0 => {
                bar.without_end(": evaluating results")
            }
            SimulationProgress::Fraction(share) => bar.set((1000.0 * share) as u64),
            SimulationProgress::Trial(foundations) => {
                bar.name(&format!("simulating, trial with {foundations}"))
            }
        }
        ControlFlow::Continue(())
    })?;
    drop(bar);
    clock.lap("simulation");
    let stage = progress.stage("writing the results");
    let written = write_run(&run, name, folder, global.threads, clock)?;
    drop(stage);
    for warning in &written.warnings {
        progress.say(&format!("warning: {warning}"));
    }
    let exit = finish(&run, &written, fail, global, &progress);
    // the process ends now, and its memory with it, in one piece
    std::mem::forget(run);
    exit
}

/// Prints the results and warnings. Returns an error if a run is incomplete.
fn finish(
    run: &SceneRun,
    written: &WrittenRun,
    fail: Option<FailOnLimit>,
    global: Global,
    progress: &Progress,
) -> Result<Exit, Failure> {
    let incomplete = run.reason_incomplete();
    let mut verdicts = Vec::new();
    if incomplete.is_none() && (progress.speaks() || fail.is_some()) {
        let cases = run.document.cases.iter().zip(&run.cases);
        verdicts.extend(cases.map(|(case, outcome)| verdict(&case.scene, outcome)));
    }
    // the warnings are computed anew
    if progress.speaks() {
        tell(run, progress);
        let units = run.document.scene().units;
        for (index, (own, outcome)) in verdicts.iter().zip(&run.cases).enumerate() {
            if index > 0 && own.result == VerdictResult::NotChecked {
                continue;
            }
            let lines = report::verdict_lines(own, units);
            if verdicts.len() > 1 {
                progress.say(&format!("{}: {}", outcome.label, lines[0]));
            } else {
                progress.say(&lines[0]);
            }
            if index == 0 {
                lines[1..].iter().for_each(|line| progress.say(line));
            }
        }
    }
    progress.say(&format!("wrote {}", written.folder.display()));
    if global.json {
        let result =
            json!({ "output": written.folder.display().to_string(), "summary": written.summary });
        output::print(&json_text(&result))?;
    }
    if let Some(why) = incomplete {
        return Err(Failure::Untrusted(why));
    }
    for own in &verdicts {
        exit_of(own, fail)?;
    }
    Ok(Exit::Done)
}

/// Writes what the user should know of the results.
fn tell(run: &SceneRun, progress: &Progress) {
    let scene = run.document.scene();
    let unit = scene.units.length.word();
    for outcome in &run.cases {
        for body in &scene.bodies {
            let Some(deepest) = outcome.peak(&body.name, "deflection") else {
                continue;
            };
            progress.say(&format!(
                "{}: {}: maximum deflection {:.6} {unit}",
                outcome.label, body.name, deepest.max.value
            ));
        }
    }
    for outcome in &run.cases {
        for choice in &outcome.choices {
            let name = &scene.structures[choice.structure].name;
            progress.say(&format!(
                "{}: {name}: {}",
                outcome.label,
                foundations::selection_reason(choice)
            ));
        }
    }
    for message in warning::messages(&run.cases, &run.document) {
        progress.say(&message.to_string());
    }
}

/// Solves each distinct spec of the document once.
fn solve(
    document: &Document,
    _: &Path,
    progress: &Progress,
) -> Result<Vec<SolvedStructure>, Failure> {
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
