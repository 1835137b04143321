//! What the caller says: bodies, wheels and their laws, prescribed motions, ropes, stops, drives, brakes, rules,
//! irregular rails and the foundations that carry them.
//!
//! Plain values. Enums and errors stand at the bottom and know no scene; [`model`] puts everything together, and
//! [`check`] holds all checks of it. The wing stands on `numerics` alone.

pub(crate) mod actuators;
pub(crate) mod body;
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
