//! Where the contacts are, how rails and bodies comply there, and the forces of one stage.
//!
//! Every unknown scalar force is a force element. [`element`] says what an element answers, one file each holds the
//! kinds ([`vertical`], [`flange`], [`traction`], [`drive`], [`brake`], [`rope`], [`stop`]), [`elements`] lists them,
//! and [`system`] is a scene with its elements. [`geometry`] brings them to a state, [`forces`] solves for their
//! forces, and [`solver`] puts both together at an instant and in a stage. The wing stands on `mechanics` and knows
//! no step.

pub(crate) mod active;
pub(crate) mod brake;
pub(crate) mod chart;
pub(crate) mod charts;
pub(crate) mod compliance;
pub(crate) mod convergence;
pub(crate) mod drive;
pub(crate) mod element;
pub(crate) mod elements;
pub(crate) mod energy;
pub(crate) mod flange;
pub(crate) mod forces;
pub(crate) mod free_motion;
pub(crate) mod geometry;
pub(crate) mod grip;
pub(crate) mod matrices;
pub(crate) mod path;
pub(crate) mod places;
pub(crate) mod probes;
pub(crate) mod projection;
pub(crate) mod rope;
pub(crate) mod rows;
pub(crate) mod solver;
pub(crate) mod spring;
pub(crate) mod stop;
pub(crate) mod switches;
pub(crate) mod system;
pub(crate) mod traction;
pub(crate) mod vertical;
