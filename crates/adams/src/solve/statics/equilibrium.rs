//! What is reported of a static equilibrium.

use crate::ModelState;
use crate::solve::solution::SolvedModelState;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A static equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// The poses of the parts, and the values DIF for which every DIF1 is zero.
    pub state: ModelState,
    /// VARIABLEs, forces and requests at that state.
    pub solution: SolvedModelState,
    /// The reaction of every JOINT, JPRIM and MOTION, by keyword and identifier.
    pub reactions: BTreeMap<(&'static str, u32), ConstraintReaction>,
    /// Newton iterations.
    pub iterations: usize,
    /// The rank deficiency of the equations: the number of degrees of freedom that no equation determines,
    /// such as the rotation of a wheel without torque, and of redundant constraints.
    pub rank_deficiency: usize,
}

/// The force and torque that a constraint exerts on the part of its marker I, in ground axes and in the units
/// of the data set. The opposite force and torque act on the part of J at the same point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstraintReaction {
    /// Force.
    pub force: Vector3<f64>,
    /// Torque about the origin of I.
    pub torque: Vector3<f64>,
}
