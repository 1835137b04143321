//! `girderway splines`: the tables of a grid.

use std::path::Path;

use adams::Curves;
use splines::{Axis, Surface};

use super::check_tables;
use crate::appraisal::Manner;
use crate::cli::{Global, Splines};
use crate::crosscheck::Quantity;
use crate::diagnostic::Diagnostic;
use crate::exit::{Exit, Failure};
use crate::fault::{Fault, Faults};
use crate::grid::{self, Grid};
use crate::grid_file;
use crate::inputs::Inputs;
use crate::output;
use crate::place::Place;
use crate::progress::Progress;
use crate::source::Source;
use crate::stations::{self, Goal};
use crate::tables;

/// Reads the grid, writes its tables in the format of the file's ending, as an ADAMS data set to standard output.
///
/// # Errors
/// What is wrong with the grid; an ending without a format; a file that cannot be written.
pub fn run(args: &Splines, global: Global) -> Result<Exit, Failure> {
    if args.check {
        return check_tables::run(args, global);
    }
    if args.tolerance.is_some() && args.reading.is_none() {
        let wrong = Diagnostic::of_file("command line", "--tolerance is that of a reading");
        return Err(wrong.hint("add --reading akispl, or --check").into());
    }
    let format = args.output.as_deref().map_or(Ok(Format::Adams), format)?;
    let (_, source) = Inputs::open(&args.grid)?;
    let (mut grid, surface) = grid_file::read(&source)?;
    let progress = Progress::new(global);
    if let (Some(manner), Some(tolerance)) = (args.reading, args.tolerance) {
        grid = chosen(args, (manner, tolerance), &source, (&grid, surface), global)?;
    }
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

/// The grid at the fewest stations that keep the tolerance, told on standard error, with `--json` on standard output
/// where the tables go to a file.
fn chosen(
    args: &Splines,
    (manner, tolerance): (Manner, f64),
    source: &Source,
    (grid, surface): (&Grid, Option<Surface>),
    global: Global,
) -> Result<Grid, Failure> {
    let root = Place::root();
    let refuse = |fault: Fault| Failure::Input(source.diagnose(&Faults(vec![fault])));
    let Some(surface) = surface else {
        let fault = Fault::new(&root, "has no `surface`: nothing says what is exact between its stations");
        return Err(refuse(fault.hint("`girderway fea SPEC -o GRID.json` writes one")));
    };
    let mut axes: Vec<Axis> = args.directions.iter().map(|direction| Axis::from(*direction)).collect();
    axes.sort_unstable();
    axes.dedup();
    if axes.is_empty() {
        axes = if manner == Manner::Exact { vec![Axis::Vertical] } else { stations::usual(grid) };
    }
    for axis in &axes {
        let direct = Quantity::ALL.into_iter().find(|quantity| grid::axes(*quantity) == (*axis, *axis));
        if direct.is_none_or(|quantity| grid.block(quantity).is_none()) {
            let wrong = format!("has no {} grid", stations::word(*axis));
            return Err(refuse(Fault::new(&root.key("influence"), wrong)));
        }
    }
    let goal = Goal { manner, tolerance, axes };
    let progress = Progress::new(global);
    let stage = progress.stage("stations");
    let found = stations::choose(grid, &surface, &goal);
    drop(stage);
    let choice = found.map_err(|error| match error {
        splines::Error::Stations { most, error } => Failure::Differs(format!(
            "{} errs by {error:.2e} with {most} stations, the most: where shear, torsion or axial force give, every \
             reading of values alone errs in proportion to the distance of stations; allow more, take another reading, or \
             name the directions that matter with --directions",
            manner.word()
        )),
        splines::Error::Unliftable => refuse(
            Fault::new(&root.key("influence"), "is not that of a uniform beam in bending on rigid supports")
                .hint("the values alone do not say what is exact between them; this file does, use it in place of tables"),
        ),
        other => refuse(Fault::new(&root.key("surface"), other.to_string())),
    })?;
    for line in choice.lines(&goal) {
        progress.say(&line);
    }
    if global.json && args.output.is_some() {
        output::print(&output::json(&choice.json(&goal)))?;
    }
    Ok(choice.grid)
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
