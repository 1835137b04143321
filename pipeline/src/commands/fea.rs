//! `girderway fea`: the influence grid of a beam spec.

use crate::cli::{FeaArgs, Global};
use crate::exit::{Exit, Failure};
use crate::output;
use crate::progress::Progress;
use formats::grid::coupling::Coupling;
use formats::grid::file;
use formats::grid::modes_file::{self, MESH_TOLERANCE};
use formats::spec::Spec;
use formats::text::fault::{Fault, Faults};
use formats::text::inputs::Inputs;
use formats::text::place::Place;
use formats::text::source::Source;

/// Number of unknowns from which the size of the system is reported.
const LARGE: usize = 1000;

/// Reads and solves the spec, and writes the grid to the named file or to standard output.
///
/// # Errors
/// The spec is invalid, the structure is a mechanism, or the file cannot be written.
pub fn run(args: &FeaArgs, global: Global) -> Result<Exit, Failure> {
    let progress = Progress::new(global);
    let (inputs, source) = Inputs::open(&args.spec)?;
    let mut spec = Spec::read(&source, None)?;
    progress.warn_of_commas(&inputs);
    if let Some(theory) = args.theory {
        spec = spec.with_theory(theory.into());
    }
    let stage = progress.stage("solving");
    let solved = foundations::solve_for_file(&spec, args.accuracy);
    drop(stage);
    let solved = solved.map_err(|error| spec.locate_error(&source, &error))?;
    // natural modes need no rail that resists loads
    if solved.grid.blocks.is_empty() && args.modes.is_none() {
        let notes = solved.grid.notes.join("; ");
        return Err(Failure::untrusted(format_args!("{}: {notes}", source.name)));
    }
    if let Some(size) = solved.size.filter(|size| size.unknowns >= LARGE) {
        progress.say(&format!("solved {size}"));
    }
    let incomplete = spec.incomplete.iter().map(ToString::to_string);
    for warning in spec.warnings().into_iter().chain(incomplete) {
        progress.say(&format!("warning: {warning}"));
    }
    for note in spec.notes.iter().chain(&solved.grid.notes) {
        progress.say(&format!("note: {note}"));
    }
    if let Some(line) = Coupling::of(&solved.grid).and_then(|coupling| coupling.summary()) {
        progress.say(&line);
    }
    let mut text = file::write(&solved.grid, solved.surface.as_ref());
    if let Some(count) = args.modes {
        let stage = progress.stage("modes");
        let found =
            fea::refined_modes(&solved.model, &solved.rails, count as usize, MESH_TOLERANCE);
        drop(stage);
        let refined = found.map_err(|error| refuse(&spec, &source, &error))?;
        progress.say(&modes_file::summary(&refined.modes));
        if let Some(error) = refined.error.filter(|error| *error > MESH_TOLERANCE) {
            progress.say(&format!(
                "note: estimated discretisation error of the frequencies: {error:.1e}"
            ));
        }
        text = modes_file::append(&text, &modes_file::write(&refined, &solved.grid.stations()));
    }
    output::deliver(args.output.as_deref(), &text, &progress)?;
    Ok(Exit::Done)
}

/// Converts an error of the modal analysis. For a spec without mass, the error refers to the missing key.
fn refuse(spec: &Spec, source: &Source, error: &fea::Error) -> Failure {
    if *error != fea::Error::NoMass {
        return spec.locate_error(source, error).into();
    }
    let root = Place::root();
    let fault = if spec.girder().is_some() {
        Fault::new(&root.key("girder"), "missing key `mass_per_length`")
    } else {
        Fault::new(
            &root.key("materials"),
            "one of them must have a `density`, or the spec `masses`",
        )
    };
    Failure::Input(source.diagnose(&Faults(vec![fault.hint("modes need mass")])))
}
