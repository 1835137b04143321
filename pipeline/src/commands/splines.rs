//! `girderway splines`: conversion of a grid, or of a file of tables, to tables in another format.

use adams::SplineValues;
use serde_json::{Map, Value, json};
use splines::ExactSurface;

use super::factored::factored;
use super::{check_tables, fewest};
use crate::cli::{Global, SplinesArgs, TableFormArg};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::grid::file as grid_file;
use formats::grid::{GridRail, StationGrid};
use formats::tables::{self, TableFormat, TableSet};
use formats::text::diagnostic::Diagnostic;
use formats::text::fault::{Fault, Faults};
use formats::text::inputs::{Input, Inputs};
use formats::text::place::Place;
use formats::units::Units;
use outputs::files::json as json_text;
use study::table_quality::TableReadingMethod;

/// Reads a grid or tables and writes tables, to a file in the format of its extension or to standard output as an
/// ADAMS data set.
///
/// # Errors
/// The input is invalid, the file extension is unknown, the tables have no factored form, or the file cannot be
/// written.
pub fn run(args: &SplinesArgs, global: Global) -> Result<Exit, Failure> {
    if args.check {
        return check_tables::run(args, global);
    }
    fits(args)?;
    let format = match &args.output {
        Some(path) => TableFormat::of(&path.display().to_string()).map_err(|fault| *fault)?,
        None => TableFormat::Adams,
    };
    let progress = Progress::new(global);
    let inputs = Inputs::open_bytes(&args.grid).map_err(|fault| *fault)?;
    let input = &inputs.all()[0];
    let mut summary = Map::new();
    let (mut set, exact) = given(args, input, &progress, &mut summary)?;
    if set.tables.is_empty() {
        progress.say(&format!("warning: {} has no tables", input.display_name));
    }
    if !args.only.is_empty() {
        let directions: Vec<_> = args
            .only
            .iter()
            .map(|direction| (*direction).into())
            .collect();
        set = tables::select(&set, &directions);
        if set.tables.is_empty() {
            let fault =
                Diagnostic::of_file(&input.display_name, "has no table of these directions");
            return Err(fault
                .hint("a table's direction is known from a grid, or from the end of its name")
                .into());
        }
    }
    match args.form {
        Some(TableFormArg::Table) => set = tables::expand(&set),
        Some(TableFormArg::Factored) => {
            set = factored(args, &set, exact.as_ref(), input, &progress, &mut summary)?
        }
        None => {}
    }
    if let Some(digits) = args.digits {
        let refused =
            |why: tables::RoundError| Diagnostic::of_file(&input.display_name, why.to_string());
        let (rounded, rounding) = tables::round(&set, usize::from(digits)).map_err(refused)?;
        progress.say(&rounding.message());
        summary.insert("rounding".into(), rounding.json());
        set = rounded;
    }
    let bytes = tables::write(&set, format)?;
    output::deliver_bytes(args.output.as_deref(), &bytes, &progress)?;
    if let Some(path) = args.output.as_ref().filter(|_| global.json) {
        summary.insert("output".into(), json!(path.display().to_string()));
        summary.insert("tables".into(), json!(set.tables.len()));
        output::print(&json_text(&Value::Object(summary)))?;
    }
    Ok(Exit::Done)
}

/// Rejects flags that cannot be combined.
fn fits(args: &SplinesArgs) -> Result<(), Failure> {
    let factored = args.form == Some(TableFormArg::Factored);
    let wrong = if args.tolerance.is_some() && args.reading.is_none() && !factored {
        "--tolerance requires --reading, --check or --form factored"
    } else if args.rank.is_some() && !factored {
        "--rank requires --form factored"
    } else if args.rank.is_some() && args.tolerance.is_some() && args.reading.is_none() {
        "--rank and --tolerance cannot be used together without --reading: both set the number of products"
    } else {
        return Ok(());
    };
    Err(Diagnostic::of_file("command line", wrong).into())
}

/// The tables of the input, and the exact surface with its rails if the input is a grid that has one.
type Given = (TableSet, Option<(ExactSurface, Vec<GridRail>)>);

fn given(
    args: &SplinesArgs,
    input: &Input,
    progress: &Progress,
    told_more: &mut Map<String, Value>,
) -> Result<Given, Failure> {
    let units = args.length.zip(args.force);
    let units = units.map(|(length, force)| Units {
        length: length.into(),
        force: force.into(),
    });
    if tables::is_tables(&input.display_name, &input.bytes) {
        if args.reading.is_some() {
            let fault = Diagnostic::of_file(
                &input.display_name,
                "contains no exact influence function between its stations",
            );
            return Err(fault
                .hint("--reading and --tolerance need a grid file")
                .into());
        }
        let set = tables::read(&input.display_name, &input.bytes, units)?;
        if let Some(message) = set.left_out_message() {
            progress.say(&format!("warning: {}: {message}", input.display_name));
        }
        return Ok((set, None));
    }
    let source = input.source()?;
    let (mut grid, surface) = grid_file::read(&source)?;
    if units.is_some_and(|units| units != grid.units) {
        let fault = Diagnostic::of_file(&input.display_name, "a grid already states its units");
        return Err(fault.hint("leave out --length and --force").into());
    }
    if let Some(wanted) = args
        .reading
        .map(TableReadingMethod::from)
        .zip(args.tolerance)
    {
        grid = fewest::chosen(
            args,
            wanted,
            &source,
            (&grid, surface.as_ref()),
            progress,
            told_more,
        )?;
    }
    for rail in grid
        .rails
        .iter()
        .filter(|rail| rail.stations.len() < SplineValues::MIN_POINTS)
    {
        progress.say(&format!(
            "note: rail {} has fewer than four stations; its tables are omitted",
            rail.name
        ));
    }
    let set = TableSet::of_grid(&grid);
    if set.tables.is_empty() {
        let root = Place::root();
        let fault = Fault::new(
            &root.key("rails"),
            "must have a rail of at least four stations",
        );
        let fault = fault.hint("a SPLINE needs at least four x values");
        return Err(Failure::Input(source.diagnose(&Faults(vec![fault]))));
    }
    let StationGrid { rails, .. } = grid;
    Ok((set, surface.map(|surface| (surface, rails))))
}
