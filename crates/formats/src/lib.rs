//! File formats and units: from the bytes of files to checked values, and back.
//!
//! Beam specs ([`spec`]), scenes ([`scene`]), grids ([`grid_file`]) and tables ([`tables`]) are read here; every number
//! that leaves is finite, checked and in the units asked for. Everything that is wrong with a file is a
//! [`diagnostic::Diagnostic`] with its place.

pub mod check;
pub mod diagnostic;
pub mod entries;
pub mod fault;
pub mod grid;
pub mod inputs;
pub mod motion;
pub mod number;
pub mod object;
pub mod place;
pub mod quantity;
pub mod scene;
pub mod schema;
pub mod source;
pub mod spec;
pub mod tables;
pub mod units;
pub mod vector;

pub use grid::{block, coupling, effects as effect, file as grid_file, modes_file, surface_file};
pub use spec::{cross_section as shape, ties as track};
