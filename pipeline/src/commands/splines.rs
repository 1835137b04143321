//! `girderway splines`: the tables of a grid.

use std::path::Path;

use adams::Curves;

use crate::cli::{Global, Splines};
use crate::diagnostic::Diagnostic;
use crate::exit::{Exit, Failure};
use crate::fault::{Fault, Faults};
use crate::grid_file;
use crate::inputs::Inputs;
use crate::output;
use crate::place::Place;
use crate::progress::Progress;
use crate::tables;

/// Reads the grid, writes its tables in the format of the file's ending, as an ADAMS data set to standard output.
///
/// # Errors
/// What is wrong with the grid; an ending without a format; a file that cannot be written.
pub fn run(args: &Splines, global: Global) -> Result<Exit, Failure> {
    let format = args.output.as_deref().map_or(Ok(Format::Adams), format)?;
    let (_, source) = Inputs::open(&args.grid)?;
    let (grid, _) = grid_file::read(&source)?;
    let progress = Progress::new(global);
    for rail in grid.rails.iter().filter(|rail| rail.stations.len() < Curves::LEAST) {
        progress
            .say(&format!("note: no tables of loads on rail {}: it has fewer than four stations", rail.name));
    }
    let set = tables::data_set(&grid);
    if set.splines.is_empty() {
        let root = Place::root();
        let fault = Fault::new(&root.key("rails"), "must have a rail of at least four stations");
        let fault = fault.hint("a SPLINE has four x values or more");
        return Err(Failure::Input(source.diagnose(&Faults(vec![fault]))));
    }
    let text = match format {
        Format::Adams => adams::tables::write(&set).map_err(Failure::untrusted)?,
        Format::Json => tables::to_json(&grid, &set),
        Format::Csv => tables::to_csv(&set),
    };
    output::deliver(args.output.as_deref(), &text, &progress)?;
    Ok(Exit::Done)
}

#[derive(Clone, Copy, Debug)]
enum Format {
    Adams,
    Json,
    Csv,
}

fn format(path: &Path) -> Result<Format, Failure> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let refuse = |expected: String| {
        Err(Diagnostic::of_file(path.display().to_string(), expected).hint("use .adm, .json or .csv").into())
    };
    match ending.as_str() {
        "adm" => Ok(Format::Adams),
        "json" => Ok(Format::Json),
        "csv" => Ok(Format::Csv),
        "cmd" | "npz" => refuse(format!("the format .{ending} is not available in this version")),
        _ => refuse("the ending says no format".to_owned()),
    }
}
