//! What stepping tells of a run: the work done, and the first strike of a flange or a stop, after which runs part.

/// Work done by a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: usize,
    /// Rejected steps.
    pub rejected: usize,
    /// Solutions of the contact forces in the stages of all steps.
    pub stages: usize,
    /// Instants at which a wheel left or met the rail.
    pub events: usize,
}

/// What struck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StruckBy {
    /// The flange of this wheel met its rail.
    Flange(usize),
    /// This stop of the scene was met.
    Stop(usize),
}

/// The first strike of a flange or a stop in a run. A flange or a stop turns a small difference of speeds into one of
/// times, and each further strike multiplies it: from this time on, values of runs with different accuracies differ at equal
/// times, while their extremes agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstImpact {
    /// Time of the strike.
    pub time: f64,
    /// What struck.
    pub by: StruckBy,
}
