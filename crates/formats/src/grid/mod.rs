//! Influence grids of a structure, and the files that hold them.
//!
//! An [`StationGrid`] holds the compliances between all stations of a structure. Its file, `girderway-grid/1`,
//! may also hold influence lines of reactions and internal forces, the exact compliance between the stations, and
//! natural modes. From low to high: [`block`], [`effects`], [`influence`], [`coupling`], then the members of the file
//! and the [`file`](mod@file) itself.

pub mod block;
pub mod coupling;
pub mod effects;
mod effects_file;
pub mod file;
pub mod influence;
pub mod modes_file;
pub mod surface_file;

pub use block::{GridBlock, axes};
pub use influence::{GridRail, StationGrid};
