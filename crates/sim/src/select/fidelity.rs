//! Fidelities of a structure, what builds and runs them, and what was chosen.

use std::ops::ControlFlow;

use super::predict::PredictedErrors;
use super::rung::Fidelity;
use crate::run::run;
use crate::{Error, Foundation, Run, Scene, Structure};

/// Accuracy asked of the compared runs, by the tolerance: where a load strikes hard wheels, runs err by up to
/// thirty times what they are asked.
pub const RUN_ACCURACY: f64 = 0.03;
/// Share of the tolerance that an estimate may reach: the higher fidelity errs too.
pub(super) const SAFE: f64 = 0.8;

/// What builds foundations on demand.
pub trait FoundationProvider {
    /// What can go wrong.
    type Error: From<Error>;

    /// About the lowest `count` modes that vertical forces on the rails of `structure` excite, from the lowest, where
    /// it has so many: frequencies to a few parts in a hundred will do. `None`: its mass is not known.
    ///
    /// # Errors
    /// A structure whose modes cannot be found.
    fn modes(&mut self, structure: usize, count: usize) -> Result<Option<Structure>, Self::Error>;

    /// `structure` at `rung`; a structure whose foundation is given ignores `rung`.
    ///
    /// # Errors
    /// A fidelity that cannot be built.
    fn foundation(&mut self, structure: usize, rung: Fidelity) -> Result<Foundation, Self::Error>;

    /// Runs the scene: [`run()`], unless it is to be integrated in another way.
    ///
    /// # Errors
    /// A scene that cannot be set up.
    fn run(
        &mut self,
        scene: &Scene,
        foundations: &[Foundation],
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Run, Error> {
        run(scene, foundations, watch)
    }
}

/// Why a fidelity was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// No mass is known: the error of leaving it out is not known either.
    NoMass,
    /// A sequence of equilibria has no inertia.
    QuasiStatic,
    /// What it leaves out is predicted to be far below the tolerance: no higher fidelity was run.
    Predicted,
    /// The estimate is within 0.8 of the tolerance.
    Sufficient,
    /// Nothing lower was sufficient. The estimate is that of the mesh with half as many elements: above the tolerance,
    /// or, where that mesh could not be run, none.
    Highest,
    /// No higher fidelity could be built or run to check it: its error is not known, or exceeds the tolerance.
    Unchecked,
}

/// A fidelity that was tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FidelityTrial {
    /// Which.
    pub fidelity: Fidelity,
    /// Its error against `against`, see [`distance`](crate::distance()); infinite where the two runs cannot be
    /// compared.
    pub estimate: f64,
    /// What it was checked against.
    pub against: Fidelity,
    /// Stages that its run took.
    pub stages: u64,
}

/// The foundation of one structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Which structure.
    pub structure: usize,
    /// Its fidelity.
    pub fidelity: Fidelity,
    /// Why.
    pub reason: Reason,
    /// Its error, where that is known.
    pub estimate: Option<f64>,
    /// What was expected of the fidelities; `None` where nothing was.
    pub predicted: Option<PredictedErrors>,
    /// Rungs left out, as they were expected to err by far more than is allowed.
    pub skipped: Vec<Fidelity>,
    /// All that were compared, in order.
    pub tried: Vec<FidelityTrial>,
    /// Rungs that could not be built, started or run to the end, in order.
    pub failed: Vec<Fidelity>,
}

/// Foundations chosen, and the run on them.
pub struct Selection {
    /// One a structure whose foundation was to be chosen, in their order.
    pub choices: Vec<Choice>,
    /// The run on the foundations chosen: of the scene's accuracy, or of 0.03 of the tolerance where that is finer.
    pub run: Run,
    /// Number of runs that were made, this one among them.
    pub runs: usize,
}

impl Choice {
    pub(super) fn new(structure: usize, fidelity: Fidelity, reason: Reason) -> Choice {
        let (skipped, tried, failed) = (Vec::new(), Vec::new(), Vec::new());
        Choice { structure, fidelity, reason, estimate: None, predicted: None, skipped, tried, failed }
    }
}
