//! Sparse Cholesky factor, with solves that follow the elimination tree.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::linalg::matmul::matmul;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Accum, MatMut, MatRef, Par, Side};
use sprs::CsMat;

use crate::memory::MEMORY;
use crate::real::Real;

/// Loads that go through single columns together.
const ABREAST: usize = 8;
/// Loads that go through panels together.
const CROWD: usize = 32;
/// Width from which a panel is worth a dense product.
const WIDE: usize = 4;

/// Why a matrix has no factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Refusal {
    /// A pivot that is not positive.
    Indefinite,
    /// Too large for memory or indices; entries, where they are known.
    Size(u64),
}

/// L with L L^T = K, K symmetric positive definite, in panels of adjoining columns.
#[derive(Debug)]
pub(crate) struct Factor<T: Real = f64> {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<T>,
    /// Panel of each column.
    owner: Vec<usize>,
    panels: usize,
}

/// Columns `start..start + width` of L: `values` holds a dense column-major block whose first `width`
/// rows are the triangle and whose others are the rows `below`.
struct Panel<'a, T> {
    start: usize,
    width: usize,
    below: &'a [usize],
    values: &'a [T],
}

/// w = L^-1 p for a sparse p: values on the panels between p and the root, ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tail {
    /// Where each run of values begins.
    pub starts: Vec<usize>,
    /// How long it is.
    pub widths: Vec<usize>,
    /// The runs, one after the other.
    pub values: Vec<f64>,
}

impl<T: Real> Factor<T> {
    /// Factors the matrix whose upper triangle is given, in the order given.
    pub fn new(upper: &CsMat<T>) -> Result<Factor<T>, Refusal> {
        let n = upper.cols();
        let mut params = CholeskySymbolicParams::default();
        if !T::PANELS {
            params.supernodal_flop_ratio_threshold = SupernodalThreshold::FORCE_SIMPLICIAL;
        }
        let Analysis { pattern, symbolic, mut values } = analyse(upper, params)?;
        let request = symbolic.factorize_numeric_llt_scratch::<T>(Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(request).map_err(|_| Refusal::Size(0))?;
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
            .map_err(|_| Refusal::Indefinite)?;
        let (owner, panels) = match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(_) => ((0..n).collect(), n),
            SymbolicCholeskyRaw::Supernodal(s) => {
                let spans = s.supernode_begin().iter().zip(s.supernode_end());
                let owner = spans.enumerate().flat_map(|(k, (a, b))| std::iter::repeat_n(k, b - a)).collect();
                (owner, s.n_supernodes())
            }
        };
        Ok(Factor { symbolic, values, owner, panels })
    }

    pub fn len(&self) -> usize {
        self.owner.len()
    }

    fn panel(&self, k: usize) -> Panel<'_, T> {
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

    /// Panels from those of `columns` to the root, ascending.
    fn path(&self, columns: impl Iterator<Item = usize>, seen: &mut [bool]) -> Vec<usize> {
        let mut path = Vec::new();
        for column in columns {
            let mut k = self.owner[column];
            while !seen[k] {
                seen[k] = true;
                path.push(k);
                match self.panel(k).below.iter().min() {
                    Some(&next) => k = self.owner[next],
                    None => break,
                }
            }
        }
        path.iter().for_each(|&k| seen[k] = false);
        path.sort_unstable();
        path
    }

    /// L^-1 p of every load p, following the elimination tree from the entries of p to its root; several loads at
    /// a time, so that each entry of L is read once for all of them.
    ///
    /// # Source
    /// Gilbert and Peierls (1988), SIAM J. Sci. Stat. Comput. 9; Davis, Direct Methods for Sparse Linear
    /// Systems (2006), chapter 3.
    pub fn forward(&self, loads: &[Vec<(usize, f64)>]) -> Vec<Tail> {
        if loads.len() < ABREAST {
            self.in_ranks::<1>(loads)
        } else if self.panels == self.len() || loads.len() < CROWD {
            self.in_ranks::<ABREAST>(loads)
        } else {
            self.in_ranks::<CROWD>(loads)
        }
    }

    fn in_ranks<const K: usize>(&self, loads: &[Vec<(usize, f64)>]) -> Vec<Tail> {
        let mut tails = Vec::with_capacity(loads.len());
        let mut seen = vec![false; self.panels];
        let mut x = vec![[T::zero(); K]; self.len()];
        let mut spare = Vec::new();
        for some in loads.chunks(K) {
            self.abreast(some, &mut x, &mut seen, &mut spare, &mut tails);
        }
        tails
    }

    /// The same for at most K loads; `x` is zero and `seen` false, before and after.
    fn abreast<const K: usize>(
        &self,
        loads: &[Vec<(usize, f64)>],
        x: &mut [[T; K]],
        seen: &mut [bool],
        spare: &mut Vec<[T; K]>,
        tails: &mut Vec<Tail>,
    ) {
        for (lane, load) in loads.iter().enumerate() {
            load.iter().for_each(|&(row, value)| x[row][lane] += T::from(value));
        }
        let path = self.path(loads.iter().flatten().map(|&(row, _)| row), seen);
        for &k in &path {
            self.panel(k).forward(x, spare);
        }
        for (lane, load) in loads.iter().enumerate() {
            let own = if K == 1 { &path } else { &self.path(load.iter().map(|&(row, _)| row), seen) };
            let mut tail = Tail::default();
            for &k in own {
                let panel = self.panel(k);
                match (tail.starts.last(), tail.widths.last_mut()) {
                    (Some(&start), Some(width)) if start + *width == panel.start => *width += panel.width,
                    _ => {
                        tail.starts.push(panel.start);
                        tail.widths.push(panel.width);
                    }
                }
                let values = &x[panel.start..panel.start + panel.width];
                tail.values.extend(values.iter().map(|value| value[lane].double()));
            }
            tails.push(tail);
        }
        for &k in &path {
            let panel = self.panel(k);
            x[panel.start..panel.start + panel.width].fill([T::zero(); K]);
        }
    }

    /// Solves K x = x in place.
    pub fn solve(&self, x: &mut [T]) {
        let (alone, _) = x.as_chunks_mut::<1>();
        let mut spare = Vec::new();
        for k in 0..self.panels {
            self.panel(k).forward(alone, &mut spare);
        }
        for k in (0..self.panels).rev() {
            self.panel(k).backward(x);
        }
    }

    /// Largest row sum of |L| |L^T|, and the most entries of a row of L.
    pub fn growth(&self) -> (f64, usize) {
        let n = self.len();
        let mut columns = vec![0.0_f64; n];
        entries(&self.symbolic, &self.values, |_, column, value| columns[column] += value.double().abs());
        let (mut rows, mut lengths) = (vec![0.0_f64; n], vec![0_usize; n]);
        entries(&self.symbolic, &self.values, |row, column, value| {
            rows[row] += value.double().abs() * columns[column];
            lengths[row] += 1;
        });
        (rows.into_iter().fold(0.0, f64::max), lengths.into_iter().max().unwrap_or(0))
    }
}

/// A matrix ready to be factored.
pub(crate) struct Analysis<'a, T> {
    pub pattern: SymbolicSparseColMatRef<'a, usize>,
    pub symbolic: SymbolicCholesky<usize>,
    /// Room for the factor.
    pub values: Vec<T>,
}

/// Analyses the matrix whose upper triangle is given, in the order given.
pub(crate) fn analyse<'a, T: Real>(
    upper: &'a CsMat<T>,
    params: CholeskySymbolicParams<'_>,
) -> Result<Analysis<'a, T>, Refusal> {
    let n = upper.cols();
    let storage = upper.indptr().into_raw_storage();
    let pattern = SymbolicSparseColMatRef::new_checked(n, n, storage, None, upper.indices());
    let symbolic = factorize_symbolic_cholesky(pattern, Side::Upper, SymmetricOrdering::Identity, params)
        .map_err(|_| Refusal::Size(0))?;
    let size = symbolic.len_val() as u64;
    if size.saturating_mul(size_of::<T>() as u64) > MEMORY {
        return Err(Refusal::Size(size));
    }
    let mut values = Vec::new();
    values.try_reserve_exact(symbolic.len_val()).map_err(|_| Refusal::Size(size))?;
    values.resize(symbolic.len_val(), T::zero());
    Ok(Analysis { pattern, symbolic, values })
}

/// Row, column and value of every entry of a factor.
pub(crate) fn entries<T: Copy>(
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
                let row = if i < panel.width { panel.start + i } else { panel.below[i - panel.width] };
                each(row, panel.start + j, panel.values[j * height + i]);
            }
        }
    }
}

/// Products of `tail` with each of `others`, over the scratch `x`, zero before and after.
pub(crate) fn dots<'a>(
    x: &mut [f64],
    tail: &Tail,
    others: impl Iterator<Item = &'a Tail>,
    mut each: impl FnMut(f64),
) {
    tail.runs().for_each(|(start, run)| x[start..start + run.len()].copy_from_slice(run));
    for other in others {
        let mut sum = 0.0;
        for (start, run) in other.runs() {
            sum += dot(run, &x[start..start + run.len()]);
        }
        each(sum);
    }
    tail.runs().for_each(|(start, run)| x[start..start + run.len()].fill(0.0));
}

/// Sum of products in four lanes, in an order that depends on the length alone.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (fours, rest) = a.as_chunks::<4>();
    let (others, last) = b.as_chunks::<4>();
    let mut lanes = [0.0; 4];
    for (p, q) in fours.iter().zip(others) {
        for (lane, (x, y)) in lanes.iter_mut().zip(p.iter().zip(q)) {
            *lane += x * y;
        }
    }
    let tail: f64 = rest.iter().zip(last).map(|(x, y)| x * y).sum();
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]) + tail
}

impl Tail {
    fn runs(&self) -> impl Iterator<Item = (usize, &[f64])> {
        let mut from = 0;
        self.starts.iter().zip(&self.widths).map(move |(&start, &width)| {
            let run = &self.values[from..from + width];
            from += width;
            (start, run)
        })
    }
}

/// target - l value.
#[inline]
fn lessen<T: Real, const K: usize>(target: &mut [T; K], l: T, value: &[T; K]) {
    for (target, value) in target.iter_mut().zip(value) {
        *target -= l * *value;
    }
}

impl<'a, T> Panel<'a, T> {
    fn of(symbolic: &'a SymbolicCholesky<usize>, values: &'a [T], k: usize) -> Panel<'a, T> {
        match symbolic.raw() {
            SymbolicCholeskyRaw::Simplicial(s) => {
                let (from, to) = (s.col_ptr()[k], s.col_ptr()[k + 1]);
                Panel { start: k, width: 1, below: &s.row_idx()[from + 1..to], values: &values[from..to] }
            }
            SymbolicCholeskyRaw::Supernodal(s) => {
                let (start, end) = (s.supernode_begin()[k], s.supernode_end()[k]);
                let values = &values[s.col_ptr_for_val()[k]..s.col_ptr_for_val()[k + 1]];
                Panel { start, width: end - start, below: s.supernode(k).pattern(), values }
            }
        }
    }
}

impl<T: Real> Panel<'_, T> {
    /// Eliminates the panel's rows from x; `spare` is scratch.
    fn forward<const K: usize>(&self, x: &mut [[T; K]], spare: &mut Vec<[T; K]>) {
        let height = self.width + self.below.len();
        let dense = T::PANELS && K > 1 && self.width >= WIDE;
        for j in 0..self.width {
            let column = &self.values[j * height + j..(j + 1) * height];
            let (pivot, rest) = column.split_at(1);
            let value = x[self.start + j].map(|value| value / pivot[0]);
            x[self.start + j] = value;
            if value == [T::zero(); K] {
                continue;
            }
            let (triangle, below) = rest.split_at(self.width - 1 - j);
            for (l, target) in triangle.iter().zip(&mut x[self.start + j + 1..]) {
                lessen(target, *l, &value);
            }
            if !dense {
                for (l, &row) in below.iter().zip(self.below) {
                    lessen(&mut x[row], *l, &value);
                }
            }
        }
        if dense && !self.below.is_empty() {
            // (L21 x)^T = x^T L21^T: a row of x is a column of its transpose, in one piece.
            spare.clear();
            spare.resize(self.below.len(), [T::zero(); K]);
            let own = x[self.start..self.start + self.width].as_flattened();
            let lower = MatRef::from_column_major_slice_with_stride(
                &self.values[self.width..],
                self.below.len(),
                self.width,
                height,
            );
            let product = MatMut::from_column_major_slice_mut(spare.as_flattened_mut(), K, self.below.len());
            let own = MatRef::from_column_major_slice(own, K, self.width);
            matmul(product, Accum::Replace, own, lower.transpose(), T::one(), Par::Seq);
            for (&row, product) in self.below.iter().zip(spare.iter()) {
                lessen(&mut x[row], T::one(), product);
            }
        }
    }

    fn backward(&self, x: &mut [T]) {
        let height = self.width + self.below.len();
        for j in (0..self.width).rev() {
            let column = &self.values[j * height + j..(j + 1) * height];
            let (pivot, rest) = column.split_at(1);
            let (triangle, below) = rest.split_at(self.width - 1 - j);
            let mut value = x[self.start + j];
            for (l, &known) in triangle.iter().zip(&x[self.start + j + 1..]) {
                value -= *l * known;
            }
            for (l, &row) in below.iter().zip(self.below) {
                value -= *l * x[row];
            }
            x[self.start + j] = value / pivot[0];
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use sprs::TriMat;

    use super::*;
    use crate::real::Extended;

    /// Positive definite matrix with the given half bandwidth, and its upper triangle.
    fn banded(n: usize, width: usize) -> (DMatrix<f64>, CsMat<f64>) {
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0 * width as f64 + 0.1 * (i % 7) as f64,
            gap if gap <= width => -1.0 + 0.01 * ((i * j) % 13) as f64,
            _ => 0.0,
        };
        let dense = DMatrix::from_fn(n, n, entry);
        let mut upper = TriMat::new((n, n));
        for j in 0..n {
            (j.saturating_sub(width)..=j).for_each(|i| upper.add_triplet(i, j, dense[(i, j)]));
        }
        (dense, upper.to_csc())
    }

    #[test]
    fn solves_agree_with_a_dense_factor_in_single_columns_and_in_panels() {
        agree(|upper| upper.clone());
    }

    #[test]
    fn extended_solves_agree_with_a_dense_factor() {
        agree(|upper| upper.map(|x: &f64| Extended::from(*x)));
    }

    fn agree<T: Real>(precision: impl Fn(&CsMat<f64>) -> CsMat<T>) {
        for (n, width, panels) in [(40, 1, false), (300, 299, true)] {
            let (dense, upper) = banded(n, width);
            let factor = Factor::new(&precision(&upper)).expect("positive definite");
            assert_eq!(factor.panels < n, panels && T::PANELS, "another kind of factor than meant");
            let inverse = dense.clone().try_inverse().expect("positive definite");
            let scale = inverse.amax();
            let mut scratch = vec![0.0; n];
            let loads = [vec![(3, 1.0)], vec![(n - 1, 1.0), (7, -2.0)]];
            let tails = factor.forward(&loads);
            let many: Vec<_> = (0..20).flat_map(|_| loads.clone()).collect();
            for (a, b) in factor.forward(&many).iter().zip(tails.iter().cycle()) {
                let size = b.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
                assert!(a.values.iter().zip(&b.values).all(|(a, b)| (a - b).abs() < 1e-14 * size));
            }
            let full = loads.each_ref().map(|load| {
                let mut x = DVector::zeros(n);
                load.iter().for_each(|&(k, value)| x[k] = value);
                x
            });
            for i in 0..2 {
                let mut products = Vec::new();
                dots(&mut scratch, &tails[i], tails.iter(), |product| products.push(product));
                for j in 0..2 {
                    let exact = (full[i].transpose() * &inverse * &full[j])[0];
                    assert!((products[j] - exact).abs() < 1e-13 * scale);
                }
                let mut x: Vec<T> = full[i].iter().map(|&x| T::from(x)).collect();
                factor.solve(&mut x);
                let x = DVector::from_iterator(n, x.into_iter().map(Real::double));
                assert!((x - &inverse * &full[i]).amax() < 1e-13 * scale);
            }
        }
    }

    #[test]
    fn growth_is_the_norm_of_the_products_and_pivots_the_diagonal() {
        let (dense, upper) = banded(300, 299);
        let factor = Factor::new(&upper).expect("positive definite");
        let l = dense.cholesky().expect("positive definite").l();
        let bound = (l.abs() * l.abs().transpose()).column_sum().amax();
        let (growth, longest) = factor.growth();
        assert!((growth / bound - 1.0).abs() < 1e-12);
        assert_eq!(longest, 300);
        let least = l.diagonal().min().powi(2);
        assert!((factor.least_pivot() / least - 1.0).abs() < 1e-12);
    }

    #[test]
    fn indefinite_matrices_are_refused() {
        let (_, upper) = banded(10, 1);
        let shifted = &upper + &CsMat::eye_csc(10).map(|one: &f64| -5.0 * one);
        assert_eq!(Factor::new(&shifted).err(), Some(Refusal::Indefinite));
    }
}
