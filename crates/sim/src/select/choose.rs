//! Choice of the foundations of a scene: the lowest fidelity whose estimated error is within the tolerance.
//!
//! 1. The scene is run with influence functions. This costs least of all flexible foundations.
//! 2. The wheel forces of this run act on the natural modes ([`tail_errors`]). This costs little and estimates the
//!    error of leaving out all modes but the lowest m, for each m, m = 0 being the run itself. The runs of the next steps
//!    are sampled as densely as the run before them was stepped. If the estimate for m = 0 is a tenth of the tolerance or
//!    less, the choice ends here. Wheels that remember n of their bounces may amplify what the rails lack by n: from n = 8 on
//!    it must be 0.8/n of the tolerance or less, 0.027 from n = 30 on.
//! 3. Otherwise the scene is run with the lowest m modes for which the estimate is a fifth of the tolerance, or a tenth
//!    at equal times and in runs of many bounces. The difference of the two runs is the error of the first one; its ratio
//!    to the estimate of step 2 is the factor by which the wheels amplify what the rails lack. The wheel forces of the new
//!    run act on the modes again: the tail beyond m modes times that factor is the error of the new run.
//! 4. The start of the motion, an eighth of the run, is repeated with more modes and with a tenth of the accuracy, before
//!    the new run is chosen. There the wheels meet a structure at rest, modes that are left out would begin to move at
//!    once, and the accelerations of those that are kept, which enter reactions and internal forces, may be followed worse
//!    than displacements and wheel forces, for which the steps are chosen. The start of the finer run in place of that of
//!    the new run changes the quantities by its error there, whatever the wheels amplify. Errors of motions and wheel
//!    forces that grow during the start are taken to grow on as long as the wheels remember their bounces ([`drift`]); by
//!    extremes in a long run they count as far as the end of the run cuts extremes off.
//!    Where the error exceeds the tolerance and the steps cause more than half of it, the new run is repeated with that
//!    finer accuracy.
//! 5. Wheels that remember n of their bounces, n from 8 on, may amplify later what they hardly show at the start. Where the
//!    error of motions and wheel forces found so far is more than 0.8/n of the tolerance (0.027 from n = 30 on), the whole new
//!    run is repeated with more modes and longer steps, and the motions and wheel forces of both are compared.
//! 6. The first run is chosen if the difference and the error of the new run together are within 0.7 of the tolerance, and
//!    otherwise the new run if its error is within 0.8 of it (within the tolerance where no further run would help), and so are
//!    those of its repetitions. If neither is, the number of modes is raised to one whose new estimate is within the
//!    tolerance, or else to the largest known one, and at least to that of the repetitions if these have shown an error beyond the
//!    tolerance. Steps 3 to 5 are repeated, up to three times. After that the error is reported as exceeding the tolerance.
//!    Where even the largest number leaves an error far beyond the tolerance, more modes are not tried.
//!
//! Runs are compared at the output times of the scene. The run with influence functions, and the run that checks them
//! where the estimate of step 2 leaves it open whether they suffice, have only the accuracy of a tenth of the tolerance;
//! the one that becomes the result is repeated with the accuracy of the result, and with a tenth of it where its quantities
//! have changed by more than half of the tolerance. `accuracy` is relative to the penetrations of the wheels at rest, and
//! motions that are much smaller are quantities of the record as well.
//!
//! A first run that cannot go on, or hardly advances, is given up: numbers of modes are then tried without it.
//!
//! Every structure has its own modes and its own number of them, and all structures are raised in the same run.

mod open;
mod repetition;

use std::ops::ControlFlow;

use self::open::{NO_BETTER, Open, SAFE, is_unreachable, largest};

use super::fidelity::{Fidelity, fastest_bounce, remembered_bounces, slowest_bounce};
use super::measure::{Bounces, MANY, Measure, Record, difference};
use super::replay::{Loaded, TailError, tail_errors};
use super::selection::{
    Choice, FidelityTrial, FoundationProvider, Reason, Selection, Tolerance, TrialCheck,
};
use crate::{Analysis, Channel, Foundation, Run, Scene, Status};

/// Number of modes that are computed first, and at the most.
const MODES: [usize; 2] = [24, 144];
/// Factor by which all further modes reduce an estimate that twice as many have hardly reduced: 144 are less than four times
/// as many as 48.
const LEFT: f64 = 2.0;
/// Least ratio of the number of known modes to the number for which an estimate is used.
const BEYOND: f64 = 1.5;
/// Estimates for which a number of modes is chosen first, and when it is raised, relative to the tolerance, where extremes
/// change by no more than the amplitudes that are estimated.
const AIM: [f64; 2] = [0.2, 0.4];
/// The same at equal times and in runs of many bounces, where phases that are not quite those of a run with more modes count.
const AIM_IN_PHASE: [f64; 2] = [0.1, 0.1];
/// Fraction of the tolerance that the difference from a run with more modes, with the error of that run, may reach: on random
/// scenes errors were up to 1.43 times as large where more than half of the tolerance was found.
const BESIDE: f64 = 0.7;
/// Estimate for influence functions, relative to the tolerance, above which they are not expected to suffice.
const HOPELESS: f64 = 10.0;
/// Estimate for which the number of modes is chosen in a run that only checks influence functions, relative to their own.
const CHECKED: f64 = 0.015;
/// Frequency below which modes interact with bodies that bounce on their wheels, relative to that of the fastest bounce.
const ABOVE_CONTACT: f64 = 3.0;
/// Estimate, relative to the one that is aimed at, for which modes do not interact with wheels either.
const NEGLIGIBLE: f64 = 0.1;
/// Numbers of bounces that wheels remember from which, and up to which, they may amplify what the rails lack.
const REMEMBERED: [f64; 2] = [8.0, 30.0];
/// Limits of the factor between the error of a run and the estimate from the modes that it lacks.
const AMPLIFICATION: [f64; 2] = [1.0, 30.0];
/// The factor where there are no two runs to compare.
const UNKNOWN: f64 = 3.0;
/// Largest number of runs with modes.
const MODAL_RUNS: usize = 3;
/// Accuracy of a run that only checks influence functions, relative to the tolerance.
const CHECK_ACCURACY: f64 = 0.1;
/// Factor on the number of modes that a further run needs by its estimates, where more modes hardly reduce these.
const SPARE: usize = 2;
/// Samples for each period of the fastest bounce, and the largest number of samples of a run.
const SAMPLES: [f64; 2] = [10.0, 40_000.0];
/// Stages of a run for each of its samples from which its steps are so short that further runs are sampled more densely, and
/// the largest factor between the numbers of samples.
const DENSER: (u64, usize) = (3, 8);
/// Steps of the first run that must advance it by this share of the fastest bounce, or of the run where that is shorter. A run
/// that takes shorter ones, because wheels without mass between stiff contacts and a massless rail open and close without end,
/// is no longer the cheapest.
const ADVANCE: (usize, f64) = (1000, 0.02);
/// Cost of a run from which it counts: cheaper runs take some hundredths of a second.
const LONG: u64 = 10_000;
/// Ratio of the costs of two runs from which the run of the costlier one, once made, is kept.
const COSTLY: u64 = 2;

/// Chooses a fidelity for every structure with a tolerance (`None`: the foundation of the structure is fixed) and
/// runs the scene. `watch` receives the time that every run has reached, and may stop the choice.
///
/// # Errors
/// A fixed foundation or an influence foundation that cannot be built, or a scene that cannot be started on it.
pub fn choose<L: FoundationProvider>(
    scene: &Scene,
    tolerances: &[Option<Tolerance>],
    provider: &mut L,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Selection, L::Error> {
    let mut search = Search::new(scene, tolerances, provider, watch);
    let open = search.open();
    let influence = vec![Fidelity::Influence; tolerances.len()];
    if open.is_empty() {
        search.scene.output_parts = scene.output_parts;
    }
    let checks = CHECK_ACCURACY * least(tolerances);
    let accuracy = if open.is_empty() {
        search.accuracy
    } else {
        checks.max(search.accuracy)
    };
    search.must_advance = !open.is_empty();
    let first = search.trial(&influence, accuracy, !open.is_empty())?;
    search.must_advance = false;
    let chosen = if open.is_empty() {
        first
    } else {
        search.search(open, first)?
    };
    Ok(search.finish(chosen))
}

/// A run and the fidelities of all structures in it.
struct Trial {
    fidelities: Vec<Fidelity>,
    foundations: Vec<Foundation>,
    /// The run, with samples between the output times.
    run: Run,
    /// The history at the output times.
    record: Record,
    /// The accuracy of the run, and its number of samples in each output interval.
    accuracy: f64,
    parts: usize,
    /// Its number, from 1.
    number: usize,
    /// Whether it was given up because its steps were too short.
    is_given_up: bool,
}

impl Trial {
    /// A measure of its computing time.
    fn cost(&self) -> u64 {
        let modes = |fidelity: &Fidelity| match fidelity {
            Fidelity::Modal(count) => *count as u64,
            _ => 0,
        };
        self.run.counts.stages as u64 * (16 + self.fidelities.iter().map(modes).sum::<u64>()) / 16
    }
}

/// How far a run gets with its latest steps.
#[derive(Default)]
struct Progress {
    since: f64,
    steps: usize,
}

impl Progress {
    /// Notes the end of a step; false if the latest steps, [`ADVANCE`] of them, have advanced the run by less than `least`.
    fn is_sufficient(&mut self, time: f64, least: f64) -> bool {
        self.steps += 1;
        if self.steps < ADVANCE.0 && time > self.since {
            return true;
        }
        // a run that is repeated with another method begins again
        let advanced = if time > self.since {
            time - self.since
        } else {
            f64::INFINITY
        };
        (self.since, self.steps) = (time, 0);
        advanced >= least
    }
}

/// What a refinement by runs with modes begins with.
struct Refinement {
    open: Vec<Open>,
    /// Number of modes of each structure in the next run.
    counts: Vec<usize>,
    /// Whether influence is not expected to suffice.
    is_hopeless: bool,
    bounces: Bounces,
    /// All foundations, with the exact compliances.
    compliances: Vec<Foundation>,
}

struct Search<'a, L: FoundationProvider> {
    /// The scene with the sampling of the trials.
    scene: Scene,
    /// Accuracy of the result.
    accuracy: f64,
    /// Whether a run is given up where its steps are too short.
    must_advance: bool,
    tolerances: &'a [Option<Tolerance>],
    provider: &'a mut L,
    watch: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
    choices: Vec<Choice>,
    runs: usize,
}

impl<'a, L: FoundationProvider> Search<'a, L> {
    fn new(
        scene: &Scene,
        tolerances: &'a [Option<Tolerance>],
        provider: &'a mut L,
        watch: &'a mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Self {
        let mut scene = scene.clone();
        let mut accuracy = scene.accuracy;
        if scene.analysis == Analysis::Dynamic {
            for tolerance in tolerances.iter().flatten() {
                accuracy = accuracy.min(tolerance.run_accuracy());
            }
            let wanted = scene.output_dt * SAMPLES[0] / fastest_bounce(&scene);
            let most = SAMPLES[1] * scene.output_dt / scene.end;
            scene.output_parts = wanted.min(most).ceil().max(1.0) as usize;
        }
        let (must_advance, choices, runs) = (false, Vec::new(), 0);
        Search {
            scene,
            accuracy,
            must_advance,
            tolerances,
            provider,
            watch,
            choices,
            runs,
        }
    }

    /// The structures whose choice depends on runs. The choices of the others are made.
    fn open(&mut self) -> Vec<Open> {
        let mut open = Vec::new();
        for (structure, tolerance) in self.tolerances.iter().enumerate() {
            let Some(tolerance) = tolerance else { continue };
            let choice = self.choices.len();
            self.choices.push(Choice::new(
                structure,
                Fidelity::Influence,
                Reason::Unchecked,
            ));
            if self.scene.analysis == Analysis::QuasiStatic {
                self.choices[choice].reason = Reason::QuasiStatic;
                continue;
            }
            match self.provider.modes(structure, MODES[0]) {
                Ok(Some(basis)) if basis.structure.dynamics.dofs() > 0 => {
                    let has_amplitudes = tolerance.measure == Measure::Extremes
                        && remembered_bounces(&self.scene) <= MANY;
                    let shares = if has_amplitudes { AIM } else { AIM_IN_PHASE };
                    let aims = shares.map(|share| share * tolerance.value);
                    let (tolerance, tails) = (tolerance.value, Vec::new());
                    open.push(Open {
                        structure,
                        tolerance,
                        aims,
                        basis,
                        tails,
                        tails_of: None,
                        choice,
                    });
                }
                // no mode that wheels excite: nothing of the mass moves
                Ok(Some(_)) => {
                    self.choices[choice].reason = Reason::Sufficient;
                    self.choices[choice].estimate = Some(0.0);
                }
                Ok(None) => self.choices[choice].reason = Reason::NoMass,
                Err(_) => self.choices[choice].failed.push(Fidelity::Modal(MODES[0])),
            }
        }
        open
    }

    /// Runs the scene at `fidelities`, one for each structure, with an accuracy, and observes it if it `is_compared`.
    fn trial(
        &mut self,
        fidelities: &[Fidelity],
        accuracy: f64,
        is_compared: bool,
    ) -> Result<Trial, L::Error> {
        self.checking_trial(fidelities, &[], accuracy, is_compared)
    }

    /// The same; where `kept` has a number of modes, that of the run whose error is to be shown, only these need the
    /// accuracy of a result.
    fn checking_trial(
        &mut self,
        fidelities: &[Fidelity],
        kept: &[(usize, usize)],
        accuracy: f64,
        is_compared: bool,
    ) -> Result<Trial, L::Error> {
        let auto = fidelities
            .iter()
            .enumerate()
            .filter(|(s, _)| self.tolerances[*s].is_some());
        self.provider
            .begin(&auto.map(|(s, fidelity)| (s, *fidelity)).collect::<Vec<_>>());
        let built = fidelities.iter().enumerate();
        let foundations = built
            .map(
                |(s, fidelity)| match (fidelity, kept.iter().find(|own| own.0 == s)) {
                    (Fidelity::Modal(count), Some((_, kept))) => {
                        self.provider.finer_foundation(s, *count, *kept)
                    }
                    _ => self.provider.foundation(s, *fidelity),
                },
            )
            .collect::<Result<Vec<_>, _>>()?;
        self.scene.accuracy = accuracy;
        let least = if self.must_advance {
            ADVANCE.1 * fastest_bounce(&self.scene).min(self.scene.end)
        } else {
            0.0
        };
        let (mut progress, mut is_given_up) = (Progress::default(), false);
        let mut watch = |time: f64| {
            is_given_up |= !progress.is_sufficient(time, least);
            if is_given_up {
                ControlFlow::Break(())
            } else {
                (self.watch)(time)
            }
        };
        let run = self.provider.run(&self.scene, &foundations, &mut watch)?;
        self.runs += 1;
        let mut record = Record::default();
        if is_compared && run.status.is_complete() {
            let is_ended = matches!(run.status, Status::Ended(_));
            let history = run.history.clone().every(self.scene.output_parts, is_ended);
            record = self.provider.observe(&history)?;
        }
        let (fidelities, parts, number) = (fidelities.to_vec(), self.scene.output_parts, self.runs);
        Ok(Trial {
            fidelities,
            foundations,
            run,
            record,
            accuracy,
            parts,
            number,
            is_given_up,
        })
    }

    /// The bounces of the wheels in a run.
    fn bounces(&self, trial: &Trial) -> Bounces {
        Bounces {
            slowest: slowest_bounce(&self.scene, &trial.run.history),
            remembered: remembered_bounces(&self.scene),
        }
    }

    /// Samples further runs more densely where the steps of the run `last` were shorter than the time between its samples: a
    /// wheel that lands on its rail passes a peak of its force within a fraction of a bounce, and modes of short periods follow
    /// it.
    fn sample_as_stepped(&mut self, last: &Trial) {
        let rows = last.record.time.len().max(1);
        let wanted = (last.run.counts.stages as u64 / DENSER.0) as usize / rows;
        let most = (SAMPLES[1] as usize / rows).min(DENSER.1 * self.scene.output_parts);
        self.scene.output_parts = self.scene.output_parts.max(wanted.min(most));
    }

    /// Steps 2 to 6 of the head of this module, from the run `first` with influence functions.
    fn search(&mut self, mut open: Vec<Open>, mut first: Trial) -> Result<Trial, L::Error> {
        match first.run.status {
            Status::Done | Status::Ended(_) => {}
            // Other foundations may still complete the motion.
            Status::StepTooSmall(_) | Status::TooManySteps { .. } | Status::TooLarge { .. } => {
                return self.search_without_influence(open, first);
            }
            Status::Stopped if first.is_given_up => {
                return self.search_without_influence(open, first);
            }
            // On other foundations the wheels would leave their rails as well.
            Status::Stopped | Status::Failed(..) => return Ok(first),
        }
        self.sample_as_stepped(&first);
        let bounces = self.bounces(&first);
        let compliances = std::mem::take(&mut first.foundations);
        let frequency = 2.0 * std::f64::consts::PI / fastest_bounce(&self.scene);
        // wheels amplify what the rails lack by as many times as they remember bounces
        let enough = SAFE / bounces.remembered.clamp(REMEMBERED[0], REMEMBERED[1]);
        let (counts, is_hopeless) =
            self.first_counts(&mut open, &first, &compliances, (frequency, enough));
        self.note_tails(&open, &vec![0; open.len()], 1.0, &first);
        if counts.iter().any(|count| *count > 0) {
            return self.refine(
                Refinement {
                    open,
                    counts,
                    is_hopeless,
                    bounces,
                    compliances,
                },
                first,
            );
        }
        for own in &open {
            self.settle(own, Fidelity::Influence, Reason::Sufficient, &own.tail(0));
        }
        self.rigid_if_still(&open, first, bounces)
    }

    /// Estimates the error of the run `first`; returns the numbers of modes for the next run, 0 where influence
    /// suffices, and whether influence is not expected to suffice somewhere. `frequency` is that of the fastest bounce,
    /// `enough` the estimate with which influence suffices, relative to the tolerance.
    fn first_counts(
        &mut self,
        open: &mut [Open],
        first: &Trial,
        compliances: &[Foundation],
        (frequency, enough): (f64, f64),
    ) -> (Vec<usize>, bool) {
        for own in open.iter_mut() {
            self.estimate(own, first, compliances, 0, [f64::INFINITY; 2]);
        }
        let is_hopeless = open
            .iter()
            .any(|own| own.tail(0).error > HOPELESS * own.tolerance);
        let mut counts = vec![0; open.len()];
        for (own, count) in open.iter_mut().zip(&mut counts) {
            let error = own.tail(0).error;
            if error > enough * own.tolerance {
                let least = own.modes_below(ABOVE_CONTACT * frequency).max(1);
                let limit = if is_hopeless {
                    let limits = [own.aims[0], SAFE / UNKNOWN * own.tolerance];
                    self.estimate(own, first, compliances, 1, limits);
                    limits[0]
                } else {
                    // a run that only checks influence need not be within the tolerance itself
                    let limits = [
                        (AIM_IN_PHASE[0] * own.tolerance).max(CHECKED * error),
                        f64::INFINITY,
                    ];
                    self.estimate_by(|tail| tail.in_phase, own, first, compliances, (1, limits));
                    limits[0]
                };
                let needed = |limit: f64| {
                    let found = if is_hopeless {
                        own.count_for(limit, UNKNOWN, 1, 1)
                    } else {
                        own.checking_count(limit)
                    };
                    found.unwrap_or(own.known())
                };
                *count = needed(limit).max(least.min(needed(NEGLIGIBLE * own.aims[0])));
            }
        }
        (counts, is_hopeless)
    }

    /// Steps 3 to 6 of the head of this module: runs with modes until one of two runs is sufficient. `lower` is the
    /// run with influence functions.
    fn refine(&mut self, refinement: Refinement, mut lower: Trial) -> Result<Trial, L::Error> {
        let Refinement {
            mut open,
            mut counts,
            is_hopeless,
            bounces,
            compliances,
        } = refinement;
        let strictest = self.strictest(&open, &counts);
        let mut accuracy = if is_hopeless {
            self.accuracy
        } else {
            CHECK_ACCURACY * strictest.value
        };
        let mut lacking = largest(&open, &vec![0; open.len()], |tail| tail.error);
        // whether the repetitions of the lower run have shown that its error is too large
        let mut is_refuted = false;
        for round in 1..=MODAL_RUNS {
            let Some(mut higher) = self.modal_trial(&open, &counts, accuracy) else {
                return self.repeated(&open, lower, bounces);
            };
            for (own, count) in open.iter_mut().zip(&counts) {
                self.estimate(own, &higher, &compliances, *count, [f64::INFINITY; 2]);
            }
            let apart = difference(&lower.record, &higher.record, strictest.measure, bounces);
            let factor = apart.largest / lacking.max(f64::MIN_POSITIVE);
            let mut factor = factor.clamp(AMPLIFICATION[0], AMPLIFICATION[1]);
            lacking = largest(&open, &counts, |tail| tail.error);
            let error = apart.largest + factor * largest(&open, &counts, |tail| tail.in_phase);
            self.note_runs(&open, &lower, &higher, error, &apart.quantity);
            self.note_tails(&open, &counts, factor, &higher);
            if error <= BESIDE * strictest.value && !is_refuted {
                let error = TailError {
                    error,
                    quantity: apart.quantity,
                    ..TailError::none(0)
                };
                return self.choose_lower(&open, lower, higher, (&error, bounces));
            }
            let mut repeated = None;
            is_refuted = false;
            let mut raised = self.raised(&mut open, &counts, factor, &higher, &compliances);
            if raised == counts && !is_unreachable(factor * lacking, strictest.value) {
                (higher, repeated) = self.check_by_repetitions(
                    &open,
                    (&counts, factor),
                    higher,
                    strictest,
                    bounces,
                )?;
                let found = repeated.as_ref().map_or(0.0, |repeated| repeated.error);
                is_refuted = found > strictest.value;
                if is_refuted {
                    factor = factor.max(found / lacking.max(f64::MIN_POSITIVE));
                    let of_repetitions: Vec<usize> = open
                        .iter()
                        .zip(&counts)
                        .map(|(own, count)| own.kept_beyond(*count))
                        .collect();
                    raised = self.raised(&mut open, &counts, factor, &higher, &compliances);
                    for ((raised, count), repeated) in
                        raised.iter_mut().zip(&counts).zip(of_repetitions)
                    {
                        if *raised > *count {
                            *raised = repeated.max(*raised);
                        }
                    }
                }
            }
            if raised == counts || round == MODAL_RUNS {
                self.settle_higher(
                    &open,
                    &counts,
                    factor,
                    repeated,
                    &higher,
                    round == MODAL_RUNS,
                );
                return self.repeated(&open, higher, bounces);
            }
            self.sample_as_stepped(&higher);
            (lower, counts, accuracy) = (higher, raised, self.accuracy);
        }
        Ok(lower)
    }

    /// Numbers of modes after a run with `counts` modes whose errors are `factor` times their estimates: those of structures
    /// whose error is too large are raised as far as that helps.
    fn raised(
        &mut self,
        open: &mut [Open],
        counts: &[usize],
        factor: f64,
        higher: &Trial,
        compliances: &[Foundation],
    ) -> Vec<usize> {
        let mut raised = counts.to_vec();
        for (own, count) in open.iter_mut().zip(&mut raised) {
            if factor * own.tail(*count).error > SAFE * own.tolerance {
                let [limit, enough] =
                    [own.aims[1], SAFE * own.tolerance].map(|error| error / factor);
                self.estimate(own, higher, compliances, *count + 1, [limit, enough]);
                *count = own
                    .count_for(limit, factor, *count, SPARE)
                    .unwrap_or(*count);
            }
        }
        raised
    }

    /// Chooses the lower one of two runs, whose error is small enough, unless the higher one costs so much more
    /// that its run is kept.
    fn choose_lower(
        &mut self,
        open: &[Open],
        lower: Trial,
        higher: Trial,
        (error, bounces): (&TailError, Bounces),
    ) -> Result<Trial, L::Error> {
        let is_kept =
            higher.accuracy <= self.accuracy && higher.cost() > LONG.max(COSTLY * lower.cost());
        let (chosen, reason) = if is_kept {
            (higher, Reason::Kept)
        } else {
            (lower, Reason::Sufficient)
        };
        for own in open {
            self.settle(own, chosen.fidelities[own.structure], reason, error);
        }
        self.repeated(open, chosen, bounces)
    }

    /// Enters a run with `counts` modes in the choices, with its estimated errors times `factor`, or the error found where it
    /// was `repeated` where that is larger; `is_last` where no further run is allowed.
    fn settle_higher(
        &mut self,
        open: &[Open],
        counts: &[usize],
        factor: f64,
        repeated: Option<TailError>,
        higher: &Trial,
        is_last: bool,
    ) {
        let insufficient = if is_last {
            Reason::Limit
        } else {
            Reason::NoBetter
        };
        for (own, &count) in open.iter().zip(counts) {
            let tail = own.tail(count);
            let tail = TailError {
                error: factor * tail.error,
                ..tail
            };
            let error = repeated
                .clone()
                .filter(|repeated| repeated.error > tail.error)
                .unwrap_or(tail);
            // the margin decides whether another run is worth its cost, which is over here
            let reason = if error.error <= own.tolerance {
                Reason::Sufficient
            } else {
                insufficient
            };
            self.settle(own, higher.fidelities[own.structure], reason, &error);
        }
    }

    /// The choice where the run `first` with influence functions could not continue: the first number of modes that
    /// completes the motion and whose error, estimated with the factor [`UNKNOWN`], and that of its repetitions, are within
    /// the tolerance. Where no modes complete it, influence functions are given all the time they want.
    fn search_without_influence(
        &mut self,
        mut open: Vec<Open>,
        mut first: Trial,
    ) -> Result<Trial, L::Error> {
        for own in &open {
            self.choices[own.choice].failed.push(Fidelity::Influence);
        }
        let compliances = std::mem::take(&mut first.foundations);
        let mut counts: Vec<usize> = open.iter().map(Open::known).collect();
        let strictest = self.strictest(&open, &counts);
        let mut last = None;
        for round in 1..=MODAL_RUNS {
            let Some(mut trial) = self.modal_trial(&open, &counts, self.accuracy) else {
                break;
            };
            // no two runs tell how much wheels amplify
            let bounces = self.bounces(&trial);
            let bounces = Bounces {
                remembered: bounces.remembered.max(REMEMBERED[0]),
                ..bounces
            };
            for (own, count) in open.iter_mut().zip(&counts) {
                self.estimate(
                    own,
                    &trial,
                    &compliances,
                    *count,
                    [SAFE / UNKNOWN * own.tolerance; 2],
                );
            }
            self.note_tails(&open, &counts, UNKNOWN, &trial);
            let raise = |open: &[Open], factor: f64| -> Vec<usize> {
                let raised = |(own, &count): (&Open, &usize)| {
                    own.sufficient_count(SAFE / factor * own.tolerance, count)
                        .unwrap_or(count)
                };
                open.iter().zip(&counts).map(raised).collect()
            };
            let (mut raised, mut repeated) = (raise(&open, UNKNOWN), None);
            if raised == counts {
                (trial, repeated) = self.check_by_repetitions(
                    &open,
                    (&counts, UNKNOWN),
                    trial,
                    strictest,
                    bounces,
                )?;
                let found = repeated.as_ref().map_or(0.0, |repeated| repeated.error);
                let lacking = largest(&open, &counts, |tail| tail.error);
                if found > strictest.value && lacking > 0.0 {
                    raised = raise(&open, UNKNOWN.max(found / lacking));
                }
            }
            let is_done = raised == counts;
            last = Some((
                trial,
                std::mem::replace(&mut counts, raised),
                repeated,
                round == MODAL_RUNS,
            ));
            if is_done {
                break;
            }
        }
        let Some((trial, counts, repeated, is_last)) = last else {
            return if first.is_given_up {
                self.trial(&first.fidelities, self.accuracy, true)
            } else {
                Ok(first)
            };
        };
        self.settle_higher(&open, &counts, UNKNOWN, repeated, &trial, is_last);
        let bounces = self.bounces(&trial);
        self.repeated(&open, trial, bounces)
    }

    /// The smallest tolerance of the structures that have modes, in the stricter measure.
    fn strictest(&self, open: &[Open], counts: &[usize]) -> Tolerance {
        let all = open.iter().zip(counts).filter(|(_, count)| **count > 0);
        let own = all.filter_map(|(own, _)| self.tolerances[own.structure]);
        own.reduce(|a, b| Tolerance {
            value: a.value.min(b.value),
            measure: if a.measure == Measure::History {
                a.measure
            } else {
                b.measure
            },
        })
        .unwrap_or(Tolerance {
            value: 0.0,
            measure: Measure::History,
        })
    }

    /// Runs the scene with `counts` modes of the structures `open`; `None` if that is not possible.
    fn modal_trial(&mut self, open: &[Open], counts: &[usize], accuracy: f64) -> Option<Trial> {
        let mut fidelities = vec![Fidelity::Influence; self.tolerances.len()];
        for (own, count) in open.iter().zip(counts).filter(|(_, count)| **count > 0) {
            fidelities[own.structure] = Fidelity::Modal(*count);
        }
        match self.trial(&fidelities, accuracy, true) {
            Ok(trial) if trial.run.status.is_complete() => Some(trial),
            _ => {
                for own in open
                    .iter()
                    .filter(|own| fidelities[own.structure] != Fidelity::Influence)
                {
                    self.choices[own.choice]
                        .failed
                        .push(fidelities[own.structure]);
                }
                None
            }
        }
    }

    /// Estimates the errors of leaving out modes of a structure under the wheel forces of a run. More modes are
    /// computed until the smallest number, at least `least`, whose estimate is at most `limit` is two thirds of them. The
    /// search ends as well where more modes have hardly reduced the least estimate of such numbers ([`NO_BETTER`]), and it is at
    /// most `enough`, or so large that the modes that are left cannot help.
    fn estimate(
        &mut self,
        own: &mut Open,
        trial: &Trial,
        compliances: &[Foundation],
        least: usize,
        limits: [f64; 2],
    ) {
        self.estimate_by(|tail| tail.error, own, trial, compliances, (least, limits));
    }

    /// The same, by the errors `of` the estimates.
    fn estimate_by(
        &mut self,
        of: fn(&TailError) -> f64,
        own: &mut Open,
        trial: &Trial,
        compliances: &[Foundation],
        (least, [limit, enough]): (usize, [f64; 2]),
    ) {
        let mut last_best = None;
        loop {
            let known = own.known();
            if own.tails_of != Some((trial.number, known)) {
                let loaded = Loaded {
                    scene: &self.scene,
                    structure: own.structure,
                    foundations: compliances,
                    history: &trial.run.history,
                    record: &trial.record,
                    measure: self.tolerances[own.structure]
                        .map_or(Measure::History, |own| own.measure),
                    bounces: self.bounces(trial),
                };
                own.tails = tail_errors(&loaded, &own.basis).unwrap_or_default();
                own.tails_of = Some((trial.number, known));
            }
            let usable =
                |tail: &&TailError| tail.kept >= least && BEYOND * tail.kept as f64 <= known as f64;
            let best = own.tails.iter().filter(usable).map(of).reduce(f64::min);
            let is_known = best.is_some_and(|best| {
                let is_level = last_best.is_some_and(|last: f64| last <= NO_BETTER * best);
                let is_settled = best <= enough || is_unreachable(best / LEFT, own.tolerance);
                best <= limit || (is_level && is_settled)
            });
            if is_known || own.basis.is_whole || known >= MODES[1] {
                return;
            }
            last_best = best;
            match self
                .provider
                .modes(own.structure, (2 * known).min(MODES[1]))
            {
                Ok(Some(basis)) if basis.structure.dynamics.dofs() > known => own.basis = basis,
                _ => return,
            }
        }
    }

    /// Notes the errors of a run that are estimated from the modes that it lacks.
    fn note_tails(&mut self, open: &[Open], counts: &[usize], factor: f64, trial: &Trial) {
        for (own, count) in open.iter().zip(counts) {
            let tail = own.tail(*count);
            self.choices[own.choice].tried.push(FidelityTrial {
                fidelity: trial.fidelities[own.structure],
                estimate: factor * tail.error,
                quantity: tail.quantity,
                against: TrialCheck::Replay(own.known()),
                stages: trial.run.counts.stages as u64,
            });
        }
    }

    /// Notes the error of a run that was compared with one of higher fidelity.
    fn note_runs(
        &mut self,
        open: &[Open],
        lower: &Trial,
        higher: &Trial,
        estimate: f64,
        quantity: &str,
    ) {
        for own in open {
            let [fidelity, against] = [lower, higher].map(|trial| trial.fidelities[own.structure]);
            if fidelity != against {
                self.choices[own.choice].tried.push(FidelityTrial {
                    fidelity,
                    estimate,
                    quantity: quantity.to_owned(),
                    against: TrialCheck::Run(against),
                    stages: lower.run.counts.stages as u64,
                });
            }
        }
    }

    fn settle(&mut self, own: &Open, fidelity: Fidelity, reason: Reason, error: &TailError) {
        let choice = &mut self.choices[own.choice];
        (choice.fidelity, choice.reason, choice.estimate) = (fidelity, reason, Some(error.error));
        choice.quantity.clone_from(&error.quantity);
    }

    /// Where no rail deflects by more than what the tolerance leaves of the largest displacements, tries rigid rails.
    fn rigid_if_still(
        &mut self,
        open: &[Open],
        first: Trial,
        bounces: Bounces,
    ) -> Result<Trial, L::Error> {
        let scales = first.record.scales();
        let moves = |own: &Open| {
            let quantities = first.record.quantities.iter().zip(&scales);
            quantities
                .filter(|(quantity, _)| matches!(quantity.channel, Some(Channel::Deflection(_))))
                .any(|(quantity, scale)| {
                    quantity
                        .values
                        .iter()
                        .any(|value| value.abs() > own.tolerance * scale)
                })
        };
        if open.len() < self.tolerances.len() || open.iter().any(moves) {
            return self.repeated(open, first, bounces);
        }
        let rigid = vec![Fidelity::Rigid; self.tolerances.len()];
        let Ok(trial) = self.trial(&rigid, self.accuracy, true) else {
            return self.repeated(open, first, bounces);
        };
        let strictest = self.strictest(open, &vec![1; open.len()]);
        let apart = difference(&trial.record, &first.record, strictest.measure, bounces);
        self.note_runs(open, &trial, &first, apart.largest, &apart.quantity);
        if apart.largest > SAFE * strictest.value {
            return self.repeated(open, first, bounces);
        }
        let error = TailError {
            error: apart.largest,
            quantity: apart.quantity,
            ..TailError::none(0)
        };
        for own in open {
            self.settle(own, Fidelity::Rigid, Reason::Sufficient, &error);
        }
        Ok(trial)
    }

    fn finish(mut self, chosen: Trial) -> Selection {
        let mut run = chosen.run;
        let is_ended = matches!(run.status, Status::Ended(_));
        run.history = run.history.every(chosen.parts, is_ended);
        let remembered = remembered_bounces(&self.scene);
        for choice in &mut self.choices {
            let asks_for_phases = self.tolerances[choice.structure]
                .is_some_and(|own| own.measure == Measure::History);
            choice.drifting = (asks_for_phases && remembered > MANY).then_some(remembered);
        }
        Selection {
            choices: self.choices,
            run,
            runs: self.runs,
        }
    }
}

/// The least tolerance of all structures.
fn least(tolerances: &[Option<Tolerance>]) -> f64 {
    tolerances
        .iter()
        .flatten()
        .fold(f64::INFINITY, |least, own| least.min(own.value))
}
