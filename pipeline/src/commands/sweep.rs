//! `girderway sweep`: many runs of a scene or design, whole, in shards, and joined.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use serde_json::json;
use sweep::{RecordLines, ResultTable, RunFailure, RunPlan, RunRecord, Runner, SweepInfo};

use crate::cli::{Global, SweepArgs};
use crate::commands;
use crate::exit::{Exit, Failure};
use crate::folder::{OutputFolder, PlannedFiles};
use crate::manifest::{InputEntry, Manifest};
use crate::output;
use crate::progress::Progress;
use crate::shard::{ROWS, SHARD, Shard, read_shards};
use crate::sweep_rows::SweepRows;
use formats::design::Design;
use formats::scene::Document;
use formats::sweep::{Sweep, SweepInput};
use formats::text::fault::{Fault, Faults};
use formats::text::inputs::{Inputs, sha256};
use formats::text::place::Place;
use report::text::sweep_report::sweep_report;
use results::threads::parallel_stream;

/// Files that a sweep writes.
const FILES: [&str; 5] = ["results.csv", "results.parquet", "failures.csv", "summary.json", "report.html"];

/// Runs a sweep, one of its shards or one of its runs, or joins shards.
///
/// # Errors
/// The sweep or a file of it is invalid, its input cannot be run as it is written, shards do not belong together, a file
/// cannot be written, or no run has results.
pub fn run(args: &SweepArgs, global: Global) -> Result<Exit, Failure> {
    let Some(file) = &args.sweep else { return merge(args, global) };
    let (sweep, own) = Sweep::open(file)?;
    Progress::new(global).warn_of_commas(&own);
    match args.run {
        Some(number) => repeat(number, &sweep, args, global),
        None => make(&sweep, &own, args, global),
    }
}

/// Makes all runs of a sweep or of a shard.
fn make(sweep: &Sweep, own: &Inputs, args: &SweepArgs, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let (k, n) = args.shard.unwrap_or((1, 1));
    if n > sweep.count {
        let fault = Fault::new(&Place::root(), format!("has {} runs, too few for {n} shards", sweep.count));
        return Err(Failure::Input(own.all()[0].source()?.diagnose(&Faults(vec![fault]))));
    }
    let plan = RunPlan::new(sweep);
    let wanted: Vec<usize> = (k..=sweep.count).step_by(n).collect();
    let inputs = InputEntry::all(own).into_iter().chain(InputEntry::all(sweep.target.inputs())).collect();
    let key = key(&inputs, args.shard);
    let path = args.output.clone().unwrap_or_else(|| default_folder(sweep, args.shard));
    let planned = PlannedFiles { names: names(args.shard.is_some()), plots: Vec::new() };
    let folder = OutputFolder::open(&path, "sweep", args.force, &planned)?;

    let runner = Runner::new(sweep);
    let info = {
        let _stage = progress.stage("running the input as it is written");
        as_written(sweep, own, &runner)?
    };
    let (mut rows, mut records) = SweepRows::open(&path, &key, args.force)?;
    if !records.is_empty() {
        progress.say(&format!("resumes after {} of {} runs", records.len(), wanted.len()));
    }
    let made: BTreeSet<usize> = records.iter().map(|record| record.run).collect();
    let left: Vec<usize> = wanted.iter().copied().filter(|run| !made.contains(run)).collect();
    let bar = progress.bar("runs", left.len() as u64);
    let mut failed = None;
    let work = |run: &usize| {
        let axes = plan.values(*run);
        let outcome = runner.run(&axes);
        RunRecord { run: *run, axes, outcome }
    };
    let mut done = 0;
    parallel_stream(&left, global.threads, work, |_, record| {
        if let Err(error) = rows.add(&record) {
            failed = Some(error);
            return false;
        }
        records.push(record);
        done += 1;
        bar.set(done);
        true
    });
    drop(bar);
    if let Some(error) = failed {
        return Err(error);
    }
    records.sort_by_key(|record| record.run);
    let shard =
        args.shard.map(|(shard, of)| Shard { key: key_of_all(&inputs), shard, of, info: info.clone() });
    let written = write(folder, (&info, sweep.pointers()), inputs, records, shard.as_ref(), global);
    rows.remove();
    written
}

/// The description of a sweep, for which its input is run as it is written.
fn as_written(sweep: &Sweep, own: &Inputs, runner: &Runner<'_>) -> Result<SweepInfo, Failure> {
    let file = &own.all()[0];
    match runner.run_as_written() {
        Ok((units, row)) => Ok(SweepInfo::new(sweep, &file.name, units, &row)),
        Err(RunFailure::Missing(result, why)) => {
            let root = Place::root();
            let results = root.key("results");
            let fault = Fault::new(&results.index(result), why);
            Err(Failure::Input(file.source()?.diagnose(&Faults(vec![fault]))))
        }
        Err(RunFailure::Failed(why)) => {
            Err(Failure::Untrusted(format!("{} cannot be run as it is written: {why}", sweep.input.file())))
        }
    }
}

/// Writes the results of runs, in the order of their numbers, into a folder.
fn write(
    mut folder: OutputFolder,
    (info, axes): (&SweepInfo, Vec<String>),
    inputs: Vec<InputEntry>,
    records: Vec<RunRecord>,
    shard: Option<&Shard>,
    global: Global,
) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    if let Some(shard) = shard {
        let mut lines = RecordLines::default();
        folder.add(ROWS, records.iter().map(|record| lines.lines(record)).collect::<String>());
        folder.add(SHARD, output::json(&shard.json(&inputs)));
    }
    let table = ResultTable::new(axes, records);
    folder.add("results.csv", table.csv().map_err(Failure::untrusted)?);
    #[cfg(feature = "parquet")]
    folder.add("results.parquet", sweep::parquet(&table).map_err(Failure::untrusted)?);
    folder.add("failures.csv", table.failures_csv().map_err(Failure::untrusted)?);
    let summary = sweep::summary(info, &table);
    folder.add("summary.json", output::json(&summary));
    let report = sweep_report(info, &table);
    folder.add("report.html", report.html(global.threads).map_err(Failure::untrusted)?);
    let written = folder.commit(Manifest::of_entries("sweep", inputs, json!({})))?;
    if let Some((run, _, why)) = table.failures.first() {
        let count = table.failures.len();
        let runs = if count == 1 { "run has" } else { "runs have" };
        progress.say(&format!("warning: {count} {runs} no results, see failures.csv; run {run}: {why}"));
    }
    progress.say(&format!("{} runs with results, {} without", table.rows.len(), table.failures.len()));
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let all = json!({ "output": written.display().to_string(), "summary": summary });
        output::print(&output::json(&all))?;
    }
    if table.rows.is_empty() {
        return Err(Failure::Untrusted("no run has results; failures.csv has the reasons".to_owned()));
    }
    Ok(Exit::Done)
}

/// Joins the folders of all shards of a sweep.
fn merge(args: &SweepArgs, global: Global) -> Result<Exit, Failure> {
    let path = args.output.as_ref().expect("the command line requires a folder beside --merge");
    let shards = read_shards(&args.merge)?;
    let planned = PlannedFiles { names: names(false), plots: Vec::new() };
    let folder = OutputFolder::open(path, "sweep", args.force, &planned)?;
    let info = shards.info;
    let axes = info.axes.iter().map(|[pointer, _]| pointer.clone()).collect();
    write(folder, (&info, axes), shards.inputs, shards.records, None, global)
}

/// Repeats one run with everything that `run` or `design` writes.
fn repeat(number: usize, sweep: &Sweep, args: &SweepArgs, global: Global) -> Result<Exit, Failure> {
    if number == 0 || number > sweep.count {
        let expected = format!("--run must be from 1 to {}, got {number}", sweep.count);
        return Err(formats::text::diagnostic::Diagnostic::of_file("command line", expected).into());
    }
    let values = RunPlan::new(sweep).values(number);
    let progress = Progress::new(global);
    for (axis, value) in sweep.axes.iter().zip(&values) {
        progress.say(&format!("{} = {value}", axis.pointer));
    }
    let inputs = Runner::new(sweep).inputs(&values);
    let folder = PathBuf::from("girderway-out").join(format!("{}-run-{number}", sweep.name));
    let path = args.output.clone().unwrap_or(folder);
    match &sweep.input {
        SweepInput::Scene(_) => {
            let document = Document::read_scene(inputs)?;
            commands::run::of_document("run", &document, &path, args.force, global)
        }
        SweepInput::Design(_) => {
            let (design, inputs) = Design::read(inputs)?;
            commands::design::of_design(&design, &inputs, &path, args.force, global).map(|_| Exit::Done)
        }
    }
}

/// Key of the runs of a sweep or shard: program version, files and shard.
fn key(inputs: &Vec<InputEntry>, shard: Option<(usize, usize)>) -> String {
    match shard {
        None => key_of_all(inputs),
        Some((k, n)) => format!("{} {k}/{n}", key_of_all(inputs)),
    }
}

/// Key of all runs of a sweep: program version and files.
fn key_of_all(inputs: &Vec<InputEntry>) -> String {
    sha256(json!([env!("CARGO_PKG_VERSION"), inputs]).to_string().as_bytes())
}

fn default_folder(sweep: &Sweep, shard: Option<(usize, usize)>) -> PathBuf {
    let name = match shard {
        None => format!("{}-sweep", sweep.name),
        Some((k, n)) => format!("{}-sweep-{k}-of-{n}", sweep.name),
    };
    Path::new("girderway-out").join(name)
}

fn names(is_shard: bool) -> Vec<String> {
    let shard: &[&str] = if is_shard { &[ROWS, SHARD] } else { &[] };
    FILES.iter().chain(shard).map(|name| (*name).to_owned()).collect()
}
