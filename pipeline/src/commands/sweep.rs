//! `girderway sweep`: many runs of a scene or design, whole, in shards, and joined.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use serde_json::json;
use sweep::{RunPlan, Runner};

use crate::cli::{Global, SweepArgs};
use crate::commands;
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::sweep::{Sweep, SweepInput};
use formats::text::diagnostic::Diagnostic;
use outputs::files::json as json_text;
use outputs::sweep_files::{SweepProgress, WrittenSweep, join_shards, make_sweep};

/// Runs a sweep, one of its shards or one of its runs, or joins shards.
///
/// # Errors
/// The sweep or a file of it is invalid, its input cannot be run as it is written, shards do not belong together, a file
/// cannot be written, or no run has results.
pub fn run(args: &SweepArgs, global: Global) -> Result<Exit, Failure> {
    let Some(file) = &args.sweep else {
        let path = args
            .output
            .as_ref()
            .expect("the command line requires a folder beside --merge");
        let written = join_shards(&args.merge, path, args.force, global.threads)?;
        return report(&written, global);
    };
    let progress = Progress::new(global);
    let (sweep, own) = Sweep::open(file)?;
    progress.warn_of_commas(&own);
    if let Some(number) = args.run {
        return repeat(number, &sweep, args, global);
    }
    let path = args
        .output
        .clone()
        .unwrap_or_else(|| default_folder(&sweep, args.shard));
    let bar = progress.bar("runs", sweep.count as u64);
    let mut observed = |now: SweepProgress| {
        match now {
            SweepProgress::Resumed(made, all) => {
                progress.say(&format!("resuming: {made} of {all} runs are finished"))
            }
            SweepProgress::Made(made, all) => bar.set_of(made as u64, all as u64),
        }
        ControlFlow::Continue(())
    };
    // Ctrl-C ends the process
    let go_on = || ControlFlow::Continue(());
    let written = make_sweep(
        (&sweep, &own),
        args.shard,
        (&path, args.force),
        global.threads,
        &mut observed,
        &go_on,
    )?;
    drop(bar);
    report(&written, global)
}

/// Says what was written.
fn report(written: &WrittenSweep, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    if let Some((run, why)) = written.failures.first() {
        let count = written.failures.len();
        let runs = if count == 1 { "run" } else { "runs" };
        progress.say(&format!(
            "warning: {count} {runs} failed, see failures.csv; first failure: run {run}: {why}"
        ));
    }
    progress.say(&format!(
        "{} runs finished, {} failed",
        written.rows,
        written.failures.len()
    ));
    progress.say(&format!("wrote {}", written.folder.display()));
    if global.json {
        let all =
            json!({ "output": written.folder.display().to_string(), "summary": written.summary });
        output::print(&json_text(&all))?;
    }
    if written.rows == 0 {
        return Err(Failure::Untrusted(
            "all runs failed; failures.csv lists the reasons".to_owned(),
        ));
    }
    Ok(Exit::Done)
}

/// Repeats one run with everything that `run` or `design` writes.
fn repeat(number: usize, sweep: &Sweep, args: &SweepArgs, global: Global) -> Result<Exit, Failure> {
    if number == 0 || number > sweep.count {
        let expected = format!("--run must be from 1 to {}, got {number}", sweep.count);
        return Err(Diagnostic::of_file("command line", expected).into());
    }
    let values = RunPlan::new(sweep).values(number);
    let progress = Progress::new(global);
    for (axis, value) in sweep.axes.iter().zip(&values) {
        progress.say(&format!("{} = {value}", axis.pointer));
    }
    let runner = Runner::new(sweep);
    let folder = PathBuf::from("girderway-out").join(format!("{}-run-{number}", sweep.name));
    let path = args.output.clone().unwrap_or(folder);
    match &sweep.input {
        SweepInput::Scene(_) => {
            commands::run::of_document(runner.scene(&values)?, &path, args.force, global)
        }
        SweepInput::Design(_) => {
            let (design, inputs) = runner.design(&values)?;
            commands::design::of_design(&design, inputs, &path, args.force, global)
                .map(|_| Exit::Done)
        }
    }
}

fn default_folder(sweep: &Sweep, shard: Option<(usize, usize)>) -> PathBuf {
    let name = match shard {
        None => format!("{}-sweep", sweep.name),
        Some((k, n)) => format!("{}-sweep-{k}-of-{n}", sweep.name),
    };
    Path::new("girderway-out").join(name)
}
