//! The one question that contact asks of a structure.

use nalgebra::DMatrix;

use crate::{Error, Probe};

/// Influence coefficients of a set of probes, and their slopes along the rail.
#[derive(Clone, Debug)]
pub struct Influence {
    /// `value[(i, j)]`: displacement at probe i along its axis per unit force at probe j along its axis.
    pub value: DMatrix<f64>,
    /// `slope[(i, j)]`: derivative of `value[(i, j)]` with respect to the coordinate of probe i.
    pub slope: DMatrix<f64>,
}

impl Influence {
    /// Zeros for n probes.
    #[must_use]
    pub fn zeros(n: usize) -> Self {
        Influence { value: DMatrix::zeros(n, n), slope: DMatrix::zeros(n, n) }
    }

    /// Refuses matrices of another size than `n` probes.
    pub(crate) fn expect(&self, n: usize) -> Result<(), Error> {
        for matrix in [&self.value, &self.slope] {
            let (rows, columns) = matrix.shape();
            if (rows, columns) != (n, n) {
                return Err(Error::OutputShape { rows, columns, expected: n });
            }
        }
        Ok(())
    }
}

/// A structure's give at its rails: displacements per unit force between any set of probes.
pub trait Compliance: Send + Sync {
    /// Fills the n x n `out` (already of that size) for the n probes `at`.
    ///
    /// # Errors
    /// A probe beyond its rail, on a rail that does not exist, or in a direction that nothing resists.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error>;

    /// Coordinates along `rail` where slopes of the surface may jump: supports, hinges, stations.
    fn breaks(&self, rail: usize) -> Vec<f64>;

    /// First and last coordinate of `rail`; `None` where the rail has no end.
    fn range(&self, rail: usize) -> Option<[f64; 2]>;

    /// Whether `value[(i, j)]` = `value[(j, i)]` everywhere, Maxwell's law: a solver may then use half of it.
    fn is_symmetric(&self) -> bool;
}
