//! Products p_i^T K^-1 p_j of sparse loads by their forward solves w = L^-1 p.
//!
//! A load is not zero on the paths of the elimination tree from its entries to the root. The solves of all loads go up
//! the tree together: a panel holds the loads whose paths it is on, side by side, in one dense block. Solves, updates of
//! the panels above and products are dense products of such blocks, which run with the widest vector registers that the
//! processor has.

use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};

use crate::assembly::Real;
use crate::factor::cholesky::{Factor, Panel};
use crate::factor::product::{clear_registers, multiply};

/// Width of a panel from which its products are dense.
const DENSE_WIDTH: usize = 4;
/// Loads of a panel from which its products are dense.
const DENSE_LOADS: usize = 4;
/// Numbers of a block of solves from which products of its columns are dense.
const DENSE_NUMBERS: usize = 48;
/// Width of a panel from which its triangle is solved in blocks.
const BLOCKED_WIDTH: usize = 12;
/// Most unknowns whose products are added up at once: it bounds the roundings of a sum.
const SLAB: usize = 64;
/// Most loads in a column of blocks of the products.
const STRIP: usize = 64;

/// A sparse load: unknown and value of each entry.
pub(crate) type SparseLoad = Vec<(usize, f64)>;

/// Products of all pairs of some loads.
#[derive(Clone, Debug)]
pub(crate) struct Gram {
    /// p_i^T K^-1 p_j, symmetric to the last bit.
    pub value: DMatrix<f64>,
    /// Most roundings that a term of a product takes part in.
    pub roundings: usize,
}

impl<T: Real> Factor<T> {
    /// Products w_i . w_j of the forward solves w = L^-1 p, rounded to doubles, of some loads.
    ///
    /// # Source
    /// Gilbert and Peierls (1988), SIAM J. Sci. Stat. Comput. 9 (paths); Liu (1992), SIAM Review 34 (dense blocks that
    /// go up the elimination tree).
    pub fn gram(&self, loads: &[SparseLoad]) -> Gram {
        Arch::new().dispatch(Products {
            factor: self,
            loads,
        })
    }
}

/// Products of loads, compiled for several sets of vector registers.
struct Products<'a, T: Real> {
    factor: &'a Factor<T>,
    loads: &'a [SparseLoad],
}

impl<T: Real> WithSimd for Products<'_, T> {
    type Output = Gram;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Gram {
        let paths = Paths::new(self.factor, self.loads);
        let mut solved = Solved::new(self.factor, paths, self.loads);
        solved.solve();
        solved.products(self.loads.len())
    }
}

/// The loads whose paths each panel is on.
struct Paths {
    /// First of its loads, by panel; the number of all at the end.
    starts: Vec<usize>,
    /// Loads, ascending for each panel.
    loads: Vec<usize>,
    /// Next panel on the way to the root, by panel; itself for a root.
    parents: Vec<usize>,
}

impl Paths {
    fn new<T: Real>(factor: &Factor<T>, loads: &[SparseLoad]) -> Paths {
        let panels = factor.panels;
        // The parent of a panel in the elimination tree is that of its first row below the diagonal.
        let parent = |k: usize| {
            factor
                .panel(k)
                .below
                .iter()
                .min()
                .map_or(k, |&row| factor.panel_of[row])
        };
        let parents: Vec<usize> = (0..panels).map(parent).collect();
        let mut last = vec![usize::MAX; panels];
        let (mut path, mut ends) = (Vec::new(), Vec::with_capacity(loads.len()));
        let mut starts = vec![0; panels + 1];
        for (index, load) in loads.iter().enumerate() {
            for &(row, _) in load {
                let mut k = factor.panel_of[row];
                while last[k] != index {
                    last[k] = index;
                    path.push(k);
                    starts[k + 1] += 1;
                    k = parents[k];
                }
            }
            ends.push(path.len());
        }
        (0..panels).for_each(|k| starts[k + 1] += starts[k]);
        let mut next = starts.clone();
        let mut by_panel = vec![0; path.len()];
        let mut from = 0;
        for (index, &end) in ends.iter().enumerate() {
            for &k in &path[from..end] {
                by_panel[next[k]] = index;
                next[k] += 1;
            }
            from = end;
        }
        Paths {
            starts,
            loads: by_panel,
            parents,
        }
    }

    fn of(&self, panel: usize) -> &[usize] {
        &self.loads[self.starts[panel]..self.starts[panel + 1]]
    }

    fn count(&self, panel: usize) -> usize {
        self.starts[panel + 1] - self.starts[panel]
    }

    /// Where the loads of a panel are among those of a panel above it.
    fn within(&self, panel: usize, above: usize) -> Places {
        let (own, all) = (self.of(panel), self.of(above));
        let first = all.partition_point(|load| *load < own[0]);
        if all.get(first + own.len() - 1) == Some(&own[own.len() - 1]) {
            return Places::Adjoining(first);
        }
        let mut at = first;
        let place = |load: &usize| {
            at += all[at..]
                .iter()
                .position(|other| other == load)
                .expect("paths end at the root");
            at
        };
        Places::Apart(own.iter().map(place).collect())
    }
}

/// Places of some loads in a list that has them all.
enum Places {
    Adjoining(usize),
    Apart(Vec<usize>),
}

/// Forward solves: a block for each panel, with a column of numbers for each unknown and a row for each of the loads.
struct Solved<'a, T: Real> {
    factor: &'a Factor<T>,
    paths: Paths,
    /// First number of the block of each panel; their sum at the end.
    offsets: Vec<usize>,
    values: Vec<T>,
}

impl<'a, T: Real> Solved<'a, T> {
    /// The blocks of the loads before they are solved.
    #[inline(always)]
    fn new(factor: &'a Factor<T>, paths: Paths, loads: &[SparseLoad]) -> Solved<'a, T> {
        let mut offsets = Vec::with_capacity(factor.panels + 1);
        let mut size = 0;
        for k in 0..factor.panels {
            offsets.push(size);
            size += factor.panel(k).width * paths.count(k);
        }
        offsets.push(size);
        let mut values = vec![T::zero(); size];
        for (index, load) in loads.iter().enumerate() {
            for &(row, value) in load {
                let k = factor.panel_of[row];
                let place = paths.of(k).partition_point(|other| *other < index);
                let column = row - factor.panel(k).start;
                values[offsets[k] + column * paths.count(k) + place] += T::from(value);
            }
        }
        Solved {
            factor,
            paths,
            offsets,
            values,
        }
    }

    #[inline(always)]
    fn solve(&mut self) {
        let mut scratch = Vec::new();
        for k in 0..self.factor.panels {
            let count = self.paths.count(k);
            if count == 0 {
                continue;
            }
            let panel = self.factor.panel(k);
            let (own, above) = self.values[self.offsets[k]..].split_at_mut(panel.width * count);
            solve_triangle(&panel, own, count);
            let dense = T::NATIVE && panel.width >= DENSE_WIDTH && count >= DENSE_LOADS;
            if dense && !panel.below.is_empty() {
                scratch.clear();
                scratch.resize(panel.below.len() * count, T::zero());
                let product =
                    MatMut::from_column_major_slice_mut(&mut scratch, count, panel.below.len());
                let own = MatRef::from_column_major_slice(own, count, panel.width);
                multiply(
                    product,
                    Accum::Replace,
                    own,
                    panel.lower().transpose(),
                    T::one(),
                );
            }
            let behind = self.offsets[k + 1];
            for_each_run(self.factor, panel.below, |above_panel, rows| {
                let places = self.paths.within(k, above_panel);
                let (start, all) = (
                    self.factor.panel(above_panel).start,
                    self.paths.count(above_panel),
                );
                for row in rows {
                    let from =
                        self.offsets[above_panel] - behind + (panel.below[row] - start) * all;
                    let target = &mut above[from..from + all];
                    if dense {
                        subtract(
                            target,
                            &places,
                            T::one(),
                            &scratch[row * count..(row + 1) * count],
                        );
                        continue;
                    }
                    for (j, own) in own.chunks_exact(count).enumerate() {
                        subtract(target, &places, panel.entry(panel.width + row, j), own);
                    }
                }
            });
        }
    }

    /// Products of all pairs of `loads` loads.
    #[inline(always)]
    fn products(&self, loads: usize) -> Gram {
        let mut value = DMatrix::zeros(loads, loads);
        let slabs = self.slabs();
        let (mut wide, mut strip) = (Vec::new(), Vec::new());
        for slab in &slabs {
            let own = self.paths.of(slab.panel);
            let count = own.len();
            wide.clear();
            wide.extend(
                self.values[slab.from..slab.from + slab.width * count]
                    .iter()
                    .map(|w| w.double()),
            );
            if count < DENSE_LOADS || count * slab.width < DENSE_NUMBERS {
                add_products(value.as_mut_slice(), loads, own, &wide);
                continue;
            }
            let block = MatRef::from_column_major_slice(&wide, count, slab.width);
            let adjoin = own[count - 1] - own[0] == count - 1;
            for from in (0..count).step_by(STRIP) {
                let (rows, columns) = (count - from, STRIP.min(count - from));
                let [a, b] = [block.subrows(from, rows), block.subrows(from, columns)];
                if adjoin {
                    let first = (own[from]) * loads + own[from];
                    let target = &mut value.as_mut_slice()[first..];
                    let target = MatMut::from_column_major_slice_with_stride_mut(
                        target, rows, columns, loads,
                    );
                    multiply(target, Accum::Add, a, b.transpose(), 1.0);
                    continue;
                }
                strip.clear();
                strip.resize(rows * columns, 0.0);
                let target = MatMut::from_column_major_slice_mut(&mut strip, rows, columns);
                multiply(target, Accum::Replace, a, b.transpose(), 1.0);
                for (column, products) in strip.chunks_exact(rows).enumerate() {
                    let target = &mut value.as_mut_slice()[own[from + column] * loads..][..loads];
                    for (&row, product) in own[from..].iter().zip(products) {
                        target[row] += product;
                    }
                }
            }
        }
        for j in 0..loads {
            for i in 0..j {
                value[(i, j)] = value[(j, i)];
            }
        }
        Gram {
            value,
            roundings: self.roundings(&slabs),
        }
    }

    /// Adjoining unknowns on the paths of the same loads, at most [`SLAB`] together, ascending.
    fn slabs(&self) -> Vec<Slab> {
        let mut slabs: Vec<Slab> = Vec::new();
        let mut before = None;
        for panel in (0..self.factor.panels).filter(|&k| self.paths.count(k) > 0) {
            let (count, width) = (self.paths.count(panel), self.factor.panel(panel).width);
            // The loads of a panel are among those of the next one on their path: as many are the same.
            let continues = before.is_some_and(|k| {
                k + 1 == panel && self.paths.parents[k] == panel && self.paths.count(k) == count
            });
            before = Some(panel);
            let mut done = 0;
            if continues && let Some(slab) = slabs.last_mut() {
                done = width.min(SLAB - slab.width);
                slab.width += done;
                slab.panel = panel;
            }
            while done < width {
                let part = SLAB.min(width - done);
                slabs.push(Slab {
                    first: panel,
                    panel,
                    width: part,
                    from: self.offsets[panel] + done * count,
                });
                done += part;
            }
        }
        slabs
    }

    /// A term of a product is rounded with those of its slab, and with each slab after it on the way to the root.
    fn roundings(&self, slabs: &[Slab]) -> usize {
        let mut after = vec![0; self.factor.panels];
        let (mut most, mut widest) = (0, 0);
        for slab in slabs.iter().rev() {
            let parent = self.paths.parents[slab.panel];
            let own = after[slab.panel].max(after[parent]) + 1;
            after[slab.first..=slab.panel].fill(own);
            (most, widest) = (most.max(own), widest.max(slab.width));
        }
        most + widest
    }
}

/// Unknowns whose products are added up at once.
struct Slab {
    /// First panel that it is of.
    first: usize,
    /// Last panel that it is of.
    panel: usize,
    width: usize,
    /// First of its numbers.
    from: usize,
}

/// Calls `each` with every panel that some rows belong to, and the range of these rows, which adjoin.
#[inline(always)]
fn for_each_run<T: Real>(
    factor: &Factor<T>,
    rows: &[usize],
    mut each: impl FnMut(usize, std::ops::Range<usize>),
) {
    let mut from = 0;
    while from < rows.len() {
        let panel = factor.panel_of[rows[from]];
        let count = rows[from..]
            .iter()
            .take_while(|&&row| factor.panel_of[row] == panel)
            .count();
        each(panel, from..from + count);
        from += count;
    }
}

/// x := L11^-1 x for the `count` loads of a panel, whose numbers for an unknown adjoin.
#[inline(always)]
fn solve_triangle<T: Real>(panel: &Panel<'_, T>, x: &mut [T], count: usize) {
    if T::NATIVE && panel.width >= BLOCKED_WIDTH && count >= DENSE_LOADS {
        let x = MatMut::from_row_major_slice_mut(x, panel.width, count);
        solve_lower_triangular_in_place(panel.triangle(), x, Par::Seq);
        clear_registers();
        return;
    }
    for j in 0..panel.width {
        let (before, rest) = x.split_at_mut((j + 1) * count);
        let own = &mut before[j * count..];
        // Quotients of double-doubles take several times as long as products.
        let reciprocal = T::one() / panel.entry(j, j);
        own.iter_mut().for_each(|value| *value *= reciprocal);
        for (i, target) in rest.chunks_exact_mut(count).enumerate() {
            subtract(
                target,
                &Places::Adjoining(0),
                panel.entry(j + 1 + i, j),
                own,
            );
        }
    }
}

/// Adds the products of the columns of a small block to the lower triangle of a matrix of `n` rows, at the places `own`.
#[inline(always)]
fn add_products(value: &mut [f64], n: usize, own: &[usize], block: &[f64]) {
    let count = own.len();
    for (j, &column) in own.iter().enumerate() {
        let target = &mut value[column * n..(column + 1) * n];
        for (i, &row) in own.iter().enumerate().skip(j) {
            let products = block
                .chunks_exact(count)
                .map(|unknown| unknown[i] * unknown[j]);
            target[row] += products.sum::<f64>();
        }
    }
}

/// target -= factor * values, at the places given.
#[inline(always)]
fn subtract<T: Real>(target: &mut [T], places: &Places, factor: T, values: &[T]) {
    match places {
        Places::Adjoining(first) => {
            for (target, value) in target[*first..*first + values.len()].iter_mut().zip(values) {
                *target -= factor * *value;
            }
        }
        Places::Apart(places) => {
            for (&place, value) in places.iter().zip(values) {
                target[place] -= factor * *value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};
    use sprs::CsMat;

    use super::*;
    use crate::assembly::Extended;
    use crate::factor::banded;
    use crate::factor::cholesky::FactorError;

    /// Positive definite matrix with the given half bandwidth, and its upper triangle.
    fn definite(n: usize, width: usize) -> (DMatrix<f64>, CsMat<f64>) {
        banded(n, width, |i, j| match i.abs_diff(j) {
            0 => 2.0 * width as f64 + 0.1 * (i % 7) as f64,
            _ => -1.0 + 0.01 * ((i * j) % 13) as f64,
        })
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
            let (dense, upper) = definite(n, width);
            let factor = Factor::new(&precision(&upper)).expect("positive definite");
            assert_eq!(
                factor.panels < n,
                panels && T::NATIVE,
                "another kind of factor than meant"
            );
            let inverse = dense.clone().try_inverse().expect("positive definite");
            let scale = inverse.amax();
            let loads = [vec![(3, 1.0)], vec![(n - 1, 1.0), (7, -2.0)]];
            let products = factor.gram(&loads).value;
            let many: Vec<_> = (0..120).flat_map(|_| loads.clone()).collect();
            let all = factor.gram(&many);
            assert!(all.roundings <= n);
            for i in 0..240 {
                for j in 0..240 {
                    let (own, size) = (products[(i % 2, j % 2)], products.amax());
                    assert!((all.value[(i, j)] - own).abs() < 1e-14 * size);
                    assert_eq!(all.value[(i, j)], all.value[(j, i)]);
                }
            }
            let full = loads.each_ref().map(|load| {
                let mut x = DVector::zeros(n);
                load.iter().for_each(|&(k, value)| x[k] = value);
                x
            });
            for i in 0..2 {
                for j in 0..2 {
                    let exact = (full[i].transpose() * &inverse * &full[j])[0];
                    assert!((products[(i, j)] - exact).abs() < 1e-13 * scale);
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
        let (dense, upper) = definite(300, 299);
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
        let (_, upper) = definite(10, 1);
        let shifted = &upper + &CsMat::eye_csc(10).map(|one: &f64| -5.0 * one);
        assert_eq!(Factor::new(&shifted).err(), Some(FactorError::Indefinite));
    }
}
