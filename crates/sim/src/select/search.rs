//! One structure, from the lowest fidelity that may suffice to the first that does.

use std::ops::ControlFlow;

use super::distance::distance;
use super::fidelity::{Choice, FidelityTrial, FoundationProvider, RUN_ACCURACY, Reason, SAFE};
use super::predict::predict;
use super::rung::{Fidelity, MODES, contact_frequency};
use crate::{Foundation, Run, Scene, Status, Structure};

/// The highest mode kept must be this many times as fast as a body on its contacts to check anything.
const ABOVE_CONTACT: f64 = 3.0;
/// Error of a mesh by its difference from one of half the elements, at most: order 4 in the elements' length makes it
/// 1/15.
const HALVED: f64 = 0.25;
/// Errors predicted, by the tolerance, above which a fidelity is skipped: rigid, influence, modes.
const SKIP: [f64; 3] = [1.5, 6.0, 10.0];
/// Errors predicted, by the tolerance, below which a fidelity is taken unchecked: rigid, influence, modes.
const TAKE: [f64; 3] = [0.25, 0.2, 0.15];
/// So many times as fast again where modes are taken unchecked.
const FAR: f64 = 3.0;

/// A fidelity, run.
pub(super) struct Candidate {
    pub rung: Fidelity,
    pub foundation: Foundation,
    pub run: Run,
}

/// What the search found.
pub(super) struct Outcome {
    pub choice: Choice,
    pub found: Candidate,
    /// Runs made.
    pub runs: usize,
}

/// The search for one structure.
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

/// Rungs to try.
struct Plan {
    /// To be compared with the first of the others.
    lower: Vec<Fidelity>,
    /// Each checks what was found below it.
    higher: Vec<Fidelity>,
    /// The last of `higher` needs no check.
    taken: bool,
    /// Whether more modes would not change what is tried first.
    is_enough: bool,
}

fn of_class<T: Copy>(table: [T; 3], rung: Fidelity) -> T {
    match rung {
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

    pub fn run(mut self, few: Option<Structure>) -> Result<Outcome, L::Error> {
        let Plan { lower, higher, taken, .. } = self.plan(few);
        let mut below: Vec<Candidate> = Vec::new();
        for rung in lower {
            match self.attempt(rung) {
                // elsewhere the wheels would leave their rails as well
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
                // a higher one may still follow the motion
                if below.is_empty() {
                    below.push(found);
                }
                continue;
            }
            for lower in below.drain(..) {
                let estimate = distance(&lower.run, &found.run, self.scene);
                self.choice.tried.push(FidelityTrial {
                    fidelity: lower.rung,
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
        // what was skipped is better than nothing
        let last = match below.pop() {
            Some(found) => Some(found),
            None => {
                let mut all = [Fidelity::Influence, Fidelity::Rigid].into_iter();
                all.find_map(
                    |rung| if self.choice.failed.contains(&rung) { None } else { self.attempt(rung) },
                )
            }
        };
        match (last, self.error.take()) {
            (Some(found), _) => Ok(self.end(found, Reason::Unchecked, None)),
            (None, Some(error)) => Err(error),
            // nothing fails without an error
            (None, None) => Err(L::Error::from(crate::Error::NoSuch { what: "rung", index: self.structure })),
        }
    }

    /// What must be tried, by what is predicted: by few modes, where these tell enough.
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
        let is_far = |rung: Fidelity| match rung {
            Fidelity::Modal(m) => highest(m) > FAR * needed,
            _ => true,
        };
        let by_tolerance = |rung: Fidelity| {
            predicted.as_ref().and_then(|predicted| predicted.of(rung)).map(|error| error / self.tolerance)
        };
        let modal = MODES.into_iter().filter(|&m| reaches(m)).map(Fidelity::Modal);
        let all: Vec<Fidelity> = [Fidelity::Rigid, Fidelity::Influence].into_iter().chain(modal).collect();
        let is_complete = predicted.as_ref().is_some_and(|predicted| predicted.is_complete);
        let sure = all.iter().copied().find(|&rung| {
            let is_small = by_tolerance(rung).is_some_and(|error| error < of_class(TAKE, rung));
            is_complete && is_far(rung) && is_small
        });
        let last = sure.unwrap_or(Fidelity::Full);
        let (skipped, kept): (Vec<Fidelity>, Vec<Fidelity>) = all
            .into_iter()
            .filter(|rung| *rung < last)
            .partition(|&rung| by_tolerance(rung).is_some_and(|error| error > of_class(SKIP, rung)));
        let is_enough = sure.is_some() || kept.contains(&Fidelity::Modal(MODES[0]));
        self.choice.skipped = skipped;
        self.choice.predicted = predicted;
        let (lower, mut higher): (Vec<Fidelity>, Vec<Fidelity>) =
            kept.into_iter().partition(|rung| *rung <= Fidelity::Influence);
        higher.push(last);
        Plan { lower, higher, taken: sure.is_some(), is_enough }
    }

    /// Builds and runs a fidelity. One that cannot be built or started is noted.
    fn attempt(&mut self, rung: Fidelity) -> Option<Candidate> {
        let built = self.provider.foundation(self.structure, rung);
        let ran = built.and_then(|foundation| {
            self.foundations[self.structure] = foundation;
            Ok(self.provider.run(&self.finer, self.foundations, self.watch)?)
        });
        match ran {
            Ok(run) => {
                self.runs += 1;
                if !run.status.is_complete() {
                    self.choice.failed.push(rung);
                }
                let foundation = std::mem::take(&mut self.foundations[self.structure]);
                Some(Candidate { rung, foundation, run })
            }
            Err(error) => {
                self.choice.failed.push(rung);
                self.error.get_or_insert(error);
                None
            }
        }
    }

    /// The mesh whole, checked by half of it.
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
        let choice = Choice { fidelity: found.rung, reason, estimate, ..self.choice };
        Outcome { choice, found, runs: self.runs }
    }
}

impl Candidate {
    /// Whether the run ended where no other fidelity would go on.
    fn is_final(&self) -> bool {
        matches!(self.run.status, Status::Stopped | Status::Failed(..))
    }
}
