//! The files of a run: grids, tables, histories, summary, pictures and the page.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use crate::Error;
use crate::clock::StageClock;
use crate::files::json as json_text;
use crate::folder::OutputFolder;
use crate::manifest::Manifest;
use crate::planned::{check_names, planned_files};
use formats::grid::file as grid_file;
use formats::tables;
use foundations::distinct_specs;
use report::figures::run::{OmittedFigure, figures};
use report::text::run_report;
use results::fatigue;
use results::scene_run::SceneRun;
use results::threads::parallel_map;

/// What was written for a run.
#[derive(Clone, Debug)]
pub struct WrittenRun {
    /// The folder.
    pub folder: PathBuf,
    /// The contents of `summary.json`.
    pub summary: Value,
    /// Warnings about figures that are left out because they cannot be drawn.
    pub warnings: Vec<String>,
}

/// Writes a run to a folder, as `girderway run` does; `clock` has the times of its stages so far. Files of others are
/// replaced only where `force`.
///
/// # Errors
/// A file that would be replaced belongs to somebody else, or the folder cannot be written.
pub fn save_run(
    run: &SceneRun,
    path: &Path,
    force: bool,
    threads: Option<u16>,
    clock: StageClock,
) -> Result<WrittenRun, Error> {
    check_names(&run.document, path)?;
    let folder = OutputFolder::open(path, "run", force, &planned_files("run", &run.document))?;
    write_run(run, "run", folder, threads, clock)
}

/// Writes the files of a run into an open folder; `command` is its name in the manifest.
///
/// # Errors
/// As [`save_run`].
pub fn write_run(
    run: &SceneRun,
    command: &str,
    mut folder: OutputFolder,
    threads: Option<u16>,
    mut clock: StageClock,
) -> Result<WrittenRun, Error> {
    let SceneRun { document, structures, cases } = run;
    let scene = document.scene();
    for ((name, ..), entry) in distinct_specs(document).iter().zip(structures) {
        let solved = &entry.solution;
        folder.add(&format!("grid-{name}.json"), grid_file::write(&solved.grid, solved.surface.as_ref()));
        if let Some(text) = tables::adm(name, &solved.grid).map_err(Error::not_shown)? {
            folder.add(&format!("{name}.adm"), text);
        }
    }
    let sheets = parallel_map(cases, threads, |_, case| case.columns.csv());
    for (index, ((case, result), sheet)) in document.cases.iter().zip(cases).zip(sheets).enumerate() {
        let name = case
            .label
            .as_ref()
            .map_or_else(|| "history.csv".to_owned(), |label| format!("history-{label}.csv"));
        folder.add(&name, sheet.map_err(Error::not_shown)?);
        if let Some(cycles) = fatigue::csv(&result.fatigue, &result.columns).map_err(Error::not_shown)? {
            folder.add(&name.replacen("history", "cycles", 1), cycles);
        }
        if let Some(envelope) = result.girders().csv(&case.scene, index + 1).map_err(Error::not_shown)? {
            folder.add(&name.replacen("history", "envelope", 1), envelope);
        }
    }
    let comparison = run.comparison(threads);
    let summary = run.summary(&comparison);
    folder.add("summary.json", json_text(&summary));
    clock.lap("tables");

    let mut figures = figures(document, cases, structures, &comparison);
    for (name, svg) in figures.draw(threads) {
        folder.add(&format!("plots/{name}.svg"), svg.file());
    }
    clock.lap("plots");
    let page = run_report::report(document, cases, &run.solutions(), &comparison, figures.figures);
    folder.add("report.html", page.html(threads).map_err(Error::not_shown)?);
    clock.lap("report");
    folder.add_varying("timing.json", json_text(&clock.json()));
    let settings = json!({ "accuracy": scene.accuracy, "analysis": format!("{:?}", scene.analysis) });
    let folder = folder.commit(Manifest::new(command, &document.inputs, settings))?;
    let warnings = figures.omitted.iter().map(|OmittedFigure { name, why }| {
        format!("the figure {name} is omitted because it cannot be drawn: {why}")
    });
    Ok(WrittenRun { folder, summary, warnings: warnings.collect() })
}
