//! The lowest fidelity of each structure that suffices: predicted from the scene, compared with higher ones where the
//! prediction is not sure, and checked for all structures together.
//!
//! The top wing: it stands on `run` and sees results alone.

pub(crate) mod choose;
pub(crate) mod distance;
pub(crate) mod fidelity;
pub(crate) mod joint;
pub(crate) mod predict;
pub(crate) mod rung;
pub(crate) mod search;
