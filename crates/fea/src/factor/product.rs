//! Products of dense matrices.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};

use crate::assembly::Real;

/// out := factor a b, or out += factor a b.
pub(crate) fn multiply<T: Real>(
    out: MatMut<'_, T>,
    accum: Accum,
    a: MatRef<'_, T>,
    b: MatRef<'_, T>,
    factor: T,
) {
    matmul(out, accum, a, b, factor, Par::Seq);
    clear_registers();
}

/// Clears the upper halves of the vector registers after products of faer.
///
/// The kernels of faer's product (private-gemm-x86 0.1) return without clearing them. On x86-64 every scalar instruction
/// after them then waits for the register's last value: code that follows takes up to ten times as long, until some
/// function clears them. The norm of a few numbers is such a function.
pub(crate) fn clear_registers() {
    std::hint::black_box(MatRef::from_column_major_slice(&[1.0_f64; 16], 16, 1).norm_max());
}
