//! Blocks of vectors, the columns of a matrix: products with sparse and with dense matrices.

use faer::{Accum, MatMut, MatRef};
use nalgebra::DMatrix;
use sprs::CsMat;

use crate::assembly::symmetric_product_lanes;
use crate::factor::multiply;

/// Number of vectors to which a sparse matrix is applied at once.
const LANES: usize = 8;

fn view(x: &DMatrix<f64>) -> MatRef<'_, f64> {
    MatRef::from_column_major_slice(x.as_slice(), x.nrows(), x.ncols())
}

/// y += factor a b, with a^T in place of a if `transposed`.
fn add(y: &mut DMatrix<f64>, factor: f64, a: &DMatrix<f64>, transposed: bool, b: &DMatrix<f64>) {
    let (rows, columns) = y.shape();
    let out = MatMut::from_column_major_slice_mut(y.as_mut_slice(), rows, columns);
    let a = if transposed {
        view(a).transpose()
    } else {
        view(a)
    };
    multiply(out, Accum::Add, a, view(b), factor);
}

/// a^T b.
pub(super) fn inner(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(a.ncols(), b.ncols());
    add(&mut out, 1.0, a, true, b);
    out
}

/// a b.
pub(super) fn combine(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(a.nrows(), b.ncols());
    add(&mut out, 1.0, a, false, b);
    out
}

/// y -= a b.
pub(super) fn subtract(y: &mut DMatrix<f64>, a: &DMatrix<f64>, b: &DMatrix<f64>) {
    add(y, -1.0, a, false, b);
}

/// The columns of `b` behind those of `a`.
pub(super) fn append(a: &mut DMatrix<f64>, b: &DMatrix<f64>) {
    let old = a.ncols();
    let own = std::mem::replace(a, DMatrix::zeros(0, 0));
    *a = own.resize_horizontally(old + b.ncols(), 0.0);
    a.columns_mut(old, b.ncols()).copy_from(b);
}

/// Replaces the columns of `x` by `operator` of them; it receives [`LANES`] columns at a time, side by side in each row,
/// the last ones completed with zeros.
pub(super) fn apply(
    mut x: DMatrix<f64>,
    operator: impl Fn(&mut Vec<[f64; LANES]>),
) -> DMatrix<f64> {
    let n = x.nrows();
    let mut lanes = vec![[0.0; LANES]; n];
    for first in (0..x.ncols()).step_by(LANES) {
        let width = LANES.min(x.ncols() - first);
        let mut columns = x.columns_mut(first, width);
        for (i, row) in lanes.iter_mut().enumerate() {
            *row = std::array::from_fn(|w| if w < width { columns[(i, w)] } else { 0.0 });
        }
        operator(&mut lanes);
        for (i, row) in lanes.iter().enumerate() {
            (0..width).for_each(|w| columns[(i, w)] = row[w]);
        }
    }
    x
}

/// Product of the symmetric matrix whose upper triangle is given with the columns of `x`.
pub(super) fn symmetric_products(upper: &CsMat<f64>, x: &DMatrix<f64>) -> DMatrix<f64> {
    apply(x.clone(), |lanes| {
        *lanes = symmetric_product_lanes(upper, lanes)
    })
}
