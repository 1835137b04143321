//! Choice of the foundations of a scene: the lowest fidelity whose estimated error is within the tolerance.
//!
//! 1. The scene is run with influence functions. This costs least of all flexible foundations.
//! 2. The wheel forces of this run act on the natural modes ([`tail_errors`]). This costs little and estimates the
//!    error of leaving out all modes but the lowest m, for each m, m = 0 being the run itself. The runs of the next steps
//!    are sampled as densely as the run before them was stepped. If the estimate for m = 0 is a tenth of the tolerance or
//!    less, the choice ends here. Wheels that remember n of their bounces may amplify what the rails lack by n: from n = 8 on
//!    it must be 0.8/n of the tolerance or less, 0.027 from n = 30 on.
//! 3. Otherwise the scene is run with the lowest m modes for which the estimate is a tenth of the tolerance. The
//!    difference of the two runs is the error of the first one; its ratio to the estimate of step 2 is the factor by
//!    which the wheels amplify what the rails lack. The wheel forces of the new run act on the modes again: the tail
//!    beyond m modes times that factor is the error of the new run.
//! 4. The start of the motion, an eighth of the run, is repeated with more modes and with a tenth of the accuracy, before
//!    the new run is chosen. There the wheels meet a structure at rest, modes that are left out would begin to move at
//!    once, and the accelerations of those that are kept, which enter reactions and internal forces, may be followed worse
//!    than displacements and wheel forces, for which the steps are chosen. The start of the finer run in place of that of
//!    the new run changes the quantities by its error there, whatever the wheels amplify. Errors of motions and wheel
//!    forces that grow during the start are taken to grow on as long as the wheels remember their bounces ([`drift`]); by
//!    extremes in a long run they count as far as the end of the run cuts extremes off.
//!    Where the error exceeds the tolerance and the steps cause more than half of it, the new run is repeated with that
//!    finer accuracy.
//! 5. The first run is chosen if the difference and the error of the new run together are within 0.7 of the tolerance, and
//!    otherwise the new run if its error is within 0.8 of it (within the tolerance where no further run would help), and so is that
//!    of its start. If neither is, the number of modes is raised to one whose new estimate is within the tolerance, or else to
//!    the largest known one, and steps 3 and 4 are repeated, up to three times. After that the error is reported as exceeding
//!    the tolerance. Where even the largest number leaves an error far beyond the tolerance, more modes are not tried.
//!
//! Runs are compared at the output times of the scene. The run with influence functions, and the run that checks them
//! where the estimate of step 2 leaves it open whether they suffice, have only the accuracy of a tenth of the tolerance;
//! the one that becomes the result is repeated with the accuracy of the result, and with a tenth of it where its quantities
//! have changed by more than half of the tolerance. `accuracy` is relative to the penetrations of the wheels at rest, and
//! motions that are much smaller are quantities of the record as well.
//!
//! Every structure has its own modes and its own number of them, and all structures are raised in the same run.

use std::ops::ControlFlow;

use super::fidelity::{Fidelity, fastest_bounce, remembered_bounces, remembered_time, slowest_bounce};
use super::measure::{Bounces, MANY, Measure, Record, difference, drift};
use super::replay::{Loaded, ModalBasis, TailError, tail_errors};
use super::selection::{Choice, FidelityTrial, FoundationProvider, Reason, Selection, Tolerance, TrialCheck};
use crate::{Analysis, Channel, Foundation, Run, Scene, Status};

/// Number of modes that are computed first, and at the most.
const MODES: [usize; 2] = [24, 144];
/// Least ratio of the number of known modes to the number for which an estimate is used.
const BEYOND: f64 = 1.5;
/// Estimate for which a number of modes is chosen, relative to the tolerance.
const AIM: f64 = 0.1;
/// Fraction of the tolerance that an estimated error may reach.
const SAFE: f64 = 0.8;
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
/// Estimate for the largest number of modes, relative to the tolerance, above which no number is expected to suffice.
const UNREACHABLE: f64 = 10.0;
/// Ratio of the estimates for two numbers of modes up to which the larger number is no better, where neither suffices.
const NO_BETTER: f64 = 1.5;
/// Limits of the factor between the error of a run and the estimate from the modes that it lacks.
const AMPLIFICATION: [f64; 2] = [1.0, 30.0];
/// Part of the run that is repeated with more modes, and the least number of its output steps.
const START: (f64, usize) = (0.125, 2);
/// Estimate for the number of modes of this repetition, relative to that of the run itself, and the largest ratio with
/// which the error of the repetition is extrapolated.
const START_RATIO: [f64; 2] = [0.3, 0.5];
/// Number of modes, relative to that of the run, and the least number, from which a further reduction of the estimate is not
/// waited for.
const START_MODES: (usize, usize) = (3, 24);
/// Accuracy of this repetition, relative to that of the run, and the error of its steps, relative to those of the run.
const START_ACCURACY: (f64, f64) = (0.1, 0.2);
/// Share of the error at the start, or of the tolerance, by the steps from which a run is repeated with finer ones.
const BY_STEPS: f64 = 0.5;
/// Largest number of repetitions of a run with finer steps.
const REPETITIONS: usize = 3;
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
/// Stages of a run from which its cost counts: shorter runs take some hundredths of a second.
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
    let accuracy = if open.is_empty() { search.accuracy } else { checks.max(search.accuracy) };
    let first = search.trial(&influence, accuracy, !open.is_empty())?;
    let chosen = if open.is_empty() { first } else { search.search(open, first)? };
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

/// A structure whose fidelity is to be chosen.
struct Open {
    structure: usize,
    tolerance: f64,
    basis: ModalBasis,
    /// Estimates from the wheel forces of the last run, the number of this run, and the number of modes.
    tails: Vec<TailError>,
    tails_of: Option<(usize, usize)>,
    /// Index of its choice.
    choice: usize,
}

impl Open {
    /// Number of modes that are known.
    fn known(&self) -> usize {
        self.basis.structure.dynamics.dofs()
    }

    /// Smallest number of modes, at least `least`, whose estimate is at most `limit`; all modes if there is none and they
    /// are the whole structure.
    fn sufficient_count(&self, limit: f64, least: usize) -> Option<usize> {
        let found = self.tails.iter().find(|tail| tail.kept >= least && tail.error <= limit);
        let whole = Some(self.known()).filter(|_| self.basis.is_whole);
        found.map(|tail| tail.kept).or(whole)
    }

    /// The same; where there is none, `spare` times the smallest number whose estimate, times `factor`, is within the
    /// tolerance with the margin [`SAFE`], and otherwise the largest one that has an estimate. Where even its estimate is far
    /// beyond the tolerance ([`UNREACHABLE`]), or a whole range, it is the smallest number that is no worse.
    fn count_for(&self, limit: f64, factor: f64, least: usize, spare: usize) -> Option<usize> {
        let within = || {
            let count = self.sufficient_count(SAFE / factor * self.tolerance, least)?;
            let more = self.tails.iter().map(|tail| tail.kept).find(|kept| *kept >= spare * count);
            Some(more.unwrap_or(count))
        };
        let most = || {
            let last = self.tails.last().filter(|last| last.kept >= least)?;
            if is_unreachable(last.error, self.tolerance) {
                self.no_worse_count(least)
            } else {
                Some(last.kept)
            }
        };
        self.sufficient_count(limit, least).or_else(within).or_else(most)
    }

    /// Smallest number of modes, at least `least`, whose estimate is that for the largest number or less, but for the factor
    /// [`NO_BETTER`].
    fn no_worse_count(&self, least: usize) -> Option<usize> {
        self.sufficient_count(NO_BETTER * self.tails.last()?.error, least)
    }

    /// Number of modes with which the start of a run with `count` modes is repeated, and the ratio of the estimates for the
    /// two numbers; `None` where no more modes are known.
    fn beyond(&self, count: usize) -> Option<(usize, f64)> {
        let known = self.known();
        let own = self.tail(count).error;
        if count == 0 || known <= count || own == 0.0 {
            return None;
        }
        let most = self.tails.last().map_or(known, |last| last.kept);
        let many = START_MODES.1.max(START_MODES.0 * count).min(most);
        let suffices = |tail: &&TailError| tail.error <= START_RATIO[0] * own || tail.kept >= many;
        let found = self.tails.iter().filter(|tail| tail.kept > count).find(suffices);
        let (more, error) = found.map_or((known, self.tail(known).error), |tail| (tail.kept, tail.error));
        Some((more, (error / own).min(START_RATIO[1])))
    }

    /// Number of known modes with frequencies below `omega`.
    fn modes_below(&self, omega: f64) -> usize {
        self.basis.structure.dynamics.frequencies().iter().filter(|own| **own < omega).count()
    }

    /// The estimate for `kept` modes; for all known ones it is that of the largest number that has one.
    fn tail(&self, kept: usize) -> TailError {
        let found = self.tails.iter().find(|tail| tail.kept == kept).cloned();
        let beyond = || self.tails.last().filter(|_| !self.basis.is_whole).cloned();
        found.or_else(beyond).unwrap_or(TailError { kept, error: 0.0, quantity: String::new() })
    }
}

struct Search<'a, L: FoundationProvider> {
    /// The scene with the sampling of the trials.
    scene: Scene,
    /// Accuracy of the result, and whether it records the ends of its steps.
    accuracy: f64,
    records_steps: bool,
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
        let records_steps = scene.records_steps;
        Search { scene, accuracy, records_steps, tolerances, provider, watch, choices: Vec::new(), runs: 0 }
    }

    /// The structures whose choice depends on runs. The choices of the others are made.
    fn open(&mut self) -> Vec<Open> {
        let mut open = Vec::new();
        for (structure, tolerance) in self.tolerances.iter().enumerate() {
            let Some(tolerance) = tolerance else { continue };
            let choice = self.choices.len();
            self.choices.push(Choice::new(structure, Fidelity::Influence, Reason::Unchecked));
            if self.scene.analysis == Analysis::QuasiStatic {
                self.choices[choice].reason = Reason::QuasiStatic;
                continue;
            }
            match self.provider.modes(structure, MODES[0]) {
                Ok(Some(basis)) if basis.structure.dynamics.dofs() > 0 => {
                    let (tolerance, tails) = (tolerance.value, Vec::new());
                    open.push(Open { structure, tolerance, basis, tails, tails_of: None, choice });
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
        let auto = fidelities.iter().enumerate().filter(|(s, _)| self.tolerances[*s].is_some());
        self.provider.begin(&auto.map(|(s, fidelity)| (s, *fidelity)).collect::<Vec<_>>());
        let built = fidelities.iter().enumerate();
        let foundations = built
            .map(|(s, fidelity)| match (fidelity, kept.iter().find(|own| own.0 == s)) {
                (Fidelity::Modal(count), Some((_, kept))) => self.provider.finer_foundation(s, *count, *kept),
                _ => self.provider.foundation(s, *fidelity),
            })
            .collect::<Result<Vec<_>, _>>()?;
        self.scene.accuracy = accuracy;
        // only a run with the accuracy of the result may become the result
        self.scene.records_steps = self.records_steps && accuracy <= self.accuracy;
        let run = self.provider.run(&self.scene, &foundations, self.watch)?;
        self.runs += 1;
        let mut record = Record::default();
        if is_compared && run.status.is_complete() {
            let is_ended = matches!(run.status, Status::Ended(_));
            let history = run.history.clone().every(self.scene.output_parts, is_ended);
            record = self.provider.observe(&history)?;
        }
        let (fidelities, parts, number) = (fidelities.to_vec(), self.scene.output_parts, self.runs);
        Ok(Trial { fidelities, foundations, run, record, accuracy, parts, number })
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

    /// Steps 2 to 4 of the head of this module, from the run `first` with influence functions.
    fn search(&mut self, mut open: Vec<Open>, mut first: Trial) -> Result<Trial, L::Error> {
        match first.run.status {
            Status::Done | Status::Ended(_) => {}
            // Other foundations may still complete the motion.
            Status::StepTooSmall(_) => return self.search_without_influence(open, first),
            // On other foundations the wheels would leave their rails as well.
            Status::Stopped | Status::Failed(..) => return Ok(first),
        }
        self.sample_as_stepped(&first);
        let bounces = self.bounces(&first);
        let compliances = std::mem::take(&mut first.foundations);
        let frequency = 2.0 * std::f64::consts::PI / fastest_bounce(&self.scene);
        // wheels amplify what the rails lack by as many times as they remember bounces
        let enough = SAFE / bounces.remembered.clamp(SAFE / AIM, AMPLIFICATION[1]);
        let (counts, is_hopeless) = self.first_counts(&mut open, &first, &compliances, (frequency, enough));
        self.note_tails(&open, &vec![0; open.len()], 1.0, &first);
        if counts.iter().any(|count| *count > 0) {
            return self.refine(Refinement { open, counts, is_hopeless, bounces, compliances }, first);
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
        let is_hopeless = open.iter().any(|own| own.tail(0).error > HOPELESS * own.tolerance);
        let mut counts = vec![0; open.len()];
        for (own, count) in open.iter_mut().zip(&mut counts) {
            let aim = AIM * own.tolerance;
            let limit = if is_hopeless { aim } else { aim.max(CHECKED * own.tail(0).error) };
            if own.tail(0).error > enough * own.tolerance {
                let least = own.modes_below(ABOVE_CONTACT * frequency).max(1);
                // a run that only checks influence need not be within the tolerance itself
                let enough = if is_hopeless { SAFE / UNKNOWN * own.tolerance } else { f64::INFINITY };
                self.estimate(own, first, compliances, 1, [limit, enough]);
                let found = |limit: f64| match own.sufficient_count(limit, 1) {
                    None if !is_hopeless => own.no_worse_count(1),
                    None => own.count_for(limit, UNKNOWN, 1, 1),
                    found => found,
                };
                let needed = |limit: f64| found(limit).unwrap_or(own.known());
                *count = needed(limit).max(least.min(needed(NEGLIGIBLE * aim)));
            }
        }
        (counts, is_hopeless)
    }

    /// Steps 3 and 4 of the head of this module: runs with modes until one of two runs is sufficient. `lower` is the
    /// run with influence functions.
    fn refine(&mut self, refinement: Refinement, mut lower: Trial) -> Result<Trial, L::Error> {
        let Refinement { mut open, mut counts, is_hopeless, bounces, compliances } = refinement;
        let strictest = self.strictest(&open, &counts);
        let mut accuracy = if is_hopeless { self.accuracy } else { CHECK_ACCURACY * strictest.value };
        let mut lacking = largest(&open, &vec![0; open.len()]);
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
            lacking = largest(&open, &counts);
            let error = apart.largest + factor * lacking;
            self.note_runs(&open, &lower, &higher, error, &apart.quantity);
            self.note_tails(&open, &counts, factor, &higher);
            if error <= BESIDE * strictest.value {
                let error = TailError { kept: 0, error, quantity: apart.quantity };
                return self.choose_lower(&open, lower, higher, (&error, bounces));
            }
            let mut start = None;
            let mut raised = self.raised(&mut open, &counts, factor, &higher, &compliances);
            if raised == counts && !is_unreachable(factor * lacking, strictest.value) {
                (higher, start) = self.check_start(&open, &counts, higher, strictest, bounces)?;
                let found = start.as_ref().map_or(0.0, |start| start.error);
                if found > strictest.value {
                    factor = factor.max(found / lacking.max(f64::MIN_POSITIVE));
                    raised = self.raised(&mut open, &counts, factor, &higher, &compliances);
                }
            }
            if raised == counts || round == MODAL_RUNS {
                self.settle_higher(&open, &counts, factor, start, &higher, round == MODAL_RUNS);
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
                let [limit, enough] = [AIM, SAFE].map(|share| share * own.tolerance / factor);
                self.estimate(own, higher, compliances, *count + 1, [limit, enough]);
                *count = own.count_for(limit, factor, *count, SPARE).unwrap_or(*count);
            }
        }
        raised
    }

    /// Step 4 of the head of this module: the run `higher` with `counts` modes, repeated where its steps are too coarse, and
    /// the error at its start.
    fn check_start(
        &mut self,
        open: &[Open],
        counts: &[usize],
        mut higher: Trial,
        Tolerance { value, measure }: Tolerance,
        bounces: Bounces,
    ) -> Result<(Trial, Option<TailError>), L::Error> {
        // the errors of the steps of a run that only checks exceed what is to be found
        if higher.accuracy > self.accuracy {
            higher = self.trial(&higher.fidelities, self.accuracy, true)?;
        }
        let Some(start) = self.start_error(open, counts, &higher, measure, bounces) else {
            return Ok((higher, None));
        };
        if start.error > value {
            let same = vec![0; open.len()];
            let by_steps = self.start_error(open, &same, &higher, measure, bounces);
            if by_steps.is_some_and(|by_steps| by_steps.error > BY_STEPS * start.error) {
                self.accuracy *= START_ACCURACY.0;
                let finer = self.trial(&higher.fidelities, self.accuracy, true)?;
                let error = START_ACCURACY.1 * start.error;
                return Ok((finer, Some(TailError { error, ..start })));
            }
        }
        Ok((higher, Some(start)))
    }

    /// Error at the start of the run `higher` with `counts` modes: the change of its quantities where its start is replaced
    /// by that of a run with more modes and finer steps, D, as D / (1 - r) with the larger one of the ratios r of the
    /// estimates for the two numbers of modes and of the errors of the steps. The number of modes stays where none are left
    /// out (a count of 0) or no more are known. `None` where the finer run fails.
    fn start_error(
        &mut self,
        open: &[Open],
        counts: &[usize],
        higher: &Trial,
        measure: Measure,
        bounces: Bounces,
    ) -> Option<TailError> {
        let (mut fidelities, mut ratio) = (higher.fidelities.clone(), START_ACCURACY.1);
        let mut kept = Vec::new();
        for (own, count) in open.iter().zip(counts) {
            if let Some((more, own_ratio)) = own.beyond(*count) {
                fidelities[own.structure] = Fidelity::Modal(more);
                kept.push((own.structure, *count));
                ratio = ratio.max(own_ratio);
            }
        }
        let steps = (START.0 * higher.record.time.len() as f64).ceil().max(START.1 as f64);
        let (end, start) = (self.scene.end, steps * self.scene.output_dt);
        if start >= end {
            return None;
        }
        // its forces do not act on the modes: the times of the record suffice
        let parts = std::mem::replace(&mut self.scene.output_parts, 1);
        self.scene.end = start;
        let finer = self.checking_trial(&fidelities, &kept, START_ACCURACY.0 * higher.accuracy, true);
        (self.scene.end, self.scene.output_parts) = (end, parts);
        let finer = finer.ok()?;
        if finer.run.status != Status::Done || finer.record.quantities.len() != higher.record.quantities.len()
        {
            return None;
        }
        let replaced = higher.record.with_start_of(&finer.record, finer.record.time.len());
        let apart = difference(&replaced, &higher.record, measure, bounces);
        let times = [start, remembered_time(&self.scene)];
        let drift = drift(&replaced, &higher.record, measure, bounces, times);
        let (apart, quantity) = if drift.0 > apart.largest { drift } else { (apart.largest, apart.quantity) };
        let error = TailError { kept: 0, error: apart / (1.0 - ratio), quantity };
        for own in open {
            let [fidelity, against] = [higher, &finer].map(|trial| trial.fidelities[own.structure]);
            if fidelity != Fidelity::Influence {
                self.choices[own.choice].tried.push(FidelityTrial {
                    fidelity,
                    estimate: error.error,
                    quantity: error.quantity.clone(),
                    against: TrialCheck::Start(against),
                    stages: finer.run.counts.stages as u64,
                });
            }
        }
        Some(error)
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
        let is_kept = higher.accuracy <= self.accuracy
            && lower.run.counts.stages as u64 > LONG
            && higher.cost() > COSTLY * lower.cost();
        let (chosen, reason) = if is_kept { (higher, Reason::Kept) } else { (lower, Reason::Sufficient) };
        for own in open {
            self.settle(own, chosen.fidelities[own.structure], reason, error);
        }
        self.repeated(open, chosen, bounces)
    }

    /// Enters a run with `counts` modes in the choices, with its estimated errors times `factor`, or the error at its
    /// `start` where that is larger; `is_last` where no further run is allowed.
    fn settle_higher(
        &mut self,
        open: &[Open],
        counts: &[usize],
        factor: f64,
        start: Option<TailError>,
        higher: &Trial,
        is_last: bool,
    ) {
        let insufficient = if is_last { Reason::Limit } else { Reason::NoBetter };
        for (own, &count) in open.iter().zip(counts) {
            let tail = own.tail(count);
            let tail = TailError { error: factor * tail.error, ..tail };
            let error = start.clone().filter(|start| start.error > tail.error).unwrap_or(tail);
            // the margin decides whether another run is worth its cost, which is over here
            let reason = if error.error <= own.tolerance { Reason::Sufficient } else { insufficient };
            self.settle(own, higher.fidelities[own.structure], reason, &error);
        }
    }

    /// The choice where the run `first` with influence functions could not continue: the first number of modes that
    /// completes the motion and whose error, estimated with the factor [`UNKNOWN`], is within the tolerance.
    fn search_without_influence(&mut self, mut open: Vec<Open>, mut first: Trial) -> Result<Trial, L::Error> {
        for own in &open {
            self.choices[own.choice].failed.push(Fidelity::Influence);
        }
        let compliances = std::mem::take(&mut first.foundations);
        let mut counts: Vec<usize> = open.iter().map(Open::known).collect();
        let (mut last, mut is_last) = (first, false);
        for round in 1..=MODAL_RUNS {
            let Some(trial) = self.modal_trial(&open, &counts, self.accuracy) else { break };
            for (own, count) in open.iter_mut().zip(&counts) {
                self.estimate(own, &trial, &compliances, *count, [SAFE / UNKNOWN * own.tolerance; 2]);
            }
            self.note_tails(&open, &counts, UNKNOWN, &trial);
            last = trial;
            let raised: Vec<usize> = (open.iter().zip(&counts))
                .map(|(own, &count)| {
                    own.sufficient_count(SAFE / UNKNOWN * own.tolerance, count).unwrap_or(count)
                })
                .collect();
            is_last = round == MODAL_RUNS;
            if raised == counts || is_last {
                break;
            }
            counts = raised;
        }
        for own in open.iter().filter(|_| last.run.status.is_complete()) {
            let fidelity = last.fidelities[own.structure];
            let kept = if let Fidelity::Modal(count) = fidelity { count } else { 0 };
            let tail = own.tail(kept);
            let tail = TailError { error: UNKNOWN * tail.error, ..tail };
            let insufficient = if is_last { Reason::Limit } else { Reason::NoBetter };
            let reason = if tail.error <= own.tolerance { Reason::Sufficient } else { insufficient };
            self.settle(own, fidelity, reason, &tail);
        }
        Ok(last)
    }

    /// A trial, repeated with the accuracy of the result if it was made with a coarser one. Where that changes its quantities
    /// by more than [`BY_STEPS`] of the tolerance, it is repeated with finer steps, at most [`REPETITIONS`] times.
    fn repeated(&mut self, open: &[Open], mut trial: Trial, bounces: Bounces) -> Result<Trial, L::Error> {
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
                self.accuracy *= START_ACCURACY.0;
            }
            trial = finer;
        }
        Ok(trial)
    }

    /// The smallest tolerance of the structures that have modes, in the stricter measure.
    fn strictest(&self, open: &[Open], counts: &[usize]) -> Tolerance {
        let all = open.iter().zip(counts).filter(|(_, count)| **count > 0);
        let own = all.filter_map(|(own, _)| self.tolerances[own.structure]);
        own.reduce(|a, b| Tolerance {
            value: a.value.min(b.value),
            measure: if a.measure == Measure::History { a.measure } else { b.measure },
        })
        .unwrap_or(Tolerance { value: 0.0, measure: Measure::History })
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
                for own in open.iter().filter(|own| fidelities[own.structure] != Fidelity::Influence) {
                    self.choices[own.choice].failed.push(fidelities[own.structure]);
                }
                None
            }
        }
    }

    /// Estimates the errors of leaving out modes of a structure under the wheel forces of a run. More modes are
    /// computed until the smallest number, at least `least`, whose estimate is at most `limit` is two thirds of them. The
    /// search ends as well where the least estimate of such numbers is at most `enough`, and more modes have hardly reduced it
    /// ([`NO_BETTER`]).
    fn estimate(
        &mut self,
        own: &mut Open,
        trial: &Trial,
        compliances: &[Foundation],
        least: usize,
        [limit, enough]: [f64; 2],
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
                    measure: self.tolerances[own.structure].map_or(Measure::History, |own| own.measure),
                    bounces: self.bounces(trial),
                };
                own.tails = tail_errors(&loaded, &own.basis).unwrap_or_default();
                own.tails_of = Some((trial.number, known));
            }
            let usable = |tail: &&TailError| tail.kept >= least && BEYOND * tail.kept as f64 <= known as f64;
            let best = own.tails.iter().filter(usable).map(|tail| tail.error).reduce(f64::min);
            let is_known = best.is_some_and(|best| {
                let is_level = last_best.is_some_and(|last: f64| last <= NO_BETTER * best);
                best <= limit || (best <= enough && is_level)
            });
            if is_known || own.basis.is_whole || known >= MODES[1] {
                return;
            }
            last_best = best;
            match self.provider.modes(own.structure, (2 * known).min(MODES[1])) {
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
    fn note_runs(&mut self, open: &[Open], lower: &Trial, higher: &Trial, estimate: f64, quantity: &str) {
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
    fn rigid_if_still(&mut self, open: &[Open], first: Trial, bounces: Bounces) -> Result<Trial, L::Error> {
        let scales = first.record.scales();
        let moves = |own: &Open| {
            let quantities = first.record.quantities.iter().zip(&scales);
            quantities.filter(|(quantity, _)| matches!(quantity.channel, Some(Channel::Deflection(_)))).any(
                |(quantity, scale)| quantity.values.iter().any(|value| value.abs() > own.tolerance * scale),
            )
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
        let error = TailError { kept: 0, error: apart.largest, quantity: apart.quantity };
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
            let asks_for_phases =
                self.tolerances[choice.structure].is_some_and(|own| own.measure == Measure::History);
            choice.drifting = (asks_for_phases && remembered > MANY).then_some(remembered);
        }
        Selection { choices: self.choices, run, runs: self.runs }
    }
}

/// Whether an error is so far beyond a tolerance, or a whole range, that more modes are not expected to bring it within.
fn is_unreachable(error: f64, tolerance: f64) -> bool {
    error > (UNREACHABLE * tolerance).min(1.0)
}

/// The least tolerance of all structures.
fn least(tolerances: &[Option<Tolerance>]) -> f64 {
    tolerances.iter().flatten().fold(f64::INFINITY, |least, own| least.min(own.value))
}

/// Largest estimate of the structures with these numbers of modes.
fn largest(open: &[Open], counts: &[usize]) -> f64 {
    open.iter().zip(counts).map(|(own, count)| own.tail(*count).error).fold(0.0, f64::max)
}
