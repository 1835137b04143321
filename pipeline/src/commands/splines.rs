//! `girderway splines`: the tables of a grid.

use std::path::Path;

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
    let (_, source) = Inputs::open(&args.grid).map_err(|error| Failure::from(*error))?;
    let grid = grid_file::read(&source)?;
    let refuse = |error: splines::Error| {
        let root = Place::root();
        let fault = Fault::new(&root.key("rails"), error.to_string());
        Failure::Input(source.diagnose(&Faults(vec![fault.hint("a SPLINE has four x values or more")])))
    };
    let set = tables::data_set(&grid).map_err(refuse)?;
    let text = match format {
        Format::Adams => splines::adams::write(&set).map_err(refuse)?,
        Format::Json => tables::to_json(&grid, &set),
        Format::Csv => tables::to_csv(&set),
    };
    match &args.output {
        Some(path) => {
            output::write(path, text.as_bytes())?;
            Progress::new(global).say(&format!("wrote {}", path.display()));
        }
        None => output::print(&text)?,
    }
    Ok(Exit::Done)
}

#[derive(Clone, Copy, Debug)]
enum Format {
    Adams,
    Json,
    Csv,
}

fn format(path: &Path) -> Result<Format, Diagnostic> {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
    let refuse = |expected: String| {
        Err(Diagnostic::of_file(path.display().to_string(), expected).hint("use .adm, .json or .csv"))
    };
    match ending.as_str() {
        "adm" => Ok(Format::Adams),
        "json" => Ok(Format::Json),
        "csv" => Ok(Format::Csv),
        "cmd" | "npz" => refuse(format!("the format .{ending} is not available in this version")),
        _ => refuse("the ending says no format".to_owned()),
    }
}
