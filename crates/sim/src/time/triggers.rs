//! Rules that have not acted yet: evaluation of their conditions, and location of the instant within a step at which
//! one is met.

use super::step::Step;
use crate::Error;
use crate::contact::solver::Solver;
use crate::contact::system::System;
use crate::mechanics::state::State;
use crate::record::recorder::Recorder;

/// Time by which a step may end after the instant at which a rule acts, relative to the step and to the time.
const SLACK: [f64; 2] = [1e-9, 1e-13];

/// The rules that have not acted yet.
pub(crate) struct Triggers {
    pending: Vec<Trigger>,
    /// Evaluates the channels of the conditions; `None` if there are no rules.
    recorder: Option<Recorder>,
    row: Vec<f64>,
    /// Whether the last step was cut to end where a rule acts.
    has_cut: bool,
    /// Number of consecutive steps that were cut but at whose end the condition was not met because of rounding; each
    /// of them increases the slack tenfold.
    missed: i32,
}

/// A rule and the columns of the history that its condition adds up, with their factors.
struct Trigger {
    rule: usize,
    columns: Vec<(usize, f64)>,
}

impl Triggers {
    /// Creates the triggers for all rules of a scene.
    ///
    /// # Errors
    /// A rule refers to a channel that is not in the history.
    pub fn new(system: &System) -> Result<Self, Error> {
        let rules = &system.scene.actuators.rules;
        let recorder = (!rules.is_empty()).then(|| Recorder::new(system));
        let column = |channel, rule| {
            let position = recorder.as_ref().and_then(|recorder| {
                let channels = recorder.channels();
                channels.iter().position(|known| *known == channel)
            });
            position.ok_or(Error::NoSuch {
                what: "quantity of rule",
                index: rule,
            })
        };
        let mut pending = Vec::new();
        for (rule, given) in rules.iter().enumerate() {
            let terms = given.when.terms.iter();
            let columns = terms
                .map(|(channel, factor)| Ok((column(*channel, rule)?, *factor)))
                .collect::<Result<_, Error>>()?;
            pending.push(Trigger { rule, columns });
        }
        Ok(Triggers {
            pending,
            recorder,
            row: Vec::new(),
            has_cut: false,
            missed: 0,
        })
    }

    /// Rules whose conditions are met in the state `at`, for which the geometry of the solver must be current.
    fn met(&mut self, solver: &Solver, at: &State) -> Result<Vec<usize>, Error> {
        let Some(recorder) = self.recorder.as_mut().filter(|_| !self.pending.is_empty()) else {
            return Ok(Vec::new());
        };
        let system = solver.system();
        self.row.clear();
        recorder.row(system, solver.geometry(), at, &mut self.row)?;
        let is_met = |trigger: &&Trigger| {
            let sum = trigger
                .columns
                .iter()
                .map(|&(column, factor)| factor * self.row[column])
                .sum();
            system.scene.actuators.rules[trigger.rule].when.is_met(sum)
        };
        Ok(self
            .pending
            .iter()
            .filter(is_met)
            .map(|trigger| trigger.rule)
            .collect())
    }

    /// Finds by bisection the length of the step that ends where the first rule acts. Returns `None` if no rule acts
    /// within the step of length `h` just taken, or if one acts only at its end.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
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

    /// Rules whose conditions are met at the end of the last step.
    ///
    /// # Errors
    /// Any error from evaluating the rails.
    pub fn due(&mut self, step: &Step) -> Result<Vec<usize>, Error> {
        let due = self.met(step.solver, &step.to)?;
        let is_missed = due.is_empty() && self.has_cut;
        self.missed = if is_missed { self.missed + 1 } else { 0 };
        self.has_cut = false;
        Ok(due)
    }

    /// Removes a rule that acts from the pending ones.
    pub fn take(&mut self, rule: usize) {
        self.pending.retain(|trigger| trigger.rule != rule);
    }
}
