//! Provider of foundations at each fidelity, and the result of the selection.

use std::ops::ControlFlow;

use super::fidelity::Fidelity;
use super::measure::{Measure, Record};
use super::replay::ModalBasis;
use crate::run::run;
use crate::{Error, Foundation, History, Run, Scene};

/// Error that a structure's foundation may cause.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Largest relative error of a recorded quantity.
    pub value: f64,
    /// Measure of the error.
    pub measure: Measure,
}

impl Tolerance {
    /// Accuracy of the runs from which the result is chosen: 0.002 of the tolerance for extremes, 0.001 for values at
    /// equal times. Reactions and internal forces depend on the accelerations of all modes; their errors were up to
    /// three hundred times the accuracy of the run, and mostly below twenty times. In most scenes with modes the steps
    /// are limited by the modes and by corners, so that a finer accuracy costs little.
    #[must_use]
    pub fn run_accuracy(&self) -> f64 {
        match self.measure {
            Measure::Extremes => 2e-3 * self.value,
            Measure::History => 1e-3 * self.value,
        }
    }
}

/// Builds the foundations of the structures on demand.
pub trait FoundationProvider {
    /// Error type of the provider.
    type Error: From<Error>;

    /// The lowest modes of `structure` that wheels excite, at least `count` of them where it has as many, in ascending
    /// order, with its damping. `None`: the mass of the structure is not known, or it has none.
    ///
    /// # Errors
    /// The modes of the structure cannot be computed.
    fn modes(&mut self, structure: usize, count: usize) -> Result<Option<ModalBasis>, Self::Error>;

    /// Builds the foundation of `structure` at fidelity `fidelity`, which is ignored for a structure with a fixed
    /// foundation.
    ///
    /// # Errors
    /// The fidelity cannot be built.
    fn foundation(
        &mut self,
        structure: usize,
        fidelity: Fidelity,
    ) -> Result<Foundation, Self::Error>;

    /// Builds a foundation with `count` modes that only shows the error of one with the lowest `kept` of them: only their
    /// frequencies need the accuracy of a result.
    ///
    /// # Errors
    /// The modes cannot be computed.
    fn finer_foundation(
        &mut self,
        structure: usize,
        count: usize,
        _kept: usize,
    ) -> Result<Foundation, Self::Error> {
        self.foundation(structure, Fidelity::Modal(count))
    }

    /// Runs the scene with [`run()`], unless the provider uses another integration.
    ///
    /// # Errors
    /// The scene cannot be set up.
    fn run(
        &mut self,
        scene: &Scene,
        foundations: &[Foundation],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        run(scene, foundations, watch)
    }

    /// The quantities whose error matters, from the history of a run on the foundations that were built last.
    ///
    /// # Errors
    /// A quantity that cannot be computed.
    fn observe(&mut self, history: &History) -> Result<Record, Self::Error> {
        Ok(Record::of(history))
    }

    /// Receives the fidelities of the structures before each run.
    fn begin(&mut self, _fidelities: &[(usize, Fidelity)]) {}
}

/// Reason for the choice of a fidelity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The mass of the structure is not known, so the error of neglecting it is not known either.
    NoMass,
    /// The analysis is a sequence of equilibria, in which inertia has no effect.
    QuasiStatic,
    /// It is the lowest fidelity whose estimated error is within the tolerance.
    Sufficient,
    /// A lower fidelity is within the tolerance as well. The run of this one, which showed it, is kept, because
    /// repeating the lower one would not save anything.
    Kept,
    /// The estimated error exceeds the tolerance, and the number of runs is at its limit.
    Limit,
    /// The estimated error exceeds the tolerance, and by the estimates no larger number of modes reduces it enough.
    NoBetter,
    /// No other fidelity could be built or run for a check. The error is unknown.
    Unchecked,
}

/// How the error of a trial was estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TrialCheck {
    /// The wheel forces of the run acted on this number of modes.
    Replay(usize),
    /// The run was compared with one at another fidelity.
    Run(Fidelity),
    /// The start of the run was compared with one with finer steps, at the same or another fidelity.
    Start(Fidelity),
    /// The motions of the whole run were compared with those of one with longer steps at another fidelity.
    Whole(Fidelity),
}

/// A fidelity that was run, with its estimated error.
#[derive(Clone, Debug, PartialEq)]
pub struct FidelityTrial {
    /// Which.
    pub fidelity: Fidelity,
    /// Estimated error; infinite where it is unknown.
    pub estimate: f64,
    /// The quantity with that error.
    pub quantity: String,
    /// How it was estimated.
    pub against: TrialCheck,
    /// Number of integration stages of its run.
    pub stages: u64,
}

/// The fidelity chosen for one structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Which structure.
    pub structure: usize,
    /// Chosen fidelity.
    pub fidelity: Fidelity,
    /// Reason for the choice.
    pub reason: Reason,
    /// Estimated error of the choice; `None` where it is not known.
    pub estimate: Option<f64>,
    /// The quantity with the largest estimated error; empty where none is known.
    pub quantity: String,
    /// Estimates in the order in which they were made.
    pub tried: Vec<FidelityTrial>,
    /// Fidelities that could not be built, started or run to the end, in order.
    pub failed: Vec<Fidelity>,
    /// Number of bounces that no damper of a wheel reduces, where values at equal times are asked for and the phases of
    /// the bounces cannot be known: the estimate holds up to 100 of them.
    pub drifting: Option<f64>,
}

/// The chosen foundations and the run with them.
pub struct Selection {
    /// One choice for each structure with a tolerance, in the order of the structures.
    pub choices: Vec<Choice>,
    /// The run with the chosen foundations. Its accuracy is that of the scene, or [`Tolerance::run_accuracy`] where that
    /// is finer; on uneven rails it may be finer still.
    pub run: Run,
    /// Number of runs made, including this one.
    pub runs: usize,
}

impl Choice {
    pub(super) fn new(structure: usize, fidelity: Fidelity, reason: Reason) -> Choice {
        let (tried, failed) = (Vec::new(), Vec::new());
        Choice {
            structure,
            fidelity,
            reason,
            estimate: None,
            quantity: String::new(),
            tried,
            failed,
            drifting: None,
        }
    }
}
