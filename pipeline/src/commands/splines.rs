//! `girderway splines`: the tables of a grid, or of a file of tables, in another format.

use adams::Curves;
use serde_json::{Map, Value, json};
use splines::{Rank, Surface};

use crate::cli::{Form, Global, Splines};
use crate::diagnostic::Diagnostic;
use crate::exit::{Exit, Failure};
use crate::fault::{Fault, Faults};
use crate::grid::{Grid, GridRail};
use crate::grid_file;
use crate::inputs::{Input, Inputs};
use crate::output;
use crate::place::Place;
use crate::progress::Progress;
use crate::tables::{self, Format, TableSet};
use crate::units::Units;

/// Reads a grid or tables, writes the tables in the format of the file's ending, as an ADAMS data set to
/// standard output.
///
/// # Errors
/// What is wrong with the input; an ending without a format; tables without a factored form; a file that cannot
/// be written.
pub fn run(args: &Splines, global: Global) -> Result<Exit, Failure> {
    let format = match &args.output {
        Some(path) => Format::of(&path.display().to_string()).map_err(|fault| *fault)?,
        None => Format::Adams,
    };
    if args.form != Some(Form::Factored) && (args.rank.is_some() || args.tolerance.is_some()) {
        let fault = Diagnostic::of_file("girderway", "--rank and --tolerance are of the factored form");
        return Err(fault.hint("add --form factored").into());
    }
    let progress = Progress::new(global);
    let inputs = Inputs::open_bytes(&args.grid).map_err(|fault| *fault)?;
    let input = &inputs.all()[0];
    let mut told = Map::new();
    let (mut set, exact) = given(args, input, &progress)?;
    if !args.directions.is_empty() {
        set = tables::only(&set, &args.directions);
        if set.tables.is_empty() {
            let fault = Diagnostic::of_file(&input.shown, "has no table of these directions");
            return Err(fault
                .hint("a table's direction is known from a grid, or from the end of its name")
                .into());
        }
    }
    match args.form {
        Some(Form::Table) => set = tables::expand(&set),
        Some(Form::Factored) => set = factored(args, &set, exact.as_ref(), input, &progress, &mut told)?,
        None => {}
    }
    if let Some(digits) = args.digits {
        let refused = |why: tables::Unrounded| Diagnostic::of_file(&input.shown, why.to_string());
        let (rounded, rounding) = tables::round(&set, usize::from(digits)).map_err(refused)?;
        progress.say(&rounding.message());
        told.insert("rounding".into(), rounding.json());
        set = rounded;
    }
    let bytes = tables::write(&set, format)?;
    output::deliver_bytes(args.output.as_deref(), &bytes, &progress)?;
    if let Some(path) = args.output.as_ref().filter(|_| global.json) {
        told.insert("output".into(), json!(path.display().to_string()));
        told.insert("tables".into(), json!(set.tables.len()));
        output::print(&output::json(&Value::Object(told)))?;
    }
    Ok(Exit::Done)
}

/// The tables asked for; the exact surface of a grid that has one.
type Given = (TableSet, Option<(Surface, Vec<GridRail>)>);

fn given(args: &Splines, input: &Input, progress: &Progress) -> Result<Given, Failure> {
    let told = args.length.zip(args.force);
    let told = told.map(|(length, force)| Units { length: length.into(), force: force.into() });
    if tables::is_tables(&input.shown, &input.bytes) {
        return Ok((tables::read(&input.shown, &input.bytes, told)?, None));
    }
    let source = input.source()?;
    let (grid, surface) = grid_file::read(&source)?;
    if told.is_some_and(|told| told != grid.units) {
        let fault = Diagnostic::of_file(&input.shown, "a grid says its units itself");
        return Err(fault.hint("leave out --length and --force").into());
    }
    for rail in grid.rails.iter().filter(|rail| rail.stations.len() < Curves::LEAST) {
        progress
            .say(&format!("note: no tables of loads on rail {}: it has fewer than four stations", rail.name));
    }
    let set = TableSet::of_grid(&grid);
    if set.tables.is_empty() {
        let root = Place::root();
        let fault = Fault::new(&root.key("rails"), "must have a rail of at least four stations");
        let fault = fault.hint("a SPLINE has four x values or more");
        return Err(Failure::Input(source.diagnose(&Faults(vec![fault]))));
    }
    let Grid { rails, .. } = grid;
    Ok((set, surface.map(|surface| (surface, rails))))
}

fn factored(
    args: &Splines,
    set: &TableSet,
    exact: Option<&(Surface, Vec<GridRail>)>,
    input: &Input,
    progress: &Progress,
    told: &mut Map<String, Value>,
) -> Result<TableSet, Failure> {
    let rank = match (args.rank, args.tolerance) {
        (Some(rank), _) => Rank::Count(usize::from(rank)),
        (None, Some(tolerance)) => Rank::Tolerance(tolerance),
        (None, None) => Rank::Full,
    };
    let refused = |why: tables::Unfactored| {
        Failure::from(Diagnostic::of_file(&input.shown, format!("has no factored form: {why}")))
    };
    let factoring = tables::factor(&tables::expand(set), rank).map_err(refused)?;
    for id in &factoring.skipped {
        progress.say(&format!("note: SPLINE/{id} is left out: it is zero, or has fewer than four stations"));
    }
    let ranks: Vec<String> = factoring.ranks.iter().map(|[kept, of]| format!("{kept} of {of}")).collect();
    progress.say(&format!("factored form: {} products", ranks.join(", ")));
    progress.say(&format!("  error at the stations: {}", factoring.stations.message()));
    let between = exact.and_then(|(surface, rails)| factoring.against(surface, rails));
    match &between {
        Some(found) => progress.say(&format!("  error against the exact surface: {}", found.message())),
        None => {
            progress.say("  error between the stations: not known without the exact surface of a grid file")
        }
    }
    let ranks: Vec<Value> =
        factoring.ranks.iter().map(|[kept, of]| json!({ "kept": kept, "of": of })).collect();
    let between = between.map(|found| found.json());
    let object =
        json!({ "ranks": ranks, "at_stations": factoring.stations.json(), "against_surface": between });
    told.insert("factored".into(), object);
    Ok(factoring.set)
}
