//! `girderway run`: the main job.

use crate::cli::{Global, Scene};
use crate::exit::{Exit, Failure};
use crate::scene::Document;

/// Reads and checks the scene.
///
/// # Errors
/// What is wrong with the scene or the files it names.
pub fn run(args: &Scene, _global: Global) -> Result<Exit, Failure> {
    let _document = Document::open(&args.scene)?;
    Ok(Exit::Done)
}
