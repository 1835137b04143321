//! The content of the report of a run, section by section.

pub(crate) mod codes;
mod design_codes;
pub mod design_report;
mod design_stresses;
pub(crate) mod fatigue;
pub(crate) mod girders;
pub(crate) mod responses;
pub mod run_report;
