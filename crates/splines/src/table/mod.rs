//! Compliance from tables of values at stations, read as ADAMS reads a SPLINE or better.
//!
//! Order: `values` (one table), `block` (a table and the directions that it relates), then the readings:
//! `adams` (AKISPL and CUBSPL), `tensor` (natural splines in both directions), `reading` (either of them),
//! `factored` (sums of products of curves), and `beam_fit` (the exact surface of the beam behind a table).

mod adams;
mod beam_fit;
mod block;
mod factored;
mod reading;
mod tensor;
mod values;

pub use beam_fit::{BeamFit, fit_beam};
pub use block::InfluenceBlock;
pub use factored::{FactorCurves, FactoredTable, Rank, TableFactor};
pub use reading::{ReadingMethod, TableReading};
pub use values::SplineTable;
