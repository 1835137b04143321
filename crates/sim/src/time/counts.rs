//! How much work a run took.

/// Work done by a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Accepted steps.
    pub steps: usize,
    /// Rejected steps.
    pub rejected: usize,
    /// Contact solutions in stages.
    pub stages: usize,
    /// Instants at which a wheel left or met the rail.
    pub events: usize,
}
