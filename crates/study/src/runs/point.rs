//! What came of a setting.

use crate::measure::deviation::Deviation;
use crate::measure::memory::Memory;
use crate::measure::quantity::ErrorGroup;
use crate::measure::spread::Spread;
use crate::settings::setting::Setting;

/// A setting with what came of it.
#[derive(Clone, Debug)]
pub struct StudyPoint {
    /// The setting.
    pub setting: Setting,
    /// What came of it.
    pub outcome: PointOutcome,
}

/// What came of a setting.
#[derive(Clone, Debug)]
pub enum PointOutcome {
    /// It ran to its end.
    Done(Box<MeasuredPoint>),
    /// It took longer than a setting may.
    Stopped,
    /// It could not be set up or did not reach its end; why.
    Refused(String),
}

/// Error and cost of a run.
#[derive(Clone, Debug)]
pub struct MeasuredPoint {
    /// Errors, one a group.
    pub errors: [Option<Deviation>; ErrorGroup::COUNT],
    /// Steps, stages, events.
    pub counts: sim::Counts,
    /// Freedoms of the foundations.
    pub dof_count: usize,
    /// Times of runs, in seconds that the thread worked.
    pub time: Option<Spread>,
    /// Seconds that it took to make the foundations.
    pub setup: f64,
    /// Memory that it takes, where the program counts it.
    pub memory: Option<Memory>,
}

impl StudyPoint {
    /// What was measured, where it ran to its end.
    #[must_use]
    pub fn measured(&self) -> Option<&MeasuredPoint> {
        match &self.outcome {
            PointOutcome::Done(measured) => Some(measured),
            PointOutcome::Stopped | PointOutcome::Refused(_) => None,
        }
    }

    /// Largest error in a group.
    #[must_use]
    pub fn error(&self, quantity: ErrorGroup) -> Option<f64> {
        let at = ErrorGroup::ALL.iter().position(|own| *own == quantity)?;
        self.measured()?.errors[at].map(|own| own.largest)
    }

    /// Median time.
    #[must_use]
    pub fn seconds(&self) -> Option<f64> {
        self.measured()?.time.map(|spread| spread.median)
    }
}
