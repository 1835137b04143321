//! Time integration: steppers, collocation, power series, and the events at which steps end.
//!
//! This module depends on `instant` and on `record`: rules read the recorded channels, and steps add to the audit.

pub(crate) mod books;
pub(crate) mod collocation;
pub(crate) mod events;
pub(crate) mod guesses;
pub(crate) mod modal_loads;
pub(crate) mod node_forces;
pub(crate) mod nodes;
pub(crate) mod outcome;
pub(crate) mod passage;
pub(crate) mod penetrations;
pub(crate) mod samples;
pub(crate) mod sdirk;
pub(crate) mod step;
pub(crate) mod step_size;
pub(crate) mod stepper;
pub(crate) mod suitability;
pub(crate) mod tableau;
pub(crate) mod transients;
pub(crate) mod triggers;
pub(crate) mod wheel_forces;
