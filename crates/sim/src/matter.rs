//! Mass, damping and stiffness of all freedoms, in blocks: the bodies, then each structure.

use std::ops::Range;

use nalgebra::DMatrix;

use crate::Error;
use crate::dense::{dot, invert_spd};
use crate::foundation::{Dynamics, Structure};

/// M, C and K of freedoms that nothing but contact couples to others.
pub(crate) struct Block {
    /// Freedoms.
    pub range: Range<usize>,
    matter: Matter,
}

enum Matter {
    /// Bodies: no damping, no stiffness.
    Free(DMatrix<f64>),
    Matrices {
        mass: DMatrix<f64>,
        damping: DMatrix<f64>,
        stiffness: DMatrix<f64>,
    },
    /// Modes of mass 1: 2 zeta omega and omega^2.
    Modes {
        damping: Vec<f64>,
        stiffness: Vec<f64>,
    },
}

/// Inverse of a block of M + g C + g^2 K.
enum Inverse {
    Matrix(DMatrix<f64>),
    Diagonal(Vec<f64>),
}

/// (M + g C + g^2 K)^-1: accelerations per unit load inside a step with the coefficient g.
pub(crate) struct Mobility {
    step: f64,
    blocks: Vec<(Range<usize>, Inverse)>,
    scratch: Vec<f64>,
}

impl Block {
    pub fn bodies(mass: DMatrix<f64>) -> Block {
        Block { range: 0..mass.nrows(), matter: Matter::Free(mass) }
    }

    pub fn structure(range: Range<usize>, structure: &Structure) -> Block {
        let matter = match &structure.dynamics {
            Dynamics::Matrices { mass, damping, stiffness } => Matter::Matrices {
                mass: mass.clone(),
                damping: damping.clone(),
                stiffness: stiffness.clone(),
            },
            Dynamics::Modes { omega, ratio } => Matter::Modes {
                damping: omega.iter().zip(ratio).map(|(omega, ratio)| 2.0 * ratio * omega).collect(),
                stiffness: omega.iter().map(|omega| omega * omega).collect(),
            },
        };
        Block { range, matter }
    }

    fn inverse(&self, g: f64) -> Result<Inverse, Error> {
        match &self.matter {
            Matter::Free(mass) => inverse(mass.clone()).map(Inverse::Matrix),
            Matter::Matrices { mass, damping, stiffness } => {
                inverse(mass + g * damping + g * g * stiffness).map(Inverse::Matrix)
            }
            Matter::Modes { damping, stiffness } => Ok(Inverse::Diagonal(
                damping.iter().zip(stiffness).map(|(c, k)| 1.0 / (1.0 + g * c + g * g * k)).collect(),
            )),
        }
    }

    /// `load` -= C v + K q, all over all freedoms.
    pub fn resist(&self, v: &[f64], q: &[f64], load: &mut [f64]) {
        let range = self.range.clone();
        let (v, q, load) = (&v[range.clone()], &q[range.clone()], &mut load[range]);
        match &self.matter {
            Matter::Free(_) => {}
            Matter::Matrices { damping, stiffness, .. } => {
                for (j, (v, q)) in v.iter().zip(q).enumerate() {
                    let (damping, stiffness) = (damping.column(j), stiffness.column(j));
                    for (load, (c, k)) in load.iter_mut().zip(damping.iter().zip(stiffness.iter())) {
                        *load -= c * v + k * q;
                    }
                }
            }
            Matter::Modes { damping, stiffness } => {
                for (i, load) in load.iter_mut().enumerate() {
                    *load -= damping[i] * v[i] + stiffness[i] * q[i];
                }
            }
        }
    }

    /// M of bodies.
    pub fn body_mass(&self) -> Option<&DMatrix<f64>> {
        match &self.matter {
            Matter::Free(mass) => Some(mass),
            _ => None,
        }
    }

    /// 1/2 v^T M v.
    pub fn kinetic(&self, v: &[f64]) -> f64 {
        let v = &v[self.range.clone()];
        match &self.matter {
            Matter::Free(mass) | Matter::Matrices { mass, .. } => 0.5 * quadratic(mass, v),
            Matter::Modes { .. } => 0.5 * dot(v, v),
        }
    }

    /// 1/2 q^T K q.
    pub fn elastic(&self, q: &[f64]) -> f64 {
        let q = &q[self.range.clone()];
        match &self.matter {
            Matter::Free(_) => 0.0,
            Matter::Matrices { stiffness, .. } => 0.5 * quadratic(stiffness, q),
            Matter::Modes { stiffness, .. } => 0.5 * weighted(stiffness, q),
        }
    }

    /// v^T C v.
    pub fn loss(&self, v: &[f64]) -> f64 {
        let v = &v[self.range.clone()];
        match &self.matter {
            Matter::Free(_) => 0.0,
            Matter::Matrices { damping, .. } => quadratic(damping, v),
            Matter::Modes { damping, .. } => weighted(damping, v),
        }
    }

    /// K^-1 `load`, one column a load; loads and answers over the block's own freedoms.
    ///
    /// # Errors
    /// A stiffness that is not positive definite.
    pub fn rest(&self, load: &DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
        match &self.matter {
            Matter::Free(_) => Ok(DMatrix::zeros(load.nrows(), load.ncols())),
            Matter::Matrices { stiffness, .. } => {
                let factor = stiffness.clone().cholesky().ok_or(Error::Number {
                    what: "stiffness of a structure",
                    wanted: "positive definite",
                    found: stiffness.diagonal().min(),
                })?;
                Ok(factor.solve(load))
            }
            Matter::Modes { stiffness, .. } => {
                Ok(DMatrix::from_fn(load.nrows(), load.ncols(), |i, j| load[(i, j)] / stiffness[i]))
            }
        }
    }
}

impl Mobility {
    /// Changes the mass of the bodies.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub fn set_mass(&mut self, mass: &DMatrix<f64>) -> Result<(), Error> {
        if let Some((_, Inverse::Matrix(bodies))) = self.blocks.first_mut() {
            bodies.copy_from(mass);
            if !invert_spd(bodies.as_mut_slice(), &mut self.scratch, mass.nrows()) {
                return Err(not_definite(mass.diagonal().min()));
            }
        }
        Ok(())
    }

    /// `out` = Z `load` of the bodies alone, both over their freedoms.
    pub fn apply_to_bodies(&self, load: &[f64], out: &mut [f64]) {
        if let Some((_, inverse)) = self.blocks.first() {
            inverse.apply(load, out);
        }
    }

    /// M^-1; of bodies whose mass changes, what [`Mobility::set_mass`] makes it later.
    pub fn new(blocks: &[Block], mass_changes: bool) -> Result<Mobility, Error> {
        let of = |block: &Block| {
            let inverse = match &block.matter {
                Matter::Free(mass) if mass_changes => Inverse::Matrix(mass.clone()),
                _ => block.inverse(0.0)?,
            };
            Ok((block.range.clone(), inverse))
        };
        let bodies = blocks.first().map_or(0, |block| block.range.len());
        let blocks = blocks.iter().map(of).collect::<Result<_, Error>>()?;
        Ok(Mobility { step: 0.0, blocks, scratch: vec![0.0; bodies * bodies] })
    }

    /// Changes the coefficient g; the bodies' block does not depend on it.
    pub fn set_step(&mut self, blocks: &[Block], g: f64) -> Result<(), Error> {
        if g != self.step {
            for ((_, inverse), block) in self.blocks.iter_mut().zip(blocks) {
                if !matches!(block.matter, Matter::Free(_)) {
                    *inverse = block.inverse(g)?;
                }
            }
            self.step = g;
        }
        Ok(())
    }

    /// `out` = Z `load`.
    pub fn apply(&self, load: &[f64], out: &mut [f64]) {
        for (range, inverse) in &self.blocks {
            inverse.apply(&load[range.clone()], &mut out[range.clone()]);
        }
    }
}

impl Inverse {
    fn apply(&self, load: &[f64], out: &mut [f64]) {
        match self {
            Inverse::Matrix(matrix) => {
                out.fill(0.0);
                for (j, factor) in load.iter().enumerate().filter(|(_, load)| **load != 0.0) {
                    for (out, entry) in out.iter_mut().zip(matrix.column(j).as_slice()) {
                        *out += entry * factor;
                    }
                }
            }
            Inverse::Diagonal(diagonal) => {
                for ((out, load), entry) in out.iter_mut().zip(load).zip(diagonal) {
                    *out = entry * load;
                }
            }
        }
    }
}

fn inverse(matrix: DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
    if matrix.is_empty() {
        return Ok(matrix);
    }
    let smallest = matrix.diagonal().min();
    matrix.cholesky().map(|factor| factor.inverse()).ok_or(not_definite(smallest))
}

fn not_definite(found: f64) -> Error {
    Error::Number { what: "mass matrix", wanted: "positive definite", found }
}

fn quadratic(matrix: &DMatrix<f64>, x: &[f64]) -> f64 {
    matrix.column_iter().zip(x).map(|(column, factor)| factor * dot(column.as_slice(), x)).sum()
}

fn weighted(weights: &[f64], x: &[f64]) -> f64 {
    weights.iter().zip(x).map(|(weight, x)| weight * x * x).sum()
}
