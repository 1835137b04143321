//! Sparse Cholesky factor in panels of adjoining columns.
//!
//! Solves run with the widest vector registers that the processor has. Their results are the same in every bit without
//! them: the order of the sums is fixed, and products are rounded before they are added. Double-doubles need the product
//! with one rounding (fused multiply-add), which is a function call where the processor is not asked first.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, MatMut, MatRef, Par, Side};
use pulp::{Arch, Simd, WithSimd};
use sprs::CsMat;

use crate::assembly::Real;
use crate::factor::memory::MEMORY_LIMIT;
use crate::factor::product::multiply;

/// Width of a panel from which a dense matrix product pays.
const DENSE_WIDTH: usize = 4;

/// Vectors from which panels are solved for all of them together.
const DENSE_LANES: usize = 4;

/// Why a matrix has no factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FactorError {
    /// A pivot is not positive.
    Indefinite,
    /// The factor exceeds the memory or the indices; its number of entries, 0 if unknown.
    TooLarge(u64),
}

/// L with L L^T = K, K symmetric positive definite, in panels of adjoining columns.
#[derive(Debug)]
pub(crate) struct Factor<T: Real = f64> {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<T>,
    /// 1/L_kk of a factor in single columns: a quotient of double-doubles takes several times as long as a product.
    reciprocals: Vec<T>,
    /// Panel of each column.
    pub(super) panel_of: Vec<usize>,
    pub(super) panels: usize,
}

/// Columns `start..start + width` of L: `values` is a dense column-major block whose first `width` rows
/// are the triangle and whose other rows are those of `below`.
pub(super) struct Panel<'a, T> {
    pub start: usize,
    pub width: usize,
    pub below: &'a [usize],
    values: &'a [T],
}

impl<T: Real> Factor<T> {
    /// Factors the matrix whose upper triangle is given, in the order given, on one thread.
    pub fn new(upper: &CsMat<T>) -> Result<Factor<T>, FactorError> {
        let n = upper.cols();
        let mut params = CholeskySymbolicParams::default();
        // faer has dense kernels for native numbers only: double-doubles are factored column by column.
        if !T::NATIVE {
            params.supernodal_flop_ratio_threshold = SupernodalThreshold::FORCE_SIMPLICIAL;
        }
        let Analysis {
            pattern,
            symbolic,
            mut values,
        } = analyse(upper, params)?;
        let request = symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(request).map_err(|_| FactorError::TooLarge(0))?;
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(pattern, upper.data()),
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|_| FactorError::Indefinite)?;
        let (panel_of, panels, reciprocals) = match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(columns) => {
                let of = |&start: &usize| T::one() / values[start];
                (
                    (0..n).collect(),
                    n,
                    columns.col_ptr()[..n].iter().map(of).collect(),
                )
            }
            SymbolicCholeskyRaw::Supernodal(s) => {
                let spans = s.supernode_begin().iter().zip(s.supernode_end());
                let all = spans
                    .enumerate()
                    .flat_map(|(k, (a, b))| std::iter::repeat_n(k, b - a))
                    .collect();
                (all, s.n_supernodes(), Vec::new())
            }
        };
        Ok(Factor {
            symbolic,
            values,
            reciprocals,
            panel_of,
            panels,
        })
    }

    /// Number of rows and columns.
    pub fn len(&self) -> usize {
        self.panel_of.len()
    }

    pub(super) fn panel(&self, k: usize) -> Panel<'_, T> {
        Panel::of(&self.symbolic, &self.values, k)
    }

    /// Bytes of its entries.
    pub fn bytes(&self) -> u64 {
        (self.values.len() * size_of::<T>()) as u64
    }

    /// Smallest pivot L_kk^2.
    pub fn least_pivot(&self) -> f64 {
        let mut least = f64::INFINITY;
        for k in 0..self.panels {
            let panel = self.panel(k);
            let rows = panel.width + panel.below.len();
            for j in 0..panel.width {
                let pivot = panel.values[j * rows + j].double();
                least = least.min(pivot * pivot);
            }
        }
        least
    }

    /// Solves K x = x in place.
    pub fn solve(&self, x: &mut [T]) {
        let (single, _) = x.as_chunks_mut::<1>();
        self.solve_lanes(single);
    }

    /// Solves K x = x in place for W vectors, side by side in each row.
    pub fn solve_lanes<const W: usize>(&self, x: &mut [[T; W]]) {
        Arch::new().dispatch(Solve { factor: self, x });
    }

    #[inline(always)]
    fn solve_panels<const W: usize>(&self, x: &mut [[T; W]]) {
        let mut scratch = Vec::new();
        for k in 0..self.panels {
            self.panel(k).forward(x, &mut scratch);
        }
        for k in (0..self.panels).rev() {
            self.panel(k).backward(x, &mut scratch);
        }
    }

    /// Largest row sum of |L| |L^T|, and the largest number of entries in a row of L.
    pub fn growth(&self) -> (f64, usize) {
        Arch::new().dispatch(Growth { factor: self })
    }
}

/// [`Factor::growth`], compiled for several sets of vector registers.
struct Growth<'a, T: Real> {
    factor: &'a Factor<T>,
}

impl<T: Real> WithSimd for Growth<'_, T> {
    type Output = (f64, usize);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> (f64, usize) {
        let n = self.factor.len();
        let (mut rows, mut lengths) = (vec![0.0_f64; n], vec![0_usize; n]);
        let mut sums = Vec::new();
        for k in 0..self.factor.panels {
            let panel = self.factor.panel(k);
            let height = panel.height();
            sums.clear();
            sums.resize(height, 0.0);
            for j in 0..panel.width {
                let column = &panel.values[j * height + j..(j + 1) * height];
                let size = magnitude_sum(column);
                for (sum, value) in sums[j..].iter_mut().zip(column) {
                    *sum += value.double().abs() * size;
                }
                lengths[panel.start + j] += j + 1;
            }
            let (own, below) = sums.split_at(panel.width);
            rows[panel.start..][..panel.width]
                .iter_mut()
                .zip(own)
                .for_each(|(row, sum)| *row += sum);
            for (&row, sum) in panel.below.iter().zip(below) {
                rows[row] += sum;
                lengths[row] += panel.width;
            }
        }
        (
            rows.into_iter().fold(0.0, f64::max),
            lengths.into_iter().max().unwrap_or(0),
        )
    }
}

/// Sum of the magnitudes of some numbers, in eight parts.
#[inline(always)]
fn magnitude_sum<T: Real>(values: &[T]) -> f64 {
    let (parts, rest) = values.as_chunks::<8>();
    let mut sums = [0.0_f64; 8];
    for part in parts {
        sums.iter_mut()
            .zip(part)
            .for_each(|(sum, value)| *sum += value.double().abs());
    }
    rest.iter().map(|value| value.double().abs()).sum::<f64>() + sums.iter().sum::<f64>()
}

/// Solution of K x = x for W vectors, compiled for several sets of vector registers.
struct Solve<'a, T: Real, const W: usize> {
    factor: &'a Factor<T>,
    x: &'a mut [[T; W]],
}

impl<T: Real, const W: usize> WithSimd for Solve<'_, T, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        if let SymbolicCholeskyRaw::Simplicial(columns) = self.factor.symbolic.raw() {
            let Factor {
                values,
                reciprocals,
                ..
            } = self.factor;
            solve_columns(
                columns.col_ptr(),
                columns.row_idx(),
                (values, reciprocals),
                self.x,
            );
            return;
        }
        if W == 1 || W >= DENSE_LANES {
            self.factor.solve_panels(self.x);
            return;
        }
        for lane in 0..W {
            let mut own: Vec<[T; 1]> = self.x.iter().map(|x| [x[lane]]).collect();
            self.factor.solve_panels(&mut own);
            self.x
                .iter_mut()
                .zip(own)
                .for_each(|(x, [value])| x[lane] = value);
        }
    }
}

/// Solves K x = x in place by a factor in single columns, by the starts of the columns, their rows, their values and the
/// reciprocals of their pivots.
#[inline(always)]
fn solve_columns<T: Real, const W: usize>(
    starts: &[usize],
    rows: &[usize],
    (values, reciprocals): (&[T], &[T]),
    x: &mut [[T; W]],
) {
    for (k, ends) in starts.windows(2).enumerate() {
        let (rows, values) = (&rows[ends[0] + 1..ends[1]], &values[ends[0]..ends[1]]);
        let value = x[k].map(|value| value * reciprocals[k]);
        x[k] = value;
        for (&row, l) in rows.iter().zip(&values[1..]) {
            subtract_scaled(&mut x[row], *l, &value);
        }
    }
    for (k, ends) in starts.windows(2).enumerate().rev() {
        let (rows, values) = (&rows[ends[0] + 1..ends[1]], &values[ends[0]..ends[1]]);
        let mut value = x[k];
        for (&row, l) in rows.iter().zip(&values[1..]) {
            subtract_scaled(&mut value, *l, &x[row]);
        }
        x[k] = value.map(|value| value * reciprocals[k]);
    }
}

/// A matrix ready to be factored.
pub(crate) struct Analysis<'a, T> {
    pub pattern: SymbolicSparseColMatRef<'a, usize>,
    pub symbolic: SymbolicCholesky<usize>,
    /// Zeros, as many as the factor has entries.
    pub values: Vec<T>,
}

/// Symbolic analysis of the matrix whose upper triangle is given, in the order given.
pub(crate) fn analyse<'a, T: Real>(
    upper: &'a CsMat<T>,
    params: CholeskySymbolicParams<'_>,
) -> Result<Analysis<'a, T>, FactorError> {
    let n = upper.cols();
    let storage = upper.indptr().into_raw_storage();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, storage, None, upper.indices());
    let symbolic =
        factorize_symbolic_cholesky(pattern, Side::Upper, SymmetricOrdering::Identity, params)
            .map_err(|_| FactorError::TooLarge(0))?;
    // The size is known before a number is allocated.
    let size = symbolic.len_val() as u64;
    if size.saturating_mul(size_of::<T>() as u64) > MEMORY_LIMIT {
        return Err(FactorError::TooLarge(size));
    }
    let mut values = Vec::new();
    values
        .try_reserve_exact(symbolic.len_val())
        .map_err(|_| FactorError::TooLarge(size))?;
    values.resize(symbolic.len_val(), T::zero());
    Ok(Analysis {
        pattern,
        symbolic,
        values,
    })
}

/// Calls `each` with row, column and value of every entry of a factor.
pub(crate) fn for_each_entry<T: Copy>(
    symbolic: &SymbolicCholesky<usize>,
    values: &[T],
    mut each: impl FnMut(usize, usize, T),
) {
    let panels = match symbolic.raw() {
        SymbolicCholeskyRaw::Simplicial(_) => symbolic.nrows(),
        SymbolicCholeskyRaw::Supernodal(s) => s.n_supernodes(),
    };
    for k in 0..panels {
        let panel = Panel::of(symbolic, values, k);
        let height = panel.width + panel.below.len();
        for j in 0..panel.width {
            for i in j..height {
                let row = if i < panel.width {
                    panel.start + i
                } else {
                    panel.below[i - panel.width]
                };
                each(row, panel.start + j, panel.values[j * height + i]);
            }
        }
    }
}

/// target -= l * value, in K lanes.
#[inline(always)]
fn subtract_scaled<T: Real, const K: usize>(target: &mut [T; K], l: T, value: &[T; K]) {
    for (target, value) in target.iter_mut().zip(value) {
        *target -= l * *value;
    }
}

impl<'a, T> Panel<'a, T> {
    fn of(symbolic: &'a SymbolicCholesky<usize>, values: &'a [T], k: usize) -> Panel<'a, T> {
        match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(s) => {
                let (from, to) = (s.col_ptr()[k], s.col_ptr()[k + 1]);
                Panel {
                    start: k,
                    width: 1,
                    below: &s.row_idx()[from + 1..to],
                    values: &values[from..to],
                }
            }
            SymbolicCholeskyRaw::Supernodal(s) => {
                let (start, end) = (s.supernode_begin()[k], s.supernode_end()[k]);
                let values = &values[s.col_ptr_for_val()[k]..s.col_ptr_for_val()[k + 1]];
                Panel {
                    start,
                    width: end - start,
                    below: s.supernode(k).pattern(),
                    values,
                }
            }
        }
    }
}

impl<'a, T: Real> Panel<'a, T> {
    /// Number of its rows.
    fn height(&self) -> usize {
        self.width + self.below.len()
    }

    /// The entry of one of its rows and columns, of the lower triangle.
    #[inline]
    pub fn entry(&self, row: usize, column: usize) -> T {
        self.values[column * self.height() + row]
    }

    /// The triangle, with anything above its diagonal.
    pub fn triangle(&self) -> MatRef<'a, T> {
        MatRef::from_column_major_slice_with_stride(
            self.values,
            self.width,
            self.width,
            self.height(),
        )
    }

    /// The rows of `below`; there must be some.
    pub fn lower(&self) -> MatRef<'a, T> {
        let (rows, values) = (self.below.len(), &self.values[self.width..]);
        MatRef::from_column_major_slice_with_stride(values, rows, self.width, self.height())
    }

    /// One panel of x := L^-1 x for K vectors: divides by the pivots, subtracts the panel from the rows
    /// below it, in a dense product if the panel is wide enough.
    #[inline(always)]
    fn forward<const K: usize>(&self, x: &mut [[T; K]], scratch: &mut Vec<[T; K]>) {
        let height = self.height();
        let dense = T::NATIVE && K > 1 && self.width >= DENSE_WIDTH;
        // What the columns subtract from a row below is added up before it is scattered.
        scratch.clear();
        scratch.resize(self.below.len(), [T::zero(); K]);
        for j in 0..self.width {
            let column = &self.values[j * height + j..(j + 1) * height];
            let (pivot, rest) = column.split_at(1);
            let value = x[self.start + j].map(|value| value / pivot[0]);
            x[self.start + j] = value;
            // Columns before the first entry of a load are zero: they change nothing.
            if value == [T::zero(); K] {
                continue;
            }
            let (triangle, below) = rest.split_at(self.width - 1 - j);
            for (l, target) in triangle.iter().zip(&mut x[self.start + j + 1..]) {
                subtract_scaled(target, *l, &value);
            }
            if dense {
                continue;
            }
            for (l, sum) in below.iter().zip(scratch.iter_mut()) {
                sum.iter_mut()
                    .zip(&value)
                    .for_each(|(sum, value)| *sum += *l * *value);
            }
        }
        if dense && !self.below.is_empty() {
            // (L21 x)^T = x^T L21^T: a row of x is a column of its transpose, in one piece.
            let own = x[self.start..self.start + self.width].as_flattened();
            let product = MatMut::from_column_major_slice_mut(
                scratch.as_flattened_mut(),
                K,
                self.below.len(),
            );
            let own = MatRef::from_column_major_slice(own, K, self.width);
            multiply(
                product,
                Accum::Replace,
                own,
                self.lower().transpose(),
                T::one(),
            );
        }
        for (&row, sum) in self.below.iter().zip(scratch.iter()) {
            subtract_scaled(&mut x[row], T::one(), sum);
        }
    }

    /// One panel of x := L^-T x for K vectors.
    #[inline(always)]
    fn backward<const K: usize>(&self, x: &mut [[T; K]], scratch: &mut Vec<[T; K]>) {
        let height = self.height();
        scratch.clear();
        scratch.extend(self.below.iter().map(|&row| x[row]));
        for j in (0..self.width).rev() {
            let column = &self.values[j * height + j..(j + 1) * height];
            let (pivot, rest) = column.split_at(1);
            let (triangle, below) = rest.split_at(self.width - 1 - j);
            let own = &x[self.start + j..self.start + self.width];
            let mut value = own[0];
            subtract_products(&mut value, triangle, &own[1..]);
            subtract_products(&mut value, below, scratch);
            x[self.start + j] = value.map(|value| value / pivot[0]);
        }
    }
}

/// value -= sum of l_i x_i, in K lanes; the products of one lane are added up in eight parts.
#[inline(always)]
fn subtract_products<T: Real, const K: usize>(value: &mut [T; K], l: &[T], x: &[[T; K]]) {
    if K > 1 {
        l.iter()
            .zip(x)
            .for_each(|(l, x)| subtract_scaled(value, *l, x));
        return;
    }
    let ((parts, rest), (others, last)) = (l.as_chunks::<8>(), x.as_chunks::<8>());
    let mut sums = [T::zero(); 8];
    for (part, other) in parts.iter().zip(others) {
        for (sum, (l, x)) in sums.iter_mut().zip(part.iter().zip(other)) {
            *sum += *l * x[0];
        }
    }
    if !parts.is_empty() {
        sums.iter().for_each(|sum| value[0] -= *sum);
    }
    rest.iter()
        .zip(last)
        .for_each(|(l, x)| value[0] -= *l * x[0]);
}
