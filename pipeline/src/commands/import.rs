//! `girderway import`: a model of another program as a beam spec.

use crate::cli::{Global, ImportArgs};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::text::inputs::Inputs;
use import::{ImportOptions, import};

/// Reads the model, writes the beam spec to the file named or to standard output; what was left out is said on
/// standard error.
///
/// # Errors
/// What is wrong with the model or the flags; a file that cannot be written.
pub fn run(args: &ImportArgs, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
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
        skip: args.skip.iter().map(|name| name.trim().to_ascii_uppercase()).collect(),
    };
    let imported = import(&args.model, &|path| std::fs::read(path), &options)?;
    for warning in &imported.warnings {
        progress.say(&format!("warning: {warning}"));
    }
    output::deliver(args.output.as_deref(), &imported.text, &progress)?;
    Ok(Exit::Done)
}
