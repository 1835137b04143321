//! What is measured of a run: deviations from a reference, time, memory.

pub mod cpu;
pub(crate) mod deviation;
pub(crate) mod front;
pub(crate) mod memory;
pub(crate) mod quantity;
pub(crate) mod spread;
