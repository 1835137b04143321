//! A data set with every reference resolved, ready to be executed.

mod beam;
mod body;
mod build;
mod constraint;
mod fields;
mod load;
mod names;
mod order;
mod units;

use crate::code::Code;
use crate::interpolation::Family;
use crate::space::Vector;
use crate::{Expression, Fault, State};
pub(crate) use beam::Beam;
pub(crate) use body::{Marker, Part};
pub(crate) use constraint::{Constraint, Equation};
pub(crate) use load::{Kind, Load};
pub(crate) use order::Block;

/// A data set that can be executed: forces at a given state, static equilibrium.
#[derive(Clone, Debug)]
pub struct Model {
    pub(crate) parts: Vec<Part>,
    pub(crate) markers: Vec<Marker>,
    pub(crate) loads: Vec<Load>,
    pub(crate) constraints: Vec<Constraint>,
    /// Every scalar that an expression defines: VARIABLEs, components of loads, DIF1s.
    pub(crate) slots: Vec<Slot>,
    pub(crate) diffs: Vec<Diff>,
    pub(crate) requests: Vec<Request>,
    pub(crate) families: Vec<Family>,
    /// SPLINE of each family.
    pub(crate) splines: Vec<u32>,
    /// Acceleration of gravity times the factor from mass to force.
    pub(crate) gravity: Vector<f64>,
    pub(crate) order: Vec<Block>,
    pub(crate) symbols: names::Symbols,
}

/// A scalar that an expression defines.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    pub owner: Owner,
    pub id: u32,
    pub code: Code,
    /// The expression is to vanish, rather than to be the value.
    pub implicit: bool,
    pub guess: f64,
}

/// Whose scalar it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner {
    Variable,
    /// Load and component.
    Load(usize, usize),
    /// DIF1 of a DIFF.
    Rate(usize),
}

#[derive(Clone, Debug)]
pub(crate) struct Diff {
    pub id: u32,
    pub start: f64,
    /// Its slot, of DIF1.
    pub slot: usize,
    /// Kept as it is in statics.
    pub hold: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct Request {
    pub id: u32,
    /// F1 to F8 that are there.
    pub columns: Vec<(usize, Code)>,
}

impl Model {
    /// The state that the data set begins with: PART QG, REULER, VX to WZ, and DIFF IC, at time zero.
    #[must_use]
    pub fn initial(&self) -> State {
        let parts =
            self.parts.iter().filter(|part| !part.ground).map(|part| (part.id, part.pose(&self.markers)));
        let differentials = self.diffs.iter().map(|diff| (diff.id, diff.start));
        State { time: 0.0, parts: parts.collect(), differentials: differentials.collect() }
    }

    /// The keyword and argument that a slot belongs to.
    pub(crate) fn label(&self, slot: &Slot) -> (&'static str, &'static str) {
        match slot.owner {
            Owner::Variable => ("VARIABLE", "FUNCTION"),
            Owner::Rate(_) => ("DIFF", "FUNCTION"),
            Owner::Load(load, component) => {
                self.loads.get(load).map_or(("GFORCE", "FUNCTION"), |load| load.label(component))
            }
        }
    }

    /// Code of one more expression.
    pub(crate) fn compiled(&self, tree: &Expression) -> Result<Code, (usize, Fault)> {
        names::Compiler { symbols: &self.symbols, reactions: true }.compile(tree)
    }
}
