//! Which force elements act: fixed within a step, revised at its end.

use crate::mechanics::state::State;

/// Relative rounding of a penetration.
pub(crate) const ROUNDING: f64 = 1e-12;

/// The elements that may push or pull, and what the dampers of open contacts have stored.
#[derive(Clone, PartialEq)]
pub(crate) struct ActiveSet {
    active: Vec<bool>,
    stored: Vec<Option<[f64; 2]>>,
}

impl ActiveSet {
    /// Elements that `begin` active, the `verticals` vertical contacts first.
    pub fn new(begin: Vec<bool>, verticals: usize) -> Self {
        ActiveSet { active: begin, stored: vec![None; verticals] }
    }

    /// Whether element `i` is active.
    pub fn has(&self, i: usize) -> bool {
        self.active[i]
    }

    /// The flags of all elements.
    pub fn flags(&self) -> &[bool] {
        &self.active
    }

    /// Activates or deactivates element `i`.
    pub fn set(&mut self, i: usize, is_active: bool) {
        self.active[i] = is_active;
    }

    /// Penetration that the damper of vertical contact `i` had stored as it opened, and when; `None` where it has not
    /// opened during the run.
    pub fn stored(&self, i: usize) -> Option<[f64; 2]> {
        self.stored[i]
    }

    /// Stores the penetration at which vertical contact `i` opens at `at`.
    pub fn store(&mut self, i: usize, at: &State) {
        self.stored[i] = Some([at.p[i].max(0.0) * (1.0 + ROUNDING), at.t]);
    }

    /// Takes all of `other`.
    pub fn copy_from(&mut self, other: &ActiveSet) {
        self.active.clone_from(&other.active);
        self.stored.clone_from(&other.stored);
    }
}
