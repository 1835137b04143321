//! Unknowns of statics: where parts are, and the rest.

use crate::frame::Frame;
use crate::model::{Block, Model, Owner};
use crate::space::{Matrix, add, turned, vector};
use crate::{Dual, Error, Pose, Scalar, State};
use nalgebra::{Matrix3, Rotation3, Vector3};
use std::collections::BTreeMap;

/// What the unknown at an index is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unknown {
    /// Part and axis; the equation beside it is the force along it.
    Shift(usize, usize),
    /// Part and axis; the torque about it.
    Turn(usize, usize),
    /// A torn slot.
    Slot(usize),
    /// DIF of a DIFF.
    Differential(usize),
    /// Constraint and equation.
    Reaction(usize, usize),
}

/// Which unknowns a model has.
pub(super) fn unknowns(model: &Model) -> Vec<Unknown> {
    let mut out = Vec::new();
    for (k, _) in model.parts.iter().enumerate().filter(|(_, part)| !part.ground) {
        out.extend((0..3).map(|axis| Unknown::Shift(k, axis)));
        out.extend((0..3).map(|axis| Unknown::Turn(k, axis)));
    }
    for block in &model.order {
        if let Block::Loop { torn, .. } = block {
            let rate = |slot: usize| matches!(model.slots[slot].owner, Owner::Rate(_));
            out.extend(torn.iter().copied().filter(|slot| !rate(*slot)).map(Unknown::Slot));
        }
    }
    let moving = model.diffs.iter().enumerate().filter(|(_, diff)| !diff.hold);
    out.extend(moving.map(|(k, _)| Unknown::Differential(k)));
    for (k, constraint) in model.constraints.iter().enumerate() {
        out.extend((0..constraint.equations.len()).map(|equation| Unknown::Reaction(k, equation)));
    }
    out
}

/// Values of all unknowns.
#[derive(Clone, Debug)]
pub(super) struct Place {
    pub time: f64,
    /// One a part; ground's are not used.
    pub origins: Vec<Vector3<f64>>,
    pub rotations: Vec<Matrix3<f64>>,
    /// One a slot, of which only torn ones count.
    pub values: Vec<f64>,
    pub differentials: Vec<f64>,
    /// One list a constraint.
    pub reactions: Vec<Vec<f64>>,
}

impl Place {
    pub fn new(model: &Model, state: &State) -> Result<Place, Error> {
        let mut out = Place {
            time: state.time,
            origins: Vec::new(),
            rotations: Vec::new(),
            values: model.slots.iter().map(|slot| slot.guess).collect(),
            differentials: Vec::new(),
            reactions: model.constraints.iter().map(|one| vec![0.0; one.equations.len()]).collect(),
        };
        for part in &model.parts {
            let ground = Pose::at(Vector3::zeros(), Matrix3::identity());
            let pose = if part.ground { Some(&ground) } else { state.parts.get(&part.id) };
            let pose = pose.ok_or_else(|| Error::State { keyword: "PART".to_owned(), id: part.id })?;
            out.origins.push(pose.origin);
            out.rotations.push(right(&pose.rotation));
        }
        for diff in &model.diffs {
            let value = state.differentials.get(&diff.id);
            let value = value.ok_or_else(|| Error::State { keyword: "DIFF".to_owned(), id: diff.id })?;
            out.differentials.push(*value);
        }
        Ok(out)
    }

    /// This place after a share of a step.
    pub fn ahead(&self, unknowns: &[Unknown], step: &[f64], share: f64) -> Place {
        let mut out = self.clone();
        let mut turns: BTreeMap<usize, Vector3<f64>> = BTreeMap::new();
        for (unknown, d) in unknowns.iter().zip(step) {
            let d = share * d;
            match *unknown {
                Unknown::Shift(part, axis) => out.origins[part][axis] += d,
                Unknown::Turn(part, axis) => turns.entry(part).or_insert_with(Vector3::zeros)[axis] += d,
                Unknown::Slot(slot) => out.values[slot] += d,
                Unknown::Differential(diff) => out.differentials[diff] += d,
                Unknown::Reaction(constraint, equation) => out.reactions[constraint][equation] += d,
            }
        }
        for (part, turn) in turns {
            out.rotations[part] = right(&(Rotation3::new(turn).into_inner() * self.rotations[part]));
        }
        out
    }

    /// Frames of the parts, at rest.
    pub fn frames(&self) -> Vec<Frame<f64>> {
        let still = self.origins.iter().zip(&self.rotations);
        still.map(|(origin, rotation)| Frame::at_rest((*origin).into(), rows(rotation))).collect()
    }

    /// The same with derivatives by the unknowns.
    pub fn dual_frames(&self, unknowns: &[Unknown]) -> Vec<Frame<Dual>> {
        let count = unknowns.len();
        let mut shifts: Vec<[Dual; 3]> = self.origins.iter().map(|origin| vector((*origin).into())).collect();
        let mut turns: Vec<[Dual; 3]> = vec![vector([0.0; 3]); shifts.len()];
        for (k, unknown) in unknowns.iter().enumerate() {
            match *unknown {
                Unknown::Shift(part, axis) => {
                    shifts[part][axis] = Dual::unknown(self.origins[part][axis], k, count);
                }
                Unknown::Turn(part, axis) => turns[part][axis] = Dual::unknown(0.0, k, count),
                _ => {}
            }
        }
        let each = shifts.into_iter().zip(turns).zip(&self.rotations);
        each.map(|((origin, turn), rotation)| {
            let axes: Matrix<Dual> = crate::space::matrix(rows(rotation));
            let change = turned(&turn, &axes);
            Frame::at_rest(origin, std::array::from_fn(|row| add(&axes[row], &change[row])))
        })
        .collect()
    }

    pub fn state(&self, model: &Model) -> State {
        let moving = model.parts.iter().enumerate().filter(|(_, part)| !part.ground);
        let pose = |k: usize| Pose::at(self.origins[k], self.rotations[k]);
        State {
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

fn rows(m: &Matrix3<f64>) -> Matrix<f64> {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

/// Axes made orthonormal, x first; unchanged where they cannot be.
fn right(m: &Matrix3<f64>) -> Matrix3<f64> {
    let x = m.column(0).normalize();
    let y = (m.column(1) - x * x.dot(&m.column(1))).normalize();
    let out = Matrix3::from_columns(&[x, y, x.cross(&y)]);
    if out.iter().all(|value| value.is_finite()) { out } else { *m }
}

/// A number with its derivative by the unknown `index`, where there is one.
pub(super) fn seed(value: f64, index: Option<usize>, count: usize) -> Dual {
    index.map_or_else(|| Dual::constant(value), |index| Dual::unknown(value, index, count))
}
