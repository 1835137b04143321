//! The mobility Z = (M + g C + g^2 K)^-1, the accelerations per unit load in a step with the coefficient g. For g = 0
//! it is M^-1.
//!
//! The block of the bodies and the block of every structure are inverted separately. Where a body carries a structure
//! with mass, B couples the two blocks ([`InertialCoupling`]). With Z_s = (M_s + g C_s + g^2 K_s)^-1, the block of
//! the bodies is then the inverse of the Schur complement S = M_b - B^T Z_s B, and the accelerations are a_b = S^-1
//! (f_b - B^T Z_s f_s) and a_s = Z_s (f_s - B a_b).

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::assembly::Mechanics;
use super::coupling::InertialCoupling;
use super::inertia::{Block, Matrices, columns_of};
use crate::Error;
use crate::numerics::dense::{add_lines, invert_spd};

/// Mobility (M + g C + g^2 K)^-1 of the whole scene.
pub(crate) struct Mobility<'a> {
    parts: BlockMobility,
    couplings: &'a [InertialCoupling],
    /// Z_s B of each inertial coupling.
    answers: Vec<DMatrix<f64>>,
    /// Sum of B^T Z_s B over the inertial couplings.
    reduced: DMatrix<f64>,
    /// Mass matrix of the bodies.
    mass: DMatrix<f64>,
    /// S^-1 B^T of each inertial coupling.
    pulls: Vec<DMatrix<f64>>,
    /// Scratch memory.
    row: DVector<f64>,
    step: f64,
}

impl<'a> Mobility<'a> {
    /// Builds M^-1. Where bodies are carried by other bodies, the result is valid only after [`Mobility::set_mass`].
    ///
    /// # Errors
    /// A mass matrix that is not positive definite.
    pub fn new(mechanics: &'a Mechanics) -> Result<Mobility<'a>, Error> {
        let later = !mechanics.carried.is_empty() || !mechanics.couplings.is_empty();
        let bodies = mechanics.body_dofs();
        let mass = mechanics.blocks[0]
            .body_mass()
            .cloned()
            .unwrap_or_else(|| DMatrix::zeros(bodies, bodies));
        let mut whole = Mobility {
            parts: BlockMobility::new(&mechanics.blocks, later)?,
            couplings: &mechanics.couplings,
            answers: mechanics
                .couplings
                .iter()
                .map(|tie| tie.between.clone())
                .collect(),
            reduced: DMatrix::zeros(bodies, bodies),
            mass,
            pulls: mechanics
                .couplings
                .iter()
                .map(|tie| tie.between.transpose())
                .collect(),
            row: DVector::zeros(bodies),
            step: 0.0,
        };
        whole.reduce(mechanics.dofs);
        if mechanics.carried.is_empty() && !mechanics.couplings.is_empty() {
            whole.answer()?;
        }
        Ok(whole)
    }

    /// Sets the mass matrix of the bodies.
    ///
    /// # Errors
    /// A mass matrix that is not positive definite.
    pub fn set_mass(&mut self, mass: &DMatrix<f64>) -> Result<(), Error> {
        self.mass.as_mut_slice().copy_from_slice(mass.as_slice());
        self.answer()
    }

    /// Sets the coefficient g. Where bodies are carried by other bodies, [`Mobility::set_mass`] must be called
    /// afterwards.
    ///
    /// # Errors
    /// A structure whose matrix is not positive definite.
    pub fn set_step(&mut self, mechanics: &Mechanics, g: f64) -> Result<(), Error> {
        self.parts.set_step(&mechanics.blocks, g)?;
        if g != self.step && !self.couplings.is_empty() {
            self.reduce(mechanics.dofs);
            if mechanics.carried.is_empty() {
                self.answer()?;
            }
        }
        self.step = g;
        Ok(())
    }

    /// Computes Z_s B of each coupling and the sum of B^T Z_s B for the present g.
    fn reduce(&mut self, freedoms: usize) {
        if self.couplings.is_empty() {
            return;
        }
        let (mut load, mut out) = (vec![0.0; freedoms], vec![0.0; freedoms]);
        self.reduced.fill(0.0);
        for (tie, answer) in self.couplings.iter().zip(&mut self.answers) {
            for j in 0..tie.between.ncols() {
                load.fill(0.0);
                load[tie.range.clone()].copy_from_slice(tie.between.column(j).as_slice());
                self.parts.apply(&load, &mut out);
                answer
                    .column_mut(j)
                    .copy_from_slice(&out[tie.range.clone()]);
            }
            self.reduced += tie.between.transpose() * &*answer;
        }
    }

    /// Inverts the Schur complement S = M_b - sum of B^T Z_s B and computes S^-1 B^T of each coupling.
    fn answer(&mut self) -> Result<(), Error> {
        if self.couplings.is_empty() {
            return self.parts.set_mass(&self.mass);
        }
        self.mass -= &self.reduced;
        let set = self.parts.set_mass(&self.mass);
        self.mass += &self.reduced;
        set?;
        for (tie, pull) in self.couplings.iter().zip(&mut self.pulls) {
            for (k, mut column) in pull.column_iter_mut().enumerate() {
                self.row.copy_from(&tie.between.row(k).transpose());
                self.parts
                    .apply_to_bodies(self.row.as_slice(), column.as_mut_slice());
            }
        }
        Ok(())
    }

    /// Computes `out` = Z `load`.
    pub fn apply(&self, load: &[f64], out: &mut [f64]) {
        self.parts.apply(load, out);
        let (bodies, others) = out.split_at_mut(self.mass.nrows());
        for (tie, pull) in self.couplings.iter().zip(&self.pulls) {
            for (y, column) in others[self.own(tie)].iter().zip(pull.column_iter()) {
                bodies
                    .iter_mut()
                    .zip(column.iter())
                    .for_each(|(out, p)| *out -= p * y);
            }
        }
        for (tie, answer) in self.couplings.iter().zip(&self.answers) {
            let own = &mut others[self.own(tie)];
            for (column, a) in answer.column_iter().zip(bodies.iter()) {
                own.iter_mut()
                    .zip(column.iter())
                    .for_each(|(out, y)| *out -= y * a);
            }
        }
    }

    /// Range of the degrees of freedom of a structure, counted from the end of those of the bodies.
    fn own(&self, tie: &InertialCoupling) -> Range<usize> {
        let bodies = self.mass.nrows();
        tie.range.start - bodies..tie.range.end - bodies
    }
}

/// Inverse of a block of M + g C + g^2 K.
enum Inverse {
    Matrix(DMatrix<f64>),
    Diagonal(Vec<f64>),
}

/// Mobility (M + g C + g^2 K)^-1 without inertial couplings, block by block.
struct BlockMobility {
    step: f64,
    blocks: Vec<(Range<usize>, Inverse)>,
}

impl BlockMobility {
    /// Sets the mass matrix of the bodies.
    ///
    /// # Errors
    /// A mass matrix that is not positive definite.
    pub fn set_mass(&mut self, mass: &DMatrix<f64>) -> Result<(), Error> {
        if let Some((_, Inverse::Matrix(bodies))) = self.blocks.first_mut() {
            bodies.as_mut_slice().copy_from_slice(mass.as_slice());
            if !invert_spd(bodies.as_mut_slice(), mass.nrows()) {
                return Err(not_definite(mass.diagonal().min()));
            }
        }
        Ok(())
    }

    /// Computes `out` = Z `load` for the block of the bodies alone; both vectors are over the degrees of freedom of
    /// the bodies.
    pub fn apply_to_bodies(&self, load: &[f64], out: &mut [f64]) {
        if let Some((_, inverse)) = self.blocks.first() {
            inverse.apply(load, out);
        }
    }

    /// Builds M^-1. Where the mass of the bodies changes, their block is valid only after
    /// [`BlockMobility::set_mass`].
    pub fn new(blocks: &[Block], mass_changes: bool) -> Result<BlockMobility, Error> {
        let of = |block: &Block| {
            let inverse = match &block.matrices {
                Matrices::Bodies(mass) if mass_changes => Inverse::Matrix(mass.clone()),
                _ => inverse_of(block, 0.0)?,
            };
            Ok((block.range.clone(), inverse))
        };
        Ok(BlockMobility {
            step: 0.0,
            blocks: blocks.iter().map(of).collect::<Result<_, Error>>()?,
        })
    }

    /// Sets the coefficient g. The block of the bodies does not depend on it.
    pub fn set_step(&mut self, blocks: &[Block], g: f64) -> Result<(), Error> {
        if g != self.step {
            for ((_, inverse), block) in self.blocks.iter_mut().zip(blocks) {
                if !matches!(block.matrices, Matrices::Bodies(_)) {
                    *inverse = inverse_of(block, g)?;
                }
            }
            self.step = g;
        }
        Ok(())
    }

    /// Computes `out` = Z `load`.
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
                add_lines(load.iter().copied().zip(columns_of(matrix)), out);
            }
            Inverse::Diagonal(diagonal) => {
                for ((out, load), entry) in out.iter_mut().zip(load).zip(diagonal) {
                    *out = entry * load;
                }
            }
        }
    }
}

/// Inverse of M + g C + g^2 K of a block.
fn inverse_of(block: &Block, g: f64) -> Result<Inverse, Error> {
    match &block.matrices {
        Matrices::Bodies(mass) => inverse(mass.clone()).map(Inverse::Matrix),
        Matrices::General {
            mass,
            damping,
            stiffness,
        } => inverse(mass + g * damping + g * g * stiffness).map(Inverse::Matrix),
        Matrices::Modes { damping, stiffness } => Ok(Inverse::Diagonal(
            damping
                .iter()
                .zip(stiffness)
                .map(|(c, k)| 1.0 / (1.0 + g * c + g * g * k))
                .collect(),
        )),
    }
}

fn inverse(matrix: DMatrix<f64>) -> Result<DMatrix<f64>, Error> {
    if matrix.is_empty() {
        return Ok(matrix);
    }
    let smallest = matrix.diagonal().min();
    matrix
        .cholesky()
        .map(|factor| factor.inverse())
        .ok_or(not_definite(smallest))
}

fn not_definite(found: f64) -> Error {
    Error::Number {
        what: "mass matrix",
        wanted: "positive definite",
        found,
    }
}
