//! Influence grids of a structure and their files.
//!
//! A [`StationGrid`] contains the compliances between all stations of a structure. Its file, `girderway-grid/1`, can
//! also contain influence lines of reactions and internal forces, the exact compliance between the stations, and
//! natural modes. The modules from low to high are [`block`], [`effects`], [`influence`], [`coupling`], the members
//! of the file, and the [`file`](mod@file) itself.

pub mod block;
pub mod coupling;
pub mod effects;
mod effects_file;
pub mod file;
pub mod influence;
pub mod modes_file;
mod rows;
pub mod surface_file;

pub use block::{GridBlock, axes};
pub use influence::{GridCritical, GridRail, StationGrid};
