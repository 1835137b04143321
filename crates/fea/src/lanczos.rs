//! Lowest eigenpairs of K x = lambda M x: block Lanczos on K^-1 M.

use faer::{Mat, Side};
use nalgebra::{DMatrix, DVector, DVectorView};
use sprs::CsMat;

use crate::factor::Refusal;
use crate::inertia::negatives;
use crate::solver::Solver;

/// Vectors of a block.
const BLOCK: usize = 8;
/// Residual of K^-1 M x - x / lambda, relative to 1 / lambda, both in the norm of M.
const TOLERANCE: f64 = 1e-11;
/// Residual that rounding leaves, relative to the largest 1 / lambda.
const NOISE: f64 = 4.0 * f64::EPSILON;
/// Part of a vector, relative to what it was, below which orthogonalising has left rounding alone.
const DEPENDENT: f64 = 1e-10;
/// Inverse iterations of a vector that has converged.
const POLISH: usize = 2;
/// Growth of the basis between two looks at its Ritz values.
const LOOK: f64 = 1.1;

/// K x = lambda M x, K positive definite and factored, M positive semi-definite.
#[derive(Clone, Copy)]
pub(crate) struct Pencil<'a> {
    /// Upper triangle.
    pub stiffness: &'a CsMat<f64>,
    /// Upper triangle.
    pub mass: &'a CsMat<f64>,
    pub factor: &'a Solver,
}

impl Pencil<'_> {
    pub fn len(&self) -> usize {
        self.factor.len()
    }

    /// K^-1 x.
    pub fn solve(&self, mut x: DVector<f64>) -> DVector<f64> {
        self.factor.solve(x.as_mut_slice());
        x
    }
}

/// Product of the symmetric matrix whose upper triangle is given with a vector.
pub(crate) fn product(upper: &CsMat<f64>, x: DVectorView<'_, f64>) -> DVector<f64> {
    let mut y = DVector::zeros(x.len());
    let (x, out) = (x.as_slice(), y.as_mut_slice());
    for (j, column) in upper.outer_iterator().enumerate() {
        let (value, mut sum) = (x[j], 0.0);
        for (i, &entry) in column.iter() {
            if i == j {
                sum += entry * value;
            } else {
                sum += entry * x[i];
                out[i] += entry * value;
            }
        }
        out[j] += sum;
    }
    y
}

/// A growing space of vectors orthonormal in M, with the projection T of K^-1 M on it.
///
/// Every new block is orthogonalised twice against all others. A block that loses rank is filled up with
/// random vectors, so that further copies of multiple eigenvalues turn up; a space that is full is
/// restarted with its best Ritz vectors.
///
/// # Source
/// Grimes, Lewis and Simon (1994), SIAM J. Matrix Anal. Appl. 15; Wu and Simon (2000), SIAM J. Matrix
/// Anal. Appl. 22; Ericsson and Ruhe (1980), Math. Comp. 35.
pub(crate) struct Space<'a> {
    pencil: Pencil<'a>,
    vectors: Vec<DVector<f64>>,
    projection: DMatrix<f64>,
    /// The next block.
    next: Vec<DVector<f64>>,
    /// Coefficients of the next block in K^-1 M times the last one: residual = next * coupling * last part.
    coupling: DMatrix<f64>,
    /// Largest 1 / lambda seen.
    largest: f64,
    stream: u64,
    pub pairs: Pairs,
}

/// Ritz pairs of a space, lowest lambda first.
#[derive(Default)]
pub(crate) struct Pairs {
    /// 1 / lambda.
    pub inverse: Vec<f64>,
    /// How many of the first have converged.
    pub converged: usize,
    /// No further eigenvalue is finite.
    pub exhausted: bool,
    coefficients: DMatrix<f64>,
}

impl<'a> Space<'a> {
    pub fn new(pencil: Pencil<'a>) -> Space<'a> {
        let mut space = Space {
            pencil,
            vectors: Vec::new(),
            projection: DMatrix::zeros(0, 0),
            next: Vec::new(),
            coupling: DMatrix::zeros(0, 0),
            largest: 0.0,
            stream: 0x6a09_e667_f3bc_c908,
            pairs: Pairs::default(),
        };
        space.fill();
        space
    }

    /// Grows until the lowest `count` pairs have converged or no more exist; false where it gives up.
    pub fn converge(&mut self, count: usize) -> bool {
        let limit = 3 * count + 8 * BLOCK;
        let mut look = self.vectors.len() + 1;
        for _ in 0..(80 + 4 * count) {
            let full = self.next.is_empty();
            if full || self.vectors.len() >= look {
                self.look();
                self.pairs.exhausted = full;
                if self.pairs.converged >= count || full {
                    return true;
                }
                look = (LOOK * self.vectors.len() as f64) as usize + 1;
            }
            if self.vectors.len() + BLOCK > limit && limit < self.pencil.len() {
                self.look();
                self.restart(count + (limit - count) / 3);
                look = 0;
            }
            self.step();
        }
        false
    }

    /// Drops all but the pairs that have converged, and goes on from random vectors orthogonal to them.
    pub fn refresh(&mut self) {
        self.restart(self.pairs.converged);
        self.next.clear();
        self.fill();
    }

    /// The eigenvalues that have converged, lowest first.
    pub fn known(&self) -> Vec<f64> {
        self.pairs.inverse[..self.pairs.converged].iter().map(|inverse| inverse.recip()).collect()
    }

    /// Number of eigenvalues below `lambda`; `None` where rounding may have changed it.
    pub fn negatives(&self, lambda: f64) -> Result<Option<usize>, Refusal> {
        negatives(&(self.pencil.stiffness + &self.pencil.mass.map(|value| -lambda * value)))
    }

    /// The lowest `count` eigenpairs, lowest first: vectors orthonormal in M, largest entry positive; values
    /// lambda = x^T K x / x^T M x.
    pub fn modes(&self, count: usize) -> Vec<(f64, DVector<f64>)> {
        let mut modes: Vec<(f64, DVector<f64>)> = Vec::with_capacity(count);
        for pair in 0..count {
            let mut x = self.combine(self.pairs.coefficients.column(pair));
            let mut lambda = 0.0;
            // What rounding left of higher modes shrinks, what it left of lower ones is taken away.
            for _ in 0..POLISH {
                let load = product(self.pencil.mass, x.as_view());
                x = self.pencil.solve(load.clone());
                for _ in 0..2 {
                    let image = product(self.pencil.mass, x.as_view());
                    modes.iter().for_each(|(_, other)| x.axpy(-other.dot(&image), other, 1.0));
                }
                lambda = x.dot(&load) / x.dot(&product(self.pencil.mass, x.as_view()));
                x /= self.norm(&x);
            }
            let sign = if x[x.iamax()] < 0.0 { -1.0 } else { 1.0 };
            modes.push((lambda, x * sign));
        }
        modes.sort_by(|a, b| a.0.total_cmp(&b.0));
        modes
    }

    fn combine(&self, coefficients: DVectorView<'_, f64>) -> DVector<f64> {
        let mut out = DVector::zeros(self.pencil.len());
        for (vector, &share) in self.vectors.iter().zip(coefficients.iter()) {
            out.axpy(share, vector, 1.0);
        }
        out
    }

    /// Takes the next block into the space and computes the one after it.
    fn step(&mut self) {
        let old = self.vectors.len();
        let block = std::mem::take(&mut self.next);
        let mut images: Vec<DVector<f64>> =
            block.iter().map(|x| self.pencil.solve(product(self.pencil.mass, x.as_view()))).collect();
        let width = block.len();
        self.vectors.extend(block);
        let size = self.vectors.len();
        let mut projection = std::mem::replace(&mut self.projection, DMatrix::zeros(0, 0));
        projection = projection.resize(size, size, 0.0);
        let shares = self.orthogonalise(&mut images);
        projection.columns_mut(old, width).copy_from(&shares);
        projection.view_mut((old, 0), (width, old)).copy_from(&shares.rows(0, old).transpose());
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
            self.admit(image, Some(j));
        }
        self.fill();
    }

    /// Fills the next block with random vectors, as many as there are.
    fn fill(&mut self) {
        let n = self.pencil.len();
        let mut misses = 0;
        while self.next.len() < BLOCK && misses < 2 {
            let mut x = DVector::from_fn(n, |_, _| self.random());
            let before = self.norm(&x);
            self.reduce(&mut x);
            let left = self.norm(&x);
            misses += 1;
            if left <= DEPENDENT * before {
                continue;
            }
            // Within the range of K^-1 M, where all vectors that matter lie.
            let image = product(self.pencil.mass, x.as_view());
            let mut x = self.pencil.solve(image / left);
            let before = self.norm(&x);
            x /= before;
            self.reduce(&mut x);
            if before > 0.0 && self.admit(x, None) {
                misses = 0;
            }
        }
    }

    /// Removes the part of `x` within the space and the next block.
    fn reduce(&self, x: &mut DVector<f64>) {
        self.orthogonalise(std::slice::from_mut(x));
        for _ in 0..2 {
            let image = product(self.pencil.mass, x.as_view());
            for other in &self.next {
                let share = other.dot(&image);
                x.axpy(-share, other, 1.0);
            }
        }
    }

    /// Normalises a vector orthogonal to the space against the next block and appends it; `column`: of the
    /// coupling. False where nothing but rounding is left of it.
    fn admit(&mut self, mut x: DVector<f64>, column: Option<usize>) -> bool {
        let scale = if column.is_some() { self.largest } else { 1.0 };
        for _ in 0..2 {
            let image = product(self.pencil.mass, x.as_view());
            for (i, other) in self.next.iter().enumerate() {
                let share = other.dot(&image);
                x.axpy(-share, other, 1.0);
                if let Some(column) = column {
                    self.coupling[(i, column)] += share;
                }
            }
        }
        let size = self.norm(&x);
        let floor = if column.is_some() { 16.0 * f64::EPSILON } else { DEPENDENT };
        if !(size > floor * scale && size.is_finite()) {
            return false;
        }
        if let Some(column) = column {
            self.coupling[(self.next.len(), column)] = size;
        }
        x /= size;
        // What was small has little left of its orthogonality.
        if size < 1e-4 * scale {
            self.reduce(&mut x);
            let size = self.norm(&x);
            x /= size;
        }
        self.next.push(x);
        true
    }

    /// Removes the parts of `block` within the space, twice; gives their coefficients.
    fn orthogonalise(&self, block: &mut [DVector<f64>]) -> DMatrix<f64> {
        let mut shares = DMatrix::zeros(self.vectors.len(), block.len());
        for _ in 0..2 {
            let images: Vec<DVector<f64>> =
                block.iter().map(|x| product(self.pencil.mass, x.as_view())).collect();
            for (k, vector) in self.vectors.iter().enumerate() {
                for (j, (x, image)) in block.iter_mut().zip(&images).enumerate() {
                    let share = vector.dot(image);
                    x.axpy(-share, vector, 1.0);
                    shares[(k, j)] += share;
                }
            }
        }
        shares
    }

    fn norm(&self, x: &DVector<f64>) -> f64 {
        x.dot(&product(self.pencil.mass, x.as_view())).max(0.0).sqrt()
    }

    /// Computes the Ritz pairs.
    fn look(&mut self) {
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
        self.pairs = Pairs { inverse, converged, exhausted: false, coefficients };
    }

    /// Keeps the first Ritz vectors alone.
    fn restart(&mut self, keep: usize) {
        let keep = keep.min(self.vectors.len());
        self.vectors = (0..keep).map(|k| self.combine(self.pairs.coefficients.column(k))).collect();
        self.pairs.inverse.truncate(keep);
        self.projection = DMatrix::from_diagonal(&DVector::from_column_slice(&self.pairs.inverse));
        self.pairs.coefficients = DMatrix::identity(keep, keep);
        self.coupling = DMatrix::zeros(0, 0);
    }

    /// A number in -1..1 (splitmix64).
    fn random(&mut self) -> f64 {
        self.stream = self.stream.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.stream;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// Eigenvalues of a symmetric matrix, largest first, and their vectors.
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
mod tests {
    use sprs::TriMat;

    use super::*;
    use crate::factor::Factor;

    /// Upper triangle of a matrix.
    fn upper(dense: &DMatrix<f64>) -> CsMat<f64> {
        let n = dense.nrows();
        let mut out = TriMat::new((n, n));
        for j in 0..n {
            (0..=j).filter(|&i| dense[(i, j)] != 0.0).for_each(|i| out.add_triplet(i, j, dense[(i, j)]));
        }
        out.to_csc()
    }

    /// Stiffness of a chain, and a mass of which `massless` freedoms have none.
    fn pencil(n: usize, massless: usize) -> [DMatrix<f64>; 2] {
        let stiffness = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 => 2.0 + 0.01 * (i % 5) as f64,
            1 => -1.0,
            _ => 0.0,
        });
        let mass = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
            _ if i.min(j) < massless => 0.0,
            0 => 4.0 + (i % 3) as f64,
            1 => 1.0,
            _ => 0.0,
        });
        [stiffness, mass]
    }

    fn solver(stiffness: &CsMat<f64>) -> Solver {
        Solver::Double(Factor::new(stiffness).expect("positive definite"))
    }

    #[test]
    fn pairs_are_those_of_the_dense_pencil_massless_freedoms_too() {
        for (n, massless, count) in [(1, 0, 1), (6, 2, 3), (90, 0, 12), (90, 31, 20), (400, 150, 37)] {
            let [stiffness, mass] = pencil(n, massless);
            // 1 / lambda are the eigenvalues of L^-1 M L^-T.
            let l = stiffness.clone().cholesky().expect("positive definite").l();
            let half = l.solve_lower_triangular(&mass).expect("regular");
            let whole = l.solve_lower_triangular(&half.transpose()).expect("regular");
            let mut exact: Vec<f64> = whole.symmetric_eigenvalues().iter().copied().collect();
            exact.sort_by(|a, b| b.total_cmp(a));
            let [k, m] = [&stiffness, &mass].map(upper);
            let factor = solver(&k);
            let mut space = Space::new(Pencil { stiffness: &k, mass: &m, factor: &factor });
            assert!(space.converge(count));
            assert!(space.pairs.converged >= count);
            let modes = space.modes(count);
            for (i, (lambda, x)) in modes.iter().enumerate() {
                assert!((lambda * exact[i] - 1.0).abs() < 1e-11, "{n}, {i}: {lambda} {}", 1.0 / exact[i]);
                assert!((&stiffness * x - &mass * x * *lambda).norm() < 1e-10 * x.norm());
                for (j, (_, y)) in modes.iter().enumerate() {
                    let unit = f64::from(u8::from(i == j));
                    assert!((x.dot(&(&mass * y)) - unit).abs() < 1e-12);
                }
            }
        }
    }

    #[test]
    fn a_search_beyond_the_rank_of_the_mass_ends_with_all_there_are() {
        let [stiffness, mass] = pencil(90, 31);
        let [k, m] = [&stiffness, &mass].map(upper);
        let factor = solver(&k);
        let mut space = Space::new(Pencil { stiffness: &k, mass: &m, factor: &factor });
        assert!(space.converge(80));
        assert!(space.pairs.exhausted);
        assert_eq!(space.pairs.converged, 59);
    }

    #[test]
    fn after_a_refresh_known_pairs_remain_and_others_follow() {
        let [stiffness, mass] = pencil(400, 0);
        let [k, m] = [&stiffness, &mass].map(upper);
        let factor = solver(&k);
        let mut space = Space::new(Pencil { stiffness: &k, mass: &m, factor: &factor });
        assert!(space.converge(5));
        let before = space.known();
        space.refresh();
        assert!(space.converge(before.len() + 3));
        for (a, b) in before.iter().zip(space.known()) {
            assert!((a / b - 1.0).abs() < 1e-12);
        }
    }
}
