//! Rules that have not acted yet: whether their conditions are met, and the instant within a step at which one is.

use super::step::Step;
use crate::Error;
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::record::recorder::Recorder;

/// Time by which a step may end beyond the instant at which a rule acts, relative to the step and to the time.
const SLACK: [f64; 2] = [1e-9, 1e-13];

/// The rules that have not acted yet.
pub(crate) struct Triggers {
    pending: Vec<Trigger>,
    /// Where there are rules.
    recorder: Option<Recorder>,
    row: Vec<f64>,
    /// Whether the last step was cut to end where a rule acts.
    has_cut: bool,
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
        let rules = &system.scene.actuators.rules;
        let recorder = (!rules.is_empty()).then(|| Recorder::new(system));
        let column = |channel, rule| {
            let position = recorder.as_ref().and_then(|recorder| recorder.history().position(channel));
            position.ok_or(Error::NoSuch { what: "quantity of rule", index: rule })
        };
        let mut pending = Vec::new();
        for (rule, given) in rules.iter().enumerate() {
            let terms = given.when.terms.iter();
            let columns = terms
                .map(|(channel, factor)| Ok((column(*channel, rule)?, *factor)))
                .collect::<Result<_, Error>>()?;
            pending.push(Trigger { rule, columns });
        }
        Ok(Triggers { pending, recorder, row: Vec::new(), has_cut: false, missed: 0 })
    }

    /// Rules whose conditions are met at `at`, where the solver's geometry belongs to it.
    fn met(&mut self, solver: &Solver, at: &State) -> Result<Vec<usize>, Error> {
        let Some(recorder) = self.recorder.as_mut().filter(|_| !self.pending.is_empty()) else {
            return Ok(Vec::new());
        };
        let system = solver.system();
        self.row.clear();
        recorder.row(system, solver.geometry(), at, &mut self.row)?;
        let is_met = |trigger: &&Trigger| {
            let sum = trigger.columns.iter().map(|&(column, factor)| factor * self.row[column]).sum();
            system.scene.actuators.rules[trigger.rule].when.is_met(sum)
        };
        Ok(self.pending.iter().filter(is_met).map(|trigger| trigger.rule).collect())
    }

    /// Length of the step that ends where the first rule acts, if one does within the step of length `h` just taken
    /// and not at its end already.
    ///
    /// # Errors
    /// What the rails refuse.
    pub fn first(&mut self, step: &mut Step, h: f64) -> Result<Option<f64>, Error> {
        if self.pending.is_empty() || self.met(step.solver, &step.to)?.is_empty() {
            return Ok(None);
        }
        let slack = (SLACK[0] * h + SLACK[1] * step.to.t) * 10.0_f64.powi(self.missed);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        while (high - low) * h > 0.25 * slack {
            let middle = 0.5 * (low + high);
            if !step.look_at(middle)? {
                break;
            }
            let is_met = !self.met(step.solver, &step.probe)?.is_empty();
            if is_met { high = middle } else { low = middle }
        }
        step.return_to_end()?;
        let length = high * h + 0.5 * slack;
        let cuts = length < h - 0.5 * slack;
        self.has_cut |= cuts;
        Ok(cuts.then_some(length))
    }

    /// Rules whose conditions are met where the last step ended.
    ///
    /// # Errors
    /// What the rails refuse.
    pub fn due(&mut self, step: &Step) -> Result<Vec<usize>, Error> {
        let due = self.met(step.solver, &step.to)?;
        let is_missed = due.is_empty() && self.has_cut;
        self.missed = if is_missed { self.missed + 1 } else { 0 };
        self.has_cut = false;
        Ok(due)
    }

    /// Takes a rule that acts from those that are pending.
    pub fn take(&mut self, rule: usize) {
        self.pending.retain(|trigger| trigger.rule != rule);
    }
}
