//! File formats and units: from the bytes of files to checked values, and back.
//!
//! Beam specs ([`spec`]), scenes ([`scene`]), grids ([`grid_file`]) and tables ([`tables`]) are read here; every number
//! that leaves is finite, checked and in the units asked for. Everything that is wrong with a file is a
//! [`diagnostic::Diagnostic`] with its place.

pub mod block;
pub mod check;
pub mod coupling;
pub mod effect;
mod effect_file;
pub mod grid;
pub mod grid_file;
pub mod modes_file;
pub mod motion;
pub mod quantity;
pub mod scene;
pub mod schema;
pub mod shape;
pub mod spec;
pub mod surface_file;
pub mod tables;
pub mod text;
pub mod track;
pub mod units;
pub mod vector;

pub use text::{diagnostic, entries, fault, inputs, number, object, place, source};
