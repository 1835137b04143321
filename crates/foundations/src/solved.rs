//! FE solutions of the structures of a scene, computed once for all foundations that are built from them.

use std::sync::{Arc, OnceLock};

use fea::FactoredFrame;
use formats::grid::StationGrid;
use formats::grid::file::surface_omission;
use formats::kept::KeptValues;
use formats::scene::{Document, Origin};
use formats::spec::{SolveError, Spec};
use formats::text::inputs::Input;
use splines::ExactSurface;

use crate::mesh_modes::ComputedModes;

/// FE model of a structure and its solution.
pub struct SolvedModel {
    /// The model.
    pub model: fea::Model,
    /// Its rails.
    pub rails: Vec<fea::Rail>,
    /// Exact influence surface; `None` where it is too large for the grid file for which the spec was solved
    /// ([`solve_for_file`]).
    pub surface: Option<ExactSurface>,
    /// Grids at the stations.
    pub grid: StationGrid,
    /// The girder; `None` where the structure is not a straight girder.
    pub girder: Option<fea::Girder>,
    /// Size of the system of equations; `None` where the solution was read from an earlier run.
    pub size: Option<SystemSize>,
    /// Natural modes that runs have computed of it.
    pub modes: ComputedModes,
    /// Chords of its rails, once a run has asked for them.
    pub chords: OnceLock<Vec<RailChords>>,
}

/// Chords of a rail from which deflections are measured, by plane (vertical, lateral): coordinates of both ends.
pub type RailChords = [Vec<[f64; 2]>; 2];

/// Size of a system of equations.
#[derive(Clone, Copy, Debug)]
pub struct SystemSize {
    /// Number of unknown displacements and rotations.
    pub unknowns: usize,
    /// Size of the factored matrix in bytes.
    pub bytes: u64,
}

impl std::fmt::Display for SystemSize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} unknowns, a factor of {:.3} MB",
            self.unknowns,
            self.bytes as f64 / 1e6
        )
    }
}

/// Solves a spec: influence coefficients at its stations, and the exact surface between them.
///
/// # Errors
/// An entry that cannot be used, a mechanism, or a solution whose error bound exceeds [`fea::DEFAULT_ACCURACY`].
pub fn solve(spec: &Spec) -> Result<SolvedModel, fea::Error> {
    let (model, rails, frame) = spec.factored()?;
    solved(spec, model, rails, &frame, true)
}

/// Solves a spec for its grid file, with a relative error bound of the compliances of at most `accuracy`. A surface that
/// is too large for the file is not computed, because its size grows with the square of the number of rail elements.
///
/// # Errors
/// As [`solve`].
pub fn solve_for_file(spec: &Spec, accuracy: f64) -> Result<SolvedModel, fea::Error> {
    let (model, rails) = spec.model()?;
    let frame = FactoredFrame::with_accuracy(&model, &rails, accuracy)?;
    solved(spec, model, rails, &frame, false)
}

/// What is kept of a factored frame of the model of a spec. `always`: also a surface that is too large for a file.
fn solved(
    spec: &Spec,
    model: fea::Model,
    rails: Vec<fea::Rail>,
    frame: &FactoredFrame,
    always: bool,
) -> Result<SolvedModel, fea::Error> {
    let grid = StationGrid::of(spec, frame)?.with_effects(spec, &model, frame)?;
    let mut grid = grid.with_critical_factor(spec)?;
    let omission = surface_omission(6 * frame.line()?.state_count());
    let surface = if always || omission.is_none() {
        Some(frame.surface()?.surface)
    } else {
        None
    };
    grid.notes.extend(omission);
    let size = Some(SystemSize {
        unknowns: frame.unknowns(),
        bytes: frame.factor_bytes(),
    });
    Ok(SolvedModel {
        model,
        rails,
        surface,
        grid,
        girder: spec.girder().cloned(),
        size,
        modes: ComputedModes::default(),
        chords: OnceLock::new(),
    })
}

/// A spec and its solution. Copies share both.
#[derive(Clone)]
pub struct SolvedStructure {
    /// The spec.
    pub spec: Arc<Spec>,
    /// Its solution.
    pub solution: Arc<SolvedModel>,
}

/// Lists every distinct spec of the document once, as (name of its tables, file, spec). The name is that of the
/// structure, followed by the label of the comparison if the spec occurs only in a comparison.
#[must_use]
pub fn distinct_specs(document: &Document) -> Vec<(String, &str, &Arc<Spec>)> {
    let mut all: Vec<(String, &str, &Arc<Spec>)> = Vec::new();
    for case in &document.cases {
        for structure in &case.scene.structures {
            let Origin::Spec { file, spec } = &structure.origin else {
                continue;
            };
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

/// The solution of a structure's spec among `known`; `None` for a structure defined by tables or a spec that is not
/// among them.
#[must_use]
pub fn solution_of<'a>(known: &'a [SolvedStructure], origin: &Origin) -> Option<&'a SolvedModel> {
    match origin {
        Origin::Spec { spec, .. } => known
            .iter()
            .find(|entry| entry.spec == *spec)
            .map(|entry| &*entry.solution),
        Origin::Tables { .. } => None,
    }
}

/// Solves the given specs of a document (see [`distinct_specs`]).
///
/// # Errors
/// A spec that cannot be solved, with the position in its file where that is known.
pub fn solve_specs(
    document: &Document,
    specs: &[(String, &str, &Arc<Spec>)],
) -> Result<Vec<SolvedStructure>, SolveError> {
    specs
        .iter()
        .map(|&(_, file, spec)| solve_spec(document, file, spec))
        .collect()
}

/// Solves one spec of a document, which was read from `file`.
fn solve_spec(
    document: &Document,
    file: &str,
    spec: &Arc<Spec>,
) -> Result<SolvedStructure, SolveError> {
    let solution =
        solve(spec).map_err(
            |error| match document.inputs.find(file).map(Input::source) {
                Some(Ok(source)) => spec.locate_error(&source, &error),
                _ => SolveError::NoSolution(error.to_string()),
            },
        )?;
    Ok(SolvedStructure {
        spec: Arc::clone(spec),
        solution: Arc::new(solution),
    })
}

/// Solutions of the specs of many documents, each computed once and shared by all threads, as are the modes that are
/// computed of them. The last 64 are kept.
///
/// ```
/// use std::sync::Arc;
///
/// use formats::scene::Document;
/// use foundations::{StructureCache, distinct_specs};
///
/// let cache = StructureCache::default();
/// let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
/// let [first, second] = [0, 1].map(|_| cache.solve(&document).expect("a girder that stands"));
/// assert!(Arc::ptr_eq(&first[0].solution, &second[0].solution));
/// assert_eq!(first.len(), distinct_specs(&document).len());
/// ```
#[derive(Default)]
pub struct StructureCache {
    solved: KeptValues<Arc<Spec>, SolvedStructure>,
}

impl StructureCache {
    /// The solutions of the distinct specs of a document ([`distinct_specs`]).
    ///
    /// # Errors
    /// As [`solve_specs`].
    pub fn solve(&self, document: &Document) -> Result<Vec<SolvedStructure>, SolveError> {
        let specs = distinct_specs(document);
        let each = specs
            .iter()
            .map(|&(_, file, spec)| self.solved.get(spec, || solve_spec(document, file, spec)));
        each.collect()
    }
}
