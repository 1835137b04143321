//! When rules act: their conditions at a state, and the instant within a step at which one is met.

use crate::record::energy::{boundary, stored};
use crate::time::stepper::Stepper;
use crate::{Error, Fired};

/// Time by which a step may end beyond the instant at which a rule acts, relative to the step and to the time.
const SLACK: [f64; 2] = [1e-9, 1e-13];

impl Stepper<'_, '_> {
    /// Length of the step that ends where the first rule acts, if one does within the step of length `h` just taken
    /// and not at its end already.
    pub(crate) fn first_trigger(&mut self, h: f64) -> Result<Option<f64>, Error> {
        let system = self.solver.system;
        if self.triggers.met(system, self.solver, &self.to)?.is_empty() {
            return Ok(None);
        }
        let slack = (SLACK[0] * h + SLACK[1] * self.to.t) * 10.0_f64.powi(self.triggers.missed);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        while (high - low) * h > 0.25 * slack {
            let middle = 0.5 * (low + high);
            if !self.solved_at(middle)? {
                break;
            }
            let is_met = !self.triggers.met(system, self.solver, &self.probe)?.is_empty();
            if is_met { high = middle } else { low = middle }
        }
        self.return_to_end()?;
        let length = high * h + 0.5 * slack;
        let cuts = length < h - 0.5 * slack;
        self.triggers.cut |= cuts;
        Ok(cuts.then_some(length))
    }

    /// Rules whose conditions are met where the last step ended.
    pub(crate) fn due(&mut self) -> Result<Vec<usize>, Error> {
        let due = self.triggers.met(self.solver.system, self.solver, &self.to)?;
        let missed = due.is_empty() && self.triggers.cut;
        self.triggers.missed = if missed { self.triggers.missed + 1 } else { 0 };
        self.triggers.cut = false;
        Ok(due)
    }

    /// Lets the rules that are `due` act, and those whose conditions are met then; books what switching does to the
    /// energy. Returns the rules, and whether the run ends.
    pub(crate) fn act(&mut self, mut due: Vec<usize>) -> Result<(Vec<Fired>, bool), Error> {
        let system = self.solver.system;
        let (mut fired, mut ends) = (Vec::new(), false);
        while !due.is_empty() {
            self.solver.instant(&mut self.to)?;
            let before = stored(system, &self.solver.geometry, &self.to);
            for &rule in &due {
                self.triggers.pending.retain(|trigger| trigger.rule != rule);
                fired.push(Fired { time: self.to.t, rule });
                for action in &system.scene.actuators.rules[rule].actions {
                    ends |= self.solver.geometry.switches.switch(system.scene, *action, self.to.t)?;
                }
            }
            if !self.solver.settle(&mut self.to)? {
                return Err(Error::NoEquilibrium { time: self.to.t });
            }
            let after = stored(system, &self.solver.geometry, &self.to);
            self.audit.exchanged.switches += before.total() - after.total();
            self.audit.end = after;
            self.boundary = boundary(system, &self.solver.geometry, &self.to);
            due = self.due()?;
        }
        Ok((fired, ends))
    }
}
