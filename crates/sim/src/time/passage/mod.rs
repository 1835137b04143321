//! Crossings at uniform speed by power series of time, without an iteration.

pub(crate) mod crossing;
pub(crate) mod path;
pub(crate) mod series;
