//! Structures of a scene, solved once for all that is made of them.

use std::sync::Arc;

use fea::Frame;
use formats::grid::Grid;
use formats::inputs::Input;
use formats::scene::{Document, Origin};
use formats::spec::{SolveError, Spec};
use splines::Surface;

/// A structure's FE model, solved.
pub struct SolvedModel {
    /// The model.
    pub model: fea::Model,
    /// Its rails.
    pub rails: Vec<fea::Rail>,
    /// Exact influence surface; `None` where it is larger than asked for.
    pub surface: Option<Surface>,
    /// Grids at the stations.
    pub grid: Grid,
    /// The girder, where the structure is one.
    pub girder: Option<fea::Girder>,
    /// How large the system was; `None` where it was solved by an earlier run.
    pub size: Option<SystemSize>,
}

/// Size of a system of equations.
#[derive(Clone, Copy, Debug)]
pub struct SystemSize {
    /// Unknown freedoms.
    pub unknowns: usize,
    /// Bytes of its factor.
    pub bytes: u64,
}

impl std::fmt::Display for SystemSize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} unknowns, a factor of {:.3} MB", self.unknowns, self.bytes as f64 / 1e6)
    }
}

/// Solves a spec: grid at its stations and exact surface.
///
/// # Errors
/// An entry that cannot be used, a mechanism, or numbers that cannot be trusted.
pub fn solve(spec: &Spec) -> Result<SolvedModel, fea::Error> {
    solve_to(spec, fea::ACCURACY, usize::MAX)
}

/// The same, with compliances whose relative error bound is at most `accuracy`, and without a surface of more than
/// `most` freedoms.
///
/// # Errors
/// As [`solve`].
pub fn solve_to(spec: &Spec, accuracy: f64, most: usize) -> Result<SolvedModel, fea::Error> {
    let (model, rails) = spec.model()?;
    let frame = Frame::accurate(&model, &rails, accuracy)?;
    let mut grid = Grid::of(spec, &frame)?.with_effects(spec, &model, &frame)?;
    let freedoms = 6 * frame.line()?.states();
    let surface = if freedoms <= most {
        Some(frame.surface()?.surface)
    } else {
        grid.notes.push(format!(
            "no surface: the compliance of {freedoms} freedoms at the ends of the rails' cells is too large for a file"
        ));
        None
    };
    let size = Some(SystemSize { unknowns: frame.unknowns(), bytes: frame.bytes() });
    Ok(SolvedModel { model, rails, surface, grid, girder: spec.girder().cloned(), size })
}

/// A spec that was solved, and what came of it.
pub struct SolvedStructure {
    /// The spec.
    pub spec: Arc<Spec>,
    /// Its grids and surface.
    pub solution: SolvedModel,
}

/// Every different spec of the document, once: the name of its tables (the structure's, with the label of the
/// comparison that brings it), its file, and itself.
#[must_use]
pub fn distinct_specs(document: &Document) -> Vec<(String, &str, &Arc<Spec>)> {
    let mut all: Vec<(String, &str, &Arc<Spec>)> = Vec::new();
    for case in &document.cases {
        for structure in &case.scene.structures {
            let Origin::Spec { file, spec } = &structure.origin else { continue };
            let is_new = all.iter().all(|(_, _, known)| *known != spec);
            let of_scene = case.label.is_none();
            if is_new || (of_scene && all.iter().all(|(name, ..)| *name != structure.name)) {
                let name = match &case.label {
                    Some(label) => format!("{}-{label}", structure.name),
                    None => structure.name.clone(),
                };
                all.push((name, file, spec));
            }
        }
    }
    all
}

/// The solution of a structure that has a spec.
#[must_use]
pub fn solution_of<'a>(known: &'a [SolvedStructure], origin: &Origin) -> Option<&'a SolvedModel> {
    match origin {
        Origin::Spec { spec, .. } => {
            known.iter().find(|entry| entry.spec == *spec).map(|entry| &entry.solution)
        }
        Origin::Tables { .. } => None,
    }
}

/// Solves the given specs of a document (see [`distinct_specs`]).
///
/// # Errors
/// A spec that cannot be solved, at its place in its file where it can be told.
pub fn solve_specs(
    document: &Document,
    specs: &[(String, &str, &Arc<Spec>)],
) -> Result<Vec<SolvedStructure>, SolveError> {
    let solved = specs.iter().map(|&(_, file, spec)| {
        let solution = solve(spec).map_err(|error| match document.inputs.find(file).map(Input::source) {
            Some(Ok(source)) => spec.refuse(&source, &error),
            _ => SolveError::Untrusted(error.to_string()),
        })?;
        Ok(SolvedStructure { spec: Arc::clone(spec), solution })
    });
    solved.collect()
}
