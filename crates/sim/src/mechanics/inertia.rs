//! Mass, damping and stiffness of all degrees of freedom in blocks: one for the bodies and one for each structure.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::numerics::dense::dot;
use crate::{Dynamics, Error, Structure};

/// M, C and K of one group of degrees of freedom. Groups are coupled by contact forces and by inertial couplings
/// only.
pub(crate) struct Block {
    /// Range of the degrees of freedom.
    pub range: Range<usize>,
    pub matrices: Matrices,
}

/// M, C and K of one block.
pub(crate) enum Matrices {
    /// M of the bodies, which have neither damping nor stiffness of their own.
    Bodies(DMatrix<f64>),
    General {
        mass: DMatrix<f64>,
        damping: DMatrix<f64>,
        stiffness: DMatrix<f64>,
    },
    /// Natural modes of unit modal mass: 2 zeta omega and omega^2.
    Modes {
        damping: Vec<f64>,
        stiffness: Vec<f64>,
    },
}

impl Block {
    pub fn bodies(mass: DMatrix<f64>) -> Block {
        Block {
            range: 0..mass.nrows(),
            matrices: Matrices::Bodies(mass),
        }
    }

    pub fn structure(range: Range<usize>, structure: &Structure) -> Block {
        let matrices = match &structure.dynamics {
            Dynamics::Matrices {
                mass,
                damping,
                stiffness,
            } => Matrices::General {
                mass: mass.clone(),
                damping: damping.clone(),
                stiffness: stiffness.clone(),
            },
            Dynamics::Modes { omega, ratio } => Matrices::Modes {
                damping: omega
                    .iter()
                    .zip(ratio)
                    .map(|(omega, ratio)| 2.0 * ratio * omega)
                    .collect(),
                stiffness: omega.iter().map(|omega| omega * omega).collect(),
            },
        };
        Block { range, matrices }
    }

    /// Subtracts C v + K q from `load`. All three vectors are over all degrees of freedom.
    pub fn resist(&self, v: &[f64], q: &[f64], load: &mut [f64]) {
        let range = self.range.clone();
        let (v, q, load) = (&v[range.clone()], &q[range.clone()], &mut load[range]);
        match &self.matrices {
            Matrices::Bodies(_) => {}
            Matrices::General {
                damping, stiffness, ..
            } => {
                let moved = v.iter().zip(q);
                for ((damping, stiffness), (v, q)) in
                    columns_of(damping).zip(columns_of(stiffness)).zip(moved)
                {
                    for (load, (c, k)) in load.iter_mut().zip(damping.iter().zip(stiffness)) {
                        *load -= c * v + k * q;
                    }
                }
            }
            Matrices::Modes { damping, stiffness } => {
                for (i, load) in load.iter_mut().enumerate() {
                    *load -= damping[i] * v[i] + stiffness[i] * q[i];
                }
            }
        }
    }

    /// Subtracts M a from `load`, both over all degrees of freedom, where this is the block of a structure.
    pub fn resist_acceleration(&self, a: &[f64], load: &mut [f64]) {
        let (a, load) = (&a[self.range.clone()], &mut load[self.range.clone()]);
        match &self.matrices {
            Matrices::Bodies(_) => {}
            Matrices::General { mass, .. } => {
                for (column, a) in columns_of(mass).zip(a) {
                    load.iter_mut()
                        .zip(column)
                        .for_each(|(load, mass)| *load -= mass * a);
                }
            }
            Matrices::Modes { .. } => load.iter_mut().zip(a).for_each(|(load, a)| *load -= a),
        }
    }

    /// Mass matrix, where this is the block of the bodies.
    pub fn body_mass(&self) -> Option<&DMatrix<f64>> {
        match &self.matrices {
            Matrices::Bodies(mass) => Some(mass),
            _ => None,
        }
    }

    /// Kinetic energy 1/2 v^T M v.
    pub fn kinetic(&self, v: &[f64]) -> f64 {
        let v = &v[self.range.clone()];
        match &self.matrices {
            Matrices::Bodies(mass) | Matrices::General { mass, .. } => 0.5 * quadratic(mass, v),
            Matrices::Modes { .. } => 0.5 * dot(v, v),
        }
    }

    /// Elastic energy 1/2 q^T K q.
    pub fn elastic(&self, q: &[f64]) -> f64 {
        let q = &q[self.range.clone()];
        match &self.matrices {
            Matrices::Bodies(_) => 0.0,
            Matrices::General { stiffness, .. } => 0.5 * quadratic(stiffness, q),
            Matrices::Modes { stiffness, .. } => 0.5 * weighted(stiffness, q),
        }
    }

    /// Dissipated power v^T C v.
    pub fn loss(&self, v: &[f64]) -> f64 {
        let v = &v[self.range.clone()];
        match &self.matrices {
            Matrices::Bodies(_) => 0.0,
            Matrices::General { damping, .. } => quadratic(damping, v),
            Matrices::Modes { damping, .. } => weighted(damping, v),
        }
    }

    /// Static displacements K^-1 `load`, with one column per load. Loads and displacements are over the degrees of
    /// freedom of the block.
    ///
    /// # Errors
    /// The stiffness matrix is not positive definite.
    pub fn rest(&self, load: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        match &self.matrices {
            Matrices::Bodies(_) => Ok(DMatrix::zeros(load.nrows(), load.ncols())),
            Matrices::General { stiffness, .. } => {
                let factor = stiffness.clone().cholesky().ok_or(Error::Number {
                    what: "stiffness of a structure",
                    wanted: "positive definite",
                    found: stiffness.diagonal().min(),
                })?;
                Ok(factor.solve(load))
            }
            Matrices::Modes { stiffness, .. } => {
                Ok(DMatrix::from_fn(load.nrows(), load.ncols(), |i, j| {
                    load[(i, j)] / stiffness[i]
                }))
            }
        }
    }
}

/// Columns of a matrix as slices.
pub(crate) fn columns_of(matrix: &DMatrix<f64>) -> impl Iterator<Item = &[f64]> {
    matrix.as_slice().chunks_exact(matrix.nrows().max(1))
}

fn quadratic(matrix: &DMatrix<f64>, x: &[f64]) -> f64 {
    matrix
        .column_iter()
        .zip(x)
        .map(|(column, factor)| factor * dot(column.as_slice(), x))
        .sum()
}

fn weighted(weights: &[f64], x: &[f64]) -> f64 {
    weights
        .iter()
        .zip(x)
        .map(|(weight, x)| weight * x * x)
        .sum()
}
