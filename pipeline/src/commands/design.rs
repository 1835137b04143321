//! `girderway design`: envelopes, extremes and reactions of wheel trains.

use std::path::{Path, PathBuf};

use serde_json::json;

use crate::cli::{DesignArgs, Global};
use crate::exit::{Exit, Failure};
use crate::folder::{OutputFolder, PlannedFiles};
use crate::manifest::Manifest;
use crate::output;
use crate::progress::Progress;
use design::{DesignError, DesignResult, LimitCheck};
use formats::design::Design;
use formats::text::inputs::Inputs;
use report::text::design_report::design_report;

/// Files that the command writes.
const FILES: [&str; 5] = ["envelope.csv", "reactions.csv", "influence.csv", "summary.json", "report.html"];

/// Reads and solves the design, and writes its tables, summary and report.
///
/// # Errors
/// The design or its spec is invalid, the structure is a mechanism, or a file cannot be written; with
/// `--fail-on-limit`, a limit that is exceeded, after the results are written.
pub fn run(args: &DesignArgs, global: Global) -> Result<Exit, Failure> {
    let (read, inputs) = Design::open(&args.design)?;
    Progress::new(global).warn_of_commas(&inputs);
    let folder = || PathBuf::from("girderway-out").join(format!("{}-design", read.name));
    let path = args.output.clone().unwrap_or_else(folder);
    let result = of_design(&read, &inputs, &path, args.force, global)?;
    let strained = result.stresses.iter().filter(|stress| stress.utilisation() > 1.0);
    let (limits, stresses) =
        (result.limits.iter().filter(|limit| !limit.within()).count(), strained.clone().count());
    if !args.fail_on_limit || result.within() {
        return Ok(Exit::Done);
    }
    let mut said = Vec::new();
    if limits > 0 {
        said.push(format!("{limits} limits are exceeded: {}", worst(&result.limits)));
    }
    let most = strained.max_by(|a, b| a.utilisation().total_cmp(&b.utilisation()));
    said.extend(most.map(|most| {
        let used = most.utilisation();
        let (quantity, rail) = (most.quantity, &most.rail);
        format!("{stresses} stresses exceed their strength: {quantity} of rail {rail}, {used:.3} of it")
    }));
    Err(Failure::Differs(said.join("; ")))
}

/// Solves a design that is read, and writes its tables, summary and report.
pub(super) fn of_design(
    read: &Design,
    inputs: &Inputs,
    path: &Path,
    force: bool,
    global: Global,
) -> Result<DesignResult, Failure> {
    let progress = Progress::new(global);
    let planned =
        PlannedFiles { names: FILES.iter().map(|name| (*name).to_owned()).collect(), plots: Vec::new() };
    let mut folder = OutputFolder::open(path, "design", force, &planned)?;
    let read = design::with_combinations(read);
    let failed = |error| match error {
        DesignError::Input(diagnostics) => Failure::Input(diagnostics),
        DesignError::NoSolution(why) => Failure::Untrusted(why),
    };
    let result = design::solve(&read, inputs).map_err(failed)?;
    let lines = design::governing_lines(&read, inputs, &result).map_err(failed)?;
    let summary = design::summary(&read, &result);
    folder.add("envelope.csv", design::envelope_csv(&read, &result).map_err(Failure::untrusted)?);
    folder.add("reactions.csv", design::reactions_csv(&result).map_err(Failure::untrusted)?);
    folder.add("influence.csv", design::influence_csv(&read, &lines).map_err(Failure::untrusted)?);
    folder.add("summary.json", output::json(&summary));
    let report = design_report(&read, &result, &lines);
    folder.add("report.html", report.html(global.threads).map_err(Failure::untrusted)?);
    let written = folder.commit(Manifest::new("design", inputs, json!({})))?;
    for warning in &result.warnings {
        progress.say(&format!("warning: {warning}"));
    }
    for note in &read.spec.notes {
        progress.say(&format!("note: {note}"));
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let all = json!({ "output": written.display().to_string(), "summary": summary });
        output::print(&output::json(&all))?;
    }
    Ok(result)
}

/// The limit that is exceeded most, in words.
fn worst(limits: &[LimitCheck]) -> String {
    let ratio = |limit: &&LimitCheck| limit.value.abs() / limit.limit;
    let found = limits.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    found.map_or_else(String::new, |limit| {
        format!(
            "{} of rail {}, span {}: {:.3} of its limit ({})",
            limit.quantity,
            limit.rail,
            limit.span,
            ratio(&limit),
            limit.clause.standard
        )
    })
}
