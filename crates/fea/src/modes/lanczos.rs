//! Lowest eigenpairs of K x = lambda M x: block Lanczos on K^-1 M.

use faer::{Mat, Side};
use nalgebra::{DMatrix, DVector, DVectorView};
use sprs::CsMat;

use crate::assembly::symmetric_product;
use crate::factor::{Factor, FactorError, Solver};
use crate::modes::count::negative_eigenvalues;
use crate::modes::decoupled::Part;

/// Number of vectors in a block.
const BLOCK: usize = 8;
/// Residual |K^-1 M x - x / lambda| of a converged pair, relative to 1 / lambda, in the norm of M.
const TOLERANCE: f64 = 1e-11;
/// Residual that rounding leaves, relative to the largest 1 / lambda.
const NOISE: f64 = 4.0 * f64::EPSILON;
/// Norm of a random vector after orthogonalisation, relative to before, at which only rounding is left.
const DEPENDENT: f64 = 1e-10;
/// The same for a vector of the recurrence, relative to the largest 1 / lambda.
const BREAKDOWN: f64 = 16.0 * f64::EPSILON;
/// Norm at which a vector of the recurrence has lost so many digits that it is orthogonalised again.
const FEW_DIGITS: f64 = 1e-4;
/// Inverse iterations of a converged vector.
const POLISH_STEPS: usize = 2;
/// Growth of the basis after which its Ritz pairs are computed again.
const GROWTH: f64 = 1.1;

/// K x = lambda M x, K positive definite and factored, M positive semi-definite.
#[derive(Clone, Copy)]
pub(super) struct Pencil<'a> {
    /// Upper triangle of K.
    pub stiffness: &'a CsMat<f64>,
    /// Upper triangle of M.
    pub mass: &'a CsMat<f64>,
    /// Factor of K.
    pub factor: PencilFactor<'a>,
}

/// A factor of K, or of a larger matrix of which K is a diagonal block without entries beside it.
#[derive(Clone, Copy)]
pub(super) enum PencilFactor<'a> {
    /// Of K.
    Own(&'a Factor<f64>),
    /// Of the stiffness of the frame to which the part belongs.
    OfFrame(&'a Solver, &'a Part),
}

impl Pencil<'_> {
    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.stiffness.cols()
    }

    /// K^-1 x.
    pub fn solve(&self, mut x: DVector<f64>) -> DVector<f64> {
        match self.factor {
            PencilFactor::Own(factor) => {
                factor.solve(x.as_mut_slice());
                x
            }
            PencilFactor::OfFrame(solver, part) => part.solve(solver, &x),
        }
    }
}

/// Block Lanczos iteration: a basis V of vectors orthonormal in M, V^T M V = 1, and the projection
/// T = V^T M K^-1 M V of K^-1 M on it.
///
/// Each step takes the next block into the basis, computes K^-1 M times the block, orthogonalises it twice
/// against all vectors (full reorthogonalisation) and normalises what is left as the block after it. The
/// eigenvalues of T approximate 1 / lambda, largest first, and the part of the next block in K^-1 M x is the
/// residual. A block that loses rank is completed with random vectors, so that all copies of multiple
/// eigenvalues are found. A basis that is full is restarted with its best Ritz vectors. The iteration stops
/// when enough pairs have converged or when no further vector exists.
///
/// # Source
/// Grimes, Lewis and Simon (1994), SIAM J. Matrix Anal. Appl. 15; Wu and Simon (2000), SIAM J. Matrix
/// Anal. Appl. 22; Ericsson and Ruhe (1980), Math. Comp. 35.
pub(super) struct Lanczos<'a> {
    pencil: Pencil<'a>,
    vectors: Vec<DVector<f64>>,
    projection: DMatrix<f64>,
    /// The block that the next step takes into the basis.
    next_block: Vec<DVector<f64>>,
    /// Coefficients of the next block in K^-1 M times the last one: the residual of a pair is next_block *
    /// coupling * the last part of its coefficients.
    coupling: DMatrix<f64>,
    /// Largest 1 / lambda seen so far.
    largest: f64,
    /// State of the random numbers.
    random: u64,
    pub pairs: RitzPairs,
}

/// Ritz pairs of a basis, lowest lambda first.
#[derive(Default)]
pub(super) struct RitzPairs {
    /// 1 / lambda.
    pub inverse: Vec<f64>,
    /// How many of the first pairs have converged.
    pub converged: usize,
    /// All finite eigenvalues are found.
    pub exhausted: bool,
    /// Ritz vectors over the basis, one for each column.
    coefficients: DMatrix<f64>,
}

impl<'a> Lanczos<'a> {
    /// An empty basis and a random first block.
    pub fn new(pencil: Pencil<'a>) -> Lanczos<'a> {
        let mut out = Lanczos {
            pencil,
            vectors: Vec::new(),
            projection: DMatrix::zeros(0, 0),
            next_block: Vec::new(),
            coupling: DMatrix::zeros(0, 0),
            largest: 0.0,
            random: 0x6a09_e667_f3bc_c908,
            pairs: RitzPairs::default(),
        };
        out.complete_block();
        out
    }

    /// Iterates until the lowest `count` pairs have converged or no more exist; false if it gives up.
    pub fn converge(&mut self, count: usize) -> bool {
        let limit = 3 * count + 8 * BLOCK;
        // Size of the basis at which the Ritz pairs are computed next.
        let mut due = self.vectors.len() + 1;
        for _ in 0..(80 + 4 * count) {
            // No next block: the basis holds the whole range of K^-1 M.
            let full = self.next_block.is_empty();
            if full || self.vectors.len() >= due {
                self.update_pairs();
                self.pairs.exhausted = full;
                if self.pairs.converged >= count || full {
                    return true;
                }
                due = (GROWTH * self.vectors.len() as f64) as usize + 1;
            }
            // Restart before the basis exceeds its limit, with the wanted pairs and a third of the others.
            if self.vectors.len() + BLOCK > limit && limit < self.pencil.len() {
                self.update_pairs();
                self.restart(count + (limit - count) / 3);
                due = 0;
            }
            self.step();
        }
        false
    }

    /// Keeps the converged pairs alone and continues from random vectors orthogonal to them.
    pub fn restart_randomly(&mut self) {
        self.restart(self.pairs.converged);
        self.next_block.clear();
        self.complete_block();
    }

    /// The converged eigenvalues, lowest first.
    pub fn converged_values(&self) -> Vec<f64> {
        self.pairs.inverse[..self.pairs.converged].iter().map(|inverse| inverse.recip()).collect()
    }

    /// Number of eigenvalues below `lambda`; `None` if rounding may have changed it.
    pub fn count_below(&self, lambda: f64) -> Result<Option<usize>, FactorError> {
        negative_eigenvalues(&(self.pencil.stiffness + &self.pencil.mass.map(|value| -lambda * value)))
    }

    /// The lowest `count` eigenpairs, lowest first: vectors orthonormal in M with a positive largest entry,
    /// lambda = x^T K x / x^T M x.
    ///
    /// Two inverse iterations improve each vector, orthogonal to those below it.
    pub fn modes(&self, count: usize) -> Vec<(f64, DVector<f64>)> {
        let mut modes: Vec<(f64, DVector<f64>)> = Vec::with_capacity(count);
        for pair in 0..count {
            let mut x = self.combine(self.pairs.coefficients.column(pair));
            let mut lambda = 0.0;
            // The solve reduces what rounding left of higher modes; the subtraction removes the lower ones.
            for _ in 0..POLISH_STEPS {
                let load = symmetric_product(self.pencil.mass, x.as_view());
                x = self.pencil.solve(load.clone());
                for _ in 0..2 {
                    let image = symmetric_product(self.pencil.mass, x.as_view());
                    modes.iter().for_each(|(_, other)| x.axpy(-other.dot(&image), other, 1.0));
                }
                lambda = x.dot(&load) / x.dot(&symmetric_product(self.pencil.mass, x.as_view()));
                x /= self.norm(&x);
            }
            // The sign of an eigenvector is arbitrary: fix it.
            let sign = if x[x.iamax()] < 0.0 { -1.0 } else { 1.0 };
            modes.push((lambda, x * sign));
        }
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        modes
    }

    /// The vector with the given coefficients over the basis.
    fn combine(&self, coefficients: DVectorView<'_, f64>) -> DVector<f64> {
        let mut out = DVector::zeros(self.pencil.len());
        for (vector, &coefficient) in self.vectors.iter().zip(coefficients.iter()) {
            out.axpy(coefficient, vector, 1.0);
        }
        out
    }

    /// Takes the next block into the basis and computes the one after it.
    fn step(&mut self) {
        let old = self.vectors.len();
        let block = std::mem::take(&mut self.next_block);
        let mut images: Vec<DVector<f64>> = block
            .iter()
            .map(|x| self.pencil.solve(symmetric_product(self.pencil.mass, x.as_view())))
            .collect();
        let width = block.len();
        self.vectors.extend(block);
        let size = self.vectors.len();
        let mut projection = std::mem::replace(&mut self.projection, DMatrix::zeros(0, 0));
        projection = projection.resize(size, size, 0.0);
        let coefficients = self.orthogonalise(&mut images);
        projection.columns_mut(old, width).copy_from(&coefficients);
        projection.view_mut((old, 0), (width, old)).copy_from(&coefficients.rows(0, old).transpose());
        // Rounding leaves the diagonal block of the projection slightly asymmetric.
        for i in old..size {
            for j in old..i {
                let mean = 0.5 * (projection[(i, j)] + projection[(j, i)]);
                projection[(i, j)] = mean;
                projection[(j, i)] = mean;
            }
            self.largest = self.largest.max(projection[(i, i)]);
        }
        self.projection = projection;
        self.coupling = DMatrix::zeros(BLOCK.max(width), width);
        for (j, image) in images.into_iter().enumerate() {
            self.append(image, Some(j));
        }
        self.complete_block();
    }

    /// Completes the next block with random vectors, as far as they exist.
    fn complete_block(&mut self) {
        let n = self.pencil.len();
        let mut misses = 0;
        while self.next_block.len() < BLOCK && misses < 2 {
            let mut x = DVector::from_fn(n, |_, _| self.random_number());
            let before = self.norm(&x);
            self.project_out(&mut x);
            let left = self.norm(&x);
            misses += 1;
            if left <= DEPENDENT * before {
                continue;
            }
            // Only the range of K^-1 M matters: all eigenvectors of finite lambda lie in it.
            let image = symmetric_product(self.pencil.mass, x.as_view());
            let mut x = self.pencil.solve(image / left);
            let before = self.norm(&x);
            x /= before;
            self.project_out(&mut x);
            if before > 0.0 && self.append(x, None) {
                misses = 0;
            }
        }
    }

    /// Removes the part of `x` in the basis and in the next block.
    fn project_out(&self, x: &mut DVector<f64>) {
        self.orthogonalise(std::slice::from_mut(x));
        for _ in 0..2 {
            let image = symmetric_product(self.pencil.mass, x.as_view());
            for other in &self.next_block {
                let coefficient = other.dot(&image);
                x.axpy(-coefficient, other, 1.0);
            }
        }
    }

    /// Orthogonalises a vector, orthogonal to the basis already, against the next block, normalises it and
    /// appends it to the block. `column` is that of the coupling, `None` for a random vector. False if only
    /// rounding is left of the vector.
    fn append(&mut self, mut x: DVector<f64>, column: Option<usize>) -> bool {
        let scale = if column.is_some() { self.largest } else { 1.0 };
        for _ in 0..2 {
            let image = symmetric_product(self.pencil.mass, x.as_view());
            for (i, other) in self.next_block.iter().enumerate() {
                let coefficient = other.dot(&image);
                x.axpy(-coefficient, other, 1.0);
                if let Some(column) = column {
                    self.coupling[(i, column)] += coefficient;
                }
            }
        }
        let size = self.norm(&x);
        let floor = if column.is_some() { BREAKDOWN } else { DEPENDENT };
        if !(size > floor * scale && size.is_finite()) {
            return false;
        }
        if let Some(column) = column {
            self.coupling[(self.next_block.len(), column)] = size;
        }
        x /= size;
        // A vector that was small has lost digits of its orthogonality.
        if size < FEW_DIGITS * scale {
            self.project_out(&mut x);
            let size = self.norm(&x);
            x /= size;
        }
        self.next_block.push(x);
        true
    }

    /// Removes the parts of `block` in the basis, twice; returns their coefficients, basis x block.
    fn orthogonalise(&self, block: &mut [DVector<f64>]) -> DMatrix<f64> {
        let mut coefficients = DMatrix::zeros(self.vectors.len(), block.len());
        for _ in 0..2 {
            let images: Vec<DVector<f64>> =
                block.iter().map(|x| symmetric_product(self.pencil.mass, x.as_view())).collect();
            for (k, vector) in self.vectors.iter().enumerate() {
                for (j, (x, image)) in block.iter_mut().zip(&images).enumerate() {
                    let coefficient = vector.dot(image);
                    x.axpy(-coefficient, vector, 1.0);
                    coefficients[(k, j)] += coefficient;
                }
            }
        }
        coefficients
    }

    /// sqrt(x^T M x).
    fn norm(&self, x: &DVector<f64>) -> f64 {
        x.dot(&symmetric_product(self.pencil.mass, x.as_view())).max(0.0).sqrt()
    }

    /// Computes the Ritz pairs of the basis, and how many have converged.
    fn update_pairs(&mut self) {
        let size = self.vectors.len();
        let (inverse, coefficients) = spectrum(&self.projection);
        let width = self.coupling.ncols().min(size);
        let last = coefficients.rows(size - width, width);
        let residual = self.coupling.columns(0, width) * last;
        let converged = (0..size)
            .take_while(|&k| {
                let enough = (TOLERANCE * inverse[k]).max(NOISE * self.largest);
                inverse[k] > NOISE * self.largest && residual.column(k).norm() <= enough
            })
            .count();
        self.pairs = RitzPairs { inverse, converged, exhausted: false, coefficients };
    }

    /// Replaces the basis by its first `keep` Ritz vectors.
    fn restart(&mut self, keep: usize) {
        let keep = keep.min(self.vectors.len());
        self.vectors = (0..keep).map(|k| self.combine(self.pairs.coefficients.column(k))).collect();
        self.pairs.inverse.truncate(keep);
        self.projection = DMatrix::from_diagonal(&DVector::from_column_slice(&self.pairs.inverse));
        self.pairs.coefficients = DMatrix::identity(keep, keep);
        self.coupling = DMatrix::zeros(0, 0);
    }

    /// A random number from -1 to 1 (splitmix64).
    fn random_number(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.random;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Eigenvalues of a symmetric matrix, largest first, and their vectors as columns.
fn spectrum(matrix: &DMatrix<f64>) -> (Vec<f64>, DMatrix<f64>) {
    let size = matrix.nrows();
    let given = Mat::from_fn(size, size, |i, j| matrix[(i, j)]);
    let Ok(eigen) = given.self_adjoint_eigen(Side::Lower) else {
        return (vec![0.0; size], DMatrix::identity(size, size));
    };
    let (values, vectors) = (eigen.S(), eigen.U());
    let inverse = (0..size).rev().map(|k| values[k]).collect();
    (inverse, DMatrix::from_fn(size, size, |i, j| vectors[(i, size - 1 - j)]))
}

#[cfg(test)]
mod tests;
