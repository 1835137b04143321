//! The factor of a frame in the precision that it needs.

use crate::factor::{Factor, Tail};
use crate::real::{Extended, Real};

/// Cholesky factor of the scaled stiffness.
#[derive(Debug)]
pub(crate) enum Solver {
    /// In doubles.
    Double(Factor<f64>),
    /// In double-doubles, from the input doubles.
    Extended(Factor<Extended>),
}

impl Solver {
    pub fn len(&self) -> usize {
        match self {
            Solver::Double(factor) => factor.len(),
            Solver::Extended(factor) => factor.len(),
        }
    }

    /// Bytes of the factor.
    pub fn bytes(&self) -> u64 {
        match self {
            Solver::Double(factor) => factor.bytes(),
            Solver::Extended(factor) => factor.bytes(),
        }
    }

    /// w = L^-1 p of every load, rounded to doubles.
    pub fn forward(&self, loads: &[Vec<(usize, f64)>]) -> Vec<Tail> {
        match self {
            Solver::Double(factor) => factor.forward(loads),
            Solver::Extended(factor) => factor.forward(loads),
        }
    }

    /// Solves K x = x in place.
    pub fn solve(&self, x: &mut [f64]) {
        match self {
            Solver::Double(factor) => factor.solve(x),
            Solver::Extended(factor) => {
                let mut wide: Vec<Extended> = x.iter().map(|&value| value.into()).collect();
                factor.solve(&mut wide);
                x.iter_mut().zip(wide).for_each(|(x, value)| *x = value.double());
            }
        }
    }
}
