//! The unknowns of statics and their values during the iteration.

use crate::kinematics::Frame;
use crate::kinematics::vector::{Matrix, add, cross_columns, matrix, vector};
use crate::model::{AdamsModel, Block, Owner};
use crate::{Dual, Error, ModelState, Pose, Scalar, StatementId};
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::collections::BTreeMap;

/// One scalar unknown, with the equation that goes with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unknown {
    /// The translation of a part along a ground axis; its equation is the balance of forces along the axis.
    Translation(usize, usize),
    /// The rotation of a part about a ground axis; its equation is the balance of torques about the axis.
    Rotation(usize, usize),
    /// The value of a torn slot; its equation is that of the loop.
    Slot(usize),
    /// DIF of a DIFF; its equation is DIF1 = 0.
    Differential(usize),
    /// The multiplier of an equation of a constraint.
    Reaction(usize, usize),
}

/// How rotations of parts enter the equations of statics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RotationMeasure {
    /// Finite rotations, as in ADAMS.
    Finite,
    /// Small rotations theta from the axes of ground, as in a simulator that linearises: the axes of a part are I +
    /// theta x, and forces have the lever arms that they have without rotation. The equations are then the virtual
    /// work of these displacements. Parts must be parallel to ground without rotation.
    Small,
}

/// The unknowns of a model.
pub(super) fn unknowns(model: &AdamsModel) -> Vec<Unknown> {
    let mut out = Vec::new();
    for (k, _) in model
        .parts
        .iter()
        .enumerate()
        .filter(|(_, part)| !part.ground)
    {
        out.extend((0..3).map(|axis| Unknown::Translation(k, axis)));
        out.extend((0..3).map(|axis| Unknown::Rotation(k, axis)));
    }
    for block in &model.order {
        if let Block::Loop { torn, .. } = block {
            let rate = |slot: usize| matches!(model.slots[slot].owner, Owner::Rate(_));
            out.extend(
                torn.iter()
                    .copied()
                    .filter(|slot| !rate(*slot))
                    .map(Unknown::Slot),
            );
        }
    }
    let moving = model
        .diffs
        .iter()
        .enumerate()
        .filter(|(_, diff)| !diff.hold);
    out.extend(moving.map(|(k, _)| Unknown::Differential(k)));
    for (k, constraint) in model.constraints.iter().enumerate() {
        out.extend((0..constraint.equations.len()).map(|equation| Unknown::Reaction(k, equation)));
    }
    out
}

/// The values of all unknowns at one iteration.
#[derive(Clone, Debug)]
pub(super) struct Iterate {
    pub time: f64,
    pub measure: RotationMeasure,
    /// Position of each part; that of ground is not used.
    pub origins: Vec<Vector3<f64>>,
    /// Axes of each part, likewise.
    pub rotations: Vec<Matrix3<f64>>,
    /// The value of each slot, of which only the torn ones are unknowns.
    pub values: Vec<f64>,
    /// DIF of each DIFF.
    pub differentials: Vec<f64>,
    /// The multipliers of each constraint.
    pub reactions: Vec<Vec<f64>>,
}

impl Iterate {
    /// The values at a state; slots have their initial values and reactions are zero.
    ///
    /// # Errors
    /// [`Error::State`] for a state without one of the parts or DIFFs.
    pub fn new(
        model: &AdamsModel,
        state: &ModelState,
        measure: RotationMeasure,
    ) -> Result<Iterate, Error> {
        let mut out = Iterate {
            time: state.time,
            measure,
            origins: Vec::new(),
            rotations: Vec::new(),
            values: model.slots.iter().map(|slot| slot.guess).collect(),
            differentials: Vec::new(),
            reactions: model
                .constraints
                .iter()
                .map(|one| vec![0.0; one.equations.len()])
                .collect(),
        };
        for part in &model.parts {
            let ground = Pose::at_rest(Vector3::zeros(), Matrix3::identity());
            let pose = if part.ground {
                Some(&ground)
            } else {
                state.parts.get(&part.id)
            };
            let pose = pose.ok_or_else(|| Error::State {
                statement: StatementId::new("PART", part.id),
            })?;
            out.origins.push(pose.origin);
            out.rotations.push(match measure {
                RotationMeasure::Finite => orthonormal(&pose.rotation),
                RotationMeasure::Small => pose.rotation,
            });
        }
        for diff in &model.diffs {
            let value = state.differentials.get(&diff.id);
            let value = value.ok_or_else(|| Error::State {
                statement: StatementId::new("DIFF", diff.id),
            })?;
            out.differentials.push(*value);
        }
        Ok(out)
    }

    /// The iterate after a fraction of a step. Finite rotations are composed, small ones added.
    pub fn after(&self, unknowns: &[Unknown], step: &[f64], fraction: f64) -> Iterate {
        let mut out = self.clone();
        let mut rotations: BTreeMap<usize, Vector3<f64>> = BTreeMap::new();
        for (unknown, d) in unknowns.iter().zip(step) {
            let d = fraction * d;
            match *unknown {
                Unknown::Translation(part, axis) => out.origins[part][axis] += d,
                Unknown::Rotation(part, axis) => {
                    rotations.entry(part).or_insert_with(Vector3::zeros)[axis] += d
                }
                Unknown::Slot(slot) => out.values[slot] += d,
                Unknown::Differential(diff) => out.differentials[diff] += d,
                Unknown::Reaction(constraint, equation) => out.reactions[constraint][equation] += d,
            }
        }
        for (part, rotation) in rotations {
            out.rotations[part] = match self.measure {
                RotationMeasure::Finite => {
                    orthonormal(&(Rotation3::new(rotation).into_inner() * self.rotations[part]))
                }
                RotationMeasure::Small => self.rotations[part] + rotation.cross_matrix(),
            };
        }
        out
    }

    /// The frames of the parts, at rest.
    pub fn frames(&self) -> Vec<Frame<f64>> {
        let still = self.origins.iter().zip(&self.rotations);
        still
            .map(|(origin, rotation)| Frame::at_rest((*origin).into(), rows(rotation)))
            .collect()
    }

    /// The frames of the parts with derivatives with respect to the unknowns. The derivative of axes A with
    /// respect to a rotation about the axis e is e x A, and e x I for small rotations.
    pub fn dual_frames(&self, unknowns: &[Unknown]) -> Vec<Frame<Dual>> {
        let count = unknowns.len();
        let mut origins: Vec<[Dual; 3]> = self
            .origins
            .iter()
            .map(|origin| vector((*origin).into()))
            .collect();
        let mut rotations: Vec<[Dual; 3]> = vec![vector([0.0; 3]); origins.len()];
        for (k, unknown) in unknowns.iter().enumerate() {
            match *unknown {
                Unknown::Translation(part, axis) => {
                    origins[part][axis] = Dual::unknown(self.origins[part][axis], k, count);
                }
                Unknown::Rotation(part, axis) => {
                    rotations[part][axis] = Dual::unknown(0.0, k, count)
                }
                _ => {}
            }
        }
        let each = origins.into_iter().zip(rotations).zip(&self.rotations);
        each.map(|((origin, turn), rotation)| {
            let axes: Matrix<Dual> = matrix(rows(rotation));
            let change = match self.measure {
                RotationMeasure::Finite => cross_columns(&turn, &axes),
                RotationMeasure::Small => cross_columns(&turn, &matrix(rows(&Matrix3::identity()))),
            };
            Frame::at_rest(
                origin,
                std::array::from_fn(|row| add(&axes[row], &change[row])),
            )
        })
        .collect()
    }

    /// The state at this iterate.
    pub fn state(&self, model: &AdamsModel) -> ModelState {
        let moving = model
            .parts
            .iter()
            .enumerate()
            .filter(|(_, part)| !part.ground);
        let pose = |k: usize| Pose::at_rest(self.origins[k], self.rotations[k]);
        ModelState {
            time: self.time,
            parts: moving.map(|(k, part)| (part.id, pose(k))).collect(),
            differentials: model
                .diffs
                .iter()
                .zip(&self.differentials)
                .map(|(d, value)| (d.id, *value))
                .collect(),
        }
    }
}

/// A matrix as three rows.
fn rows(m: &Matrix3<f64>) -> Matrix<f64> {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

/// Axes made orthonormal by the Gram-Schmidt method, x first; unchanged if that gives no finite axes.
fn orthonormal(m: &Matrix3<f64>) -> Matrix3<f64> {
    let x = m.column(0).normalize();
    let y = (m.column(1) - x * x.dot(&m.column(1))).normalize();
    let out = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    if out.iter().all(|value| value.is_finite()) {
        out
    } else {
        *m
    }
}

/// A value that is the unknown `index` of `count`, or a constant without index.
pub(super) fn seed(value: f64, index: Option<usize>, count: usize) -> Dual {
    index.map_or_else(
        || Dual::constant(value),
        |index| Dual::unknown(value, index, count),
    )
}
