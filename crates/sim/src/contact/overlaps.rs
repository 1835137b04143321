//! Overlaps of the flanges with their rails.

use crate::Flange;
use crate::contact::solver::Solver;
use crate::mechanics::state::State;
use crate::numerics::dense::along;

impl Solver<'_> {
    /// Overlap of every flange with its rail at `at`, to which the geometry belongs; negative where it is free.
    pub fn overlaps(&self, at: &State) -> Vec<f64> {
        let flanges = self.system.laterals.iter().enumerate();
        flanges
            .map(|(index, &w)| {
                let i = self.system.lateral(index);
                let e = self.geometry.approach(i, &at.q) - along(&self.geometry.compliance, i, &at.force);
                self.flange(w).map_or(0.0, |flange| e.abs() - flange.clearance)
            })
            .collect()
    }

    pub fn flange(&self, w: usize) -> Option<&Flange> {
        self.system.scene.wheels[self.system.mechanics.wheels[w].kind].flange.as_ref()
    }
}
