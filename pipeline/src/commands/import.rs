//! `girderway import`: a model of another program as a beam spec.

use std::io::ErrorKind;

use crate::cli::{Global, ImportArgs};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::{Inputs, read_file};
use import::{ImportOptions, import};

/// Reads the model and writes the beam spec to the named file or to standard output. Warnings, for example of
/// omitted parts, are printed to standard error.
///
/// # Errors
/// The model or a flag is invalid, or the file cannot be written.
pub fn run(args: &ImportArgs, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    // a name mistyped is reported before flags that are missing for the file
    if args
        .model
        .metadata()
        .is_err_and(|error| error.kind() == ErrorKind::NotFound)
    {
        return Err(Diagnostic::of_file(
            args.model.display().to_string(),
            "cannot be read: no such file",
        )
        .into());
    }
    let sections = match &args.sections {
        Some(path) => Some(Inputs::open(path).map_err(|error| Failure::from(*error))?.1),
        None => None,
    };
    let options = ImportOptions {
        length: args.length.map(Into::into),
        force: args.force.map(Into::into),
        up: args.up,
        rails: args.rail.clone(),
        fix: args.fix.clone(),
        sections,
        spc: args.spc,
        skip: args
            .skip
            .iter()
            .map(|name| name.trim().to_ascii_uppercase())
            .collect(),
        skip_unused: args.skip_unused,
        mass: args.mass.map(Into::into),
    };
    let imported = import(&args.model, &read_file, &options)?;
    for warning in &imported.warnings {
        progress.say(&format!("warning: {warning}"));
    }
    output::deliver(args.output.as_deref(), &imported.text, &progress)?;
    Ok(Exit::Done)
}
