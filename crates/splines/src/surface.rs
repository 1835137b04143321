//! The exact influence surface of a structure along its rails.

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::lean::{self, Seat};
use crate::row::Row;
use crate::{Compliance, Error, Influence, Jet2, Jets, Line, Probe};

/// Exact influence coefficients at any place of any rail:
///
/// G(p, q) = N(p) C N(q)^T + \[same member\] b(p, q)
///
/// with the shape rows N and clamped kernels b of the cells, and the compliance C of the states at their
/// ends; cells of two rails on one member share its kernel. Exact for piecewise uniform Euler-Bernoulli and Timoshenko members loaded at the rail, whatever
/// the number of cells: on the paper's girder 4e-15 of the largest entry. Positive semi-definite where C is (a
/// Gram matrix plus the kernel of a clamped beam); once continuously differentiable, twice along one rail where
/// bending alone gives and no cell ends.
///
/// # Source
/// Superposition of the loaded cell with its ends held, and of the released ends; see
/// Przemieniecki, Theory of Matrix Structural Analysis (1968), section 10.
#[derive(Clone, Debug)]
pub struct Surface {
    line: Arc<Line>,
    nodal: DMatrix<f64>,
}

impl Surface {
    /// `nodal`: 6 S x 6 S, S = `line.states()`: displacement of freedom i per unit load on freedom j, in the
    /// frames of the rails. Its symmetric part is taken. An infinite diagonal entry marks a freedom that
    /// nothing resists: probes that need it are refused.
    ///
    /// # Errors
    /// A wrong shape; an entry that is not a number, or infinite off the diagonal.
    pub fn new(line: Arc<Line>, nodal: DMatrix<f64>) -> Result<Surface, Error> {
        let expected = 6 * line.states();
        let (rows, columns) = nodal.shape();
        if rows != expected || columns != expected {
            return Err(Error::NodalShape { rows, columns, expected });
        }
        let mut nodal = nodal;
        for column in 0..expected {
            for row in 0..=column {
                let mean = 0.5 * nodal[(row, column)] + 0.5 * nodal[(column, row)];
                if !(mean.is_finite() || (row == column && mean == f64::INFINITY)) {
                    return Err(Error::NodalNumber { row, column });
                }
                nodal[(row, column)] = mean;
                nodal[(column, row)] = mean;
            }
        }
        Ok(Surface { line, nodal })
    }

    /// The cells it stands on.
    #[must_use]
    pub fn line(&self) -> &Arc<Line> {
        &self.line
    }

    /// Compliance of the states.
    #[must_use]
    pub fn nodal(&self) -> &DMatrix<f64> {
        &self.nodal
    }

    fn assemble(
        &self,
        at: &[Probe],
        rows: &mut [Row],
        order: &mut [usize],
        out: &mut Influence,
    ) -> Result<(), Error> {
        let n = at.len();
        let size = self.nodal.nrows();
        let nodal = self.nodal.as_slice();
        let value = out.value.as_mut_slice();
        let slope = out.slope.as_mut_slice();
        for (i, p) in at.iter().enumerate() {
            self.line.row_into(*p, &mut rows[i])?;
            order[i] = i;
        }
        // Probes of one cell and axis share their freedoms: one product C N(q) serves them all.
        let block = |row: &Row| (row.cell, row.axis);
        if !rows.is_sorted_by_key(block) {
            order.sort_unstable_by_key(|&i| block(&rows[i]));
        }
        for j in 0..n {
            let load = &rows[j];
            let mut last = None;
            let mut moved = [[0.0; 4]; 3];
            for &i in order.iter() {
                let row = &rows[i];
                if last != Some(block(row)) {
                    last = Some(block(row));
                    moved = product(nodal, size, row.places(), load.places(), load.chunks()[0]);
                }
                let [values, slopes] = row.chunks();
                slope[i + n * j] = dot(slopes, &moved);
                if i >= j {
                    value[i + n * j] = dot(values, &moved);
                }
            }
        }
        for j in 0..n {
            let kernel = self.line.kernel_of(rows[j].cell);
            for i in j..n {
                let (p, q) = (&rows[i], &rows[j]);
                if let Some(kernel) = kernel.filter(|_| p.cell == q.cell) {
                    let green = kernel.pair(p.axis, p.s, q.axis, q.s);
                    value[i + n * j] += green.value;
                    slope[i + n * j] += green.first * p.rate;
                    if i != j {
                        slope[j + n * i] += green.second * q.rate;
                    }
                }
                value[j + n * i] = value[i + n * j];
            }
            if !value[j + n * j].is_finite() {
                return Err(Error::Unstiffened { rail: at[j].rail, x: at[j].x, axis: at[j].axis });
            }
        }
        if self.line.has_shared_members() {
            self.across(rows, out);
        }
        Ok(())
    }

    /// Adds what the member gives between two cells that it carries.
    #[cold]
    fn across(&self, rows: &[Row], out: &mut Influence) {
        for (j, q) in rows.iter().enumerate() {
            for (i, p) in rows.iter().enumerate().skip(j + 1).filter(|(_, p)| p.cell != q.cell) {
                let Some([own, other]) = self.line.kernels_of_one_member(p.cell, q.cell) else { continue };
                let green = own.across(p.axis, p.s, other, q.axis, q.s);
                out.value[(i, j)] += green.value;
                out.value[(j, i)] = out.value[(i, j)];
                out.slope[(i, j)] += green.first * p.rate;
                out.slope[(j, i)] += green.second * q.rate;
            }
        }
    }
}

/// C N(q)^T at the freedoms `row`, by the freedoms and shares of the load.
#[inline]
fn product(
    nodal: &[f64],
    size: usize,
    row: &[[usize; 4]],
    load: &[[usize; 4]],
    shares: &[[f64; 4]],
) -> [[f64; 4]; 3] {
    let mut out = [[0.0; 4]; 3];
    for (freedoms, s) in load.iter().zip(shares) {
        let [a, b, c, d] = freedoms.map(|freedom| &nodal[freedom * size..(freedom + 1) * size]);
        for (sum, places) in out.iter_mut().zip(row) {
            let moved: [f64; 4] = std::array::from_fn(|k| {
                let k = places[k];
                (s[0] * a[k] + s[1] * b[k]) + (s[2] * c[k] + s[3] * d[k])
            });
            *sum = std::array::from_fn(|k| sum[k] + moved[k]);
        }
    }
    out
}

fn dot(a: &[[f64; 4]], b: &[[f64; 4]; 3]) -> f64 {
    let one = |x: &[f64; 4], y: &[f64; 4]| (x[0] * y[0] + x[2] * y[2]) + (x[1] * y[1] + x[3] * y[3]);
    a.iter().zip(b).map(|(x, y)| one(x, y)).sum()
}

impl Compliance for Surface {
    /// `value` is symmetric to the last bit. At a place where a slope jumps (one's own force in shear,
    /// torsion or axially) `slope` is the mean of both sides. Up to 16 probes take no memory from the heap.
    fn fill(&self, at: &[Probe], out: &mut Influence) -> Result<(), Error> {
        let n = at.len();
        out.expect(n)?;
        if !self.line.has_shared_members() {
            let (nodal, size) = (self.nodal.as_slice(), self.nodal.nrows());
            let mut lean = |seats: &mut [Seat]| lean::fill(&self.line, nodal, size, at, seats, out);
            let done = match n {
                0..=2 => lean(&mut [Seat::EMPTY; 2][..n]),
                3..=8 => lean(&mut [Seat::EMPTY; 8][..n]),
                9..=16 => lean(&mut [Seat::EMPTY; 16][..n]),
                _ => lean(&mut vec![Seat::EMPTY; n]),
            };
            if done? {
                return Ok(());
            }
        }
        match n {
            0..=2 => self.assemble(at, &mut [Row::EMPTY; 2][..n], &mut [0; 2][..n], out),
            3..=8 => self.assemble(at, &mut [Row::EMPTY; 8][..n], &mut [0; 8][..n], out),
            9..=16 => self.assemble(at, &mut [Row::EMPTY; 16][..n], &mut [0; 16][..n], out),
            _ => self.assemble(at, &mut vec![Row::EMPTY; n], &mut vec![0; n], out),
        }
    }

    fn breaks(&self, rail: usize) -> Vec<f64> {
        self.line.breaks(rail)
    }

    fn range(&self, rail: usize) -> Option<[f64; 2]> {
        self.line.range(rail)
    }

    fn is_symmetric(&self) -> bool {
        true
    }
}

impl Jets for Surface {
    /// `pp` jumps at the ends of cells of different bending (that of the probe's own cell is given), and in the
    /// product with an offset under one's own load (the mean).
    fn jet(&self, p: Probe, q: Probe) -> Result<Jet2, Error> {
        let (nodal, size) = (self.nodal.as_slice(), self.nodal.nrows());
        if !self.line.has_shared_members()
            && let Some(jet) = lean::jet(&self.line, nodal, size, p, q)?
        {
            return Ok(jet);
        }
        let ((a, a2), (b, b2)) = (self.line.bends(p)?, self.line.bends(q)?);
        let ([a0, a1], [b0, b1]) = (a.chunks(), b.chunks());
        let moved =
            [b0, b1, &b2[..b0.len()]].map(|shares| product(nodal, size, a.places(), b.places(), shares));
        let a2 = &a2[..a0.len()];
        let mut out = Jet2 {
            value: dot(a0, &moved[0]),
            p: dot(a1, &moved[0]),
            q: dot(a0, &moved[1]),
            pp: dot(a2, &moved[0]),
            pq: dot(a1, &moved[1]),
            qq: dot(a0, &moved[2]),
        };
        if let Some([own, other]) = self.line.kernels_of_one_member(a.cell, b.cell) {
            let green = own.across(a.axis, a.s, other, b.axis, b.s);
            let bend = own.bend(a.axis, a.s, other, b.axis, b.s);
            out.value += green.value;
            out.p += green.first * a.rate;
            out.q += green.second * b.rate;
            out.pp += bend.first * a.rate * a.rate;
            out.pq += bend.mixed * a.rate * b.rate;
            out.qq += bend.second * b.rate * b.rate;
        }
        for (row, at) in [(&a, p), (&b, q)] {
            if row.indices().iter().any(|&k| self.nodal[(k, k)] == f64::INFINITY) {
                return Err(Error::Unstiffened { rail: at.rail, x: at.x, axis: at.axis });
            }
        }
        Ok(out)
    }
}
