//! `girderway design`: envelopes, extremes and reactions of wheel trains.

use std::path::{Path, PathBuf};

use serde_json::json;

use crate::cli::{DesignArgs, Global};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use design::LimitCheck;
use formats::design::Design;
use formats::text::inputs::Inputs;
use outputs::design_files::{SolvedDesign, open_design_folder};
use outputs::files::json as json_text;

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
    let SolvedDesign { result, .. } = of_design(&read, inputs, &path, args.force, global)?;
    let strained = result
        .stresses
        .iter()
        .filter(|stress| stress.utilisation() > 1.0);
    let (limits, stresses) = (
        result.limits.iter().filter(|limit| !limit.within()).count(),
        strained.clone().count(),
    );
    if !args.fail_on_limit || result.within() {
        return Ok(Exit::Done);
    }
    let mut said = Vec::new();
    if limits > 0 {
        let count = if limits == 1 { "limit" } else { "limits" };
        said.push(format!(
            "{limits} {count} exceeded; largest utilisation: {}",
            worst(&result.limits)
        ));
    }
    let most = strained.max_by(|a, b| a.utilisation().total_cmp(&b.utilisation()));
    said.extend(most.map(|most| {
        let used = most.utilisation();
        let (quantity, rail) = (most.quantity, &most.rail);
        let count = if stresses == 1 {
            "stress exceeds"
        } else {
            "stresses exceed"
        };
        format!(
            "{stresses} {count} the strength; largest utilisation: {quantity} of rail {rail}, {used:.3}"
        )
    }));
    Err(Failure::Differs(said.join("; ")))
}

/// Solves a design that is read, and writes its files into a folder.
pub(super) fn of_design(
    read: &Design,
    inputs: Inputs,
    path: &Path,
    force: bool,
    global: Global,
) -> Result<SolvedDesign, Failure> {
    let progress = Progress::new(global);
    let folder = open_design_folder(path, force)?;
    let solved = SolvedDesign::of(read, inputs)?;
    let written = solved.write(folder, global.threads)?;
    let SolvedDesign {
        design: read,
        result,
        ..
    } = &solved;
    for warning in &result.warnings {
        progress.say(&format!("warning: {warning}"));
    }
    for note in &read.spec.notes {
        progress.say(&format!("note: {note}"));
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let all = json!({ "output": written.display().to_string(), "summary": solved.summary() });
        output::print(&json_text(&all))?;
    }
    Ok(solved)
}

/// The limit that is exceeded most, in words.
fn worst(limits: &[LimitCheck]) -> String {
    let ratio = |limit: &&LimitCheck| limit.value.abs() / limit.limit;
    let found = limits.iter().max_by(|a, b| ratio(a).total_cmp(&ratio(b)));
    found.map_or_else(String::new, |limit| {
        format!(
            "{} of rail {}, span {}: {:.3} ({})",
            limit.quantity,
            limit.rail,
            limit.span,
            ratio(&limit),
            limit.clause.standard
        )
    })
}
