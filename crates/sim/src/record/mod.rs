//! Results of a run: the samples of every channel, and the energy audit.
//!
//! The results are evaluated at a given state and do not depend on the stepper. This module depends on `contact`.

pub(crate) mod energy;
pub(crate) mod history;
pub(crate) mod recorder;
