//! The cases of a scene, each simulated on its own foundations.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use sim::{Foundation, Run};

use crate::codes::Codes;
use crate::exit::Failure;
use crate::fatigue::{self, Verdict};
use crate::link::{self, Solved};
use crate::motion::{Cast, cast};
use crate::progress::Progress;
use crate::record::Record;
use crate::response::{self, Lines, Natural, Response};
use crate::scene::{Case, Document, Origin, Scene};
use crate::spec::Spec;
use crate::threads::side_by_side;

/// One case, run.
pub struct Outcome {
    /// Its label; the scene's own run is named by its foundations.
    pub label: String,
    /// What was simulated.
    pub cast: Cast,
    /// How it went.
    pub run: Run,
    /// Its named columns.
    pub record: Record,
    /// Why foundations that were "auto" are what they are.
    pub choices: Vec<sim::Choice>,
    /// Influence lines of the columns that structures answer in, one a structure.
    pub lines: Vec<Option<Lines>>,
    /// What the structures answered.
    pub response: Response,
    /// The run beside codes, where the scene asks for that.
    pub codes: Option<Codes>,
    /// Damage at the points whose stresses it has.
    pub fatigue: Vec<Verdict>,
}

/// A spec that was solved, and what came of it.
pub struct Known {
    /// The spec.
    pub spec: Arc<Spec>,
    /// Its grids and surface.
    pub solved: Solved,
}

/// Every different spec of the document, once: the name of its tables (the structure's, with the label of the
/// comparison that brings it), its file, and itself.
#[must_use]
pub fn specs(document: &Document) -> Vec<(String, &str, &Arc<Spec>)> {
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
pub fn solved_of<'a>(known: &'a [Known], origin: &Origin) -> Option<&'a Solved> {
    match origin {
        Origin::Spec { spec, .. } => {
            known.iter().find(|entry| entry.spec == *spec).map(|entry| &entry.solved)
        }
        Origin::Tables { .. } => None,
    }
}

/// Runs every case, on as many threads as asked for.
///
/// # Errors
/// A foundation that cannot be made; a scene that cannot start.
pub fn simulate(
    document: &Document,
    known: &[Known],
    threads: Option<u16>,
    progress: &Progress,
) -> Result<Vec<Outcome>, Failure> {
    let cases = &document.cases;
    let done: Vec<AtomicU64> = cases.iter().map(|_| AtomicU64::new(0)).collect();
    let bar = progress.bar("simulating", 1000 * cases.len() as u64);
    let outcomes = side_by_side(cases, threads, |index, case| {
        let mut watch = |t: f64| {
            // runs that are compared start again
            done[index].fetch_max((1000.0 * t / case.scene.end) as u64, Ordering::Relaxed);
            bar.set(done.iter().map(|share| share.load(Ordering::Relaxed)).sum());
            ControlFlow::Continue(())
        };
        one(case, known, &mut watch)
    });
    outcomes.into_iter().collect()
}

/// Values of structures' freedoms that a history holds where no reaction asks for them.
const RECORDED: f64 = 1e7;

/// Whether the history of a run of `scene` is to hold the freedoms of a structure, by its index, on a foundation.
pub(crate) fn recorded(scene: &Scene, known: &[Known]) -> impl Fn(usize, &Foundation) -> bool + use<> {
    let (answers, rows) = (response::answers(scene, known), scene.end / scene.dt);
    move |s, foundation| {
        let freedoms = foundation.freedoms();
        freedoms > 0 && (answers[s] || freedoms as f64 * rows < RECORDED)
    }
}

fn one(
    case: &Case,
    known: &[Known],
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Outcome, Failure> {
    let mut scene = case.scene.clone();
    let cast = cast(&scene)?;
    let recorded = recorded(&scene, known);
    let chosen = link::choose(&mut scene, &cast.scene, known, &recorded, watch);
    let label = case.label.clone().unwrap_or_else(|| own_label(&scene));
    let link::Chosen { choices, run, laid } = chosen.map_err(|trouble| match trouble {
        link::Trouble::Foundation(failure) => failure,
        link::Trouble::Run(error) => {
            Failure::Untrusted(format!("{label}: {}", crate::plight::words(&error, &case.scene)))
        }
    })?;
    let solved: Vec<Option<&Solved>> =
        scene.structures.iter().map(|structure| solved_of(known, &structure.origin)).collect();
    let lines = response::lines(&scene, &laid, &solved)?;
    let mut record = Record::new(&scene, &run.history);
    let mut response = Response::new(&scene, &cast, &run.history, &laid, &solved, &lines, &mut record)?;
    // only the scene itself is drawn
    if case.label.is_none() {
        response.bend(&scene, &cast, &run.history, &laid, &solved)?;
    }
    let foundations: Vec<Foundation> = laid.into_iter().map(|laid| laid.foundation).collect();
    response.modes = Natural::all(&scene, &cast, &foundations, &run);
    let codes = Codes::new(&scene, &cast, &record)?;
    let fatigue = fatigue::verdicts(&scene, &record)?;
    Ok(Outcome { label, cast, run, record, choices, lines, response, codes, fatigue })
}

/// The scene's own run is labelled by what carries it.
fn own_label(scene: &Scene) -> String {
    let mut words: Vec<&str> = scene.structures.iter().map(|structure| structure.foundation.word()).collect();
    words.dedup();
    words.join(" and ")
}
