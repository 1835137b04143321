//! A structure with mass: its degrees of freedom, their equations of motion, and their shapes along the rails.

use nalgebra::DMatrix;
use splines::Probe;

/// Shapes Phi of a structure's degrees of freedom along its rails.
pub trait Shapes: Send + Sync {
    /// Displacement at `at` along its axis per unit of each degree of freedom, and its derivative along the rail,
    /// into `value` and `slope`, of one entry a degree of freedom.
    ///
    /// # Errors
    /// A probe beyond its rail.
    fn row(&self, at: Probe, value: &mut [f64], slope: &mut [f64]) -> Result<(), splines::Error>;
}

/// Degrees of freedom of a structure that has mass.
pub struct Structure {
    /// M, C and K.
    pub dynamics: Dynamics,
    /// Phi.
    pub shapes: Box<dyn Shapes>,
}

/// How the degrees of freedom of a structure move.
#[derive(Clone, Debug, PartialEq)]
pub enum Dynamics {
    /// Degrees of freedom of any kind, n x n matrices.
    Matrices {
        /// M, symmetric and positive definite.
        mass: DMatrix<f64>,
        /// C, symmetric.
        damping: DMatrix<f64>,
        /// K, symmetric and positive definite.
        stiffness: DMatrix<f64>,
    },
    /// Natural modes of modal mass 1: q'' + 2 zeta omega q' + omega^2 q = load.
    Modes {
        /// omega, > 0, radian/time.
        omega: Vec<f64>,
        /// zeta, >= 0, one a mode.
        ratio: Vec<f64>,
    },
}

impl Dynamics {
    /// Frequencies of natural modes; empty for degrees of freedom of any kind.
    #[must_use]
    pub fn frequencies(&self) -> &[f64] {
        match self {
            Dynamics::Matrices { .. } => &[],
            Dynamics::Modes { omega, .. } => omega,
        }
    }

    /// Number of degrees of freedom.
    #[must_use]
    pub fn dofs(&self) -> usize {
        match self {
            Dynamics::Matrices { mass, .. } => mass.nrows(),
            Dynamics::Modes { omega, .. } => omega.len(),
        }
    }
}
