//! Measurements of a run: deviation from a reference, time, memory.

pub mod cpu;
pub(crate) mod deviation;
pub(crate) mod front;
pub(crate) mod memory;
pub(crate) mod quantity;
pub(crate) mod spread;
