//! Ropes that are too stiff for a step, on the interpolant of the step.

use super::Solver;
use crate::Error;
use crate::contact::chart::{Chart, Local};
use crate::mechanics::state::State;

/// (omega h)^2 of a rope's stretch above which a step of length h does not resolve it.
const UNRESOLVED: f64 = 100.0;

impl Solver<'_> {
    /// Stretches ropes that are far stiffer than a step of length `h` resolves so that they are in balance at `at`:
    /// rates of their stretch say nothing between the ends of the step.
    ///
    /// # Errors
    /// What the rail refuses.
    pub(super) fn stretch_ropes(&mut self, h: f64, at: &mut State) -> Result<(), Error> {
        let charts = std::mem::take(&mut self.charts);
        let done = charts.iter().try_for_each(|chart| self.stretch_rope(chart, h, at));
        self.charts = charts;
        done
    }

    fn stretch_rope(&mut self, chart: &Chart, h: f64, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let Some(anchor) = chart.anchor(system, self.geometry.switches(), at.t) else { return Ok(()) };
        let Some(Local { y, rate, span, .. }) = chart.local(system, &anchor, at.t, &at.q, &at.v) else {
            return Ok(());
        };
        let mut accelerations = [0.0; 2];
        let step = 0.1 * y[0].abs() + 1e-12 * span;
        for (acceleration, stretch) in accelerations.iter_mut().zip([y[0] + step, y[0]]) {
            chart.place(system, self.geometry.switches(), [stretch, y[1], y[2]], rate, at);
            if !self.instant(at)? {
                return Ok(());
            }
            let Some(local) = chart.local(system, &anchor, at.t, &at.q, &at.v) else { return Ok(()) };
            let total = chart.vector(&at.a) - anchor.point.rate(&at.a) - anchor.given[1] - local.curve;
            *acceleration = local.solve(total)[0];
        }
        let square = (accelerations[1] - accelerations[0]) / step;
        if square * h * h > UNRESOLVED {
            let stretch = y[0] + accelerations[1] / square;
            chart.place(system, self.geometry.switches(), [stretch, y[1], y[2]], rate, at);
        }
        Ok(())
    }
}
