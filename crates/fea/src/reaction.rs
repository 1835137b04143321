//! Forces that the ground exerts.

use nalgebra::{DMatrix, DVector, SMatrix, SVector, Vector3};
use splines::Probe;

use crate::assembly::reach;
use crate::error::Error;
use crate::frame::Frame;
use crate::model::{Freedom, Model};
use crate::rail::Rail;

/// Where a reaction acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hold {
    /// Index of the point.
    pub point: usize,
    /// Global freedom that is held.
    pub freedom: Freedom,
    /// Index of the spring that holds it; `None` is a support.
    pub spring: Option<usize>,
}

/// Reactions per unit rail load.
#[derive(Clone, Debug)]
pub struct Reactions {
    /// One a row: supports first, then springs. A support that others of the same rigid body make
    /// redundant is left out.
    pub holds: Vec<Hold>,
    /// `value[(i, j)]`: force or moment of the ground on the structure at hold i, global and positive
    /// along its freedom, per unit force at probe j along its axis.
    pub value: DMatrix<f64>,
}

/// Reactions of supports and springs to unit loads at the probes `at`.
///
/// In equilibrium with the loads: forces and moments of loads and reactions add up to zero.
///
/// # Errors
/// As [`Frame::new`]; a probe beyond its rail, or in a direction that nothing resists.
pub fn reactions(m: &Model, rails: &[Rail], at: &[Probe]) -> Result<Reactions, Error> {
    Frame::new(m, rails)?.reactions(m, at)
}

impl Frame {
    /// [`reactions`] of a frame that is already factored from the same model.
    ///
    /// # Errors
    /// A probe beyond its rail, or in a direction that nothing resists.
    pub fn reactions(&self, m: &Model, at: &[Probe]) -> Result<Reactions, Error> {
        let bodies = &self.freedoms.bodies;
        let mut holds = Vec::new();
        for body in bodies {
            holds.extend(body.holds.iter().map(|&(point, k)| Hold {
                point,
                freedom: Freedom::ALL[k],
                spring: None,
            }));
        }
        for (index, spring) in m.springs.iter().enumerate() {
            holds.push(Hold { point: spring.point, freedom: spring.freedom, spring: Some(index) });
        }
        let solvers: Vec<_> = bodies
            .iter()
            .map(|body| {
                let rows = body
                    .holds
                    .iter()
                    .map(|&(point, k)| self.freedoms.motion(point, &Vector3::zeros()).row(k).transpose());
                let columns: Vec<SVector<f64, 6>> = rows.collect();
                let matrix = DMatrix::from_fn(6, columns.len(), |i, j| columns[j][i]);
                matrix.qr()
            })
            .collect();
        let stiffness: Vec<_> = self
            .elements
            .iter()
            .map(|element| {
                let b = reach(element, &self.freedoms);
                (element.points.map(|point| self.freedoms.body[point]), b.transpose() * element.stiffness * b)
            })
            .filter(|(pair, _)| pair[0] != pair[1])
            .collect();

        let mut value = DMatrix::zeros(holds.len(), at.len());
        for (j, &probe) in at.iter().enumerate() {
            let (load, _) = self.load(probe)?;
            let motions = self.motions(&load);
            let mut residual = vec![SVector::<f64, 6>::zeros(); bodies.len()];
            for (pair, k) in &stiffness {
                let mut u = SVector::<f64, 12>::zeros();
                u.fixed_rows_mut::<6>(0).copy_from(&motions[pair[0]]);
                u.fixed_rows_mut::<6>(6).copy_from(&motions[pair[1]]);
                let force: SMatrix<f64, 12, 1> = k * u;
                residual[pair[0]] += force.fixed_rows::<6>(0);
                residual[pair[1]] += force.fixed_rows::<6>(6);
            }
            for &(column, share) in &self.row(probe)?.0.terms {
                residual[column / 6][column % 6] -= share;
            }
            let first_spring = holds.len() - m.springs.len();
            for (k, spring) in m.springs.iter().enumerate() {
                let body = self.freedoms.body[spring.point];
                let row = self
                    .freedoms
                    .motion(spring.point, &Vector3::zeros())
                    .row(spring.freedom as usize)
                    .into_owned();
                let force = spring.stiffness * (row * motions[body])[0];
                value[(first_spring + k, j)] = -force;
                residual[body] += row.transpose() * force;
            }
            let mut at = 0;
            for ((body, solver), residual) in bodies.iter().zip(&solvers).zip(&residual) {
                let count = body.holds.len();
                if count > 0 {
                    let turned = solver.q().transpose() * DVector::from_column_slice(residual.as_slice());
                    let forces = solver.r().solve_upper_triangular(&turned.rows(0, count));
                    if let Some(forces) = forces {
                        value.view_mut((at, j), (count, 1)).copy_from(&forces);
                    }
                    at += count;
                }
            }
        }
        Ok(Reactions { holds, value })
    }
}
