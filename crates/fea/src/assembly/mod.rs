//! From a model to the scaled stiffness of its unknowns.
//!
//! Points joined by links form rigid *bodies*. The motion of a body is that of its reference point, six
//! *columns*, less what the supports fix. Each member becomes an *element*: its exact 12 x 12 stiffness with
//! releases condensed, and the transformation B from the motions of two bodies to its end displacements. The
//! columns that remain and that something stiffens are the *unknowns*; they are numbered in elimination
//! order and scaled by powers of two, and K = sum of B^T K' B + springs is added up in them.
//!
//! All of it is written for one number type, so that it can be repeated in double-doubles.
//!
//! Order of the files: `precision`, `sparse`, `graph`, `forest`, `ordering`, `element`, `combination`, `turning`, `bodies`,
//! `ends`, `blocks`, `stiffness`.

mod blocks;
mod bodies;
mod combination;
mod element;
mod ends;
mod forest;
mod graph;
mod ordering;
mod precision;
mod sparse;
mod stiffness;
mod turning;

pub(crate) use blocks::BlockSums;
pub(crate) use bodies::{Bodies, arm};
pub(crate) use combination::Combination;
pub(crate) use element::{
    BendingPlane, Element, Geometry, Matrix6, Matrix12, Released, Triad, bending_planes,
    diagonal_blocks, vector, without_rounding,
};
pub(crate) use ends::{block_diagonal, end_displacements, end_motions, product, transformation};
pub(crate) use precision::{Extended, Real, exact_sum};
pub(crate) use sparse::{
    column_norm, inverse_iterations, irregular_vector, symmetric_product, symmetric_product_lanes,
};
pub(crate) use stiffness::{Numbering, ScaledStiffness};
