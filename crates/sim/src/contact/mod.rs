//! Geometry of the contacts, compliance of rails and bodies at them, and the forces of one stage.
//!
//! Every unknown scalar force is a force element. [`element`] defines the trait of an element, and each kind has one
//! file ([`vertical`], [`flange`], [`traction`], [`drive`], [`brake`], [`rope`], [`stop`]). [`elements`] lists the
//! kinds, and [`system`] is a scene with its elements. [`geometry`] evaluates the elements at a state, [`forces`]
//! solves for their forces, and [`solver`] combines both at one instant and in one stage of a step. This module
//! depends on `mechanics` and is independent of the time integration.

pub(crate) mod active;
pub(crate) mod brake;
pub(crate) mod candidates;
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
pub(crate) mod prescribed;
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
