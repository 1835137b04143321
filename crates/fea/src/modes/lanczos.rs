//! Lowest eigenpairs of K x = lambda M x: block Lanczos on K^-1 M.

use faer::{Mat, Side};
use nalgebra::{DMatrix, DVector, DVectorView};
use sprs::CsMat;

use crate::assembly::symmetric_product;
use crate::factor::{Factor, FactorError, Solver, negative_eigenvalues};
use crate::modes::block;
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
/// Size of the basis, for each pair asked for, from which its Ritz pairs are computed.
const LEAST_BASIS: f64 = 2.0;

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

    /// K^-1 x for every column of `x`.
    fn solve(&self, mut x: DMatrix<f64>) -> DMatrix<f64> {
        match self.factor {
            PencilFactor::Own(factor) => block::apply(x, |lanes| factor.solve_lanes(lanes)),
            PencilFactor::OfFrame(solver, part) => {
                for mut column in x.column_iter_mut() {
                    let solved = part.solve(solver, &column.clone_owned());
                    column.copy_from(&solved);
                }
                x
            }
        }
    }

    /// M x for every column of `x`.
    fn momenta(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        block::symmetric_products(self.mass, x)
    }
}

/// Block Lanczos iteration: a basis V of vectors orthonormal in M, V^T M V = 1, and the projection
/// T = V^T M K^-1 M V of K^-1 M on it.
///
/// Each step takes the next block into the basis, computes K^-1 M times the block, orthogonalises it twice
/// against all vectors (full reorthogonalisation) and normalises what is left as the block after it. The
/// eigenvalues of T approximate 1 / lambda, largest first, and the part of the next block in K^-1 M x is the
/// residual. Beside its diagonal block a new column of T has the coupling of the new block with the basis, known from
/// the step before, and zeros: the products of the basis with K^-1 M times the block would add the rounding of the
/// solve, which is of the size of the largest 1 / lambda and keeps pairs of small 1 / lambda from converging. A block that loses rank is completed with random vectors, so that all copies of multiple
/// eigenvalues are found. A basis that is full is restarted with its best Ritz vectors, of which those that have
/// converged are locked: they leave T, whose largest eigenvalue then sets a lower level of rounding for the others. The
/// iteration stops when enough pairs have converged or when no further vector exists.
///
/// # Source
/// Grimes, Lewis and Simon (1994), SIAM J. Matrix Anal. Appl. 15; Wu and Simon (2000), SIAM J. Matrix
/// Anal. Appl. 22; Ericsson and Ruhe (1980), Math. Comp. 35.
pub(super) struct Lanczos<'a> {
    pencil: Pencil<'a>,
    /// The basis V, a column for each vector: the locked ones first.
    vectors: DMatrix<f64>,
    /// 1 / lambda of the locked vectors.
    locked: Vec<f64>,
    /// T, over the vectors that are not locked.
    projection: DMatrix<f64>,
    /// The block that the next step takes into the basis, and M times it.
    next_block: Vec<DVector<f64>>,
    next_momenta: Vec<DVector<f64>>,
    /// Coefficients of the next block in K^-1 M times the vectors that are not locked: the residual of a pair is
    /// next_block * coupling * its coefficients.
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
            vectors: DMatrix::zeros(pencil.len(), 0),
            locked: Vec::new(),
            projection: DMatrix::zeros(0, 0),
            next_block: Vec::new(),
            next_momenta: Vec::new(),
            coupling: DMatrix::zeros(BLOCK, 0),
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
        let mut due = (self.vectors.ncols() + 1).max((LEAST_BASIS * count as f64) as usize);
        for _ in 0..(80 + 4 * count) {
            // No next block: the basis holds the whole range of K^-1 M.
            let full = self.next_block.is_empty();
            let is_at_limit = self.vectors.ncols() + BLOCK > limit && limit < self.pencil.len();
            if full || is_at_limit || self.vectors.ncols() >= due {
                self.update_pairs();
                self.pairs.exhausted = full;
                if self.pairs.converged >= count || full {
                    return true;
                }
                due = (GROWTH * self.vectors.ncols() as f64) as usize + 1;
            }
            // Restart before the basis exceeds its limit, with the wanted pairs and a third of the others.
            if is_at_limit {
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
        self.next_momenta.clear();
        self.coupling.fill(0.0);
        self.complete_block();
    }

    /// The converged eigenvalues, lowest first.
    pub fn converged_values(&self) -> Vec<f64> {
        self.pairs.inverse[..self.pairs.converged]
            .iter()
            .map(|inverse| inverse.recip())
            .collect()
    }

    /// Number of eigenvalues below `lambda`; `None` if rounding may have changed it.
    pub fn count_below(&self, lambda: f64) -> Result<Option<usize>, FactorError> {
        negative_eigenvalues(
            &(self.pencil.stiffness + &self.pencil.mass.map(|value| -lambda * value)),
        )
    }

    /// The lowest `count` eigenpairs, lowest first: vectors orthonormal in M with a positive largest entry,
    /// lambda = x^T K x / x^T M x.
    ///
    /// Two inverse iterations improve the vectors. After each one R^T R = Y^T M Y, with Y = K^-1 M X, makes them
    /// orthonormal, each to those below it: X := Y R^-1. The last columns of R^-1 are nearly lambda, and so
    /// lambda = x^T K x is a sum that loses no digits: the diagonal of X^T (M X_old) R^-1.
    pub fn modes(&self, count: usize) -> Vec<(f64, DVector<f64>)> {
        let mut x = block::combine(
            &self.vectors,
            &self.pairs.coefficients.columns(0, count).clone_owned(),
        );
        let mut lambda = vec![0.0; count];
        // The solve reduces what rounding left of higher modes; the factor removes the lower ones.
        for _ in 0..POLISH_STEPS {
            let load = self.pencil.momenta(&x);
            let y = self.pencil.solve(load.clone());
            let (ortho, inverse) = self.orthonormal(y);
            let again = self.orthonormal(ortho);
            let inverse = inverse * again.1;
            x = again.0;
            let work = block::inner(&x, &load);
            lambda = (0..count)
                .map(|j| work.row(j).transpose().dot(&inverse.column(j)))
                .collect();
        }
        let mut modes: Vec<(f64, DVector<f64>)> = (lambda.into_iter().zip(x.column_iter()))
            .map(|(lambda, x)| {
                // The sign of an eigenvector is arbitrary: fix it.
                let sign = if x[x.iamax()] < 0.0 { -1.0 } else { 1.0 };
                (lambda, x * sign)
            })
            .collect();
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        modes
    }

    /// Y R^-1 and R^-1, with R^T R = Y^T M Y and R upper triangular.
    fn orthonormal(&self, y: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
        let gram = block::inner(&y, &self.pencil.momenta(&y));
        let size = gram.nrows();
        let factor = gram.cholesky().expect("converged vectors are independent");
        let mut inverse = DMatrix::identity(size, size);
        let is_solved = factor
            .l()
            .transpose()
            .solve_upper_triangular_mut(&mut inverse);
        assert!(is_solved, "a Cholesky factor has no zero pivot");
        (block::combine(&y, &inverse), inverse)
    }

    /// Takes the next block into the basis and computes the one after it.
    fn step(&mut self) {
        let first = self.vectors.ncols();
        let old = self.projection.ncols();
        let width = self.next_block.len();
        let momenta = DMatrix::from_columns(&std::mem::take(&mut self.next_momenta));
        let mut images = self.pencil.solve(momenta);
        block::append(
            &mut self.vectors,
            &DMatrix::from_columns(&std::mem::take(&mut self.next_block)),
        );
        let size = old + width;
        let mut projection = std::mem::replace(&mut self.projection, DMatrix::zeros(0, 0));
        projection = projection.resize(size, size, 0.0);
        let coefficients = self.orthogonalise(&mut images, 2);
        let coupling = self.coupling.rows(0, width);
        projection
            .view_mut((old, 0), (width, old))
            .copy_from(&coupling);
        projection
            .view_mut((0, old), (old, width))
            .copy_from(&coupling.transpose());
        projection
            .view_mut((old, old), (width, width))
            .copy_from(&coefficients.rows(first, width));
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
        self.coupling = DMatrix::zeros(BLOCK, size);
        // vectors that are small beside K^-1 M x have lost digits of their orthogonality
        if images
            .column_iter()
            .any(|image| self.norm(image) < FEW_DIGITS * self.largest)
        {
            self.orthogonalise(&mut images, 1);
        }
        for (j, image) in images.column_iter().enumerate() {
            self.append(image.clone_owned(), Some(old + j));
        }
        self.complete_block();
    }

    /// Completes the next block with random vectors, as far as they exist.
    fn complete_block(&mut self) {
        let n = self.pencil.len();
        let mut misses = 0;
        while self.next_block.len() < BLOCK && misses < 2 {
            let mut x = DVector::from_fn(n, |_, _| self.random_number());
            let before = self.norm(x.as_view());
            self.project_out(&mut x);
            let left = self.norm(x.as_view());
            misses += 1;
            if left <= DEPENDENT * before {
                continue;
            }
            // Only the range of K^-1 M matters: all eigenvectors of finite lambda lie in it.
            let image = symmetric_product(self.pencil.mass, x.as_view());
            let mut x = self
                .pencil
                .solve(DMatrix::from_columns(&[image / left]))
                .column(0)
                .clone_owned();
            let before = self.norm(x.as_view());
            x /= before;
            self.project_out(&mut x);
            if before > 0.0 && self.append(x, None) {
                misses = 0;
            }
        }
    }

    /// Removes the part of `x` in the basis and in the next block.
    fn project_out(&self, x: &mut DVector<f64>) {
        let mut block = DMatrix::from_columns(std::slice::from_ref(x));
        self.orthogonalise(&mut block, 2);
        x.copy_from(&block.column(0));
        for _ in 0..2 {
            for (other, momentum) in self.next_block.iter().zip(&self.next_momenta) {
                let coefficient = momentum.dot(x);
                x.axpy(-coefficient, other, 1.0);
            }
        }
    }

    /// Orthogonalises a vector, orthogonal to the basis already, against the next block, normalises it and
    /// appends it to the block. `column` is that of the coupling, `None` for a random vector. False if only
    /// rounding is left of the vector.
    fn append(&mut self, mut x: DVector<f64>, column: Option<usize>) -> bool {
        let scale = if column.is_some() { self.largest } else { 1.0 };
        let before = self.norm(x.as_view());
        for _ in 0..2 {
            for (i, (other, momentum)) in self.next_block.iter().zip(&self.next_momenta).enumerate()
            {
                let coefficient = momentum.dot(&x);
                x.axpy(-coefficient, other, 1.0);
                if let Some(column) = column {
                    self.coupling[(i, column)] += coefficient;
                }
            }
        }
        let mut momentum = symmetric_product(self.pencil.mass, x.as_view());
        let size = x.dot(&momentum).max(0.0).sqrt();
        let floor = if column.is_some() {
            BREAKDOWN
        } else {
            DEPENDENT
        };
        if !(size > floor * scale && size.is_finite()) {
            return false;
        }
        if let Some(column) = column {
            self.coupling[(self.next_block.len(), column)] = size;
        }
        x /= size;
        momentum /= size;
        // A vector of which little is left has lost digits of its orthogonality.
        if size < FEW_DIGITS * before {
            self.project_out(&mut x);
            momentum = symmetric_product(self.pencil.mass, x.as_view());
            let size = x.dot(&momentum).max(0.0).sqrt();
            x /= size;
            momentum /= size;
        }
        self.next_block.push(x);
        self.next_momenta.push(momentum);
        true
    }

    /// Orthogonalises the columns of `block` against the basis, `times` times; returns their coefficients, basis x block.
    fn orthogonalise(&self, block: &mut DMatrix<f64>, times: usize) -> DMatrix<f64> {
        let mut coefficients = DMatrix::zeros(self.vectors.ncols(), block.ncols());
        for _ in 0..times {
            let parts = block::inner(&self.vectors, &self.pencil.momenta(block));
            block::subtract(block, &self.vectors, &parts);
            coefficients += parts;
        }
        coefficients
    }

    /// sqrt(x^T M x).
    fn norm(&self, x: DVectorView<'_, f64>) -> f64 {
        x.dot(&symmetric_product(self.pencil.mass, x))
            .max(0.0)
            .sqrt()
    }

    /// Computes the Ritz pairs of the basis, and how many have converged.
    fn update_pairs(&mut self) {
        let (locked, size) = (self.locked.len(), self.vectors.ncols());
        let (own, coefficients) = spectrum(&self.projection);
        let residual = block::combine(&self.coupling, &coefficients);
        let noise = NOISE * own.first().copied().unwrap_or(0.0);
        let is_converged = |k: usize| {
            own[k] > noise && residual.column(k).norm() <= (TOLERANCE * own[k]).max(noise)
        };
        // lowest lambda first; of equal ones those that are locked
        let all: Vec<f64> = self.locked.iter().chain(&own).copied().collect();
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&a, &b| all[b].total_cmp(&all[a]));
        let mut over_basis = DMatrix::zeros(size, size);
        for (column, &pair) in order.iter().enumerate() {
            if pair < locked {
                over_basis[(pair, column)] = 1.0;
            } else {
                let own = coefficients.column(pair - locked);
                over_basis
                    .view_mut((locked, column), (size - locked, 1))
                    .copy_from(&own);
            }
        }
        let converged = order
            .iter()
            .take_while(|&&pair| pair < locked || is_converged(pair - locked))
            .count();
        let inverse = order.iter().map(|&pair| all[pair]).collect();
        self.pairs = RitzPairs {
            inverse,
            converged,
            exhausted: false,
            coefficients: over_basis,
        };
    }

    /// Replaces the basis by its first `keep` Ritz vectors, and locks those that have converged.
    fn restart(&mut self, keep: usize) {
        let keep = keep.min(self.vectors.ncols());
        let kept = self.pairs.coefficients.columns(0, keep).clone_owned();
        self.vectors = block::combine(&self.vectors, &kept);
        let converged = self.pairs.converged.min(keep);
        let active = kept.view(
            (self.locked.len(), converged),
            (self.projection.ncols(), keep - converged),
        );
        self.coupling = block::combine(&self.coupling, &active.clone_owned());
        self.pairs.inverse.truncate(keep);
        self.locked = self.pairs.inverse[..converged].to_vec();
        self.projection = DMatrix::from_diagonal(&DVector::from_column_slice(
            &self.pairs.inverse[converged..],
        ));
        self.pairs.coefficients = DMatrix::identity(keep, keep);
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
    // the size 0 has no eigenvalues, and faer subtracts 1 from it
    if size == 0 {
        return (Vec::new(), matrix.clone());
    }
    let given = Mat::from_fn(size, size, |i, j| matrix[(i, j)]);
    let Ok(eigen) = given.self_adjoint_eigen(Side::Lower) else {
        return (vec![0.0; size], DMatrix::identity(size, size));
    };
    let (values, vectors) = (eigen.S(), eigen.U());
    let inverse = (0..size).rev().map(|k| values[k]).collect();
    (
        inverse,
        DMatrix::from_fn(size, size, |i, j| vectors[(i, size - 1 - j)]),
    )
}

#[cfg(test)]
mod tests;
