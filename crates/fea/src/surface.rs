//! Compliance at points and along whole rails.

use std::sync::Arc;

use nalgebra::DMatrix;
use splines::Surface;

use crate::certificate::Certificate;
use crate::error::{Error, Fault, Item, Quantity};
use crate::frame::Frame;
use crate::freedoms::Sum;
use crate::memory::square;
use crate::model::Model;
use crate::rail::Rail;

/// The exact influence surface of a frame along its rails.
#[derive(Clone, Debug)]
pub struct Exact {
    /// Influence coefficients at any place of any rail.
    pub surface: Surface,
    /// How far to trust the compliance of its states; evaluation adds a few roundings.
    pub certificate: Certificate,
}

/// Influence surface of all rails: compliance of the states at the ends of their cells.
///
/// # Errors
/// As [`Frame::new`]; no rail.
pub fn surface(m: &Model, rails: &[Rail]) -> Result<Exact, Error> {
    Frame::new(m, rails)?.surface()
}

/// Compliance of points, 6 n x 6 n for n points, global axes: entry (6 a + i, 6 b + j) is the
/// displacement of freedom i of point a per unit load on freedom j of point b.
///
/// Zero for supported freedoms; infinite on the diagonal, zero elsewhere, for freedoms that nothing
/// stiffens.
///
/// # Errors
/// As [`Frame::new`]; a point that does not exist.
pub fn nodal(m: &Model, points: &[usize]) -> Result<(DMatrix<f64>, Certificate), Error> {
    let frame = Frame::new(m, &[])?;
    Ok((frame.nodal(points)?, frame.certificate()))
}

impl Frame {
    /// [`surface`] of a frame that is already factored.
    ///
    /// # Errors
    /// No rail; more states than memory holds.
    pub fn surface(&self) -> Result<Exact, Error> {
        let line = Arc::clone(self.line()?);
        square(Quantity::Surface, 6 * line.states())?;
        let sums: Vec<&Sum> = self.states().iter().flatten().take(6 * line.states()).collect();
        let mut nodal = self.compliance(&sums);
        for (a, b) in self.released(line.cells()) {
            let (row, column) = (&line.cells()[a], &line.cells()[b]);
            let slack = self.slack(row, column);
            for i in 0..12 {
                for j in 0..12 {
                    let at = (6 * row.ends[i / 6] + i % 6, 6 * column.ends[j / 6] + j % 6);
                    nodal[at] += slack[(i, j)];
                }
            }
        }
        let surface = Surface::new(line, nodal)?;
        Ok(Exact { surface, certificate: self.certificate() })
    }

    /// [`nodal`] of a frame that is already factored.
    ///
    /// # Errors
    /// A point that does not exist.
    pub fn nodal(&self, points: &[usize]) -> Result<DMatrix<f64>, Error> {
        if let Some(&point) = points.iter().find(|&&point| point >= self.freedoms.body.len()) {
            return Err(Error::Invalid { item: Item::Point(point), fault: Fault::NoPoint { point } });
        }
        let own: Vec<[Sum; 6]> = points.iter().map(|&point| self.point(point)).collect();
        Ok(self.compliance(&own.iter().flatten().collect::<Vec<_>>()))
    }

    /// Compliance between sums over the columns of the bodies.
    fn compliance(&self, sums: &[&Sum]) -> DMatrix<f64> {
        let mut loose = Vec::new();
        let loads: Vec<_> = sums
            .iter()
            .enumerate()
            .map(|(k, sum)| {
                self.scaled(sum).unwrap_or_else(|| {
                    loose.push(k);
                    Vec::new()
                })
            })
            .collect();
        let tails = self.forward(&loads);
        let mut out = self.gram(&tails);
        for k in loose {
            out[(k, k)] = f64::INFINITY;
        }
        out
    }
}
