//! Answers of a factored frame: influence coefficients, reactions and internal forces of loads on rails.
//!
//! A rail is laid over the members that carry it as a line of rail elements between *states*, the motions of
//! its element ends, each a sparse row over the motions of the bodies. A unit force at a place x of a rail is
//! the load p = N(x)^T through these rows, so that no node is ever placed under a load:
//!
//! G(x, z) = p_x^T K^-1 p_z + \[same member\] b(x, z)
//!
//! with the Green's function b of the member between fixed ends. `grid` evaluates it at chosen places,
//! `surface` keeps the compliance of all states, `effects` does the same for reactions and internal forces.
//!
//! Order of the files: `layout`, `load`, `frame`, `rounding`, `extended`, `grid`, `surface`, `functional`, `effects`.

mod effects;
mod extended;
mod frame;
mod functional;
mod grid;
mod layout;
mod load;
mod rounding;
mod surface;

pub use effects::Reactions;
pub use frame::{DEFAULT_ACCURACY, FactoredFrame};
pub(crate) use functional::Functional;
pub use functional::{Effect, Restraint};
pub(crate) use grid::released_load;
pub use grid::{InfluenceGrid, grid};
pub(crate) use layout::Layout;
pub(crate) use load::RailLoads;
pub use surface::{CertifiedSurface, point_compliance, surface};
