//! One step of inverse iteration of modes with the mass as it is distributed along the members.
//!
//! A mode phi of a mesh satisfies K phi = omega^2 M phi for the motions that the mesh has. Its shear force is in balance
//! with the inertia of the mode only in the mean over each element, so that at a node it jumps, and with it the slope w' =
//! rotation + V/GAs of a member that is flexible in shear. The static deflection of the structure under the inertia
//! omega^2 m phi of the mode, as it is distributed,
//!
//! psi = omega^2 G m phi = phi + omega^2 sum over members of z_j delta_j,
//!
//! has the motions phi of the nodes, because the mesh is exact there for any load, and between them the deflections delta_j
//! of [`InertiaMotions`], z_j being the amplitudes of the member's own motions in the mode. Its shear force is an integral
//! of a load and jumps only where a force acts.
//!
//! The iterated motions are no longer orthogonal. With D_rs = omega_r^2 omega_s^2 sum z_j^r z_k^s (products of strain
//! energies of delta_j, delta_k), and T_rs the same of their kinetic energies,
//!
//! psi_r K psi_s = omega_r^2 [r = s] + D_rs
//! psi_r M psi_s = [r = s] + D_rs/omega_r^2 + D_rs/omega_s^2 + T_rs
//!
//! since delta is orthogonal to all motions of the mesh in the strain energy, and the work of the inertia omega_s^2 m phi_s
//! on delta_r is the product D_rs. The eigenvectors of these two matrices are the iterated modes: orthogonal in strain and
//! kinetic energy, so that they leave a positive semi-definite residual flexibility. By Rayleigh's quotient the errors of
//! their frequencies are of twice the order in the length of the elements.
//!
//! # Source
//! Inverse iteration and Rayleigh-Ritz: Bathe, Finite Element Procedures (1996), section 11.6; Parlett, The Symmetric
//! Eigenvalue Problem (1980), chapter 14.

use std::sync::Arc;

use faer::Mat;
use nalgebra::{SVector, Vector3};

use crate::assembly::{arm, transformation};
use crate::error::Error;
use crate::influence::FactoredFrame;
use crate::model::Model;
use crate::modes::all::dense_spectrum;
use crate::modes::inertia_motions::{InertiaMotions, MOTIONS};
use crate::modes::interior::InteriorMotion;
use crate::modes::mass::release_shapes;
use crate::modes::mode::{BETWEEN, Modes};

/// A member in one plane, and the amplitudes of its motions in all modes.
struct Place {
    member: usize,
    plane: usize,
    inertia: InertiaMotions,
    /// Products of its inertia in each of the six rigid motions of the whole with its own motions.
    coupling: [[f64; MOTIONS]; 6],
}

impl FactoredFrame {
    /// Replaces modes of this frame, as computed from its mesh, by the iterated ones. Without members that are flexible in
    /// shear they are left as they are. `m` is the model that the frame was made of.
    ///
    /// # Errors
    /// [`Error::Modes`] if the two matrices have no eigenvalues in doubles.
    pub(super) fn iterate(&self, m: &Model, modes: &mut Modes) -> Result<(), Error> {
        let count = modes.modes.len();
        let interior = InteriorMotion::all(m, &self.elements, &self.bodies);
        if count == 0 || interior.is_empty() {
            return Ok(());
        }
        let mut places = Vec::with_capacity(interior.len());
        // Amplitudes times the square of the frequency, a column for each mode.
        let mut loads = Mat::<f64>::zeros(MOTIONS * interior.len(), count);
        for (row, motion) in interior.iter().enumerate() {
            let InteriorMotion { member, plane, .. } = *motion;
            let element = &self.elements[member];
            let b = transformation(element, &self.bodies);
            let ends = release_shapes(element).map_or(b, |recovery| recovery * b);
            let pair = self.bodies.pair(element.points);
            let degrees = motion.ends(element);
            let end_motions = |of: &dyn Fn(usize) -> SVector<f64, 6>| -> [f64; 4] {
                let moved = ends.fixed_columns::<6>(0) * of(pair[0])
                    + ends.fixed_columns::<6>(6) * of(pair[1]);
                degrees.map(|(k, sign)| sign * moved[k])
            };
            let reference = |body: usize| self.bodies.list[body].reference;
            for (r, mode) in modes.modes.iter().enumerate() {
                let square = mode.omega * mode.omega;
                let z = end_motions(&|body| mode.points[reference(body)].into());
                for (k, amplitude) in z
                    .into_iter()
                    .chain([mode.between[member][plane][0]])
                    .enumerate()
                {
                    loads[(MOTIONS * row + k, r)] = square * amplitude;
                }
            }
            let whole = |k: usize| {
                end_motions(&|body| {
                    arm(&Vector3::from(m.points[reference(body)]))
                        .column(k)
                        .into_owned()
                })
            };
            let inertia = motion.inertia_motions(m, element);
            let coupling = std::array::from_fn(|k| {
                let ends = whole(k);
                std::array::from_fn(|j| {
                    ends.iter()
                        .zip(&inertia.stiffness)
                        .map(|(z, row)| z * row[j])
                        .sum()
                })
            });
            places.push(Place {
                member,
                plane,
                inertia,
                coupling,
            });
        }
        let [strain, kinetic] = [
            |of: &InertiaMotions| of.stiffness,
            |of: &InertiaMotions| of.mass,
        ]
        .map(|pick| {
            let products = weighted(&places, &loads, pick);
            loads.transpose() * products
        });
        let factors = combinations(modes, &strain, &kinetic).ok_or(Error::Modes {
            asked: count,
            found: 0,
        })?;
        combine(modes, &places, &loads, &factors);
        Ok(())
    }
}

/// The products of the amplitudes `loads` with a matrix of each place.
fn weighted(
    places: &[Place],
    loads: &Mat<f64>,
    pick: fn(&InertiaMotions) -> [[f64; MOTIONS]; MOTIONS],
) -> Mat<f64> {
    let mut out = Mat::<f64>::zeros(loads.nrows(), loads.ncols());
    for (row, place) in places.iter().enumerate() {
        let matrix = pick(&place.inertia);
        for r in 0..loads.ncols() {
            for (i, of) in matrix.iter().enumerate() {
                out[(MOTIONS * row + i, r)] = of
                    .iter()
                    .enumerate()
                    .map(|(j, value)| value * loads[(MOTIONS * row + j, r)])
                    .sum();
            }
        }
    }
    out
}

/// Squares of the frequencies, lowest first, and the factors of all modes in each iterated mode of modal mass 1.
type Combinations = (Vec<f64>, Mat<f64>);

/// The eigenvectors of the two matrices, in coordinates scaled by the frequencies. `None` where they have none in doubles.
fn combinations(modes: &Modes, strain: &Mat<f64>, kinetic: &Mat<f64>) -> Option<Combinations> {
    let count = modes.modes.len();
    let omega: Vec<f64> = modes.modes.iter().map(|mode| mode.omega).collect();
    let one = |r: usize, s: usize| if r == s { 1.0 } else { 0.0 };
    let mean =
        |of: &Mat<f64>, r: usize, s: usize| 0.5 * (of[(r, s)] + of[(s, r)]) / (omega[r] * omega[s]);
    let stiffness = Mat::from_fn(count, count, |r, s| one(r, s) + mean(strain, r, s));
    let mass = Mat::from_fn(count, count, |r, s| {
        let squares = omega[r].powi(-2) + omega[s].powi(-2);
        one(r, s) / (omega[r] * omega[s]) + mean(strain, r, s) * squares + mean(kinetic, r, s)
    });
    let pairs = dense_spectrum(stiffness.as_ref(), mass, count)?;
    if pairs.len() != count {
        return None;
    }
    let sign = |k: usize| if pairs[k].1[k] < 0.0 { -1.0 } else { 1.0 };
    let factors = Mat::from_fn(count, count, |r, k| sign(k) * pairs[k].1[r] / omega[r]);
    Some((pairs.iter().map(|pair| pair.0).collect(), factors))
}

/// Combines the modes and adds the deflections of the members.
fn combine(
    modes: &mut Modes,
    places: &[Place],
    loads: &Mat<f64>,
    (squares, factors): &Combinations,
) {
    let (states, points) = (
        6 * modes.modes[0].states.len(),
        6 * modes.modes[0].points.len(),
    );
    let rows = states + points + places.len() + 6;
    // All motions of each mode, one after another.
    let columns: Vec<Vec<f64>> = (modes.modes.iter())
        .map(|mode| {
            let motions = mode.states.iter().chain(&mode.points).flatten().copied();
            let uniform = places
                .iter()
                .map(|place| mode.between[place.member][place.plane][0]);
            motions.chain(uniform).chain(mode.coupling).collect()
        })
        .collect();
    // Many rows are zero: motions in one plane have none beside it.
    let mut is_kept = vec![false; rows];
    for column in &columns {
        is_kept
            .iter_mut()
            .zip(column)
            .for_each(|(kept, value)| *kept |= *value != 0.0);
    }
    let kept: Vec<usize> = (0..rows).filter(|&row| is_kept[row]).collect();
    let mut index = vec![None; rows];
    kept.iter()
        .enumerate()
        .for_each(|(k, &row)| index[row] = Some(k));
    let sums = Mat::from_fn(kept.len(), columns.len(), |k, r| columns[r][kept[k]]) * factors;
    let amplitudes = loads * factors;
    for (r, mode) in modes.modes.iter_mut().enumerate() {
        mode.omega = squares[r].sqrt();
        let own = |row: usize| index[row].map_or(0.0, |k: usize| sums[(k, r)]);
        for (at, motion) in mode.states.iter_mut().enumerate() {
            *motion = std::array::from_fn(|k| own(6 * at + k));
        }
        for (at, motion) in mode.points.iter_mut().enumerate() {
            *motion = std::array::from_fn(|k| own(states + 6 * at + k));
        }
        mode.coupling = std::array::from_fn(|k| own(rows - 6 + k));
        for (row, place) in places.iter().enumerate() {
            let inertia: [f64; MOTIONS] =
                std::array::from_fn(|k| amplitudes[(MOTIONS * row + k, r)]);
            for (coupling, products) in mode.coupling.iter_mut().zip(&place.coupling) {
                *coupling += products
                    .iter()
                    .zip(&inertia)
                    .map(|(a, b)| a * b)
                    .sum::<f64>();
            }
            let between = &mut mode.between[place.member][place.plane];
            let uniform = own(states + points + row);
            *between = std::array::from_fn(|k| if k == 0 { uniform } else { inertia[k - 1] });
        }
    }
    let motions = Arc::make_mut(&mut modes.motions);
    for place in places {
        motions[place.member][place.plane].truncate(BETWEEN - MOTIONS);
        motions[place.member][place.plane].extend(place.inertia.motions);
    }
}
