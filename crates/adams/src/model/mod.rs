//! A data set with every reference resolved, ready to be executed.
//!
//! `build` reads the statements of a [`DataSet`](crate::DataSet): PART and MARKER into `part`, forces into
//! `load`, joints and motions into `constraint`, expressions through `compiler` into `formula`. Every scalar
//! that an expression defines is a slot; `order` sorts the slots and finds the algebraic loops among them. A
//! `configuration` holds frames and values of slots, on which formulas and loads are evaluated.

mod arguments;
mod beam;
mod build;
mod compiler;
mod configuration;
mod constraint;
mod data;
mod formula;
mod load;
mod order;
mod part;

pub(crate) use configuration::Configuration;
pub(crate) use constraint::{Constraint, Equation};
pub use data::AdamsModel;
pub(crate) use data::Owner;
pub(crate) use formula::Evaluation;
pub(crate) use order::{Block, order};
