//! The mobility of bodies and structures, projected on the rows of the elements: Z B^T, R Z B^T and R' Z B^T.
//!
//! The columns are those of the elements that may have a force in a stage; idle elements are omitted.

use nalgebra::DVector;

use super::rows::Rows;
use super::system::System;
use crate::mechanics::mobility::Mobility;
use crate::numerics::dense::add_lines;

/// Products of rows and mobility.
pub(crate) struct Projection {
    /// Elements of the columns.
    columns: Vec<usize>,
    /// Z B^T, degrees of freedom x columns, row-major.
    spread: Vec<f64>,
    /// The same by columns: the accelerations by a unit force of each.
    answers: Vec<f64>,
    /// R Z B^T, elements x columns, row-major; and R' Z B^T for the rows of rates.
    approach: Vec<f64>,
    rate: Vec<f64>,
    /// Whether the products are constant because rows and mobility are constant.
    is_constant: bool,
    dofs: usize,
    /// Scratch: the product of another row.
    other: Vec<f64>,
}

impl Projection {
    pub fn new(system: &System) -> Self {
        let (m, n) = (system.elements.len(), system.mechanics.dofs);
        Projection {
            columns: Vec::with_capacity(m),
            spread: vec![0.0; n * m],
            answers: vec![0.0; n * m],
            approach: vec![0.0; m * m],
            rate: vec![0.0; m * m],
            is_constant: false,
            other: Vec::with_capacity(m),
            dofs: n,
        }
    }

    /// Elements of the columns.
    pub fn columns(&self) -> &[usize] {
        &self.columns
    }

    /// Row `i` of R Z B^T, over the columns.
    pub fn approach_row(&self, i: usize) -> &[f64] {
        let count = self.columns.len();
        &self.approach[i * count..(i + 1) * count]
    }

    /// Row `i` of R' Z B^T, over the columns; defined only for elements whose laws depend on rates.
    pub fn rate_row(&self, i: usize) -> &[f64] {
        let count = self.columns.len();
        &self.rate[i * count..(i + 1) * count]
    }

    /// Elements of the columns, with the entries of `row` Z B^T.
    pub fn product(&mut self, row: &[f64]) -> impl Iterator<Item = (&usize, &f64)> {
        self.other.resize(self.columns.len(), 0.0);
        product(
            row,
            &self.spread[..self.dofs * self.columns.len()],
            &mut self.other,
        );
        self.columns.iter().zip(&self.other)
    }

    /// Computes the products of the rows of `elements`, for the forces of those that are not `idle`.
    pub fn fill(
        &mut self,
        system: &System,
        rows: &Rows,
        mobility: &Mobility,
        (elements, idle): (&[usize], &[bool]),
    ) {
        if self.is_constant {
            return;
        }
        // Constant products include all elements, because they are used for every later active set.
        let all = system.traits.has_constant_rows && system.mechanics.carried.is_empty();
        self.columns.clear();
        self.columns
            .extend((0..idle.len()).filter(|&j| all || !idle[j]));
        let count = self.columns.len();
        let answers = self.answers.chunks_exact_mut(self.dofs.max(1));
        for (column, (&j, answer)) in self.columns.iter().zip(answers).enumerate() {
            mobility.apply(rows.force_row(j), answer);
            for (k, answer) in answer.iter().enumerate() {
                self.spread[k * count + column] = *answer;
            }
        }
        let spread = &self.spread[..self.dofs * count];
        for &i in elements {
            let span = i * count..(i + 1) * count;
            product(
                rows.approach_row(i),
                spread,
                &mut self.approach[span.clone()],
            );
            if system.fixed[i].feels_rates {
                product(rows.rate_row(i), spread, &mut self.rate[span]);
            }
        }
        self.is_constant = all;
    }

    /// Sets `a` = `free` + `sign` Z B^T F, where F are the entries of `force` for the columns.
    pub fn add_forces(&self, free: &DVector<f64>, sign: f64, force: &[f64], a: &mut DVector<f64>) {
        a.as_mut_slice().copy_from_slice(free.as_slice());
        let shares = self.columns.iter().map(|&j| sign * force[j]);
        add_lines(
            shares.zip(self.answers.chunks_exact(self.dofs.max(1))),
            a.as_mut_slice(),
        );
    }
}

/// Sets `sum` to the product of `row` and a row-major matrix with as many columns as `sum` has entries.
fn product(row: &[f64], matrix: &[f64], sum: &mut [f64]) {
    sum.fill(0.0);
    let width = sum.len().max(1);
    add_lines(row.iter().copied().zip(matrix.chunks_exact(width)), sum);
}
