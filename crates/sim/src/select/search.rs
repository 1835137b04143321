//! Search for the lowest sufficient fidelity of one structure.

use std::ops::ControlFlow;

use super::distance::distance;
use super::fidelity::{Fidelity, MODES, contact_frequency};
use super::predict::predict;
use super::selection::{Choice, FidelityTrial, FoundationProvider, RUN_ACCURACY, Reason, SAFE};
use crate::{Foundation, Run, Scene, Status, Structure};

/// Ratio of the highest modelled frequency to that of a body on its contacts, above which a modal fidelity can check
/// lower fidelities.
const ABOVE_CONTACT: f64 = 3.0;
/// Upper bound of the ratio of the error of a mesh to its difference from a mesh with half as many elements. For
/// convergence of order 4 in the element length the ratio is 1/15.
const HALVED: f64 = 0.25;
/// Predicted error, relative to the tolerance, above which a fidelity is skipped: rigid, influence, modes.
const SKIP: [f64; 3] = [1.5, 6.0, 10.0];
/// Predicted error, relative to the tolerance, below which a fidelity is accepted without a check: rigid, influence,
/// modes.
const TAKE: [f64; 3] = [0.25, 0.2, 0.15];
/// Further factor on the highest modelled frequency where a modal fidelity is accepted without a check.
const FAR: f64 = 3.0;

/// A fidelity with its foundation and its run.
pub(super) struct Candidate {
    pub fidelity: Fidelity,
    pub foundation: Foundation,
    pub run: Run,
}

/// Result of the search.
pub(super) struct Outcome {
    pub choice: Choice,
    pub found: Candidate,
    /// Number of runs made.
    pub runs: usize,
}

/// State of the search for one structure.
pub(super) struct Search<'a, L: FoundationProvider> {
    scene: &'a Scene,
    finer: Scene,
    tolerance: f64,
    structure: usize,
    foundations: &'a mut [Foundation],
    provider: &'a mut L,
    watch: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
    choice: Choice,
    error: Option<L::Error>,
    runs: usize,
}

/// Fidelities to be tried.
struct Plan {
    /// Fidelities that are run first and compared with the first fidelity of `higher`.
    lower: Vec<Fidelity>,
    /// Fidelities that are run in order; each one checks the fidelities below it.
    higher: Vec<Fidelity>,
    /// Whether the last fidelity of `higher` is accepted without a check.
    taken: bool,
    /// Whether computing more modes would not change what is tried first.
    is_enough: bool,
}

fn of_class<T: Copy>(table: [T; 3], fidelity: Fidelity) -> T {
    match fidelity {
        Fidelity::Rigid => table[0],
        Fidelity::Influence => table[1],
        Fidelity::Modal(_) | Fidelity::Half | Fidelity::Full => table[2],
    }
}

impl<'a, L: FoundationProvider> Search<'a, L> {
    pub fn new(
        scene: &'a Scene,
        tolerance: f64,
        structure: usize,
        foundations: &'a mut [Foundation],
        provider: &'a mut L,
        watch: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Self {
        let mut finer = scene.clone();
        finer.accuracy = finer.accuracy.min(RUN_ACCURACY * tolerance);
        let choice = Choice::new(structure, Fidelity::Influence, Reason::Unchecked);
        Search {
            scene,
            finer,
            tolerance,
            structure,
            foundations,
            provider,
            watch,
            choice,
            error: None,
            runs: 0,
        }
    }

    /// Runs the search. The fidelities `lower` of the plan are run first. Then the fidelities `higher` are run in
    /// ascending order, and each is compared with the candidates below it. The search stops at the first candidate
    /// whose estimated error is at most 0.8 of the tolerance, at the last planned fidelity where its prediction makes
    /// a check unnecessary, or at the full mesh. Where a comparison fails, the higher fidelity becomes the new
    /// candidate.
    pub fn run(mut self, few: Option<Structure>) -> Result<Outcome, L::Error> {
        let Plan { lower, higher, taken, .. } = self.plan(few);
        let mut below: Vec<Candidate> = Vec::new();
        for fidelity in lower {
            match self.attempt(fidelity) {
                // At other fidelities the wheels would leave their rails as well.
                Some(found) if found.is_final() => return Ok(self.end(found, Reason::Unchecked, None)),
                Some(found) => below.push(found),
                None => {}
            }
        }
        let top = higher.last().copied();
        for against in higher {
            let Some(found) = self.attempt(against) else { continue };
            if found.is_final() {
                let found = below.pop().unwrap_or(found);
                return Ok(self.end(found, Reason::Unchecked, None));
            }
            if !found.run.status.is_complete() {
                // A run at a higher fidelity may still complete the motion.
                if below.is_empty() {
                    below.push(found);
                }
                continue;
            }
            for lower in below.drain(..) {
                let estimate = distance(&lower.run, &found.run, self.scene);
                self.choice.tried.push(FidelityTrial {
                    fidelity: lower.fidelity,
                    estimate,
                    against,
                    stages: lower.run.counts.stages as u64,
                });
                if estimate <= SAFE * self.tolerance {
                    return Ok(self.end(lower, Reason::Sufficient, Some(estimate)));
                }
            }
            if taken && Some(against) == top {
                let estimate = self.choice.predicted.as_ref().and_then(|predicted| predicted.of(against));
                return Ok(self.end(found, Reason::Predicted, estimate));
            }
            if against == Fidelity::Full {
                return Ok(self.top(found));
            }
            below.push(found);
        }
        // No candidate is available, so the skipped fidelities are tried.
        let last = match below.pop() {
            Some(found) => Some(found),
            None => {
                let mut all = [Fidelity::Influence, Fidelity::Rigid].into_iter();
                all.find_map(|fidelity| {
                    if self.choice.failed.contains(&fidelity) { None } else { self.attempt(fidelity) }
                })
            }
        };
        match (last, self.error.take()) {
            (Some(found), _) => Ok(self.end(found, Reason::Unchecked, None)),
            (None, Some(error)) => Err(error),
            // This case does not occur, because every failure records an error.
            (None, None) => {
                Err(L::Error::from(crate::Error::NoSuch { what: "fidelity", index: self.structure }))
            }
        }
    }

    /// Plans the fidelities to be tried from the predicted errors. A few modes are used where they suffice; otherwise
    /// more modes are computed.
    fn plan(&mut self, few: Option<Structure>) -> Plan {
        let needed = ABOVE_CONTACT * contact_frequency(self.scene, self.structure);
        let plan = self.plan_by(few.as_ref(), needed);
        if few.is_none() || plan.is_enough {
            return plan;
        }
        let more = self.provider.modes(self.structure, MODES[MODES.len() - 1] + 1).ok().flatten();
        self.plan_by(more.as_ref(), needed)
    }

    fn plan_by(&mut self, motion: Option<&Structure>, needed: f64) -> Plan {
        let predicted =
            motion.and_then(|motion| predict(self.scene, self.foundations, self.structure, motion));
        let highest = |m: usize| {
            motion.map_or(f64::INFINITY, |motion| {
                motion.dynamics.frequencies().iter().take(m).copied().fold(0.0, f64::max)
            })
        };
        let reaches = |m: usize| highest(m) > needed;
        let is_far = |fidelity: Fidelity| match fidelity {
            Fidelity::Modal(m) => highest(m) > FAR * needed,
            _ => true,
        };
        let by_tolerance = |fidelity: Fidelity| {
            predicted
                .as_ref()
                .and_then(|predicted| predicted.of(fidelity))
                .map(|error| error / self.tolerance)
        };
        let modal = MODES.into_iter().filter(|&m| reaches(m)).map(Fidelity::Modal);
        let all: Vec<Fidelity> = [Fidelity::Rigid, Fidelity::Influence].into_iter().chain(modal).collect();
        let is_complete = predicted.as_ref().is_some_and(|predicted| predicted.is_complete);
        let sure = all.iter().copied().find(|&fidelity| {
            let is_small = by_tolerance(fidelity).is_some_and(|error| error < of_class(TAKE, fidelity));
            is_complete && is_far(fidelity) && is_small
        });
        let last = sure.unwrap_or(Fidelity::Full);
        let (skipped, kept): (Vec<Fidelity>, Vec<Fidelity>) =
            all.into_iter().filter(|fidelity| *fidelity < last).partition(|&fidelity| {
                by_tolerance(fidelity).is_some_and(|error| error > of_class(SKIP, fidelity))
            });
        let is_enough = sure.is_some() || kept.contains(&Fidelity::Modal(MODES[0]));
        self.choice.skipped = skipped;
        self.choice.predicted = predicted;
        let (lower, mut higher): (Vec<Fidelity>, Vec<Fidelity>) =
            kept.into_iter().partition(|fidelity| *fidelity <= Fidelity::Influence);
        higher.push(last);
        Plan { lower, higher, taken: sure.is_some(), is_enough }
    }

    /// Builds and runs a fidelity. A fidelity that cannot be built, started or completed is recorded as failed.
    fn attempt(&mut self, fidelity: Fidelity) -> Option<Candidate> {
        let built = self.provider.foundation(self.structure, fidelity);
        let ran = built.and_then(|foundation| {
            self.foundations[self.structure] = foundation;
            Ok(self.provider.run(&self.finer, self.foundations, self.watch)?)
        });
        match ran {
            Ok(run) => {
                self.runs += 1;
                if !run.status.is_complete() {
                    self.choice.failed.push(fidelity);
                }
                let foundation = std::mem::take(&mut self.foundations[self.structure]);
                Some(Candidate { fidelity, foundation, run })
            }
            Err(error) => {
                self.choice.failed.push(fidelity);
                self.error.get_or_insert(error);
                None
            }
        }
    }

    /// Accepts the full mesh; its error is estimated from a run with half as many elements.
    fn top(mut self, full: Candidate) -> Outcome {
        let half = self.attempt(Fidelity::Half).filter(|half| half.run.status.is_complete());
        let Some(half) = half else { return self.end(full, Reason::Highest, None) };
        let apart = distance(&half.run, &full.run, self.scene);
        let estimate = HALVED * apart;
        self.choice.tried.push(FidelityTrial {
            fidelity: Fidelity::Half,
            estimate: apart,
            against: Fidelity::Full,
            stages: half.run.counts.stages as u64,
        });
        let reason = if estimate <= self.tolerance { Reason::Sufficient } else { Reason::Highest };
        self.end(full, reason, Some(estimate))
    }

    fn end(self, found: Candidate, reason: Reason, estimate: Option<f64>) -> Outcome {
        let choice = Choice { fidelity: found.fidelity, reason, estimate, ..self.choice };
        Outcome { choice, found, runs: self.runs }
    }
}

impl Candidate {
    /// Whether the run ended for a reason that would end the run at every other fidelity as well.
    fn is_final(&self) -> bool {
        matches!(self.run.status, Status::Stopped | Status::Failed(..))
    }
}
