//! Where flanges begin and cease to touch: steps end there, so that each is smooth.

use crate::Error;
use crate::dense::along;
use crate::events::OVERSHOOT;
use crate::root::narrow;
use crate::solver::Solver;
use crate::state::State;
use crate::stepper::Stepper;
use crate::wheel::Flange;

/// Share of a step to which the place of a touch is found.
const WIDTH: f64 = 1e-6;

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

    fn flange(&self, w: usize) -> Option<&Flange> {
        self.system.scene.wheels[self.system.wheels[w].kind].flange.as_ref()
    }
}

impl Stepper<'_, '_> {
    /// Share of the step just taken at which a flange first touches its rail or leaves it, if one does by more than a
    /// force of [`OVERSHOOT`]: the root of its overlap on the interpolant.
    pub(crate) fn first_touch(&mut self) -> Result<Option<f64>, Error> {
        if self.overlaps.is_empty() {
            return Ok(None);
        }
        let slack = OVERSHOOT * self.largest_force();
        let mut first: Option<f64> = None;
        for (index, now) in self.solver.overlaps(&self.to).into_iter().enumerate() {
            let Some(flange) = self.solver.flange(self.solver.system.laterals[index]) else { continue };
            let (before, slack) = (self.overlaps[index], slack / flange.stiffness);
            if before * now >= 0.0 || before.abs().min(now.abs()) <= slack {
                continue;
            }
            let aim = 0.5 * slack * now.signum();
            let mut failure = None;
            let [_, share] = narrow([before - aim, now - aim], WIDTH, |share| {
                let value = self.solved_at(share);
                let value =
                    value.map(|solved| solved.then(|| self.solver.overlaps(&self.probe)[index] - aim));
                value.unwrap_or_else(|error| {
                    failure = Some(error);
                    None
                })
            });
            if let Some(error) = failure {
                return Err(error);
            }
            first = Some(first.map_or(share, |known| known.min(share)));
        }
        if first.is_some() {
            self.probe.copy_from(&self.to);
            self.solver.instant(&mut self.probe)?;
        }
        Ok(first)
    }
}
