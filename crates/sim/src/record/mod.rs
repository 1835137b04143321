//! What a run leaves: the samples of every channel, and the energy audit.
//!
//! Evaluated at a state that is given, so that it knows no stepper. It stands on `contact`.

pub(crate) mod energy;
pub(crate) mod history;
pub(crate) mod recorder;
