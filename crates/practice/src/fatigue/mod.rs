//! Fatigue: direct stress at points of a section, rainflow cycles of its history, and their damage.
//!
//! `stress` gives the stress at a point from internal forces, `rainflow` the cycles of a history, `strength`
//! the strength curves of EN 1993-1-9 with Miner's sum, `aisc` those of AISC 360.

pub mod aisc;
pub mod rainflow;
mod strength;
pub mod stress;

pub use rainflow::{Cycle, Repetition, rainflow};
pub use strength::{
    CATEGORIES, CUT_OFF_CYCLES, Damage, LIMIT_CYCLES, REFERENCE_CYCLES, Strength, Stress,
};
pub use stress::{SectionPoint, SectionProperties};
