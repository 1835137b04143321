//! Solution of a model: forces at a given state, static equilibrium, the quasi-static path.
//!
//! `loops` evaluates the slots of a model in order and closes its algebraic loops by the method of `newton`,
//! whose linear equations `linear` solves. `statics` finds parts, loops and reactions together at rest. `substitution` evaluates expressions without closing
//! their loops.
//! `solution` reports the values.

mod evaluation;
mod linear;
mod loops;
mod newton;
mod solution;
mod statics;
mod substitution;

pub use solution::{Load, SolvedModelState};
pub use statics::{ConstraintReaction, EquationResidual, Equilibrium, NewtonStep, RotationMeasure};
pub use substitution::{GivenValues, SubstitutedValues, Substitution};
