//! Functions along a rail: cells, lines, compliance surfaces, table readings.
//!
//! The bottom of the workspace: knows no file system, no unit, and no other crate of ours.

pub mod akima;
pub mod cell;
pub mod check;
pub mod compliance;
pub mod cubic;
pub mod curve;
pub mod effect;
pub mod error;
pub mod factored;
mod family;
mod kernel;
mod lean;
pub mod lift;
pub mod line;
pub mod parted;
pub mod probe;
pub mod reading;
pub mod rest;
pub mod row;
pub mod sheet;
pub mod stations;
pub mod surface;
pub mod table;
mod tensor;

pub use akima::akima;
pub use cell::{Carrier, Cell, Flexibility};
pub use compliance::{Compliance, Influence, Jet2, Jets};
pub use cubic::natural;
pub use curve::{Curve, Jet};
pub use effect::{Component, Effects, Section};
pub use error::Error;
pub use factored::{Curves, Factor, Factored, Rank};
pub use lift::{Lift, lift};
pub use line::Line;
pub use parted::{Couplings, Parted};
pub use probe::{Axis, Probe};
pub use reading::{Kind, Reading};
pub use rest::{Rest, Shapes};
pub use row::Row;
pub use sheet::Sheet;
pub use stations::{Search, Stations, stations};
pub use surface::Surface;
pub use table::Table;
