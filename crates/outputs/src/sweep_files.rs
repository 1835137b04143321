//! The files of a sweep: all its runs, those of a shard, and shards joined.

use std::io;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use sweep::{GoOn, RecordLines, RunFailure, RunPlan, RunRecord, Runner, SweepInfo, TableBuilder};

use crate::Error;
use crate::files::json as json_text;
use crate::folder::{OutputFolder, PlannedFiles};
use crate::manifest::{InputEntry, Manifest};
use crate::shard::{ROWS, SHARD, Shard, read_shards};
use crate::sweep_rows::SweepRows;
use formats::sweep::Sweep;
use formats::text::fault::{Fault, Faults};
use formats::text::inputs::{Inputs, sha256};
use formats::text::place::Place;
use report::figures::sweep::{SWEEP_FIGURES, SweepFigures};
use report::text::sweep_report::sweep_report;
use results::threads::{parallel_map, parallel_stream};

/// Files that a sweep writes.
const FILES: [&str; 4] = ["results.csv", "failures.csv", "summary.json", "report.html"];

/// The results once more, where the feature is on.
const PARQUET: &str = "results.parquet";

/// How far a sweep is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepProgress {
    /// Runs that an interrupted sweep has left, and the number of all runs.
    Resumed(usize, usize),
    /// Runs that are made, and the number of those that were to be made.
    Made(usize, usize),
}

/// What was written for a sweep.
#[derive(Clone, Debug)]
pub struct WrittenSweep {
    /// The folder.
    pub folder: PathBuf,
    /// The contents of `summary.json`.
    pub summary: Value,
    /// Number of runs with results.
    pub rows: usize,
    /// Number and reason of each run without results.
    pub failures: Vec<(usize, String)>,
}

/// Makes all runs of a sweep that was read with [`Sweep::open`], or those of shard K of N, on at most `threads` threads
/// (`None`: as many as the machine has), and writes the results into a folder. Each run is appended to a file in the
/// folder as it is made, from which the same sweep resumes there after an interruption. `progress` can break off after a
/// run, and `go_on`, which is called from any thread, between two steps of the runs at work.
///
/// # Errors
/// The input cannot be run as it is written, the folder has the runs of another sweep (unless `force`), a file cannot be
/// written, or `progress` or `go_on` has broken off.
pub fn make_sweep(
    (sweep, own): (&Sweep, &Inputs),
    shard: Option<(usize, usize)>,
    (path, force): (&Path, bool),
    threads: Option<u16>,
    progress: &mut dyn FnMut(SweepProgress) -> ControlFlow<()>,
    go_on: GoOn<'_>,
) -> Result<WrittenSweep, Error> {
    let (k, n) = shard.unwrap_or((1, 1));
    let located = |fault: Fault| match own.all()[0].source() {
        Ok(source) => Error::Files(source.diagnose(&Faults(vec![fault]))),
        Err(wrong) => Error::from(*wrong),
    };
    if n > sweep.count {
        let expected = format!("has {} runs, too few for {n} shards", sweep.count);
        return Err(located(Fault::new(&Place::root(), expected)));
    }
    let plan = RunPlan::new(sweep);
    let wanted: Vec<usize> = (k..=sweep.count).step_by(n).collect();
    let mut inputs = InputEntry::all(own);
    inputs.extend(InputEntry::all(sweep.target.inputs()));
    let key = sha256(
        json!([env!("CARGO_PKG_VERSION"), inputs])
            .to_string()
            .as_bytes(),
    );
    let folder = OutputFolder::open(path, "sweep", force, &planned(shard.is_some()))?;

    let runner = Runner::new(sweep);
    let file = &own.all()[0].name;
    let stopped = || {
        Error::NoResults("the sweep was interrupted; repeat the command to resume it".to_owned())
    };
    let info = match runner.run_as_written(go_on) {
        Ok((units, row)) => SweepInfo::new(sweep, file, units, &row),
        Err(RunFailure::Missing(result, why)) => {
            let root = Place::root();
            let results = root.key("results");
            return Err(located(Fault::new(&results.index(result), why)));
        }
        Err(RunFailure::Failed(why)) => {
            let input = sweep.input.file();
            return Err(Error::NoResults(format!(
                "{input} cannot be run as specified: {why}"
            )));
        }
        Err(RunFailure::Stopped) => return Err(stopped()),
    };
    let of_rows = shard.map_or_else(|| key.clone(), |(k, n)| format!("{key} {k}/{n}"));
    let (mut rows, made) = SweepRows::open(path, &of_rows, force)?;
    if !made.is_empty() && progress(SweepProgress::Resumed(made.len(), wanted.len())).is_break() {
        return Err(stopped());
    }
    let left: Vec<usize> = wanted
        .into_iter()
        .filter(|run| !made.contains(run))
        .collect();
    let work = |run: &usize| {
        let axes = plan.values(*run);
        let outcome = runner.run(&axes, go_on)?;
        Some(RunRecord {
            run: *run,
            axes,
            outcome,
        })
    };
    let mut done = 0;
    let mut failed = None;
    parallel_stream(&left, threads, work, |_, record| {
        let Some(record) = record else {
            failed = Some(stopped());
            return false;
        };
        if let Err(error) = rows.add(&record) {
            failed = Some(error);
            return false;
        }
        done += 1;
        if progress(SweepProgress::Made(done, left.len())).is_break() {
            failed = Some(stopped());
            return false;
        }
        true
    });
    if let Some(error) = failed {
        return Err(error);
    }
    let shard = shard.map(|(shard, of)| Shard {
        key,
        shard,
        of,
        info: info.clone(),
    });
    let made = rows.records().map_err(unreadable)?;
    let written = write(folder, &info, inputs, made, (shard.as_ref(), threads))?;
    rows.remove();
    Ok(written)
}

/// Joins the folders of all shards of a sweep in a folder, which then has the files of the sweep made in one piece.
///
/// # Errors
/// Shards are missing, there twice, changed, or of different sweeps; a file cannot be written.
pub fn join_shards(
    shards: &[PathBuf],
    path: &Path,
    force: bool,
    threads: Option<u16>,
) -> Result<WrittenSweep, Error> {
    let joined = read_shards(shards)?;
    let folder = OutputFolder::open(path, "sweep", force, &planned(false))?;
    let (info, inputs) = (&joined.info, joined.inputs.clone());
    write(folder, info, inputs, joined.records(), (None, threads))
}

/// The error of a file of runs that cannot be read again.
fn unreadable(error: io::Error) -> Error {
    Error::NoResults(format!("the finished runs cannot be read: {error}"))
}

/// Writes the results of runs, which come in any order, into a folder.
fn write(
    mut folder: OutputFolder,
    info: &SweepInfo,
    inputs: Vec<InputEntry>,
    records: impl Iterator<Item = io::Result<RunRecord>>,
    (shard, threads): (Option<&Shard>, Option<u16>),
) -> Result<WrittenSweep, Error> {
    let axes = info
        .axes
        .iter()
        .map(|[pointer, _]| pointer.clone())
        .collect();
    let mut table = TableBuilder::new(
        axes,
        shard.map_or(info.runs, |shard| info.runs.div_ceil(shard.of)),
    );
    for record in records {
        table.add(record.map_err(unreadable)?);
    }
    let table = table.finish();
    if let Some(shard) = shard {
        let mut lines = RecordLines::default();
        folder.add_written(ROWS, |file| {
            table
                .records()
                .try_for_each(|record| file.write_all(lines.lines(&record).as_bytes()))
        })?;
        folder.add(SHARD, json_text(&shard.json(&inputs)));
    }
    folder.add_written("results.csv", |file| table.write_csv(file))?;
    #[cfg(feature = "parquet")]
    folder.add_written(PARQUET, |file| {
        sweep::write_parquet(&table, file).map_err(io::Error::other)
    })?;
    folder.add_written("failures.csv", |file| table.write_failures_csv(file))?;
    let summary = sweep::summary(info, &table);
    folder.add("summary.json", json_text(&summary));
    let figures = SweepFigures::new(info, &table);
    let drawn = parallel_map(&figures.figures, threads, |_, figure| figure.svg());
    for (figure, svg) in figures.figures.iter().zip(drawn) {
        let svg = svg.map_err(Error::not_shown)?;
        folder.add(&format!("plots/{}.svg", figure.name), svg.file());
    }
    let page = sweep_report(info, &table, figures);
    folder.add("report.html", page.html(threads).map_err(Error::not_shown)?);
    let folder = folder.commit(Manifest::of_entries("sweep", inputs, json!({})))?;
    let failures = table
        .failures
        .into_iter()
        .map(|(run, _, why)| (run, why))
        .collect();
    Ok(WrittenSweep {
        folder,
        summary,
        rows: table.runs.len(),
        failures,
    })
}

fn planned(is_shard: bool) -> PlannedFiles {
    let shard: &[&str] = if is_shard { &[ROWS, SHARD] } else { &[] };
    let parquet = cfg!(feature = "parquet").then_some(&PARQUET);
    let names = FILES
        .iter()
        .chain(parquet)
        .chain(shard)
        .map(|name| (*name).to_owned())
        .collect();
    PlannedFiles {
        names,
        plots: SWEEP_FIGURES.map(str::to_owned).to_vec(),
    }
}
