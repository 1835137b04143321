//! Settings with their outcomes: errors and costs.

use crate::measure::deviation::Deviation;
use crate::measure::memory::Memory;
use crate::measure::quantity::ErrorGroup;
use crate::measure::spread::TimeSpread;
use crate::settings::setting::Setting;

/// A setting with its outcome.
#[derive(Clone, Debug)]
pub struct StudyPoint {
    /// The setting.
    pub setting: Setting,
    /// Its outcome.
    pub outcome: PointOutcome,
}

/// The outcome of a setting.
#[derive(Clone, Debug)]
pub enum PointOutcome {
    /// It ran to its end.
    Done(Box<MeasuredPoint>),
    /// It exceeded the time limit of a setting.
    Stopped,
    /// It could not be set up or did not reach its end; the reason.
    Refused(String),
}

/// Error and cost of a run.
#[derive(Clone, Debug)]
pub struct MeasuredPoint {
    /// Errors in the order of [`ErrorGroup::ALL`]; `None` where the reference has nothing to compare.
    pub errors: [Option<Deviation>; ErrorGroup::COUNT],
    /// The measure by which they are judged.
    pub measure: sim::Measure,
    /// Numbers of steps, stages and events.
    pub counts: sim::Counts,
    /// Degrees of freedom of the foundations.
    pub dof_count: usize,
    /// Thread times of runs.
    pub time: Option<TimeSpread>,
    /// Thread time, s, that building the foundations took.
    pub setup: f64,
    /// Memory that it takes, where the program counts allocations.
    pub memory: Option<Memory>,
}

impl StudyPoint {
    /// The measured error and cost, where the setting ran to its end.
    #[must_use]
    pub fn measured(&self) -> Option<&MeasuredPoint> {
        match &self.outcome {
            PointOutcome::Done(measured) => Some(measured),
            PointOutcome::Stopped | PointOutcome::Refused(_) => None,
        }
    }

    /// Relative error in a group by the measure of the study.
    #[must_use]
    pub fn error(&self, group: ErrorGroup) -> Option<f64> {
        let at = ErrorGroup::ALL.iter().position(|own| *own == group)?;
        let measured = self.measured()?;
        measured.errors[at].map(|own| own.by(measured.measure))
    }

    /// Median thread time of a run, s.
    #[must_use]
    pub fn seconds(&self) -> Option<f64> {
        self.measured()?.time.map(|spread| spread.median)
    }
}
