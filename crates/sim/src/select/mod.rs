//! Selection of the lowest sufficient fidelity of each structure. The scene is run at a cheap fidelity; its wheel forces
//! act on the natural modes that it lacks, which estimates its error; where that is not small, runs with modes follow.
//!
//! This module is the top layer of the crate. It depends on `run` and uses only the results of runs.

pub(crate) mod choose;
pub(crate) mod fidelity;
pub(crate) mod measure;
pub(crate) mod replay;
pub(crate) mod selection;
