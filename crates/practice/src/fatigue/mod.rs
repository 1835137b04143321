//! Fatigue: direct stress at points of a section, rainflow cycles of its history, and their damage.
//!
//! `stress` gives the stress at a point from internal forces, `rainflow` the cycles of a history, `strength`
//! the strength curves of EN 1993-1-9 with Miner's sum, `aisc` those of AISC 360.

pub mod aisc;
pub mod rainflow;
mod strength;
pub mod stress;

pub use rainflow::{Cycle, History, rainflow};
pub use strength::{CATEGORIES, Damage, END, KNEE, REFERENCE, Strength, Stress};
pub use stress::{Point, Section};
