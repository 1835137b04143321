//! The factor of a frame in the precision that it needs.

use crate::factor::{Factor, Tail, Work};
use crate::real::{Extended, Real};

/// Cholesky factor of the scaled stiffness.
#[derive(Debug)]
pub(crate) enum Solver {
    /// In doubles.
    Double(Factor<f64>),
    /// In double-doubles, from the input doubles.
    Extended(Factor<Extended>),
}

/// Scratch of forward solves.
pub(crate) enum Scratch {
    Double(Work<f64>),
    Extended(Work<Extended>),
}

impl Solver {
    pub fn len(&self) -> usize {
        match self {
            Solver::Double(factor) => factor.len(),
            Solver::Extended(factor) => factor.len(),
        }
    }

    pub fn scratch(&self) -> Scratch {
        match self {
            Solver::Double(factor) => Scratch::Double(factor.work()),
            Solver::Extended(factor) => Scratch::Extended(factor.work()),
        }
    }

    /// w = L^-1 p, rounded to doubles. `scratch` must be this solver's own.
    pub fn forward(&self, load: &[(usize, f64)], scratch: &mut Scratch) -> Tail {
        match (self, scratch) {
            (Solver::Double(factor), Scratch::Double(work)) => factor.forward(load, work),
            (Solver::Extended(factor), Scratch::Extended(work)) => factor.forward(load, work),
            (solver, scratch) => {
                *scratch = solver.scratch();
                solver.forward(load, scratch)
            }
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
