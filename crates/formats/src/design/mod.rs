//! Design files: wheel trains on a structure, load cases, and what is asked of them.
//!
//! `raw` is the file as written, `values` the checked design, `practice` and `read` the
//! readers; `plausibility` values that are probably in another unit.

mod plausibility;
mod practice;
mod raw;
mod read;
mod values;

pub(crate) use raw::{RawCase, RawDead, RawDeadLoads, RawDesign, RawForces, RawNamedCase};
pub use read::FORMAT;
pub use values::{
    CODE_PARTS, Design, DesignCase, DesignDead, DesignPractice, DesignSection, DesignTrain,
    DesignWheel, TILTING, TROLLEY_DRIVES, WHOLE,
};
