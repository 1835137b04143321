//! The active set of force elements: constant within a step, revised at its end.

use crate::mechanics::state::State;

/// Relative rounding error of a penetration.
pub(crate) const ROUNDING: f64 = 1e-12;

/// The active elements, and the stored penetrations of the dampers of open contacts.
#[derive(Clone, PartialEq)]
pub(crate) struct ActiveSet {
    active: Vec<bool>,
    stored: Vec<Option<[f64; 2]>>,
}

impl ActiveSet {
    /// The active set with the initial flags `begin` and `verticals` vertical contacts, which are the first elements.
    pub fn new(begin: Vec<bool>, verticals: usize) -> Self {
        ActiveSet {
            active: begin,
            stored: vec![None; verticals],
        }
    }

    /// Whether element `i` is active.
    pub fn has(&self, i: usize) -> bool {
        self.active[i]
    }

    /// Active flags of all elements.
    pub fn flags(&self) -> &[bool] {
        &self.active
    }

    /// Activates or deactivates element `i`.
    pub fn set(&mut self, i: usize, is_active: bool) {
        self.active[i] = is_active;
    }

    /// Penetration of vertical contact `i` at the time it opened, and that time; `None` if it has not opened during
    /// the run.
    pub fn stored(&self, i: usize) -> Option<[f64; 2]> {
        self.stored[i]
    }

    /// Stores the penetration and the time at which vertical contact `i` opens at `at`.
    pub fn store(&mut self, i: usize, at: &State) {
        self.stored[i] = Some([at.p[i].max(0.0) * (1.0 + ROUNDING), at.t]);
    }

    /// Copies all data of `other`.
    pub fn copy_from(&mut self, other: &ActiveSet) {
        self.active.clone_from(&other.active);
        self.stored.clone_from(&other.stored);
    }
}
