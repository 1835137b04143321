//! The cases of a scene, each simulated on its own foundations.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use sim::{Foundation, Run};

use crate::Error;
use crate::codes::Codes;
use crate::fatigue::{self, Verdict};
use crate::record::Record;
use crate::response::{self, Lines, Natural, Response};
use crate::threads::side_by_side;
use formats::motion::{Cast, cast};
use formats::scene::{Case, Document, Scene};
use foundations::{Known, Solved, solved_of};

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

/// Runs every case, on as many threads as asked for; `progress` is told the share of all simulated time that is done, from
/// any thread.
///
/// # Errors
/// A foundation that cannot be made; a scene that cannot start.
pub fn simulate(
    document: &Document,
    known: &[Known],
    threads: Option<u16>,
    progress: &(dyn Fn(f64) + Sync),
) -> Result<Vec<Outcome>, Error> {
    let cases = &document.cases;
    let done: Vec<AtomicU64> = cases.iter().map(|_| AtomicU64::new(0)).collect();
    let outcomes = side_by_side(cases, threads, |index, case| {
        let mut watch = |t: f64| {
            // runs that are compared start again
            done[index].fetch_max((1000.0 * t / case.scene.end) as u64, Ordering::Relaxed);
            let sum: u64 = done.iter().map(|share| share.load(Ordering::Relaxed)).sum();
            progress(sum as f64 / (1000.0 * cases.len() as f64));
            ControlFlow::Continue(())
        };
        one(case, known, &mut watch)
    });
    outcomes.into_iter().collect()
}

/// Values of structures' freedoms that a history holds where no reaction asks for them.
const RECORDED: f64 = 1e7;

/// Whether the history of a run of `scene` is to hold the freedoms of a structure, by its index, on a foundation.
#[must_use]
pub fn recorded(scene: &Scene, known: &[Known]) -> impl Fn(usize, &Foundation) -> bool + use<> {
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
) -> Result<Outcome, Error> {
    let mut scene = case.scene.clone();
    let cast = cast(&scene)?;
    let recorded = recorded(&scene, known);
    let chosen = foundations::choose(&mut scene, &cast.scene, known, &recorded, watch);
    let label = case.label.clone().unwrap_or_else(|| own_label(&scene));
    let foundations::Chosen { choices, run, laid } = chosen.map_err(|error| match error {
        foundations::Error::Simulation(error) => {
            let why = crate::plight::words(&error, &case.scene);
            Error::Run { label: label.clone(), why }
        }
        other => Error::Foundation(other),
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
