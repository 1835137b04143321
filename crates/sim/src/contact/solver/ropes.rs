//! Corrects the interpolant of a step for ropes whose stretch is too stiff to be resolved by the step.

use super::Solver;
use crate::Error;
use crate::contact::chart::{Chart, Local};
use crate::mechanics::state::State;

/// Value of (omega h)^2 of the stretch of a rope above which a step of length h does not resolve the oscillation.
const UNRESOLVED: f64 = 100.0;

impl Solver<'_> {
    /// Sets the stretch of every rope that a step of length `h` does not resolve to its equilibrium at `at`, because
    /// the interpolated rates of such a stretch are meaningless between the ends of the step.
    ///
    /// For each chart the acceleration of the stretch is evaluated at two values of the stretch. The difference
    /// quotient is -omega^2. If (omega h)^2 exceeds `UNRESOLVED`, one Newton step sets the stretch to the value at
    /// which its acceleration is zero.
    ///
    /// # Errors
    /// Errors of the rail models.
    pub(super) fn stretch_ropes(&mut self, h: f64, at: &mut State) -> Result<(), Error> {
        let charts = std::mem::take(&mut self.charts);
        let done = charts
            .iter()
            .try_for_each(|chart| self.stretch_rope(chart, h, at));
        self.charts = charts;
        done
    }

    fn stretch_rope(&mut self, chart: &Chart, h: f64, at: &mut State) -> Result<(), Error> {
        let system = self.system;
        let Some(anchor) = chart.anchor(system, self.geometry.switches(), at.t) else {
            return Ok(());
        };
        let Some(Local { y, rate, span, .. }) = chart.local(system, &anchor, at.t, &at.q, &at.v)
        else {
            return Ok(());
        };
        let mut accelerations = [0.0; 2];
        let step = 0.1 * y[0].abs() + 1e-12 * span;
        for (acceleration, stretch) in accelerations.iter_mut().zip([y[0] + step, y[0]]) {
            chart.place(
                system,
                self.geometry.switches(),
                [stretch, y[1], y[2]],
                rate,
                at,
            );
            if !self.instant(at)? {
                return Ok(());
            }
            let Some(local) = chart.local(system, &anchor, at.t, &at.q, &at.v) else {
                return Ok(());
            };
            let total =
                chart.vector(&at.a) - anchor.point.rate(&at.a) - anchor.given[1] - local.curve;
            *acceleration = local.solve(total)[0];
        }
        let square = (accelerations[1] - accelerations[0]) / step;
        if square * h * h > UNRESOLVED {
            let stretch = y[0] + accelerations[1] / square;
            chart.place(
                system,
                self.geometry.switches(),
                [stretch, y[1], y[2]],
                rate,
                at,
            );
        }
        Ok(())
    }
}
