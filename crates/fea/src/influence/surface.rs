//! Compliance of points and of whole rails.

use std::sync::Arc;

use nalgebra::DMatrix;
use splines::ExactSurface;

use crate::assembly::Combination;
use crate::error::{EntryAttribute, EntryFault, Error, ModelEntry};
use crate::factor::{Certificate, allow_square};
use crate::influence::frame::FactoredFrame;
use crate::model::{Model, Rail};

/// The exact influence surface of a frame along its rails.
///
/// # Example
/// ```
/// use fea::{Girder, surface};
/// use splines::{Axis, Compliance, Influence, Probe};
///
/// let girder = Girder { spans: vec![60.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let exact = surface(&model, &[rail])?;
/// // Coefficients and their slopes at any place, without another solve.
/// let at = [20.0, 30.0].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
/// let mut influence = Influence::zeros(2);
/// exact.surface.fill(&at, &mut influence)?;
/// assert!(influence.value[(1, 1)] > influence.value[(0, 0)]);
/// assert!(influence.slope[(0, 0)] > 0.0);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct CertifiedSurface {
    /// Influence coefficients at any place of any rail.
    pub surface: ExactSurface,
    /// Bound of the error of the compliance of its states. The evaluation in doubles adds a few roundings of the terms
    /// of N C N^T; where the coefficient is much smaller than they are, as beside an end that hardly moves, a grid
    /// there has a bound of its own.
    pub certificate: Certificate,
}

/// Influence surface of all rails: the compliance of the states at the ends of their rail elements.
///
/// # Errors
/// As [`FactoredFrame::new`] and [`FactoredFrame::surface`].
pub fn surface(m: &Model, rails: &[Rail]) -> Result<CertifiedSurface, Error> {
    FactoredFrame::new(m, rails)?.surface()
}

/// Compliance of points, 6 n x 6 n for n points, global axes: entry (6 a + i, 6 b + j) is the displacement
/// of point a along degree of freedom i per unit load on point b along degree of freedom j.
///
/// It is zero for supported degrees of freedom. For those that nothing stiffens it is infinite on the
/// diagonal and zero elsewhere.
///
/// # Errors
/// As [`FactoredFrame::new`]; [`Error::Invalid`] for a point that does not exist.
pub fn point_compliance(m: &Model, points: &[usize]) -> Result<(DMatrix<f64>, Certificate), Error> {
    let frame = FactoredFrame::new(m, &[])?;
    Ok((frame.point_compliance(points)?, frame.certificate()))
}

impl FactoredFrame {
    /// [`surface`] of a frame that is already factored.
    ///
    /// # Errors
    /// [`Error::NoRails`]; [`Error::Memory`] for too many states.
    pub fn surface(&self) -> Result<CertifiedSurface, Error> {
        let line = Arc::clone(self.line()?);
        allow_square(EntryAttribute::Surface, 6 * line.state_count())?;
        // States behind the last rail element belong to tips that no element of the line uses.
        let rows: Vec<&Combination> = self
            .states()
            .iter()
            .flatten()
            .take(6 * line.state_count())
            .collect();
        let mut nodal = self.compliance(&rows);
        for (a, b) in self.released_pairs(line.elements()) {
            let (row, column) = (&line.elements()[a], &line.elements()[b]);
            let compliance = self.release_compliance(row, column);
            for i in 0..12 {
                for j in 0..12 {
                    let at = (6 * row.ends[i / 6] + i % 6, 6 * column.ends[j / 6] + j % 6);
                    nodal[at] += compliance[(i, j)];
                }
            }
        }
        let surface = ExactSurface::new(line, nodal)?;
        Ok(CertifiedSurface {
            surface,
            certificate: self.certificate(),
        })
    }

    /// [`point_compliance`] of a frame that is already factored.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a point that does not exist.
    pub fn point_compliance(&self, points: &[usize]) -> Result<DMatrix<f64>, Error> {
        if let Some(&point) = points
            .iter()
            .find(|&&point| point >= self.bodies.of_point.len())
        {
            return Err(Error::Invalid {
                entry: ModelEntry::Point(point),
                fault: EntryFault::NoPoint { point },
            });
        }
        let rows: Vec<[Combination; 6]> = points.iter().map(|&point| self.point(point)).collect();
        Ok(self.compliance(&rows.iter().flatten().collect::<Vec<_>>()))
    }

    /// Compliance between displacements over the motions of the bodies.
    fn compliance(&self, rows: &[&Combination]) -> DMatrix<f64> {
        let loads: Vec<_> = rows.iter().map(|row| self.scaled(row)).collect();
        // Rows that nothing stiffens have no load: their products are zero, their own compliance is infinite.
        let unstiffened: Vec<usize> = (0..loads.len()).filter(|&k| loads[k].is_none()).collect();
        let loads: Vec<_> = loads.into_iter().map(Option::unwrap_or_default).collect();
        let mut out = self.gram(&loads).value;
        for k in unstiffened {
            out[(k, k)] = f64::INFINITY;
        }
        out
    }
}
