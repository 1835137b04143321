//! `girderway schema`: the JSON Schema of a format.

use crate::cli::{Global, SchemaArg, SchemaArgs};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::schema;
use outputs::files::json as json_text;

/// Writes the schema to the named file or to standard output.
///
/// # Errors
/// The file cannot be written.
pub fn run(args: &SchemaArgs, global: Global) -> Result<Exit, Failure> {
    let schema = match args.format {
        SchemaArg::Beam => schema::beam(),
        SchemaArg::Grid => schema::grid(),
        SchemaArg::Scene => schema::scene(),
        SchemaArg::Design => schema::design(),
        SchemaArg::Sweep => schema::sweep(),
        SchemaArg::Summary => results::summary::schema(),
        SchemaArg::DesignSummary => design::summary_schema(),
    };
    output::deliver(
        args.output.as_deref(),
        &json_text(&schema),
        &Progress::new(global),
    )?;
    Ok(Exit::Done)
}
