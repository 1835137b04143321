//! Where flanges begin and cease to touch: steps end there, so that each is smooth.

use crate::Error;
use crate::numerics::root::narrow;
use crate::time::stepper::{OVERSHOOT, Stepper};

/// Share of a step to which the place of a touch is found.
const WIDTH: f64 = 1e-4;

impl Stepper<'_, '_> {
    /// Share of the step just taken at which a flange first touches its rail or leaves it, if one does by more than a
    /// force of [`OVERSHOOT`]: the first root of the overlaps on the interpolant.
    pub(crate) fn first_touch(&mut self) -> Result<Option<f64>, Error> {
        if self.overlaps.is_empty() {
            return Ok(None);
        }
        let slack = OVERSHOOT * self.largest_force();
        // Flanges that pass from one side to the other, and where they have: there their distance to it is positive.
        let mut passes: Vec<(usize, f64)> = Vec::new();
        let mut ends = [f64::NEG_INFINITY; 2];
        for (index, now) in self.solver.overlaps(&self.to).into_iter().enumerate() {
            let Some(flange) = self.solver.flange(self.solver.system.laterals[index]) else { continue };
            let (before, slack) = (self.overlaps[index], slack / flange.stiffness);
            if before * now < 0.0 && before.abs().min(now.abs()) > slack {
                let aim = 0.5 * slack * now.signum();
                passes.push((index, aim));
                for (end, overlap) in ends.iter_mut().zip([before, now]) {
                    *end = end.max((overlap - aim) * aim.signum());
                }
            }
        }
        if passes.is_empty() {
            return Ok(None);
        }
        let mut failure = None;
        let [_, first] = narrow(ends, WIDTH, |share| {
            let solved = self.solved_at(share).unwrap_or_else(|error| {
                failure = Some(error);
                false
            });
            solved.then(|| {
                let overlaps = self.solver.overlaps(&self.probe);
                let beyond = passes.iter().map(|&(index, aim)| (overlaps[index] - aim) * aim.signum());
                beyond.fold(f64::NEG_INFINITY, f64::max)
            })
        });
        if let Some(error) = failure {
            return Err(error);
        }
        self.return_to_end()?;
        Ok(Some(first))
    }
}
