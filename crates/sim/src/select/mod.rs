//! Selection of the lowest sufficient fidelity of each structure. The error is predicted from the scene, measured
//! against higher fidelities where the prediction is not conclusive, and checked for all structures together.
//!
//! This module is the top layer of the crate. It depends on `run` and uses only the results of runs.

pub(crate) mod choose;
pub(crate) mod distance;
pub(crate) mod fidelity;
pub(crate) mod joint;
pub(crate) mod predict;
pub(crate) mod search;
pub(crate) mod selection;
