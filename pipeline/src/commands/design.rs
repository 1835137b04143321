//! `girderway design`: envelopes, extremes and reactions of wheel trains.

use std::path::{Path, PathBuf};

use serde_json::json;

use crate::cli::{DesignArgs, Global};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use crate::verdict;
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
    let solved = of_design(&read, inputs, &path, args.force, global)?;
    verdict::exit(&solved.verdict(), args.fail_on_limit)
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
    for line in report::verdict_lines(&solved.verdict(), read.units) {
        progress.say(&line);
    }
    progress.say(&format!("wrote {}", written.display()));
    if global.json {
        let all = json!({ "output": written.display().to_string(), "summary": solved.summary() });
        output::print(&json_text(&all))?;
    }
    Ok(solved)
}
