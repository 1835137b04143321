//! `girderway deck`: a scene as an ADAMS data set.

use super::run::solve_all;
use std::fs;
use std::path::{Path, PathBuf};

use crate::cli::{DeckArgs as Arguments, Global};
use crate::exit::{Exit, Failure};
use crate::interrupt;
use crate::output;
use crate::progress::Progress;
use deck::{self, DeckForm, check};
use formats::scene::Document;
use formats::text::diagnostic::Diagnostic;
use formats::text::fault::Faults;
use foundations::distinct_specs;
use outputs::files;
use outputs::files::json as json_text;

/// Writes the data set to the named file and its command file into the same folder, or the data set alone to
/// standard output.
///
/// # Errors
/// The scene or one of its files is invalid, a foundation cannot be represented in a deck, the scene has no initial
/// state, or the deck differs from the simulator.
pub fn run(args: &Arguments, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    if let Some(path) = &args.output
        && !path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("adm"))
    {
        let fault = Diagnostic::of_file(
            path.display().to_string(),
            "output file must have the extension .adm",
        );
        return Err(fault
            .hint("its command file, with the ending .acf, is written to the same folder")
            .into());
    }
    if let Some(path) = args.output.as_deref().filter(|_| !args.force) {
        check_owner(&command_file(path))?;
    }
    let document = Document::open(&args.scene)?;
    let scene = document.scene();
    let unsupported = deck::unsupported(scene);
    if !unsupported.0.is_empty() {
        return Err(document.inputs.all()[0]
            .source()?
            .diagnose(&unsupported)
            .into());
    }
    let only = Document {
        cases: document.cases[..1].to_vec(),
        inputs: document.inputs.clone(),
        changes: None,
    };
    let only = results::preflight::validate(only)?;
    let scene = only.scene();
    let known = solve_all(&document, &distinct_specs(&only), &progress)?;
    let form = args.form.map(DeckForm::from).unwrap_or_else(|| {
        DeckForm::of_readings(
            scene
                .structures
                .iter()
                .map(|structure| structure.interpolation),
        )
    });
    let file = args.scene.display().to_string();
    let plan = deck::plan(scene, &known, form, &file).map_err(|error| located(error, &document))?;
    let model = args
        .output
        .as_deref()
        .map_or_else(|| scene.name.clone(), stem);
    let deck = deck::deck(&plan, &known, &model)?;
    let text = deck.set.write().map_err(Failure::untrusted)?;
    match &args.output {
        None => output::print(&text)?,
        Some(path) => {
            let beside = command_file(path);
            let both = [
                (path.as_path(), text.as_bytes()),
                (&beside, deck.commands.as_bytes()),
            ];
            interrupt::writing(&[path, &beside], || files::write_together(&both))?;
            progress.say(&format!("wrote {}", path.display()));
            progress.say(&format!("wrote {}", beside.display()));
        }
    }
    if !args.check {
        return Ok(Exit::Done);
    }
    let stage = progress.stage("executing the deck");
    let states = args
        .states
        .map_or_else(|| check::default_states(&plan), |states| states as usize);
    let report = check::check(&plan, &text, states)?;
    drop(stage);
    for line in report.lines() {
        progress.say(&line);
    }
    // if the data set is written to standard output, nothing else may be written there
    if global.json && args.output.is_some() {
        output::print(&json_text(&report.json()))?;
    }
    if report.holds() {
        Ok(Exit::Done)
    } else {
        Err(Failure::Differs(
            "the deck differs from the simulator".to_owned(),
        ))
    }
}

/// A failure that names the body and its place in the scene where the scene has no equilibrium on the tables of the deck.
fn located(error: deck::Error, document: &Document) -> Failure {
    let deck::Error::Start(error) = error else {
        return error.into();
    };
    let scene = document.scene();
    let message = format!(
        "the deck's first instant: {}",
        results::run_error::in_scene_names(&error, scene)
    );
    let fault = results::preflight::of_error(&foundations::Error::Simulation(error), scene);
    let source = document.inputs.all()[0].source();
    match (fault, source) {
        (Some(fault), Ok(source)) => source.diagnose(&Faults(vec![fault])).into(),
        _ => Failure::Untrusted(message),
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(
        || "model".to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}

/// Checks that a command file that would be replaced has the form that this command writes.
fn check_owner(path: &Path) -> Result<(), Failure> {
    let Ok(bytes) = fs::read(path) else {
        return Ok(());
    };
    let text = String::from_utf8_lossy(&bytes);
    let lines: Vec<&str> = text.lines().collect();
    let is_ours = matches!(&lines[..], [file, simulate, "stop"]
        if file.starts_with("file/model=") && simulate.starts_with("SIMULATE/"));
    if is_ours {
        return Ok(());
    }
    let fault = Diagnostic::of_file(
        path.display().to_string(),
        "would be overwritten, but was not written by girderway or was modified since",
    );
    Err(fault
        .hint("move it, name another file with -o, or overwrite it with --force")
        .into())
}

/// Path of the command file that belongs to a data set.
fn command_file(path: &Path) -> PathBuf {
    path.with_extension("acf")
}
