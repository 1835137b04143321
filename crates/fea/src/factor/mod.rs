//! The factor of the scaled stiffness, and how far it can be trusted.
//!
//! S K S = L L^T is a sparse Cholesky factor. A solve for influence coefficients stops half way: w = L^-1 p
//! on the path of the elimination tree from the entries of p to the root, since p_i^T K^-1 p_j = w_i . w_j.
//! The certificate bounds what rounding in stiffness and factor can have changed. Where doubles do not meet
//! the accuracy asked for, stiffness and factor are formed again in double-doubles; where that does not help
//! either, the frame is refused with the name of its weakest degree of freedom.
//!
//! Order of the files: `memory`, `product`, `cholesky`, `indefinite`, `forward`, `certificate`, `solver`.

mod certificate;
mod cholesky;
mod forward;
mod indefinite;
mod memory;
mod product;
mod solver;

pub use certificate::Certificate;
pub(crate) use cholesky::{Factor, FactorError};
pub(crate) use forward::{Gram, SparseLoad};
pub(crate) use indefinite::{IndefiniteFactor, negative_eigenvalues};
pub use memory::MEMORY_LIMIT;
pub(crate) use memory::allow_square;
pub(crate) use product::multiply;
pub(crate) use solver::{Factored, Solver, ill_conditioned};

/// Symmetric matrix with the given half bandwidth and the `entry` of each row and column within it, and its upper triangle.
#[cfg(test)]
fn banded(
    n: usize,
    width: usize,
    entry: impl Fn(usize, usize) -> f64,
) -> (nalgebra::DMatrix<f64>, sprs::CsMat<f64>) {
    let within = |i: usize, j: usize| {
        if i.abs_diff(j) <= width {
            entry(i, j)
        } else {
            0.0
        }
    };
    let dense = nalgebra::DMatrix::from_fn(n, n, within);
    let mut upper = sprs::TriMat::new((n, n));
    for j in 0..n {
        (j.saturating_sub(width)..=j).for_each(|i| upper.add_triplet(i, j, dense[(i, j)]));
    }
    (dense, upper.to_csc())
}
