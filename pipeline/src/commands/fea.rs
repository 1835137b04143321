//! `girderway fea`: the influence grid of a beam spec.

use crate::cli::{Fea, Global};
use crate::coupling::Coupling;
use crate::exit::{Exit, Failure};
use crate::grid_file;
use crate::inputs::Inputs;
use crate::link;
use crate::output;
use crate::progress::Progress;
use crate::spec::Spec;

/// Reads the spec, solves it, writes the grid to the file named or to standard output.
///
/// # Errors
/// What is wrong with the spec; a structure that does not stand; a file that cannot be written.
pub fn run(args: &Fea, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let (_, source) = Inputs::open(&args.spec)?;
    let mut spec = Spec::read(&source, None)?;
    if let Some(theory) = args.theory {
        spec = spec.with_theory(theory.into());
    }
    let stage = progress.stage("solving");
    let solved = link::solve_to(&spec, args.accuracy);
    drop(stage);
    let solved = solved.map_err(|error| spec.refuse(&source, &error))?;
    for note in &solved.grid.notes {
        progress.say(&format!("note: {note}"));
    }
    if let Some(line) = Coupling::of(&solved.grid).and_then(|coupling| coupling.line()) {
        progress.say(&line);
    }
    let text = grid_file::write(&solved.grid, Some(&solved.surface));
    output::deliver(args.output.as_deref(), &text, &progress)?;
    Ok(Exit::Done)
}
