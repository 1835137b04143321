//! The model: parts, markers, loads, constraints and the scalars that expressions define.

use super::compiler::{Compiler, Symbols};
use super::constraint::Constraint;
use super::formula::Formula;
use super::load::AppliedForce;
use super::order::Block;
use super::part::{Marker, Part};
use crate::kinematics::vector::Vector;
use crate::tables::SplineFunction;
use crate::{AdamsFault, Expression, ModelState};
use std::collections::BTreeSet;

/// A data set with every reference resolved, which can be executed.
///
/// [`AdamsModel::solve`] gives the forces at a state, [`AdamsModel::equilibrium`] static equilibrium, and
/// [`AdamsModel::quasi_static_path`] the quasi-static path.
///
/// ```
/// use adams::{DataSet, AdamsModel};
///
/// let set = DataSet::read("a wheel\nPART/1,GROUND\nPART/2,QG=0,1.25,0\nEND")?;
/// let model = AdamsModel::new(&set)?;
/// assert_eq!(model.initial().parts[&2].origin.y, 1.25);
/// # Ok::<(), adams::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct AdamsModel {
    pub(crate) parts: Vec<Part>,
    pub(crate) markers: Vec<Marker>,
    pub(crate) loads: Vec<AppliedForce>,
    pub(crate) constraints: Vec<Constraint>,
    /// Every scalar that an expression defines: VARIABLEs, components of loads, DIF1s.
    pub(crate) slots: Vec<Slot>,
    pub(crate) diffs: Vec<Diff>,
    pub(crate) requests: Vec<Request>,
    pub(crate) families: Vec<SplineFunction>,
    /// The identifier of the SPLINE of each family.
    pub(crate) splines: Vec<u32>,
    /// Weight of one unit of mass, in the unit of force of the data set.
    pub(crate) gravity: Vector<f64>,
    /// The order in which the slots are evaluated.
    pub(crate) order: Vec<Block>,
    /// The slots that the expression of each slot reads.
    pub(crate) needs: Vec<BTreeSet<usize>>,
    pub(super) symbols: Symbols,
}

/// A scalar that an expression defines.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    pub owner: Owner,
    /// The identifier of the statement.
    pub id: u32,
    pub formula: Formula,
    /// Whether the slot is to be found such that the formula is zero, instead of being its value.
    pub implicit: bool,
    /// The initial value of Newton's method.
    pub guess: f64,
}

/// The statement that a slot belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    /// A VARIABLE.
    Variable,
    /// The index of a load, and the component, 0 to 5.
    Load(usize, usize),
    /// The index of a DIFF; the slot is DIF1.
    Rate(usize),
}

/// A first-order differential equation.
#[derive(Clone, Debug)]
pub(crate) struct Diff {
    pub id: u32,
    /// The initial value of DIF.
    pub start: f64,
    /// The slot of DIF1.
    pub slot: usize,
    /// Whether DIF keeps its value in statics.
    pub hold: bool,
}

/// A REQUEST with function expressions.
#[derive(Clone, Debug)]
pub(crate) struct Request {
    pub id: u32,
    /// The columns F1 to F8 that are given, numbered from 0.
    pub columns: Vec<(usize, Formula)>,
}

impl AdamsModel {
    /// The initial state: QG, REULER and VX to WZ of every PART, and IC of every DIFF, at time zero.
    #[must_use]
    pub fn initial(&self) -> ModelState {
        let parts = self
            .parts
            .iter()
            .filter(|part| !part.ground)
            .map(|part| (part.id, part.pose(&self.markers)));
        let differentials = self.diffs.iter().map(|diff| (diff.id, diff.start));
        ModelState {
            time: 0.0,
            parts: parts.collect(),
            differentials: differentials.collect(),
        }
    }

    /// The keyword and argument that a slot belongs to.
    pub(crate) fn label(&self, slot: &Slot) -> (&'static str, &'static str) {
        match slot.owner {
            Owner::Variable => ("VARIABLE", "FUNCTION"),
            Owner::Rate(_) => ("DIFF", "FUNCTION"),
            Owner::Load(load, component) => self
                .loads
                .get(load)
                .map_or(("GFORCE", "FUNCTION"), |load| load.label(component)),
        }
    }

    /// Compiles an expression that is not part of the data set.
    pub(crate) fn compile(&self, tree: &Expression) -> Result<Formula, (usize, AdamsFault)> {
        Compiler {
            symbols: &self.symbols,
            reactions: true,
        }
        .compile(tree)
    }
}
