//! The result of one case of a scene.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use formats::scene::motion::SimulationInput;
use sim::{History, Run, Solution};

use crate::codes::CodeCheck;
use crate::columns::NamedColumns;
use crate::fatigue::FatigueResult;
use crate::girders::{DeferredGirders, GirderExtremes};
use crate::response::{ColumnInfluence, Response};
use crate::steps::ColumnPeak;
use crate::undetermined::Undetermined;

/// The result of one case: its run and the quantities computed from it.
///
/// ```
/// use formats::scene::Document;
/// use foundations::{distinct_specs, solve_specs};
/// use results::case_result::CaseResult;
///
/// let document = Document::open("../../examples/bogie/scene.json".as_ref()).expect("a scene without faults");
/// let solved = solve_specs(&document, &distinct_specs(&document)).expect("a girder that stands");
/// let cases = results::cases::simulate(&document, &solved, None, &|_| ()).expect("a scene that starts");
///
/// let CaseResult { label, run, columns, choices, .. } = &cases[0];
/// assert_eq!(label, document.scene().structures[0].foundation.word());
/// assert_eq!(columns.values("time").len(), run.history.len());
/// assert!(choices.is_empty(), "its foundation is not \"auto\"");
/// ```
pub struct CaseResult {
    /// Its label; for the run of the scene itself, the foundations of its structures.
    pub label: String,
    /// The simulation input.
    pub input: SimulationInput,
    /// The run: status, history, counts, energy audit.
    pub run: Run,
    /// The history as named columns, with reactions, internal forces and stresses.
    pub columns: NamedColumns,
    /// The largest and the smallest value of every column but time, at whatever time it has them.
    pub peaks: Vec<ColumnPeak>,
    /// Extremes that the run does not determine.
    pub undetermined: Vec<Undetermined>,
    /// The fidelity chosen for each structure whose foundation is "auto", with the reason.
    pub choices: Vec<sim::Choice>,
    /// Influence lines of the columns of each structure; `None` for a structure without columns.
    pub lines: Vec<Option<ColumnInfluence>>,
    /// The response of the structures.
    pub response: Response,
    /// Extremes and envelopes of the girders, or what they are computed from.
    pub(crate) girders: DeferredGirders,
    /// Values of codes compared with those of the run; `None` where the scene does not request them.
    pub codes: Option<CodeCheck>,
    /// Damage at the stress points that have a detail category.
    pub fatigue: Vec<FatigueResult>,
    /// Bounds of the relative errors of influence coefficients, by structure.
    pub error_bounds: Vec<(String, f64)>,
    /// By rail of the scene: whether its lateral deflections are upper bounds ([`trains::twists_without_warping`]).
    pub is_lateral_bound: Vec<bool>,
    /// What first order leaves out, once it has been asked for.
    pub(crate) second_order: OnceLock<Vec<FirstOrderDoubt>>,
    /// Its warnings, once they have been asked for.
    pub(crate) warnings: OnceLock<Vec<String>>,
}

/// How far first order does not hold for a structure, where that is to be told: as a warning or a note.
#[derive(Clone, Debug)]
pub(crate) struct FirstOrderDoubt {
    pub is_warning: bool,
    pub text: String,
}

impl CaseResult {
    /// Extremes and envelopes of the girders. Where the run has left them
    /// ([`GirderTime::OnDemand`](crate::cases::GirderTime::OnDemand)), the first who asks computes them.
    #[must_use]
    pub fn girders(&self) -> &GirderExtremes {
        self.girders.get(&self.input, &self.run.solution)
    }

    /// The extremes and envelopes of the girders as [`CaseResult::girders`] returns them; `None` where `go_on` has broken
    /// off. Who asks again computes them from the beginning.
    pub fn girders_while(&self, go_on: &dyn Fn() -> ControlFlow<()>) -> Option<&GirderExtremes> {
        let solution = &self.run.solution;
        self.girders
            .get_while(&self.input, solution, &mut || go_on())
    }

    /// The peaks of the column `<owner>.<part>`; `None` where there is none.
    #[must_use]
    pub fn peak(&self, owner: &str, part: &str) -> Option<&ColumnPeak> {
        let name = format!("{owner}.{part}");
        self.peaks.iter().find(|peak| peak.column == name)
    }

    /// Drops the history of the run, whose values are in the columns, and its solution, unless extremes of girders are still to be
    /// computed from it.
    pub fn drop_history(&mut self) {
        self.run.history = History::default();
        if self.girders.is_found() {
            self.run.solution = Solution::default();
        }
    }
}
