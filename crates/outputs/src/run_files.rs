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
use formats::tables as adams_tables;
use foundations::distinct_specs;
use report::figures::run::{OmittedFigure, figures};
use report::text::run_report;
use results::fatigue;
use results::response::RunComparison;
use results::scene_run::SceneRun;
use results::threads::parallel_map;
use results::warning::case_warnings;

/// Files with their names.
type NamedFiles = Vec<(String, Vec<u8>)>;

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
    let SceneRun {
        document,
        structures,
        cases,
    } = run;
    let scene = document.scene();
    let (files, comparison, summary) = tables(run, threads)?;
    for (name, contents) in files {
        folder.add(&name, contents);
    }
    folder.add("summary.json", json_text(&summary));
    clock.lap("tables");

    let mut figures = figures(document, cases, structures, &comparison, threads);
    for (name, svg) in figures.draw(threads) {
        folder.add(&format!("plots/{name}.svg"), svg.file());
    }
    clock.lap("plots");
    let page = run_report::report(
        document,
        cases,
        &run.solutions(),
        &comparison,
        figures.figures,
    );
    folder.add("report.html", page.html(threads).map_err(Error::not_shown)?);
    clock.lap("report");
    folder.add_varying("timing.json", json_text(&clock.json()));
    let settings =
        json!({ "accuracy": scene.accuracy, "analysis": format!("{:?}", scene.analysis) });
    let folder = folder.commit(Manifest::new(command, &document.inputs, settings))?;
    let warnings = figures.omitted.iter().map(|OmittedFigure { name, why }| {
        format!("the figure {name} is omitted because it cannot be drawn: {why}")
    });
    Ok(WrittenRun {
        folder,
        summary,
        warnings: warnings.collect(),
    })
}

/// What is made of a run on one thread.
enum TablePart {
    Comparison,
    /// The tables of a case.
    Sheets(usize),
    Grids,
}

/// The tables of all cases and structures with their names, and the comparison of the cases with the summary, which take
/// longest and begin first.
fn tables(
    run: &SceneRun,
    threads: Option<u16>,
) -> Result<(NamedFiles, RunComparison, Value), Error> {
    let sheets_of = (0..run.cases.len()).map(TablePart::Sheets);
    let parts: Vec<TablePart> = [TablePart::Comparison]
        .into_iter()
        .chain(sheets_of)
        .chain([TablePart::Grids])
        .collect();
    let made = parallel_map(&parts, threads, |_, part| match part {
        TablePart::Comparison => {
            let comparison = run.comparison(Some(1));
            let summary = run.summary(&comparison);
            Ok::<_, Error>((Vec::new(), Some((comparison, summary))))
        }
        TablePart::Sheets(index) => Ok((sheets(run, *index)?, None)),
        TablePart::Grids => Ok((grids(run)?, None)),
    });
    let (mut files, mut compared) = (Vec::new(), None);
    for part in made {
        let (own, found) = part?;
        files.extend(own);
        compared = compared.or(found);
    }
    let (comparison, summary) = compared.expect("the comparison is one of the parts");
    Ok((files, comparison, summary))
}

/// The grids of the structures, and their tables for ADAMS, with their names.
fn grids(run: &SceneRun) -> Result<NamedFiles, Error> {
    let mut all = Vec::new();
    for ((name, ..), entry) in distinct_specs(&run.document).iter().zip(&run.structures) {
        let solved = &entry.solution;
        let text = grid_file::write(&solved.grid, solved.surface.as_ref());
        all.push((format!("grid-{name}.json"), text.into()));
        if let Some(text) = adams_tables::adm(name, &solved.grid).map_err(Error::not_shown)? {
            all.push((format!("{name}.adm"), text.into()));
        }
    }
    Ok(all)
}

/// The tables of a case with their names: history, cycles and envelope. Its warnings, for which summary and page ask, are
/// found on the same thread.
fn sheets(run: &SceneRun, index: usize) -> Result<NamedFiles, Error> {
    let (case, result) = (&run.document.cases[index], &run.cases[index]);
    let _ = case_warnings(&case.scene, result);
    let name = |kind: &str| match &case.label {
        Some(label) => format!("{kind}-{label}.csv"),
        None => format!("{kind}.csv"),
    };
    let mut all = vec![(
        name("history"),
        result.columns.csv().map_err(Error::not_shown)?,
    )];
    let cycles = fatigue::csv(&result.fatigue).map_err(Error::not_shown)?;
    all.extend(cycles.map(|cycles| (name("cycles"), cycles)));
    let envelope = result
        .girders()
        .csv(&case.scene, index + 1)
        .map_err(Error::not_shown)?;
    all.extend(envelope.map(|envelope| (name("envelope"), envelope)));
    Ok(all)
}
