//! Results of a run: every channel as a function of time, its rows, and the energy audit.
//!
//! The results are evaluated at a given state and do not depend on the stepper. This module depends on `contact`.

pub(crate) mod energy;
pub(crate) mod history;
pub(crate) mod modal_motion;
pub(crate) mod recorder;
pub(crate) mod solution;
