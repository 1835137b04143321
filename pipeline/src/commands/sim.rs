//! `girderway sim`: simulation with the tables that an earlier `run` wrote to the output folder.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use serde_json::Value;

use super::run::job;
use crate::cli::{Global, SceneArgs as Arguments};
use crate::exit::{Exit, Failure};
use crate::progress::Progress;
use formats::grid::file as grid_file;
use formats::scene::Document;
use formats::spec::Spec;
use formats::text::diagnostic::Diagnostic;
use formats::text::inputs::Inputs;
use foundations::{ComputedModes, SolvedModel};
use foundations::{SolvedStructure, distinct_specs};
use outputs::manifest::{MANIFEST, OutputEntry, listed_files};

/// Hint of errors of the tables.
const HINT: &str = "run `girderway run` first to compute the tables";

/// Simulates with the grids of the output folder, and rewrites the folder.
///
/// # Errors
/// The errors of [`super::run::run`]; the tables are missing, or belong to other specs than those of the scene.
pub fn run(args: &Arguments, global: Global) -> Result<Exit, Failure> {
    job("sim", args, global, load)
}

/// Reads the grid and surface of each distinct spec from the output folder.
fn load(document: &Document, folder: &Path, _: &Progress) -> Result<Vec<SolvedStructure>, Failure> {
    let mut known: Vec<SolvedStructure> = Vec::new();
    for (name, file, spec) in distinct_specs(document) {
        // a spec with pads is solved again because its pads depend on the scene, which may have changed
        if !spec.pads().is_empty() {
            let solved = foundations::solve(spec).map_err(Failure::untrusted)?;
            known.push(SolvedStructure {
                spec: Arc::clone(spec),
                solution: Arc::new(solved),
            });
            continue;
        }
        let manifest = folder.join(MANIFEST);
        let entries = unchanged(document, &manifest, file)?;
        let grid = format!("grid-{name}.json");
        let listed = entries
            .iter()
            .find(|entry| entry.name == grid)
            .and_then(|entry| entry.sha256.as_deref());
        let path = folder.join(&grid);
        known.push(SolvedStructure {
            spec: Arc::clone(spec),
            solution: Arc::new(solved(spec, &path, listed)?),
        });
    }
    Ok(known)
}

/// Checks by its hash in the manifest that the spec is the one from which the tables were computed. Returns the files
/// that the manifest lists.
fn unchanged(document: &Document, path: &Path, file: &str) -> Result<Vec<OutputEntry>, Failure> {
    let refuse = |why: &str| {
        let mut wrong = Diagnostic::of_file(path.display().to_string(), why.to_owned());
        wrong.hint = Some(HINT.to_owned());
        Failure::Input(vec![wrong])
    };
    let text = std::fs::read(path).map_err(|_| refuse("no tables found"))?;
    let outputs = listed_files(&text).ok_or_else(|| refuse("is not a manifest"))?;
    let manifest: Value = serde_json::from_slice(&text).map_err(|_| refuse("is not a manifest"))?;
    let entries = manifest["inputs"]
        .as_array()
        .map(Vec::as_slice)
        .unwrap_or_default();
    let then = entries
        .iter()
        .find(|entry| entry["name"] == file)
        .and_then(|entry| entry["sha256"].as_str());
    let now = document
        .inputs
        .find(file)
        .map(|input| input.sha256.as_str());
    if then.is_some() && then == now {
        Ok(outputs)
    } else {
        Err(refuse(&format!(
            "its tables are out of date: {file} is new or has changed"
        )))
    }
}

/// Reads grid and exact surface from a grid file, which must have the hash that the manifest lists. A spec whose surface
/// is too large for the file is solved again.
fn solved(spec: &Spec, path: &Path, listed: Option<&str>) -> Result<SolvedModel, Failure> {
    let (inputs, source) = Inputs::open(path)?;
    if listed != Some(inputs.all()[0].sha256.as_str()) {
        let wrong = Diagnostic::of_file(
            &source.name,
            format!("does not match the hash in {MANIFEST}"),
        );
        return Err(wrong.hint(HINT).into());
    }
    let (grid, surface) = grid_file::read(&source)?;
    let wrong = |why: &str| {
        Failure::Input(vec![Diagnostic::of_file(
            source.name.clone(),
            why.to_owned(),
        )])
    };
    if grid.units != spec.units {
        return Err(wrong("has units other than those of the scene"));
    }
    let Some(surface) = surface else {
        return foundations::solve(spec).map_err(Failure::untrusted);
    };
    let (model, rails) = spec.model().map_err(Failure::untrusted)?;
    let girder = spec.girder().cloned();
    let modes = ComputedModes::default();
    Ok(SolvedModel {
        model,
        rails,
        surface: Some(surface),
        grid,
        girder,
        size: None,
        modes,
        chords: OnceLock::new(),
    })
}
