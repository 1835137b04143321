//! Natural modes: the lowest, with a proof that none is missing.

use std::sync::Arc;

use faer::{Mat, Side};
use nalgebra::{DVector, DVectorView, SVector, Vector3};
use splines::{Axis, Line, Probe, Surface};
use sprs::CsMat;

use crate::error::Error;
use crate::factor::Factor;
use crate::frame::Frame;
use crate::freedoms::Sum;
use crate::lanczos::{Pencil, Space, product};
use crate::mass::Mass;
use crate::model::Model;
use crate::rail::Rail;
use crate::solver::Solver;

/// Smallest distance, relative to lambda, of two eigenvalues between which a count is taken.
const GAP: f64 = 1e-6;
/// Where in a gap the count is tried.
const PLACES: [f64; 6] = [0.5, 0.4, 0.6, 0.25, 0.75, 0.1];
/// How many more eigenvalues than asked are looked at for a gap.
const ROOM: usize = 64;
/// How many gaps are tried at a time.
const TRIES: usize = 3;
/// How many more eigenvalues are looked for where none of the gaps will do.
const STEP: usize = 8;
/// Rounding, amplified by the condition, that doubles may leave in a frequency.
const DIGITS: f64 = 1e-9;
/// Most unknowns of a frame all of whose modes are asked for.
pub const DENSE: usize = 3000;
/// Share of the largest 1/lambda below which an eigenvalue is that of a freedom without mass.
const MASSLESS: f64 = 1e-13;
/// How often a search is taken up again after a count that found more.
const ATTEMPTS: usize = 12;

/// A natural mode, of modal mass 1: phi^T M phi = 1, K phi = omega^2 M phi.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Circular frequency, radian/time.
    pub omega: f64,
    /// Motion of the states of the rails, in their frames: three displacements, three rotations. Along
    /// the cells the shape is that of the members without load ([`Modes::at`]).
    pub states: Vec<[f64; 6]>,
    /// Motion of the points, global.
    pub points: Vec<[f64; 6]>,
    /// phi^T M r for rigid motions r of the whole structure with its supports: three translations along
    /// the global axes, three rotations about the global origin. Its squares are the effective modal
    /// masses.
    pub coupling: [f64; 6],
    /// |K phi - omega^2 M phi| / ((|K| + omega^2 |M|) |phi|), of the scaled matrices, largest column sums.
    pub residual: f64,
}

/// The lowest modes of a frame.
#[derive(Clone, Debug)]
pub struct Modes {
    /// Lowest first.
    pub modes: Vec<Mode>,
    /// Circular frequency of a shift sigma^2.
    pub shift: f64,
    /// Number of eigenvalues below the shift by the signs of the pivots of K - sigma^2 M, all of which
    /// were found. Where it is less than the number of modes, the others lie within 1e-6 of each other.
    pub below: usize,
    /// Circular frequency of the mode after these; `None` where there is no other.
    pub next: Option<f64>,
    /// r^T M r of the whole structure with its supports, r as in [`Mode::coupling`]: masses, then moments
    /// and inertias about the global origin.
    pub total: [[f64; 6]; 6],
    line: Option<Arc<Line>>,
}

/// The `count` lowest modes of a frame: K phi = omega^2 M phi, M the consistent mass of members by their
/// section's mass per length, and the rigid masses.
///
/// Guarantee: none is missing ([`Modes::below`]). Fewer are returned where fewer frequencies are finite.
///
/// # Errors
/// As [`Frame::new`]; [`Frame::modes`].
pub fn modes(m: &Model, rails: &[Rail], count: usize) -> Result<Modes, Error> {
    Frame::new(m, rails)?.modes(m, count)
}

impl Frame {
    /// [`modes`] of a frame that is already factored from the same model.
    ///
    /// Shift-invert block Lanczos; then L D L^T of K - sigma^2 M with sigma between the last and the next
    /// frequency, whose negative pivots count the modes below.
    ///
    /// # Errors
    /// A freedom with mass that nothing stiffens; no mass at all; modes that could not be found or counted.
    ///
    /// # Source
    /// Grimes, Lewis and Simon (1994), SIAM J. Matrix Anal. Appl. 15.
    pub fn modes(&self, m: &Model, count: usize) -> Result<Modes, Error> {
        let (assembly, solver) = self.system();
        let double = match solver {
            Solver::Extended(_) if self.certificate().condition * f64::EPSILON < DIGITS => {
                Factor::new(&assembly.upper).ok().map(Solver::Double)
            }
            _ => None,
        };
        let factor = double.as_ref().unwrap_or(solver);
        let mass = Mass::new(m, &self.elements, &self.freedoms, assembly)?;
        let pencil = Pencil { stiffness: &assembly.upper, mass: &mass.upper, factor };
        let norms = [assembly.norm(), column_norm(&mass.upper)];
        if norms[1] == 0.0 {
            return Err(Error::NoMass);
        }
        let mut space = Space::new(pencil);
        let cut = search(&mut space, count)?;
        let found = count.min(space.pairs.converged);
        let next = space.pairs.inverse[..space.pairs.converged].get(found).map(|x| x.recip().sqrt());
        let mode = |(lambda, phi)| self.mode(&mass, norms, lambda, &phi);
        let modes = space.modes(found).into_iter().map(mode).collect();
        Ok(Modes {
            modes,
            shift: cut.lambda.sqrt(),
            below: cut.below,
            next,
            total: std::array::from_fn(|i| std::array::from_fn(|j| mass.total[(i, j)])),
            line: self.line().ok().cloned(),
        })
    }

    /// All modes of finite frequency, from dense matrices: K phi = omega^2 M phi by the eigenvalues of
    /// L^-1 M L^-T, K = L L^T. Time grows with the cube of the unknowns, memory with their square.
    ///
    /// # Errors
    /// As [`Frame::modes`], and more unknowns than [`DENSE`].
    pub fn all_modes(&self, m: &Model) -> Result<Modes, Error> {
        let (assembly, _) = self.system();
        let mass = Mass::new(m, &self.elements, &self.freedoms, assembly)?;
        let size = assembly.numbering.column.len();
        if size > DENSE {
            return Err(Error::TooManyModes { unknowns: size, most: DENSE });
        }
        let norms = [assembly.norm(), column_norm(&mass.upper)];
        if norms[1] == 0.0 {
            return Err(Error::NoMass);
        }
        let modes: Vec<Mode> = spectrum(&assembly.upper, &mass.upper)
            .ok_or(Error::Modes { asked: size, found: 0 })?
            .into_iter()
            .map(|(lambda, phi)| self.mode(&mass, norms, lambda, &phi))
            .collect();
        Ok(Modes {
            shift: modes.last().map_or(0.0, |mode| mode.omega),
            below: modes.len(),
            next: None,
            total: std::array::from_fn(|i| std::array::from_fn(|j| mass.total[(i, j)])),
            line: self.line().ok().cloned(),
            modes,
        })
    }

    /// A mode from its eigenvalue and its scaled unknowns, of modal mass 1.
    fn mode(&self, mass: &Mass, norms: [f64; 2], lambda: f64, phi: &DVector<f64>) -> Mode {
        let stiffness = &self.system().0.upper;
        let (force, momentum) = (product(stiffness, phi.as_view()), product(&mass.upper, phi.as_view()));
        let size = (norms[0] + lambda * norms[1]) * phi.norm();
        let residual = (force - momentum * lambda).norm() / size;
        let coupling =
            mass.rigid.each_ref().map(|rigid| DVectorView::from_slice(rigid, rigid.len()).dot(phi));
        let [states, points] = self.shapes(phi.as_slice());
        Mode { omega: lambda.sqrt(), states, points, coupling, residual }
    }

    /// Motion of the states of the rails and of the points by scaled unknowns.
    fn shapes(&self, x: &[f64]) -> [Vec<[f64; 6]>; 2] {
        let motions = self.spread(x);
        let value = |sum: &Sum| -> f64 {
            sum.terms.iter().map(|&(column, share)| share * motions[column / 6][column % 6]).sum()
        };
        let states = self.states().iter().map(|state| state.each_ref().map(value));
        let points = (0..self.freedoms.body.len()).map(|point| {
            let motion = self.freedoms.motion(point, &Vector3::zeros());
            (motion * motions[self.freedoms.body[point]]).into()
        });
        [states.collect(), points.collect()]
    }

    /// Motion of the references of all bodies by scaled unknowns.
    fn spread(&self, x: &[f64]) -> Vec<SVector<f64, 6>> {
        let assembly = self.system().0;
        let mut motions = vec![SVector::<f64, 6>::zeros(); self.freedoms.bodies.len()];
        for ((&value, &column), &scale) in
            x.iter().zip(&assembly.numbering.column).zip(&assembly.numbering.scale)
        {
            motions[column / 6][column % 6] = value * scale;
        }
        motions.iter().zip(&self.freedoms.bodies).map(|(motion, body)| body.basis * motion).collect()
    }
}

impl Modes {
    /// Displacement of every mode at a probe, along its axis, and its derivative by the rail coordinate.
    ///
    /// # Errors
    /// No rail; a probe beyond its rail, or in a direction that nothing resists.
    pub fn at(&self, probe: Probe) -> Result<Vec<[f64; 2]>, Error> {
        let row = self.line.as_ref().ok_or(Error::NoRails)?.row(probe)?;
        let sum = |mode: &Mode, shares: &[f64]| -> f64 {
            let terms = row.indices().iter().zip(shares);
            terms.map(|(&index, share)| share * mode.states[index / 6][index % 6]).sum()
        };
        Ok(self.modes.iter().map(|mode| [sum(mode, row.values()), sum(mode, row.slopes())]).collect())
    }

    /// Rotation of every mode about the rail at x, linear along a cell: exact where the cell runs along the rail.
    ///
    /// # Errors
    /// No rail; a place beyond it.
    pub fn twist(&self, rail: usize, x: f64) -> Result<Vec<f64>, Error> {
        let line = self.line.as_ref().ok_or(Error::NoRails)?;
        let place = |axis| line.row(Probe { rail, x, axis });
        let row =
            place(Axis::Vertical).or_else(|_| place(Axis::Lateral)).or_else(|_| place(Axis::Longitudinal))?;
        let cell = &line.cells()[row.cell];
        let r = ((x - cell.x[0]) / (cell.x[1] - cell.x[0])).clamp(0.0, 1.0);
        let [a, b] = cell.ends;
        Ok(self.modes.iter().map(|mode| (1.0 - r) * mode.states[a][3] + r * mode.states[b][3]).collect())
    }

    /// What the modes leave of an influence surface of the same frame:
    ///
    /// G_res = G - sum phi_r phi_r^T / omega_r^2
    ///
    /// Guarantee: positive semi-definite up to the rounding of G, whatever the number of modes.
    ///
    /// # Errors
    /// No rail; a surface of another frame, by its number of states.
    pub fn residual(&self, surface: &Surface) -> Result<Surface, Error> {
        let line = self.line.as_ref().ok_or(Error::NoRails)?;
        let mut nodal = surface.nodal().clone();
        let expected = 6 * line.states();
        if nodal.nrows() != expected {
            let (rows, columns) = nodal.shape();
            return Err(splines::Error::NodalShape { rows, columns, expected }.into());
        }
        for mode in &self.modes {
            let phi = DVector::from_fn(expected, |k, _| mode.states[k / 6][k % 6] / mode.omega);
            for j in (0..expected).filter(|&j| phi[j] != 0.0) {
                for i in 0..expected {
                    nodal[(i, j)] -= phi[i] * phi[j];
                }
            }
        }
        Ok(Surface::new(Arc::clone(surface.line()), nodal)?)
    }
}

/// A shift, and how many eigenvalues lie below it.
struct Cut {
    lambda: f64,
    below: usize,
}

/// Finds `count` eigenvalues, and a shift above them below which all are known.
fn search(space: &mut Space<'_>, count: usize) -> Result<Cut, Error> {
    let fail = |known: usize| Error::Modes { asked: count, found: known.min(count) };
    let mut need = count + 1;
    for _ in 0..ATTEMPTS {
        let complete = space.converge(need);
        let known = space.known();
        let mut missed = None;
        for (below, [low, high]) in gaps(&known, count, space.pairs.exhausted) {
            let counted = PLACES.iter().find_map(|place| {
                let lambda = low + place * (high - low);
                space.negatives(lambda).map(|found| found.map(|found| (lambda, found))).transpose()
            });
            match counted.transpose().map_err(|_| fail(known.len()))? {
                Some((lambda, found)) if found == below => return Ok(Cut { lambda, below }),
                Some((_, found)) if found > below => missed = Some(found - below),
                Some(_) => return Err(fail(known.len())),
                None => continue,
            }
            break;
        }
        match missed {
            Some(missed) => {
                space.refresh();
                need = known.len() + missed;
            }
            None if complete && !space.pairs.exhausted && known.len() < count + ROOM => {
                need = known.len() + STEP;
            }
            None => break,
        }
    }
    Err(fail(space.known().len()))
}

/// Gaps between eigenvalues in which to count, and how many lie below: above the first `count`, the
/// nearest first; where there is none within `ROOM`, within them.
fn gaps(known: &[f64], count: usize, exhausted: bool) -> Vec<(usize, [f64; 2])> {
    let wide = |&cut: &usize| known[cut] - known[cut - 1] > GAP * known[cut];
    let between = |cut: usize| (cut, [known[cut - 1], known[cut]]);
    let mut out: Vec<(usize, [f64; 2])> =
        (count.max(1)..known.len()).filter(wide).take(TRIES).map(between).collect();
    if let Some(&last) = known.last().filter(|_| exhausted) {
        out.push((known.len(), [last, 3.0 * last]));
    }
    if out.is_empty() && known.len() >= count + ROOM {
        out.extend((1..count).rev().filter(wide).take(TRIES).map(between));
        out.push((0, [0.0, known[0]]));
    }
    out
}

/// All (lambda, phi) of K phi = lambda M phi with finite lambda, phi^T M phi = 1, lowest first; K and M by their
/// upper triangles. `None` where the factor or the eigenvalues fail.
fn spectrum(stiffness: &CsMat<f64>, mass: &CsMat<f64>) -> Option<Vec<(f64, DVector<f64>)>> {
    let dense = |upper: &CsMat<f64>| {
        let mut full = Mat::<f64>::zeros(upper.rows(), upper.rows());
        for (value, (i, j)) in upper.iter() {
            (full[(i, j)], full[(j, i)]) = (*value, *value);
        }
        full
    };
    let factor = dense(stiffness).llt(Side::Lower).ok()?;
    let mut matrix = dense(mass);
    let lower = factor.L();
    lower.solve_lower_triangular_in_place(&mut matrix);
    let mut matrix = matrix.transpose().to_owned();
    lower.solve_lower_triangular_in_place(&mut matrix);
    let eigen = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let (values, mut vectors) = (eigen.S(), eigen.U().to_owned());
    lower.transpose().solve_upper_triangular_in_place(&mut vectors);
    let size = vectors.nrows();
    let largest = if size == 0 { 0.0 } else { values[size - 1] };
    let finite = (0..size).rev().filter(|&k| values[k] > MASSLESS * largest);
    Some(
        finite
            .map(|k| {
                let phi = DVector::from_fn(size, |i, _| vectors[(i, k)] / values[k].sqrt());
                (1.0 / values[k], phi)
            })
            .collect(),
    )
}

/// Largest column sum of the magnitudes of the symmetric matrix whose upper triangle is given.
fn column_norm(upper: &CsMat<f64>) -> f64 {
    let mut sums = vec![0.0_f64; upper.cols()];
    for (value, (i, j)) in upper.iter() {
        sums[i] += value.abs();
        if i != j {
            sums[j] += value.abs();
        }
    }
    sums.into_iter().fold(0.0, f64::max)
}
