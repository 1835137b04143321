//! The cases of a scene, each simulated on its own foundations.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use sim::Foundation;

use crate::Error;
use crate::codes::CodeCheck;
use crate::fatigue;
use crate::outcome::CaseResult;
use crate::record::NamedColumns;
use crate::response::{self, Response, SceneMode};
use crate::threads::parallel_map;
use formats::motion::cast;
use formats::scene::{Case, Document, Scene};
use foundations::{SolvedModel, SolvedStructure, solution_of};

/// Runs every case, on as many threads as asked for; `progress` is told the share of all simulated time that is done, from
/// any thread.
///
/// # Errors
/// A foundation that cannot be made; a scene that cannot start.
pub fn simulate(
    document: &Document,
    known: &[SolvedStructure],
    threads: Option<u16>,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Vec<CaseResult>, Error> {
    let cases = &document.cases;
    let done: Vec<AtomicU64> = cases.iter().map(|_| AtomicU64::new(0)).collect();
    let outcomes = parallel_map(cases, threads, |index, case| {
        let mut watch = |t: f64| {
            // runs that are compared start again
            done[index].fetch_max((1000.0 * t / case.scene.end) as u64, Ordering::Relaxed);
            let sum: u64 = done.iter().map(|share| share.load(Ordering::Relaxed)).sum();
            progress(sum as f64 / (1000.0 * cases.len() as f64));
            ControlFlow::Continue(())
        };
        run_case(case, known, &mut watch)
    });
    outcomes.into_iter().collect()
}

/// Values of structures' freedoms that a history holds where no reaction asks for them.
const RECORDED: f64 = 1e7;

/// Whether the history of a run of `scene` is to hold the freedoms of a structure, by its index, on a foundation.
#[must_use]
pub fn records_structure(
    scene: &Scene,
    known: &[SolvedStructure],
) -> impl Fn(usize, &Foundation) -> bool + use<> {
    let (answers, rows) = (response::structures_with_columns(scene, known), scene.end / scene.dt);
    move |s, foundation| {
        let freedoms = foundation.freedoms();
        freedoms > 0 && (answers[s] || freedoms as f64 * rows < RECORDED)
    }
}

fn run_case(
    case: &Case,
    known: &[SolvedStructure],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<CaseResult, Error> {
    let mut scene = case.scene.clone();
    let cast = cast(&scene)?;
    let recorded = records_structure(&scene, known);
    let chosen = foundations::select_and_run(&mut scene, &cast.scene, known, &recorded, watch);
    let label = case.label.clone().unwrap_or_else(|| foundation_label(&scene));
    let foundations::AutoRun { choices, run, built: laid } = chosen.map_err(|error| match error {
        foundations::Error::Simulation(error) => {
            let why = crate::run_error::in_scene_names(&error, &case.scene);
            Error::Run { label: label.clone(), why }
        }
        other => Error::Foundation(other),
    })?;
    let solved: Vec<Option<&SolvedModel>> =
        scene.structures.iter().map(|structure| solution_of(known, &structure.origin)).collect();
    let lines = response::lines(&scene, &laid, &solved)?;
    let mut record = NamedColumns::new(&scene, &run.history);
    let mut response = Response::new(&scene, &cast, &run.history, &laid, &solved, &lines, &mut record)?;
    // only the scene itself is drawn
    if case.label.is_none() {
        response.bend(&scene, &cast, &run.history, &laid, &solved)?;
    }
    let foundations: Vec<Foundation> = laid.into_iter().map(|laid| laid.foundation).collect();
    response.modes = SceneMode::all(&scene, &cast, &foundations, &run);
    let codes = CodeCheck::new(&scene, &cast, &record)?;
    let fatigue = fatigue::fatigue_results(&scene, &record)?;
    Ok(CaseResult { label, input: cast, run, columns: record, choices, lines, response, codes, fatigue })
}

/// The scene's own run is labelled by what carries it.
fn foundation_label(scene: &Scene) -> String {
    let mut words: Vec<&str> = scene.structures.iter().map(|structure| structure.foundation.word()).collect();
    words.dedup();
    words.join(" and ")
}
