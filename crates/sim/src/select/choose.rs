//! Choice of the foundations of a scene: the lowest fidelity whose estimated error is within the tolerance.
//!
//! 1. The scene is run with influence functions. This costs least of all flexible foundations.
//! 2. The wheel forces of this run act on the natural modes ([`tail_errors`]). This costs little and estimates the
//!    error of leaving out all modes but the lowest m, for each m, m = 0 being the run itself. If the estimate for
//!    m = 0 is a tenth of the tolerance or less, the choice ends here.
//! 3. Otherwise the scene is run with the lowest m modes for which the estimate is a tenth of the tolerance. The
//!    difference of the two runs is the error of the first one; its ratio to the estimate of step 2 is the factor by
//!    which the wheels amplify what the rails lack. The wheel forces of the new run act on the modes again: the tail
//!    beyond m modes times that factor is the error of the new run.
//! 4. The lower of the two fidelities whose error is within 0.8 of the tolerance is chosen. If it is neither, the
//!    number of modes is raised by the new estimates, and step 3 is repeated, three times at the most. After that the
//!    error is reported as exceeding the tolerance.
//!
//! Every structure has its own modes and its own number of them, and all structures are raised in the same run.

use std::ops::ControlFlow;

use super::fidelity::{Fidelity, fastest_bounce, slowest_bounce};
use super::measure::{Bounces, Measure, Record, difference};
use super::replay::{Loaded, ModalBasis, TailError, tail_errors};
use super::selection::{
    Check, Choice, FidelityTrial, FoundationProvider, RUN_ACCURACY, Reason, Selection, Tolerance,
};
use crate::{Analysis, Channel, Foundation, Run, Scene, Status};

/// Number of modes that are computed first, and at the most.
const MODES: [usize; 2] = [12, 96];
/// Estimate for which a number of modes is chosen, relative to the tolerance.
const AIM: f64 = 0.2;
/// Fraction of the tolerance that an estimated error may reach.
const SAFE: f64 = 0.8;
/// Limits of the factor between the error of a run and the estimate from the modes that it lacks.
const AMPLIFICATION: [f64; 2] = [1.0, 10.0];
/// Largest number of runs with modes.
const MODAL_RUNS: usize = 3;
/// Samples for each period of the fastest bounce, and the largest number of samples of a run.
const SAMPLES: [f64; 2] = [10.0, 40_000.0];
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
    let first = search.trial(&influence)?;
    let chosen = if open.is_empty() { first } else { search.search(open, first)? };
    Ok(search.finish(chosen))
}

/// A run and the fidelities of all structures in it.
struct Trial {
    fidelities: Vec<Fidelity>,
    foundations: Vec<Foundation>,
    run: Run,
    record: Record,
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

/// A structure whose fidelity is to be chosen.
struct Open {
    structure: usize,
    tolerance: f64,
    basis: ModalBasis,
    /// Estimates from the wheel forces of the last run.
    tails: Vec<TailError>,
    /// Index of its choice.
    choice: usize,
}

impl Open {
    /// Smallest number of modes, at least `least`, whose estimate is at most `limit`; all modes if there is none.
    fn count_for(&self, limit: f64, least: usize) -> usize {
        let sufficient = self.tails.iter().find(|tail| tail.kept >= least && tail.error <= limit);
        sufficient.map_or(self.basis.structure.dynamics.dofs(), |tail| tail.kept)
    }

    /// The estimate for `kept` modes.
    fn tail(&self, kept: usize) -> TailError {
        let found = self.tails.iter().find(|tail| tail.kept == kept).cloned();
        let last = self.tails.last().filter(|_| !self.basis.is_whole);
        found.or_else(|| last.cloned()).unwrap_or(TailError { kept, error: 0.0, quantity: String::new() })
    }
}

struct Search<'a, L: FoundationProvider> {
    /// The scene with the accuracy and the sampling of the trials.
    scene: Scene,
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
        if scene.analysis == Analysis::Dynamic {
            for tolerance in tolerances.iter().flatten() {
                scene.accuracy = scene.accuracy.min(RUN_ACCURACY * tolerance.value);
            }
            let wanted = scene.output_dt * SAMPLES[0] / fastest_bounce(&scene);
            let most = SAMPLES[1] * scene.output_dt / scene.end;
            scene.output_parts = wanted.min(most).ceil().max(1.0) as usize;
        }
        Search { scene, tolerances, provider, watch, choices: Vec::new(), runs: 0 }
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
                    open.push(Open { structure, tolerance, basis, tails, choice });
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

    /// Runs the scene at `fidelities`, one for each structure.
    fn trial(&mut self, fidelities: &[Fidelity]) -> Result<Trial, L::Error> {
        let auto = fidelities.iter().enumerate().filter(|(s, _)| self.tolerances[*s].is_some());
        self.provider.begin(&auto.map(|(s, fidelity)| (s, *fidelity)).collect::<Vec<_>>());
        let built = fidelities.iter().enumerate();
        let foundations =
            built.map(|(s, fidelity)| self.provider.foundation(s, *fidelity)).collect::<Result<Vec<_>, _>>()?;
        let run = self.provider.run(&self.scene, &foundations, self.watch)?;
        self.runs += 1;
        let is_compared = run.status.is_complete() && self.scene.analysis == Analysis::Dynamic;
        let record = if is_compared { self.provider.observe(&run)? } else { Record::default() };
        Ok(Trial { fidelities: fidelities.to_vec(), foundations, run, record })
    }

    /// Steps 2 to 4 of the head of this module, from the run `first` with influence functions.
    fn search(&mut self, mut open: Vec<Open>, first: Trial) -> Result<Trial, L::Error> {
        if !first.run.status.is_complete() {
            return Ok(first);
        }
        let bounces = Bounces {
            slowest: slowest_bounce(&self.scene, &first.run.history),
            fastest: fastest_bounce(&self.scene),
        };
        for own in &mut open {
            self.estimate(own, &first, &first.foundations);
        }
        let mut counts: Vec<usize> = open.iter().map(|own| own.count_for(AIM * own.tolerance, 0)).collect();
        self.note_tails(&open, &vec![0; open.len()], 1.0, &first);
        if counts.iter().all(|count| *count == 0) {
            for own in &open {
                self.settle(own, Fidelity::Influence, Reason::Sufficient, own.tail(0).error, own.tail(0).quantity);
            }
            return self.rigid_if_still(open, first, bounces);
        }
        let strictest = self.strictest(&open, &counts);
        let mut estimate = largest(&open, &vec![0; open.len()]);
        let mut lower = first;
        let mut exact: Option<Vec<Foundation>> = None;
        for round in 1..=MODAL_RUNS {
            let Some(higher) = self.modal_trial(&open, &counts) else { return Ok(lower) };
            let compliances = exact.get_or_insert_with(|| std::mem::take(&mut lower.foundations));
            for own in &mut open {
                self.estimate(own, &higher, compliances);
            }
            let apart = difference(&lower.record, &higher.record, strictest.measure, bounces);
            let pointwise = difference(&lower.record, &higher.record, Measure::History, bounces).largest;
            let factor = (pointwise / estimate.max(f64::MIN_POSITIVE)).clamp(AMPLIFICATION[0], AMPLIFICATION[1]);
            estimate = largest(&open, &counts);
            let error = apart.largest + factor * estimate;
            self.note_runs(&open, &lower, &higher, error, &apart.quantity);
            self.note_tails(&open, &counts, factor, &higher);
            if error <= strictest.value {
                let is_kept = lower.run.counts.stages as u64 > LONG && higher.cost() > COSTLY * lower.cost();
                let (chosen, reason) =
                    if is_kept { (higher, Reason::Kept) } else { (lower, Reason::Sufficient) };
                for own in &open {
                    let fidelity = chosen.fidelities[own.structure];
                    self.settle(own, fidelity, reason, error, apart.quantity.clone());
                }
                return Ok(chosen);
            }
            let is_within = |(own, count): (&Open, &usize)| factor * own.tail(*count).error <= SAFE * own.tolerance;
            let is_enough = open.iter().zip(&counts).all(is_within);
            let raised: Vec<usize> = open
                .iter()
                .zip(&counts)
                .map(|(own, count)| match is_within((own, count)) {
                    true => *count,
                    false => own.count_for(AIM * own.tolerance / factor, count + 1).max(*count),
                })
                .collect();
            if is_enough || raised == counts || round == MODAL_RUNS {
                for (own, count) in open.iter().zip(&counts) {
                    let reason = if is_within((own, count)) { Reason::Sufficient } else { Reason::Limit };
                    let tail = own.tail(*count);
                    let fidelity = higher.fidelities[own.structure];
                    self.settle(own, fidelity, reason, factor * tail.error, tail.quantity);
                }
                return Ok(higher);
            }
            (lower, counts) = (higher, raised);
        }
        Ok(lower)
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
    fn modal_trial(&mut self, open: &[Open], counts: &[usize]) -> Option<Trial> {
        let mut fidelities = vec![Fidelity::Influence; self.tolerances.len()];
        for (own, count) in open.iter().zip(counts).filter(|(_, count)| **count > 0) {
            fidelities[own.structure] = Fidelity::Modal(*count);
        }
        match self.trial(&fidelities) {
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
    /// computed while the highest ones matter. Without an estimate the error is taken to be infinite.
    fn estimate(&mut self, own: &mut Open, trial: &Trial, compliances: &[Foundation]) {
        loop {
            let loaded = Loaded {
                scene: &self.scene,
                structure: own.structure,
                foundations: compliances,
                history: &trial.run.history,
                record: &trial.record,
            };
            own.tails = tail_errors(&loaded, &own.basis).unwrap_or_default();
            let known = own.basis.structure.dynamics.dofs();
            let is_small = own.tails.last().is_some_and(|tail| tail.error <= 0.3 * AIM * own.tolerance);
            if is_small || own.basis.is_whole || known >= MODES[1] {
                return;
            }
            match self.provider.modes(own.structure, 2 * known) {
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
                against: Check::Replay(own.basis.structure.dynamics.dofs()),
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
                    against: Check::Run(against),
                    stages: lower.run.counts.stages as u64,
                });
            }
        }
    }

    fn settle(&mut self, own: &Open, fidelity: Fidelity, reason: Reason, estimate: f64, quantity: String) {
        let choice = &mut self.choices[own.choice];
        (choice.fidelity, choice.reason, choice.quantity) = (fidelity, reason, quantity);
        choice.estimate = Some(estimate);
    }

    /// Where no rail deflects by more than what the tolerance leaves of the largest displacements, tries rigid rails.
    fn rigid_if_still(&mut self, open: Vec<Open>, first: Trial, bounces: Bounces) -> Result<Trial, L::Error> {
        let scales = first.record.scales();
        let moves = |own: &Open| {
            let quantities = first.record.quantities.iter().zip(&scales);
            quantities.filter(|(quantity, _)| matches!(quantity.channel, Some(Channel::Deflection(_)))).any(
                |(quantity, scale)| quantity.values.iter().any(|value| value.abs() > own.tolerance * scale),
            )
        };
        if open.len() < self.tolerances.len() || open.iter().any(moves) {
            return Ok(first);
        }
        let rigid = vec![Fidelity::Rigid; self.tolerances.len()];
        let Ok(trial) = self.trial(&rigid) else { return Ok(first) };
        let strictest = self.strictest(&open, &vec![1; open.len()]);
        let apart = difference(&trial.record, &first.record, strictest.measure, bounces);
        self.note_runs(&open, &trial, &first, apart.largest, &apart.quantity);
        if !(apart.largest <= SAFE * strictest.value) {
            return Ok(first);
        }
        for own in &open {
            self.settle(own, Fidelity::Rigid, Reason::Sufficient, apart.largest, apart.quantity.clone());
        }
        Ok(trial)
    }

    fn finish(self, chosen: Trial) -> Selection {
        let mut run = chosen.run;
        let is_ended = matches!(run.status, Status::Ended(_));
        run.history = run.history.every(self.scene.output_parts, is_ended);
        Selection { choices: self.choices, run, runs: self.runs }
    }
}

/// Largest estimate of the structures with these numbers of modes.
fn largest(open: &[Open], counts: &[usize]) -> f64 {
    open.iter().zip(counts).map(|(own, count)| own.tail(*count).error).fold(0.0, f64::max)
}
