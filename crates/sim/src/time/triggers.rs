//! Rules that have not acted yet, and whether their conditions are met at a state.

use crate::Error;
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::record::recorder::Recorder;

/// The rules that have not acted yet.
pub(crate) struct Triggers {
    pub pending: Vec<Trigger>,
    recorder: Recorder,
    row: Vec<f64>,
    /// Whether the last step was cut to end where a rule acts.
    pub cut: bool,
    /// Steps in a row that were cut and at whose end rounding hid the condition: each allows ten times the slack.
    pub missed: i32,
}

/// A rule and the columns of the history that its condition sums, with their factors.
pub(crate) struct Trigger {
    pub rule: usize,
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
    pub fn met(&mut self, system: &System, solver: &Solver, at: &State) -> Result<Vec<usize>, Error> {
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
