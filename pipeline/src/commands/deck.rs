//! `girderway deck`: a scene as an ADAMS data set.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::run::solve_all;
use crate::cases::specs;
use crate::cli::{Deck as Arguments, Global};
use crate::deck::check::{self, COMPONENTS, Report};
use crate::deck::{self, Form};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use crate::scene::Document;

/// Writes the data set to the file named, with its command file beside it, or to standard output.
///
/// # Errors
/// What is wrong with the scene or its files; a foundation that a deck cannot have; a scene that cannot start.
pub fn run(args: &Arguments, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let document = Document::open(&args.scene)?;
    let scene = document.scene();
    let only = Document { cases: document.cases[..1].to_vec(), inputs: document.inputs.clone() };
    let known = solve_all(&document, &specs(&only), &progress)?;
    let form = args
        .form
        .unwrap_or_else(|| Form::of_readings(scene.structures.iter().map(|structure| structure.reading)));
    let file = args.scene.display().to_string();
    let plan = deck::plan(scene, &known, form, &file)?;
    let model = args.output.as_deref().map_or_else(|| scene.name.clone(), stem);
    let deck = deck::deck(&plan, &known, &model)?;
    let text = deck.set.write().map_err(Failure::untrusted)?;
    output::deliver(args.output.as_deref(), &text, &progress)?;
    if let Some(path) = &args.output {
        output::deliver(Some(&command_file(path)), &deck.commands, &progress)?;
    }
    if !args.check {
        return Ok(Exit::Done);
    }
    let stage = progress.stage("executing the deck");
    let report = check::check(&plan, &text, args.states as usize)?;
    drop(stage);
    for line in told(&report) {
        progress.say(&line);
    }
    if global.json {
        output::print(&output::json(&value(&report)))?;
    }
    if report.holds() { Ok(Exit::Done) } else { Err(Failure::Differs("the deck differs from the simulator".to_owned())) }
}

/// The report as a table.
fn told(report: &Report) -> Vec<String> {
    let mut lines = vec![format!(
        "{:<34} {:>7} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8}",
        "largest difference / largest force", "states", "FX", "FY", "FZ", "TX", "TZ", "asked"
    )];
    for row in &report.forces {
        let [fx, fy, fz, tx, _, tz] = row.worst;
        let asked = row.asked.map_or_else(|| "-".to_owned(), |asked| format!("{asked:.0e}"));
        lines.push(format!(
            "{:<34} {:>7} {fx:>9.1e} {fy:>9.1e} {fz:>9.1e} {tx:>9.1e} {tz:>9.1e} {asked:>8}",
            row.what, row.states
        ));
        if let Some((why, count)) = &row.failed {
            lines.push(format!("  no forces at {count} of them: {why}"));
        }
    }
    lines
}

/// The report for machines.
fn value(report: &Report) -> Value {
    let rows: Vec<Value> = report
        .forces
        .iter()
        .map(|row| {
            let worst: serde_json::Map<String, Value> =
                COMPONENTS.iter().zip(row.worst).map(|(name, worst)| ((*name).to_owned(), json!(worst))).collect();
            json!({
                "what": row.what, "states": row.states, "asked": row.asked, "difference": worst,
                "largest_force": row.largest, "failed": row.failed.as_ref().map(|(why, count)| json!({ "why": why, "count": count })),
                "holds": row.holds(),
            })
        })
        .collect();
    json!({ "format": "girderway-deck-check/1", "holds": report.holds(), "forces": rows })
}

fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(|| "model".to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// The command file beside a data set.
fn command_file(path: &Path) -> PathBuf {
    path.with_extension("acf")
}
