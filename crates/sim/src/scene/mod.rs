//! Input of a simulation: bodies, wheels and their contact laws, prescribed motions, ropes, stops, drives, brakes,
//! rules, irregular rails and the foundations that carry them.
//!
//! The types are plain data. [`model`] combines them to a scene, and [`check`] contains all checks of the scene. Of
//! the other layers of this crate, this module depends on `numerics` only.

pub(crate) mod actuators;
pub(crate) mod body;
pub(crate) mod breaks;
pub(crate) mod carrier;
pub(crate) mod channel;
pub(crate) mod check;
pub(crate) mod dof;
pub(crate) mod error;
pub(crate) mod foundation;
pub(crate) mod irregularity;
pub(crate) mod method;
pub(crate) mod model;
pub(crate) mod parts;
pub(crate) mod profile;
pub(crate) mod rope;
pub(crate) mod rule;
pub(crate) mod schedule;
pub(crate) mod structure;
pub(crate) mod wheel;
