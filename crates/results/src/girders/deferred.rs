//! Extremes of girders that are computed when they are first asked for, from what the run has left.

use std::cell::{Cell, RefCell};
use std::mem::take;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use foundations::{BuiltFoundation, SolvedModel, solution_of};
use sim::{Foundation, History, Run, SolutionNodes};

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
        DeferredGirders {
            found: OnceLock::new(),
            inputs: Mutex::new(Some(Box::new(inputs))),
        }
    }

    /// The extremes, which the first who asks computes. `input` and `history` are those of the run, `columns` the
    /// extremes of its columns.
    pub fn get(
        &self,
        input: &SimulationInput,
        history: &History,
        columns: &[ColumnEnvelope],
    ) -> &GirderExtremes {
        let found = self.get_while(input, history, columns, &mut |_| ControlFlow::Continue(()));
        // nobody stops it
        found.unwrap_or_else(|| self.found.get_or_init(GirderExtremes::default))
    }

    /// The extremes as [`DeferredGirders::get`] returns them; `None` where `watch` has broken off. Who asks again computes
    /// them from the beginning.
    pub fn get_while(
        &self,
        input: &SimulationInput,
        history: &History,
        columns: &[ColumnEnvelope],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Option<&GirderExtremes> {
        let mut inputs = self.inputs.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(own) = inputs.take() {
            match own.extremes(input, history, columns, watch) {
                Ok(found) => return Some(self.found.get_or_init(|| found)),
                Err(own) => *inputs = Some(own),
            }
        }
        self.found.get()
    }

    /// Takes what is needed of a history before its owner drops it.
    pub fn keep_rows(&mut self, history: &mut History) {
        let inputs = self
            .inputs
            .get_mut()
            .unwrap_or_else(PoisonError::into_inner);
        if let Some(inputs) = inputs
            && inputs.steps.is_empty()
        {
            inputs.rows = Some(take(history));
        }
    }
}

impl From<GirderExtremes> for DeferredGirders {
    fn from(found: GirderExtremes) -> DeferredGirders {
        DeferredGirders {
            found: OnceLock::from(found),
            inputs: Mutex::new(None),
        }
    }
}

/// What the extremes of the girders of a run are computed from, beside its history.
pub(crate) struct GirderInputs {
    /// The scene with the foundations that were chosen.
    scene: Scene,
    built: Vec<BuiltFoundation>,
    members: Arc<SolvedMembers>,
    /// Ends of the steps, where the run has recorded them, and whether times inside of the steps are among them.
    steps: History,
    has_inner_times: bool,
    /// Whether the history has an interval.
    has_rows: bool,
    /// The history, where its owner has dropped it.
    rows: Option<History>,
    /// Number of times that the run may be repeated with more rows.
    repetitions: usize,
}

impl GirderInputs {
    /// Keeps what is needed of a run of `scene` on the foundations `built`, and of the nodes of its solution.
    pub fn new(
        scene: Scene,
        built: Vec<BuiltFoundation>,
        members: Arc<SolvedMembers>,
        (run, nodes): (&Run, SolutionNodes),
    ) -> GirderInputs {
        // a repetition costs as much as the run; after a strike forces jump between any rows, and more rows do not help
        let repetitions = usize::from(run.strike.is_none() && run.status.is_complete());
        // static equilibria are solved at rows
        let steps = match run.method {
            Some(_) => nodes.increasing(),
            None => History::default(),
        };
        let has_rows = run.history.len() >= 2;
        let has_inner_times = false;
        GirderInputs {
            scene,
            built,
            members,
            steps,
            has_inner_times,
            has_rows,
            rows: None,
            repetitions,
        }
    }

    /// Computes the extremes. `watch` is called with the time in repetitions of the run, and many times between them.
    ///
    /// # Errors
    /// The same inputs where `watch` breaks off.
    pub fn extremes(
        self: Box<Self>,
        input: &SimulationInput,
        history: &History,
        columns: &[ColumnEnvelope],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<GirderExtremes, Box<GirderInputs>> {
        let GirderInputs {
            scene,
            built,
            members,
            steps,
            has_inner_times,
            has_rows,
            rows,
            repetitions,
        } = *self;
        let solved: Vec<Option<&SolvedModel>> = scene
            .structures
            .iter()
            .map(|structure| solution_of(members.known(), &structure.origin))
            .collect();
        let (watch, stop) = (RefCell::new(watch), Cell::new(false));
        let ask = |t: f64| {
            let now = (*watch.borrow_mut())(t);
            if now.is_break() {
                stop.set(true);
            }
            now
        };
        let is_stopped = || stop.get() || ask(0.0).is_break();
        let (foundations, bases): (Vec<Foundation>, Vec<_>);
        let mut found = {
            let prepared = Prepared::new(&scene, &built, &solved, &members, &is_stopped);
            (foundations, bases) = built
                .into_iter()
                .map(|built| (built.foundation, built.basis))
                .unzip();
            let recorded = match (steps.is_empty(), has_inner_times) {
                (true, _) => Recorded::Rows(rows.as_ref().unwrap_or(history)),
                (false, false) => Recorded::Steps(&steps),
                (false, true) => Recorded::Inside(&steps),
            };
            let mut left = repetitions;
            let mut repeat = |rows: usize| {
                left = left.checked_sub(1)?;
                repeated(&scene, input, &foundations, rows, &mut |t| ask(t))
            };
            match has_rows {
                true => of_run(
                    &prepared,
                    (&scene, input),
                    recorded,
                    &foundations,
                    &mut repeat,
                ),
                false => prepared.without_rows(),
            }
        };
        if stop.get() {
            let built = foundations.into_iter().zip(bases);
            let built = built
                .map(|(foundation, basis)| BuiltFoundation { foundation, basis })
                .collect();
            let again = GirderInputs {
                scene,
                built,
                members,
                steps,
                has_inner_times,
                has_rows,
                rows,
                repetitions,
            };
            return Err(Box::new(again));
        }
        found
            .reactions
            .iter_mut()
            .for_each(|reaction| reaction.extend_to(columns));
        Ok(found)
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
    let finer = sim::Scene {
        output_parts: rows,
        ..input.scene.clone()
    };
    let again = sim::run_by(scene.stepping, &finer, foundations, watch).ok()?;
    again.status.is_complete().then_some(again.history)
}
