//! Extremes of girders that are computed when they are first asked for, from what the run has left.

use std::mem::take;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use foundations::{BuiltFoundation, SolvedModel, solution_of};
use sim::{Foundation, History, Run};

use super::GirderExtremes;
use super::rows::{Prepared, Recorded, of_run};
use super::solved::SolvedMembers;
use crate::response::ColumnEnvelope;

/// Extremes of the girders of a run: computed, or what they are computed from.
pub(crate) struct DeferredGirders {
    found: OnceLock<GirderExtremes>,
    /// Taken by the first who asks.
    inputs: Mutex<Option<Box<GirderInputs>>>,
}

impl DeferredGirders {
    /// Extremes that are still to be computed.
    pub fn of(inputs: GirderInputs) -> DeferredGirders {
        DeferredGirders { found: OnceLock::new(), inputs: Mutex::new(Some(Box::new(inputs))) }
    }

    /// The extremes, which the first who asks computes. `input` and `history` are those of the run, `columns` the
    /// extremes of its columns.
    pub fn get(
        &self,
        input: &SimulationInput,
        history: &History,
        columns: &[ColumnEnvelope],
    ) -> &GirderExtremes {
        self.found.get_or_init(|| {
            let inputs = self.inputs.lock().unwrap_or_else(PoisonError::into_inner).take();
            let found = inputs
                .and_then(|own| own.extremes(input, history, columns, &mut |_| ControlFlow::Continue(())));
            // nobody stops it, and nobody else has taken what it needs
            found.unwrap_or_default()
        })
    }

    /// Takes what is needed of a history before its owner drops it.
    pub fn keep_rows(&mut self, history: &mut History) {
        let inputs = self.inputs.get_mut().unwrap_or_else(PoisonError::into_inner);
        if let Some(inputs) = inputs
            && inputs.steps.is_empty()
        {
            inputs.rows = Some(take(history));
        }
    }
}

impl From<GirderExtremes> for DeferredGirders {
    fn from(found: GirderExtremes) -> DeferredGirders {
        DeferredGirders { found: OnceLock::from(found), inputs: Mutex::new(None) }
    }
}

/// What the extremes of the girders of a run are computed from, beside its history.
pub(crate) struct GirderInputs {
    /// The scene with the foundations that were chosen.
    scene: Scene,
    built: Vec<BuiltFoundation>,
    members: Arc<SolvedMembers>,
    /// Ends of the steps, where the run has recorded them.
    steps: History,
    /// Whether the history has an interval.
    has_rows: bool,
    /// The history, where its owner has dropped it.
    rows: Option<History>,
    /// Number of times that the run may be repeated with more rows.
    repetitions: usize,
}

impl GirderInputs {
    /// Keeps what is needed of a run of `scene` on the foundations `built`, and takes the ends of its steps.
    pub fn new(
        scene: Scene,
        built: Vec<BuiltFoundation>,
        members: Arc<SolvedMembers>,
        run: &mut Run,
    ) -> GirderInputs {
        // a repetition costs as much as the run; after a strike forces jump between any rows, and more rows do not help
        let repetitions = usize::from(run.strike.is_none() && run.status.is_complete());
        let (steps, has_rows) = (take(&mut run.steps), run.history.len() >= 2);
        GirderInputs { scene, built, members, steps, has_rows, rows: None, repetitions }
    }

    /// Computes the extremes; `None` where `watch`, which is called with the time in repetitions of the run, breaks off.
    pub fn extremes(
        self,
        input: &SimulationInput,
        history: &History,
        columns: &[ColumnEnvelope],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<GirderExtremes> {
        let GirderInputs { scene, built, members, steps, has_rows, rows, repetitions: mut left } = self;
        let solved: Vec<Option<&SolvedModel>> = scene
            .structures
            .iter()
            .map(|structure| solution_of(members.known(), &structure.origin))
            .collect();
        let prepared = Prepared::new(&scene, &built, &solved, &members);
        let foundations: Vec<Foundation> = built.into_iter().map(|built| built.foundation).collect();
        let recorded = match steps.is_empty() {
            true => Recorded::Rows(rows.as_ref().unwrap_or(history)),
            false => Recorded::Steps(&steps),
        };
        let mut is_stopped = false;
        let mut repeat = |rows: usize| {
            left = left.checked_sub(1)?;
            let mut watch = |t: f64| {
                let now = watch(t);
                is_stopped |= now.is_break();
                now
            };
            repeated(&scene, input, &foundations, rows, &mut watch)
        };
        let mut found = match has_rows {
            true => of_run(&prepared, (&scene, input), recorded, &foundations, &mut repeat),
            false => prepared.without_rows(),
        };
        found.reactions.iter_mut().for_each(|reaction| reaction.extend_to(columns));
        (!is_stopped).then_some(found)
    }
}

/// The history of a run with a number of rows in each output interval; `None` if it does not end as a complete run.
fn repeated(
    scene: &Scene,
    input: &SimulationInput,
    foundations: &[Foundation],
    rows: usize,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<History> {
    let finer = sim::Scene { output_parts: rows, ..input.scene.clone() };
    let again = sim::run_by(scene.stepping, &finer, foundations, watch).ok()?;
    again.status.is_complete().then_some(again.history)
}
