//! Kinematics: vectors of scalars, states and poses of parts, frames of markers, and what is measured between
//! them.
//!
//! A [`ModelState`] gives the [`Pose`] of every moving part. A `Frame` is a part or marker in ground coordinates
//! with its velocities, over plain numbers or numbers with derivatives; `measure` evaluates DX to WZ between
//! frames.

mod frame;
mod state;
pub(crate) mod vector;

pub(crate) use frame::{Frame, Measure, angle, measure};
pub use state::{ModelState, Pose};
