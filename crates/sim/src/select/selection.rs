//! Provider of foundations at each fidelity, and the result of the selection.

use std::ops::ControlFlow;

use super::fidelity::Fidelity;
use super::predict::PredictedErrors;
use crate::run::run;
use crate::{Error, Foundation, Run, Scene, Structure};

/// Accuracy of the compared runs, relative to the tolerance. Where a load acts abruptly on stiff wheels, the error of
/// a run may be up to thirty times the accuracy requested.
pub const RUN_ACCURACY: f64 = 0.03;
/// Fraction of the tolerance that an estimated error may reach; the margin allows for the error of the higher
/// fidelity.
pub(super) const SAFE: f64 = 0.8;

/// Builds the foundations of the structures on demand.
pub trait FoundationProvider {
    /// Error type of the provider.
    type Error: From<Error>;

    /// The lowest modes, about `count` of them where the structure has as many, that vertical forces on the rails of
    /// `structure` excite, in ascending order. Frequencies accurate to a few per cent are sufficient. `None`: the
    /// mass of the structure is not known.
    ///
    /// # Errors
    /// The modes of the structure cannot be computed.
    fn modes(&mut self, structure: usize, count: usize) -> Result<Option<Structure>, Self::Error>;

    /// Builds the foundation of `structure` at fidelity `fidelity`, which is ignored for a structure with a fixed
    /// foundation.
    ///
    /// # Errors
    /// The fidelity cannot be built.
    fn foundation(&mut self, structure: usize, fidelity: Fidelity) -> Result<Foundation, Self::Error>;

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
}

/// Reason for the choice of a fidelity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The mass of the structure is not known, so the error of neglecting it is not known either.
    NoMass,
    /// The analysis is a sequence of equilibria, in which inertia has no effect.
    QuasiStatic,
    /// The predicted error is far below the tolerance, so no higher fidelity was run.
    Predicted,
    /// The estimated error is at most 0.8 of the tolerance, or for the full mesh at most the tolerance.
    Sufficient,
    /// No lower fidelity was sufficient. The estimate is derived from the mesh with half as many elements. It exceeds
    /// the tolerance, or it is missing because that mesh could not be run.
    Highest,
    /// No higher fidelity could be built or run for a check. The error is unknown or exceeds the tolerance.
    Unchecked,
}

/// A fidelity that was run and compared with another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FidelityTrial {
    /// Which.
    pub fidelity: Fidelity,
    /// Error relative to the run at fidelity `against`, see [`distance`](crate::distance()); infinite where the two
    /// runs cannot be compared.
    pub estimate: f64,
    /// Fidelity of the run that it was compared with.
    pub against: Fidelity,
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
    /// Predicted errors of the fidelities; `None` where no prediction was possible.
    pub predicted: Option<PredictedErrors>,
    /// Fidelities that were skipped because their predicted error is much larger than the tolerance.
    pub skipped: Vec<Fidelity>,
    /// Fidelities that were compared with others, in order.
    pub tried: Vec<FidelityTrial>,
    /// Fidelities that could not be built, started or run to the end, in order.
    pub failed: Vec<Fidelity>,
}

/// The chosen foundations and the run with them.
pub struct Selection {
    /// One choice for each structure with a tolerance, in the order of the structures.
    pub choices: Vec<Choice>,
    /// The run with the chosen foundations. Its accuracy is that of the scene, or 0.03 of the tolerance where that is
    /// finer.
    pub run: Run,
    /// Number of runs made, including this one.
    pub runs: usize,
}

impl Choice {
    pub(super) fn new(structure: usize, fidelity: Fidelity, reason: Reason) -> Choice {
        let (skipped, tried, failed) = (Vec::new(), Vec::new(), Vec::new());
        Choice { structure, fidelity, reason, estimate: None, predicted: None, skipped, tried, failed }
    }
}
