//! Repetitions of runs: with more modes, to find the errors that the modes alone do not tell, and with finer steps.

use super::open::{Open, SAFE};
use super::{REMEMBERED, Search, Trial};
use crate::select::fidelity::{Fidelity, remembered_time};
use crate::select::measure::{Bounces, Difference, Measure, difference, drift};
use crate::select::replay::TailError;
use crate::select::selection::{FidelityTrial, FoundationProvider, Tolerance, TrialCheck};

/// The repetition of the start of a run with more modes and finer steps, and its least number of output steps.
const START: (Repetition, usize) = (
    Repetition {
        share: 0.125,
        accuracy: 0.1,
        by_steps: 0.2,
    },
    2,
);
/// The repetition of a whole run with more modes, whose steps are long enough to cost little.
const WHOLE: Repetition = Repetition {
    share: 1.0,
    accuracy: 25.0,
    by_steps: 0.0,
};
/// Share of the error at the start, or of the tolerance, by the steps from which a run is repeated with finer ones.
const BY_STEPS: f64 = 0.5;
/// Largest number of repetitions of a run with finer steps.
const REPETITIONS: usize = 3;

/// A repetition of a run with more modes.
#[derive(Clone, Copy)]
struct Repetition {
    /// Part of the run, from its beginning.
    share: f64,
    /// Accuracy, relative to that of the run.
    accuracy: f64,
    /// Error of its steps, relative to those of the run, where these are to be found as well.
    by_steps: f64,
}

impl<L: FoundationProvider> Search<'_, L> {
    /// Steps 4 and 5 of the choice: the run `higher` with `counts` modes, repeated where its steps are too coarse,
    /// and the error by its repetitions with more modes. The errors of the run are `factor` times their estimates.
    pub fn check_by_repetitions(
        &mut self,
        open: &[Open],
        (counts, factor): (&[usize], f64),
        mut higher: Trial,
        tolerance: Tolerance,
        bounces: Bounces,
    ) -> Result<(Trial, Option<TailError>), L::Error> {
        // the errors of the steps of a run that only checks exceed what is to be found
        if higher.accuracy > self.accuracy {
            higher = self.trial(&higher.fidelities, self.accuracy, true)?;
        }
        let start = self.error_by_repetition(START.0, open, counts, &higher, tolerance, bounces);
        if let Some(start) = start.as_ref().filter(|start| start.error > tolerance.value) {
            let same = vec![0; open.len()];
            let by_steps =
                self.error_by_repetition(START.0, open, &same, &higher, tolerance, bounces);
            if by_steps.is_some_and(|by_steps| by_steps.error > BY_STEPS * start.error) {
                self.accuracy *= START.0.accuracy;
                let finer = self.trial(&higher.fidelities, self.accuracy, true)?;
                let error = START.0.by_steps * start.error;
                return Ok((
                    finer,
                    Some(TailError {
                        error,
                        ..start.clone()
                    }),
                ));
            }
            return Ok((higher, Some(start.clone())));
        }
        let remembered = bounces.remembered.min(REMEMBERED[1]);
        let of_tails = open
            .iter()
            .zip(counts)
            .map(|(own, count)| factor * own.tail(*count).of_motion);
        let of_motion = of_tails
            .chain(start.as_ref().map(|start| start.of_motion))
            .fold(0.0, f64::max);
        if remembered < REMEMBERED[0] || of_motion * remembered <= SAFE * tolerance.value {
            return Ok((higher, start));
        }
        let whole = self.error_by_repetition(WHOLE, open, counts, &higher, tolerance, bounces);
        let found = start
            .into_iter()
            .chain(whole)
            .max_by(|a, b| a.error.total_cmp(&b.error));
        Ok((higher, found))
    }

    /// Error of the run `higher` with `counts` modes: the change of its quantities where it is replaced, as far as the
    /// repetition reaches, by a run with more modes, D, as D / (1 - r) with the larger one of the ratios r of the
    /// estimates for the two numbers of modes and of the errors of the steps. The number of modes stays where none are left
    /// out (a count of 0) or no more are known; a whole run is then not repeated. Of a whole run, whose steps are longer, only
    /// motions and wheel forces count, see [`Search::difference_of_motions`]. `None` where the repetition fails.
    fn error_by_repetition(
        &mut self,
        repetition: Repetition,
        open: &[Open],
        counts: &[usize],
        higher: &Trial,
        Tolerance { value, measure }: Tolerance,
        bounces: Bounces,
    ) -> Option<TailError> {
        let (mut fidelities, mut ratio) = (higher.fidelities.clone(), repetition.by_steps);
        let mut kept = Vec::new();
        for (own, count) in open.iter().zip(counts) {
            if let Some((more, own_ratio)) = own.beyond(*count) {
                fidelities[own.structure] = Fidelity::Modal(more);
                kept.push((own.structure, *count));
                ratio = ratio.max(own_ratio);
            }
        }
        let is_whole = repetition.share >= 1.0;
        if is_whole && kept.is_empty() {
            return None;
        }
        let steps = (repetition.share * higher.record.time.len() as f64)
            .ceil()
            .max(START.1 as f64);
        let (end, reached) = (self.scene.end, steps * self.scene.output_dt);
        if !is_whole && reached >= end {
            return None;
        }
        // its forces do not act on the modes: the times of the record suffice
        let parts = std::mem::replace(&mut self.scene.output_parts, 1);
        self.scene.end = reached.min(end);
        let finer = self
            .checking_trial(
                &fidelities,
                &kept,
                repetition.accuracy * higher.accuracy,
                true,
            )
            .ok();
        let finer = finer.filter(|finer| is_comparable(finer, higher));
        let apart = finer.as_ref().and_then(|finer| {
            if is_whole {
                return self.difference_of_motions(
                    finer,
                    higher,
                    (1.0 - ratio) * value,
                    (measure, bounces),
                );
            }
            let replaced = higher
                .record
                .with_start_of(&finer.record, finer.record.time.len());
            let apart = difference(&replaced, &higher.record, measure, bounces);
            let times = [reached, remembered_time(&self.scene)];
            let drift = drift(&replaced, &higher.record, measure, bounces, times);
            let is_growing = drift.largest > apart.largest;
            Some(if is_growing {
                drift
            } else {
                Difference {
                    of_motion: drift.of_motion,
                    ..apart
                }
            })
        });
        (self.scene.end, self.scene.output_parts) = (end, parts);
        let (finer, apart) = (finer?, apart?);
        let [error, of_motion] = [apart.largest, apart.of_motion].map(|own| own / (1.0 - ratio));
        let error = TailError {
            error,
            quantity: apart.quantity,
            of_motion,
            ..TailError::none(0)
        };
        for own in open {
            let [fidelity, against] = [higher, &finer].map(|trial| trial.fidelities[own.structure]);
            if fidelity != Fidelity::Influence {
                let against = if is_whole {
                    TrialCheck::Whole(against)
                } else {
                    TrialCheck::Start(against)
                };
                self.choices[own.choice].tried.push(FidelityTrial {
                    fidelity,
                    estimate: error.error,
                    quantity: error.quantity.clone(),
                    against,
                    stages: finer.run.counts.stages as u64,
                });
            }
        }
        Some(error)
    }

    /// Difference of the motions and wheel forces of two whole runs, of which `finer` has longer steps. Where it exceeds `limit`,
    /// the steps may be the cause: `finer` is then compared with a run that has the fidelities of `higher` and steps as long.
    /// `None` where that run shows that the steps cause more than [`BY_STEPS`] of the difference, or fails.
    fn difference_of_motions(
        &mut self,
        finer: &Trial,
        higher: &Trial,
        limit: f64,
        (measure, bounces): (Measure, Bounces),
    ) -> Option<Difference> {
        let [own, others] = [higher, finer].map(|trial| trial.record.motion());
        let apart = difference(&others, &own, measure, bounces);
        if apart.largest <= limit {
            return Some(apart);
        }
        let same = self
            .checking_trial(&higher.fidelities, &[], finer.accuracy, true)
            .ok();
        let same = same
            .filter(|same| is_comparable(same, higher))?
            .record
            .motion();
        let by_steps = difference(&same, &own, measure, bounces).largest;
        Some(difference(&others, &same, measure, bounces))
            .filter(|apart| by_steps <= BY_STEPS * apart.largest)
    }

    /// A trial, repeated with the accuracy of the result if it was made with a coarser one. Where that changes its quantities
    /// by more than [`BY_STEPS`] of the tolerance, it is repeated with finer steps, at most [`REPETITIONS`] times.
    pub fn repeated(
        &mut self,
        open: &[Open],
        mut trial: Trial,
        bounces: Bounces,
    ) -> Result<Trial, L::Error> {
        let strictest = self.strictest(open, &vec![1; open.len()]);
        // the forces of a result do not act on the modes: the times of the record suffice
        self.scene.output_parts = 1;
        for _ in 0..REPETITIONS {
            if trial.accuracy <= self.accuracy {
                break;
            }
            let finer = self.trial(&trial.fidelities, self.accuracy, true)?;
            let is_complete = finer.run.status.is_complete();
            let by_steps = difference(&trial.record, &finer.record, strictest.measure, bounces);
            if is_complete && by_steps.largest > BY_STEPS * strictest.value {
                self.accuracy *= START.0.accuracy;
            }
            trial = finer;
        }
        Ok(trial)
    }
}

/// Whether two runs can be compared.
fn is_comparable(a: &Trial, b: &Trial) -> bool {
    a.run.status.is_complete() && a.record.quantities.len() == b.record.quantities.len()
}
