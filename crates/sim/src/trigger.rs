//! When rules act: their conditions at a state, and the instant within a step at which one is met.

use crate::energy::{boundary, stored};
use crate::recorder::Recorder;
use crate::solver::Solver;
use crate::state::State;
use crate::stepper::Stepper;
use crate::system::System;
use crate::{Error, Fired};

/// Time by which a step may end beyond the instant at which a rule acts, relative to the step and to the time.
const SLACK: [f64; 2] = [1e-9, 1e-13];

/// How often a step is taken again to end where a rule acts.
pub(crate) const TRIALS: usize = 20;

/// The rules that have not acted yet.
pub(crate) struct Triggers {
    pending: Vec<Trigger>,
    recorder: Recorder,
    row: Vec<f64>,
    /// Whether the last step was cut to end where a rule acts.
    cut: bool,
    /// Steps in a row that were cut and at whose end rounding hid the condition: each allows ten times the slack.
    missed: i32,
}

/// A rule and the columns of the history that its condition sums, with their factors.
struct Trigger {
    rule: usize,
    columns: Vec<(usize, f64)>,
}

impl Triggers {
    /// All rules of a scene.
    ///
    /// # Errors
    /// A channel that the history does not have.
    pub fn new(system: &System) -> Result<Self, Error> {
        let recorder = Recorder::new(system);
        let rules = &system.scene.actuators.rules;
        let column = |channel, rule| {
            let at = recorder.history.channels().iter().position(|known| *known == channel);
            at.ok_or(Error::NoSuch { what: "quantity of rule", index: rule })
        };
        let mut pending = Vec::new();
        for (rule, given) in rules.iter().enumerate() {
            let terms = given.when.terms.iter();
            let columns = terms
                .map(|(channel, factor)| Ok((column(*channel, rule)?, *factor)))
                .collect::<Result<_, Error>>()?;
            pending.push(Trigger { rule, columns });
        }
        Ok(Triggers { pending, recorder, row: Vec::new(), cut: false, missed: 0 })
    }

    /// Rules whose conditions are met at `at`, where the solver's geometry belongs to it.
    fn met(&mut self, system: &System, solver: &Solver, at: &State) -> Result<Vec<usize>, Error> {
        if self.pending.is_empty() {
            return Ok(Vec::new());
        }
        self.row.clear();
        self.recorder.row(system, &solver.geometry, at, &mut self.row)?;
        let is_met = |trigger: &&Trigger| {
            let sum = trigger.columns.iter().map(|&(column, factor)| factor * self.row[column]).sum();
            system.scene.actuators.rules[trigger.rule].when.is_met(sum)
        };
        Ok(self.pending.iter().filter(is_met).map(|trigger| trigger.rule).collect())
    }
}

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
