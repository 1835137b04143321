//! Chebyshev-Lobatto nodes on [0, 1], (1 - cos(k pi/n))/2 for k = 0 to n, and the polynomial through values at them.
//!
//! The nodes of degree n are among those of degree 2 n. Values between them follow by the barycentric formula with the weights
//! (-1)^k, half of that at both ends.
//!
//! # Source
//! Berrut, Trefethen, Barycentric Lagrange interpolation, SIAM Review 46 (2004), equations 4.2 and 5.4.

use std::f64::consts::PI;
use std::sync::LazyLock;

use smallvec::SmallVec;

use crate::polynomial::{MAX_DEGREE, Polynomial};

/// The nodes of one degree.
#[derive(Debug)]
pub struct Lobatto {
    nodes: Vec<f64>,
    /// Bernstein coefficients by the values at the nodes, row by row.
    to_bernstein: Vec<f64>,
}

/// The nodes of all degrees from 0, which has one node at 0.
static ALL: LazyLock<Vec<Lobatto>> = LazyLock::new(|| (0..=MAX_DEGREE).map(Lobatto::new).collect());

impl Lobatto {
    /// The nodes of a degree, at most [`MAX_DEGREE`].
    #[must_use]
    pub fn of(degree: usize) -> &'static Lobatto {
        &ALL[degree]
    }

    fn new(degree: usize) -> Lobatto {
        let n = degree;
        let node = |k: usize| match k {
            0 => 0.0,
            _ if k == n => 1.0,
            _ => 0.5 * (1.0 - (PI * k as f64 / n as f64).cos()),
        };
        let nodes: Vec<f64> = (0..=n).map(node).collect();
        // values at the nodes by the coefficients; its inverse by elimination with pivots
        let count = n + 1;
        let mut matrix = vec![0.0; count * 2 * count];
        for (row, &s) in nodes.iter().enumerate() {
            let mut bernstein = vec![1.0];
            for _ in 0..n {
                let mut next = vec![0.0; bernstein.len() + 1];
                for (i, b) in bernstein.iter().enumerate() {
                    next[i] += (1.0 - s) * b;
                    next[i + 1] += s * b;
                }
                bernstein = next;
            }
            matrix[row * 2 * count..][..count].copy_from_slice(&bernstein);
            matrix[row * 2 * count + count + row] = 1.0;
        }
        for k in 0..count {
            let pivot = (k..count)
                .max_by(|a, b| {
                    let size = |row: usize| matrix[row * 2 * count + k].abs();
                    size(*a).total_cmp(&size(*b))
                })
                .unwrap_or(k);
            for column in 0..2 * count {
                matrix.swap(k * 2 * count + column, pivot * 2 * count + column);
            }
            let scale = matrix[k * 2 * count + k].recip();
            (0..2 * count).for_each(|column| matrix[k * 2 * count + column] *= scale);
            for row in (0..count).filter(|row| *row != k) {
                let factor = matrix[row * 2 * count + k];
                for column in 0..2 * count {
                    matrix[row * 2 * count + column] -= factor * matrix[k * 2 * count + column];
                }
            }
        }
        let to_bernstein = matrix
            .chunks_exact(2 * count)
            .flat_map(|row| row[count..].iter().copied())
            .collect();
        Lobatto {
            nodes,
            to_bernstein,
        }
    }

    /// The nodes, increasing from 0 to 1.
    #[must_use]
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The degree of the polynomials through values at the nodes.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Bounds of a polynomial whose values at up to nine nodes are between these two: the Lebesgue constant of nine nodes is below
    /// 2, so that it leaves their range by no more than half of it.
    #[must_use]
    pub fn bounds([low, high]: [f64; 2]) -> [f64; 2] {
        let beyond = 0.5 * (high - low);
        [low - beyond, high + beyond]
    }

    /// The polynomial that has these values at the nodes.
    #[must_use]
    pub fn polynomial(&self, values: &[f64]) -> Polynomial {
        let n = self.degree();
        let rows = self.to_bernstein.chunks_exact(n + 1).enumerate();
        Polynomial::new(rows.map(|(i, row)| match i {
            // the ends are exact
            0 => values[0],
            _ if i == n => values[n],
            _ => row.iter().zip(values).map(|(own, value)| own * value).sum(),
        }))
    }

    /// Factors of the values at the nodes in the value at `share`.
    #[must_use]
    pub fn weights(&self, share: f64) -> SmallVec<[f64; MAX_DEGREE + 1]> {
        let n = self.degree();
        if let Some(at) = self.nodes.iter().position(|node| *node == share) {
            return (0..=n).map(|k| if k == at { 1.0 } else { 0.0 }).collect();
        }
        let term = |(k, node): (usize, &f64)| {
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            let half = if k == 0 || k == n { 0.5 } else { 1.0 };
            half * sign / (share - node)
        };
        let mut out: SmallVec<[f64; MAX_DEGREE + 1]> =
            self.nodes.iter().enumerate().map(term).collect();
        let sum: f64 = out.iter().sum();
        out.iter_mut().for_each(|weight| *weight /= sum);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Identity: polynomials of every degree are met by their values at the nodes, in both forms.
    #[test]
    fn polynomials_are_met() {
        for degree in 0..=MAX_DEGREE {
            let nodes = Lobatto::of(degree);
            let exact = |s: f64| (0..=degree).map(|k| (s - 0.3).powi(k as i32)).sum::<f64>();
            let values: Vec<f64> = nodes.nodes().iter().map(|s| exact(*s)).collect();
            let polynomial = nodes.polynomial(&values);
            for k in 0..=20 {
                let s = f64::from(k) / 20.0;
                let weights = nodes.weights(s);
                let found: f64 = weights.iter().zip(&values).map(|(w, v)| w * v).sum();
                assert!((found - exact(s)).abs() < 1e-13, "degree {degree} at {s}");
                let found = polynomial.value(s);
                assert!((found - exact(s)).abs() < 1e-11, "degree {degree} at {s}");
            }
        }
    }

    /// The nodes of a degree are every second one of twice the degree, to the last bits.
    #[test]
    fn nodes_are_nested() {
        for degree in [1, 2, 4, 8] {
            let all = Lobatto::of(2 * degree).nodes();
            for (k, node) in Lobatto::of(degree).nodes().iter().enumerate() {
                assert!((node - all[2 * k]).abs() < 1e-16);
            }
        }
    }
}
