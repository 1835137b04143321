//! A structure with mass: its degrees of freedom, their equations of motion, and their shape functions along the
//! rails.

use nalgebra::DMatrix;
use splines::Probe;

/// Shape functions Phi of the degrees of freedom of a structure along its rails.
pub trait Shapes: Send + Sync {
    /// Computes the displacement at `at` along its axis per unit of each degree of freedom, and its derivative along
    /// the rail. The results are written to `value` and `slope`, which have one entry per degree of freedom.
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

/// Equations of motion of the degrees of freedom of a structure.
#[derive(Clone, Debug, PartialEq)]
pub enum Dynamics {
    /// General degrees of freedom with n x n matrices.
    Matrices {
        /// M, symmetric and positive definite.
        mass: DMatrix<f64>,
        /// C, symmetric.
        damping: DMatrix<f64>,
        /// K, symmetric and positive definite.
        stiffness: DMatrix<f64>,
    },
    /// Natural modes of unit modal mass: q'' + 2 zeta omega q' + omega^2 q = load.
    Modes {
        /// Angular frequencies omega, > 0, radian/time.
        omega: Vec<f64>,
        /// Damping ratios zeta, >= 0, one per mode.
        ratio: Vec<f64>,
    },
}

impl Dynamics {
    /// Angular frequencies of the natural modes; empty for general degrees of freedom.
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
