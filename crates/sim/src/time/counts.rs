//! Counts of the work done by a run.

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
