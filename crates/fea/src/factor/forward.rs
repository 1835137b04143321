//! Forward solves w = L^-1 p of sparse loads, and products of their solutions.

use pulp::{Arch, Simd, WithSimd};

use crate::assembly::Real;
use crate::factor::cholesky::Factor;

/// Loads that are solved together where the columns of L are single.
const COLUMN_LANES: usize = 8;
/// Loads that are solved together where L has panels.
const PANEL_LANES: usize = 32;

/// A sparse load: unknown and value of each entry.
pub(crate) type SparseLoad = Vec<(usize, f64)>;

/// w = L^-1 p of a sparse load p: the values on the path of the elimination tree from p to the root, as
/// runs of adjoining unknowns, ascending. All other values are zero.
#[derive(Clone, Debug, Default)]
pub(crate) struct ForwardSolution {
    /// First unknown of each run.
    pub starts: Vec<usize>,
    /// Length of each run.
    pub widths: Vec<usize>,
    /// The runs, one after the other.
    pub values: Vec<f64>,
}

impl ForwardSolution {
    #[inline]
    fn runs(&self) -> impl Iterator<Item = (usize, &[f64])> {
        let mut from = 0;
        self.starts.iter().zip(&self.widths).map(move |(&start, &width)| {
            let run = &self.values[from..from + width];
            from += width;
            (start, run)
        })
    }

    fn push(&mut self, start: usize, width: usize) {
        match (self.starts.last(), self.widths.last_mut()) {
            (Some(&before), Some(run)) if before + *run == start => *run += width,
            _ => {
                self.starts.push(start);
                self.widths.push(width);
            }
        }
    }
}

impl<T: Real> Factor<T> {
    /// L^-1 p of every load p, following the elimination tree from the entries of p to its root. Several
    /// loads are solved together, so that each entry of L is read once for all of them.
    ///
    /// # Source
    /// Gilbert and Peierls (1988), SIAM J. Sci. Stat. Comput. 9; Davis, Direct Methods for Sparse Linear
    /// Systems (2006), chapter 3.
    pub fn forward(&self, loads: &[SparseLoad]) -> Vec<ForwardSolution> {
        // Unused lanes are computed too: few loads are solved one at a time.
        if loads.len() < COLUMN_LANES {
            self.forward_in_lanes::<1>(loads)
        } else if self.panels == self.len() || loads.len() < PANEL_LANES {
            self.forward_in_lanes::<COLUMN_LANES>(loads)
        } else {
            self.forward_in_lanes::<PANEL_LANES>(loads)
        }
    }

    fn forward_in_lanes<const K: usize>(&self, loads: &[SparseLoad]) -> Vec<ForwardSolution> {
        Arch::new().dispatch(Forward::<T, K> { factor: self, loads })
    }

    /// Solves at most K loads; `x` is zero and `seen` false, before and after.
    #[inline(always)]
    fn forward_chunk<const K: usize>(
        &self,
        loads: &[SparseLoad],
        x: &mut [[T; K]],
        seen: &mut [bool],
        scratch: &mut Vec<[T; K]>,
        solutions: &mut Vec<ForwardSolution>,
    ) {
        for (lane, load) in loads.iter().enumerate() {
            load.iter().for_each(|&(row, value)| x[row][lane] += T::from(value));
        }
        let path = self.path(loads.iter().flatten().map(|&(row, _)| row), seen);
        for &k in &path {
            self.panel(k).forward(x, scratch);
        }
        for (lane, load) in loads.iter().enumerate() {
            // The lanes share the union of their paths; each solution keeps only its own path.
            let own = if K == 1 { &path } else { &self.path(load.iter().map(|&(row, _)| row), seen) };
            let mut solution = ForwardSolution::default();
            for &k in own {
                let panel = self.panel(k);
                solution.push(panel.start, panel.width);
                let values = &x[panel.start..panel.start + panel.width];
                solution.values.extend(values.iter().map(|value| value[lane].double()));
            }
            solutions.push(solution);
        }
        for &k in &path {
            let panel = self.panel(k);
            x[panel.start..panel.start + panel.width].fill([T::zero(); K]);
        }
    }

    /// Panels on the paths of the elimination tree from those of `columns` to the root, ascending; `seen` is
    /// false, before and after.
    fn path(&self, columns: impl Iterator<Item = usize>, seen: &mut [bool]) -> Vec<usize> {
        let mut path = Vec::new();
        for column in columns {
            let mut k = self.panel_of[column];
            while !seen[k] {
                seen[k] = true;
                path.push(k);
                // The parent of a panel in the elimination tree is that of its first row below the diagonal.
                match self.panel(k).below.iter().min() {
                    Some(&next) => k = self.panel_of[next],
                    None => break,
                }
            }
        }
        path.iter().for_each(|&k| seen[k] = false);
        path.sort_unstable();
        path
    }
}

/// Forward solves of loads in chunks of K, compiled for several sets of vector registers.
struct Forward<'a, T: Real, const K: usize> {
    factor: &'a Factor<T>,
    loads: &'a [SparseLoad],
}

impl<T: Real, const K: usize> WithSimd for Forward<'_, T, K> {
    type Output = Vec<ForwardSolution>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<ForwardSolution> {
        let mut solutions = Vec::with_capacity(self.loads.len());
        let mut seen = vec![false; self.factor.panels];
        let mut x = vec![[T::zero(); K]; self.factor.len()];
        let mut scratch = Vec::new();
        for some in self.loads.chunks(K) {
            self.factor.forward_chunk(some, &mut x, &mut seen, &mut scratch, &mut solutions);
        }
        solutions
    }
}

/// Calls `each` with the product of `solution` with each of `others`; `x` is scratch, zero before and after.
pub(crate) fn dot_products<'a>(
    x: &mut [f64],
    solution: &ForwardSolution,
    others: impl Iterator<Item = &'a ForwardSolution>,
    mut each: impl FnMut(f64),
) {
    solution.runs().for_each(|(start, run)| x[start..start + run.len()].copy_from_slice(run));
    for other in others {
        let mut sum = 0.0;
        for (start, run) in other.runs() {
            sum += dot(run, &x[start..start + run.len()]);
        }
        each(sum);
    }
    solution.runs().for_each(|(start, run)| x[start..start + run.len()].fill(0.0));
}

/// Sum of products in four lanes: the order of the additions depends on the length alone.
#[inline]
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
            assert_eq!(factor.panels < n, panels && T::PANELS, "another kind of factor than meant");
            let inverse = dense.clone().try_inverse().expect("positive definite");
            let scale = inverse.amax();
            let mut scratch = vec![0.0; n];
            let loads = [vec![(3, 1.0)], vec![(n - 1, 1.0), (7, -2.0)]];
            let solutions = factor.forward(&loads);
            let many: Vec<_> = (0..20).flat_map(|_| loads.clone()).collect();
            for (a, b) in factor.forward(&many).iter().zip(solutions.iter().cycle()) {
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
                dot_products(&mut scratch, &solutions[i], solutions.iter(), |product| products.push(product));
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
