//! Compliance surfaces that follow from the elements of rails and the compliance of their node states: exact
//! influence coefficients, and what is derived from them.
//!
//! Order: `planar` (the fast path of the exact surface), `places` (displacements of fixed places under loads that change),
//! `groups` (the exact surface between groups of probes that move), `exact`,
//! `displacement_lines` (displacements of fixed places under unit loads anywhere), `effects` (reactions and internal forces),
//! `shapes` (given motions of the rails), `residual` (a surface less what such motions account for),
//! `element_residual` (the same for deflections of single members),
//! `uncoupled` (a compliance without some of its couplings).

mod displacement_lines;
mod effects;
mod element_residual;
mod exact;
mod groups;
mod places;
mod planar;
mod residual;
mod shapes;
mod uncoupled;

pub use displacement_lines::DisplacementLines;
pub use effects::{ForceComponent, InfluenceLines, InternalForce};
pub use element_residual::ElementResidual;
pub use exact::ExactSurface;
pub use residual::ResidualFlexibility;
pub use shapes::RailShapes;
pub use uncoupled::{Couplings, Uncoupled};
