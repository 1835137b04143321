//! All natural modes of a frame, from dense matrices.

use faer::{Mat, MatRef, Side};
use nalgebra::DVector;
use sprs::CsMat;

use crate::error::Error;
use crate::influence::FactoredFrame;
use crate::model::Model;
use crate::modes::decoupled::{ExcitingForces, Part};
use crate::modes::mass::ScaledMass;
use crate::modes::mode::{Count, Mode, Modes};

/// Most unknowns of a frame all of whose modes are asked for.
pub const MOST_DENSE_UNKNOWNS: usize = 3000;
/// 1/lambda, relative to the largest, at which an eigenvalue is that of a degree of freedom without mass.
const MASSLESS: f64 = 1e-13;

impl FactoredFrame {
    /// All modes of finite frequency: K phi = omega^2 M phi by the eigenvalues of L^-1 M L^-T, K = L L^T, from
    /// dense matrices. Time grows with the cube of the number of unknowns, memory with its square.
    ///
    /// `m` is the model that the frame was made of.
    ///
    /// # Errors
    /// As [`FactoredFrame::modes`]; [`Error::TooManyModes`] for more than [`MOST_DENSE_UNKNOWNS`] unknowns.
    pub fn all_modes(&self, m: &Model) -> Result<Modes, Error> {
        let mass = ScaledMass::new(m, &self.elements, &self.bodies, self.stiffness())?;
        self.all_of(&Part::whole(self, &mass), &mass)
    }

    /// All modes of finite frequency of the unknowns that `forces` can move, as [`FactoredFrame::all_modes`].
    ///
    /// # Errors
    /// As [`FactoredFrame::all_modes`], where only the unknowns that `forces` can move are counted.
    pub fn all_excited_modes(&self, m: &Model, forces: &ExcitingForces) -> Result<Modes, Error> {
        let mass = ScaledMass::new(m, &self.elements, &self.bodies, self.stiffness())?;
        let part = Part::moved_by(forces, self.rail_loads(), self.stiffness(), &mass);
        self.all_of(&part, &mass)
    }

    fn all_of(&self, part: &Part, mass: &ScaledMass) -> Result<Modes, Error> {
        let unknowns = part.len();
        few_enough(unknowns)?;
        let norms = self.norms(mass)?;
        let modes: Vec<Mode> = spectrum(&part.stiffness, &part.mass, usize::MAX)
            .ok_or(Error::Modes {
                asked: unknowns,
                found: 0,
            })?
            .into_iter()
            .map(|(lambda, phi)| self.mode(part, mass, norms, lambda, &phi))
            .collect();
        let shift = modes.last().map_or(0.0, |mode| mode.omega);
        let count = Count {
            shift,
            below: modes.len(),
            next: None,
        };
        Ok(self.collect_modes(modes, count, mass))
    }
}

/// Refuses more unknowns than dense matrices can have.
pub(super) fn few_enough(unknowns: usize) -> Result<(), Error> {
    if unknowns > MOST_DENSE_UNKNOWNS {
        return Err(Error::TooManyModes {
            unknowns,
            most: MOST_DENSE_UNKNOWNS,
        });
    }
    Ok(())
}

/// The lowest `count` (lambda, phi) of K phi = lambda M phi with finite lambda, phi^T M phi = 1, lowest first; K and M
/// by their upper triangles. `None` where the factor or the eigenvalues fail.
pub(super) fn spectrum(
    stiffness: &CsMat<f64>,
    mass: &CsMat<f64>,
    count: usize,
) -> Option<Vec<(f64, DVector<f64>)>> {
    if stiffness.cols() == 0 {
        return Some(Vec::new());
    }
    let dense = |upper: &CsMat<f64>| {
        let mut full = Mat::<f64>::zeros(upper.rows(), upper.rows());
        for (value, (i, j)) in upper.iter() {
            (full[(i, j)], full[(j, i)]) = (*value, *value);
        }
        full
    };
    dense_spectrum(dense(stiffness).as_ref(), dense(mass), count)
}

/// The same for dense matrices, both symmetric.
pub(super) fn dense_spectrum(
    stiffness: MatRef<'_, f64>,
    mut mass: Mat<f64>,
    count: usize,
) -> Option<Vec<(f64, DVector<f64>)>> {
    // the size 0 has no eigenvalues, and faer subtracts 1 from it
    if stiffness.nrows() == 0 {
        return Some(Vec::new());
    }
    let factor = stiffness.llt(Side::Lower).ok()?;
    let lower = factor.L();
    lower.solve_lower_triangular_in_place(&mut mass);
    // L^-1 M L^-T is symmetric: the transpose of L^-1 M takes the second solve.
    let mut matrix = mass.transpose().to_owned();
    lower.solve_lower_triangular_in_place(&mut matrix);
    let eigen = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    let (values, mut vectors) = (eigen.S(), eigen.U().to_owned());
    lower
        .transpose()
        .solve_upper_triangular_in_place(&mut vectors);
    let size = vectors.nrows();
    let largest = values[size - 1];
    let finite = (0..size)
        .rev()
        .filter(|&k| values[k] > MASSLESS * largest)
        .take(count);
    // phi = L^-T y has y^T y = 1 and phi^T M phi = 1/lambda: scale it to modal mass 1.
    Some(
        finite
            .map(|k| {
                let phi = DVector::from_fn(size, |i, _| vectors[(i, k)] / values[k].sqrt());
                (1.0 / values[k], phi)
            })
            .collect(),
    )
}
