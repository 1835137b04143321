//! Extremes of girders that are computed when they are first asked for, from what the run has left.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use formats::scene::Scene;
use formats::scene::motion::SimulationInput;
use foundations::{BuiltFoundation, SolvedModel, solution_of};
use sim::{Channel, Solution, SolutionNodes};

use super::GirderExtremes;
use super::solved::SolvedMembers;
use super::structure::PreparedGirders;
use crate::loads::WheelLoadReader;

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

    /// The extremes, which the first who asks computes. `input` and `solution` are those of the run.
    pub fn get(&self, input: &SimulationInput, solution: &Solution) -> &GirderExtremes {
        let found = self.get_while(input, solution, &mut || ControlFlow::Continue(()));
        // nobody stops it
        found.unwrap_or_else(|| self.found.get_or_init(GirderExtremes::default))
    }

    /// The extremes as [`DeferredGirders::get`] returns them; `None` where `watch` has broken off. Who asks again computes
    /// them from the beginning.
    pub fn get_while(
        &self,
        input: &SimulationInput,
        solution: &Solution,
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Option<&GirderExtremes> {
        let mut inputs = self.inputs.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(own) = inputs.take() {
            match own.extremes(input, (solution, &solution.intervals()), watch) {
                Some(found) => return Some(self.found.get_or_init(|| found)),
                None => *inputs = Some(own),
            }
        }
        self.found.get()
    }

    /// Whether they are computed.
    pub fn is_found(&self) -> bool {
        self.found.get().is_some()
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

/// What the extremes of the girders of a run are computed from, beside its solution.
pub(crate) struct GirderInputs {
    /// The scene with the foundations that were chosen.
    pub scene: Scene,
    pub built: Vec<BuiltFoundation>,
    pub members: Arc<SolvedMembers>,
}

impl GirderInputs {
    /// Computes the extremes; `None` where `watch`, which is called many times, breaks off.
    pub fn extremes(
        &self,
        input: &SimulationInput,
        (solution, nodes): (&Solution, &SolutionNodes),
        watch: &mut dyn FnMut() -> ControlFlow<()>,
    ) -> Option<GirderExtremes> {
        let GirderInputs {
            scene,
            built,
            members,
        } = self;
        let is_stopped = Cell::new(false);
        let watch = std::cell::RefCell::new(watch);
        let ask = || {
            if !is_stopped.get() && (*watch.borrow_mut())().is_break() {
                is_stopped.set(true);
            }
            is_stopped.get()
        };
        let loads = WheelLoadReader::new(scene, input, &nodes.rows);
        let mut out = GirderExtremes::default();
        for (s, built) in built.iter().enumerate() {
            let solved: Option<&SolvedModel> =
                solution_of(members.known(), &scene.structures[s].origin);
            let Some(solved) = solved else { continue };
            // a structure that moves is evaluated where its motion was recorded
            let is_recorded = solution.position(Channel::Coordinate(s, 0)).is_some();
            let is_known = built.foundation.dofs() == 0 || is_recorded;
            match PreparedGirders::new(scene, s, built, solved, members) {
                Ok(Some(girders)) if is_known && !ask() => {
                    girders.add((solution, nodes), &loads, &built.foundation, &ask, &mut out);
                }
                Ok(_) => {}
                Err(error) => out
                    .notes
                    .push(format!("extremes of girders were not computed: {error}")),
            }
        }
        (!is_stopped.get()).then_some(out)
    }
}
