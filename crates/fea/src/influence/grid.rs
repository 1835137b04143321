//! Influence coefficients between chosen places of the rails.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, SVector};
use splines::{Probe, RailElement, ShapeRow};

use crate::assembly::Matrix12;
use crate::error::{EntryAttribute, Error};
use crate::factor::{Certificate, Gram, allow_square};
use crate::influence::frame::FactoredFrame;
use crate::influence::layout::to_rail_axes;
use crate::influence::rounding::Evaluation;
use crate::model::{Model, Rail};

/// Bound up to which a grid in doubles is left as it is although its factor is in double-doubles.
const SHARP: f64 = 2e-14;
/// The same for more than [`FEW_PROBES`] probes: double-doubles take a time that grows with the square of their number.
const SHARP_FOR_MANY: f64 = 1e-12;
/// Probes whose coefficients in double-doubles take no longer than the factor of a small frame.
const FEW_PROBES: usize = 16;

/// Influence coefficients of a list of probes, with their certificate.
///
/// # Example
/// ```
/// use fea::{Girder, grid};
/// use splines::{Axis, Probe};
///
/// let girder = Girder { spans: vec![60.0], e: 4.32e9, i_vertical: 9.528, ..Girder::default() };
/// let (model, rail) = girder.model_and_rail()?;
/// let at = [15.0, 30.0].map(|x| Probe { rail: 0, x, axis: Axis::Vertical });
/// let grid = grid(&model, &[rail], &at)?;
/// assert_eq!(grid.value[(0, 1)], grid.value[(1, 0)]);
/// let midspan = 60.0_f64.powi(3) / (48.0 * 4.32e9 * 9.528);
/// assert!((grid.value[(1, 1)] / midspan - 1.0).abs() < grid.certificate.error_bound);
/// # Ok::<(), fea::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct InfluenceGrid {
    /// n x n for n probes; `value[(i, j)]` is the displacement at probe i along its axis per unit force at
    /// probe j along its axis, length/force.
    pub value: DMatrix<f64>,
    /// Bound of the error of the coefficients.
    pub certificate: Certificate,
}

/// Influence coefficients of the probes `at`, in any directions, on any of the rails.
///
/// G_ij = w_i . w_j + \[same member\] b(x_i, x_j), w = L^-1 N(x)^T, with the Cholesky factor L of the
/// stiffness and the Green's function b of the member between fixed ends. No nodes are needed at the probes.
///
/// Guarantee: symmetric to the last bit, positive semi-definite up to rounding.
///
/// # Errors
/// As [`FactoredFrame::new`] and [`FactoredFrame::grid`].
pub fn grid(m: &Model, rails: &[Rail], at: &[Probe]) -> Result<InfluenceGrid, Error> {
    FactoredFrame::new(m, rails)?.grid(at)
}

impl FactoredFrame {
    /// [`grid`] of a frame that is already factored.
    ///
    /// # Errors
    /// [`Error::Rail`] for a probe beyond its rail, or in a direction that nothing resists; [`Error::IllConditioned`]
    /// for a bound above the accuracy; [`Error::Memory`] for too many probes.
    pub fn grid(&self, at: &[Probe]) -> Result<InfluenceGrid, Error> {
        allow_square(EntryAttribute::Grid, at.len())?;
        let InfluenceGrid { value, certificate } = self.grid_in_doubles(at)?;
        let bound = certificate.error_bound;
        // Double-doubles cost little where the factor already has them; elsewhere only where doubles do not do.
        let sharp = if at.len() <= FEW_PROBES {
            SHARP
        } else {
            SHARP_FOR_MANY
        };
        let enough = if certificate.extended {
            sharp.min(self.accuracy())
        } else {
            self.accuracy()
        };
        if bound <= enough {
            return Ok(InfluenceGrid { value, certificate });
        }
        let (value, certificate) = match self.extended_grid(at)? {
            Some((_, extended)) if bound <= extended.error_bound && bound.is_finite() => {
                (value, certificate)
            }
            Some(extended) => extended,
            None => {
                let diagonal: Vec<f64> = value.diagonal().iter().copied().collect();
                let stiff = Evaluation::DoublesWhereStiff;
                let rounding = self.rounding(at, self.unknowns(), &diagonal, stiff)?;
                let error_bound = self.certificate().error_bound + rounding;
                (
                    value,
                    Certificate {
                        error_bound,
                        ..certificate
                    },
                )
            }
        };
        Ok(InfluenceGrid {
            value,
            certificate: self.require(certificate)?,
        })
    }

    /// The grid by arithmetic in doubles, whatever its bound.
    fn grid_in_doubles(&self, at: &[Probe]) -> Result<InfluenceGrid, Error> {
        let line = self.line()?;
        let mut rows = Vec::with_capacity(at.len());
        let mut loads = Vec::with_capacity(at.len());
        // Member, rail element and index of each probe on a member.
        let mut places = Vec::with_capacity(at.len());
        for (k, &probe) in at.iter().enumerate() {
            rows.push(line.row(probe)?);
            loads.push(self.load_of_row(probe, &rows[k])?);
            if let Some(carrier) = line.elements()[rows[k].element].member {
                places.push((carrier.id, rows[k].element, k));
            }
        }
        let Gram {
            mut value,
            roundings,
        } = self.gram(&loads);
        places.sort_unstable();
        // Places on the same member also act on each other between its fixed ends.
        for same in places.chunk_by(|a, b| a.0 == b.0) {
            self.add_clamped(&rows, same, &mut value)?;
        }
        let diagonal: Vec<f64> = (0..at.len()).map(|k| value[(k, k)]).collect();
        let mut certificate = self.certificate();
        certificate.error_bound += self.rounding(at, roundings, &diagonal, Evaluation::Doubles)?;
        Ok(InfluenceGrid { value, certificate })
    }

    /// Adds b: influence coefficients of places on one member, each with its rail element and its index among the
    /// probes, while the tips of the rigid offsets at both ends of the member are fixed.
    fn add_clamped(
        &self,
        all: &[ShapeRow],
        same: &[(usize, usize, usize)],
        value: &mut DMatrix<f64>,
    ) -> Result<(), Error> {
        let line = self.line()?;
        let rows: Vec<&ShapeRow> = same.iter().map(|&(_, _, k)| &all[k]).collect();
        let releases = self.elements[same[0].0].released.as_deref();
        let released = releases.map(|released| {
            let loads = rows
                .iter()
                .map(|row| released_load(&line.elements()[row.element], row));
            (&released.compliance, loads.collect::<Vec<_>>())
        });
        line.clamped_pairs(&rows, |i, j, mut own| {
            if let Some((compliance, loads)) = &released {
                own += (loads[i].transpose() * *compliance * loads[j])[0];
            }
            let (a, b) = (same[i].2, same[j].2);
            value[(a, b)] += own;
            value[(b, a)] = value[(a, b)];
        });
        Ok(())
    }

    /// Pairs of rail elements, each with itself too, on the same member with releases.
    pub(crate) fn released_pairs(&self, cells: &[RailElement]) -> Vec<(usize, usize)> {
        let mut by_member: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (index, cell) in cells.iter().enumerate() {
            if let Some(carrier) = cell
                .member
                .filter(|carrier| self.elements[carrier.id].released.is_some())
            {
                by_member.entry(carrier.id).or_default().push(index);
            }
        }
        let pairs = |same: &Vec<usize>| {
            same.iter()
                .flat_map(|&a| same.iter().map(move |&b| (a, b)))
                .collect::<Vec<_>>()
        };
        by_member.values().flat_map(pairs).collect()
    }

    /// Displacement of the end states of rail element `a` per unit load on those of `b`, both on one member,
    /// while the tips of its rigid offsets are fixed: the compliance K_rr^-1 of its releases, in rail axes.
    pub(crate) fn release_compliance(&self, a: &RailElement, b: &RailElement) -> Matrix12 {
        let Some(carrier) = a.member else {
            return Matrix12::zeros();
        };
        let Some(released) = &self.elements[carrier.id].released else {
            return Matrix12::zeros();
        };
        to_rail_axes(a) * released.compliance * to_rail_axes(b).transpose()
    }
}

/// Load on the flexible ends of a member, local axes, of a unit force with the shape row `row`.
pub(crate) fn released_load(cell: &RailElement, row: &ShapeRow) -> SVector<f64, 12> {
    let mut shapes = SVector::zeros();
    for (&index, &shape) in row.indices().iter().zip(row.values()) {
        shapes[if index / 6 == cell.ends[0] {
            index % 6
        } else {
            6 + index % 6
        }] = shape;
    }
    let to_rail: Matrix12 = to_rail_axes(cell);
    to_rail.transpose() * shapes
}
